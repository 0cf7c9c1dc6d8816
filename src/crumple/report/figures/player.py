"""The animation of a comparison as data for the page: quantised, delta-coded, compressed, of limited size.

Per source: walls as point numbers, and for every frame the positions of the points on a grid of 65536 steps
over the bounding box (0.02 mm on a metre), one byte of plastic strain per point, hinge positions and states.
Frames after the first contain differences; low and high bytes are separate, which compresses better.
"""

from __future__ import annotations

import base64
import json
import zlib
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from crumple.comparison import Comparison, HingeMotion, Source, at_times
from crumple.comparison.measure.folds import STRAIN
from crumple.numeric.arrays import Floats
from crumple.report.drawing.view import View, choose_view
from crumple.report.figures.shape import finite_states, hinge_places
from crumple.result import States

RAW_BYTES = 6_000_000
"""Bytes of all frames before compression; the page then has some 2 MB."""
MOST_FRAMES, FEWEST_FRAMES = 101, 9
"""Most frames of an animation."""
STEPS = 65535
CLOSED, TURNING, RESTING = 0, 1, 2
"""States of a hinge."""
TURNS = 0.02
"""Share of a hinge's largest plastic rotation rate above which it counts as rotating."""
OPEN = np.radians(0.5)
"""Plastic rotation [rad] below which a hinge counts as closed."""
STRONGEST = 99.5
"""Percentile of plastic strain at the end of the colour scale, so that one wall does not determine it."""


@dataclass(frozen=True)
class Scene:
    """Text for the page: header (JSON) and payload (base64 of zlib)."""

    header: str
    payload: str
    strain: float
    frames: int


def scene_of(comparison: Comparison) -> Scene | None:
    """The animation, or None if a result has no shapes or is too large for a page.

    Parameters
    ----------
    comparison
        Candidate and reference are shown.
    """
    sources = (comparison.candidate, comparison.reference)
    found = [finite_states(source.result.states) for source in sources]
    states = [s for s in found if s is not None]
    if len(states) < len(sources):
        return None
    times = _times(states)
    if times is None:
        return None
    shown = [at_times(s, times) for s in states]
    moved = [s.points + s.displacement for s in shown]
    low = np.min([m.reshape(-1, 3).min(axis=0) for m in moved], axis=0)
    high = np.max([m.reshape(-1, 3).max(axis=0) for m in moved], axis=0)
    step = float(np.max(high - low)) / STEPS or 1.0
    strain = _strain_scale(shown)
    view = choose_view(states[-1])
    parts: list[bytes] = []
    models = [
        _model(source, s, np.round((m - low) / step).astype(np.uint16), strain, parts)
        for source, s, m in zip(sources, shown, moved, strict=True)
    ]
    header = {
        "times": [float(t) for t in times],
        "origin": low.tolist(),
        "step": step,
        "size": (high - low).tolist(),
        "view": _view(view),
        "strain": strain,
        "models": models,
    }
    payload = base64.b64encode(zlib.compress(b"".join(parts), 9)).decode()
    # a text element of the page ends at this mark
    text = json.dumps(header, ensure_ascii=True, allow_nan=False).replace("<", "\\u003c")
    return Scene(text, payload, strain, len(times))


def _times(states: list[States]) -> Floats | None:
    """Frame times: those of the reference that both results reached, thinned to the limit of the page."""
    end = min(float(s.times[-1]) for s in states)
    times = states[-1].times
    # a stepper stops at its first step after each requested time, so the last one may exceed the other's end
    if times.size > 1:
        times = times[times <= end + 0.5 * float(np.median(np.diff(times)))]
    size = sum(7 * len(s.points) for s in states)
    most = min(MOST_FRAMES, RAW_BYTES // max(size, 1))
    if most < FEWEST_FRAMES or times.size < 2:
        return None
    rows = np.unique(np.round(np.linspace(0, times.size - 1, min(most, times.size))).astype(int))
    return np.asarray(times[rows])


def _strain_scale(shown: list[States]) -> float:
    values = [s.cell_data[STRAIN][-1] for s in shown if STRAIN in s.cell_data]
    return max((float(np.nanpercentile(v, STRONGEST)) for v in values if v.size), default=0.0)


def _model(
    source: Source, states: States, grid: NDArray[np.uint16], strain: float, parts: list[bytes]
) -> dict[str, Any]:
    """Append one source's bytes and describe them."""
    quads = states.quads.astype("<u4")
    delta = np.diff(grid, axis=0, prepend=np.zeros_like(grid[:1])).astype("<u2")
    coloured = STRAIN in states.cell_data and strain > 0.0
    parts += [
        quads.tobytes(),
        (delta & 0xFF).astype(np.uint8).tobytes(),
        (delta >> 8).astype(np.uint8).tobytes(),
    ]
    if coloured:
        bytes_ = np.round(255 * np.clip(_at_points(states) / strain, 0.0, 1.0)).astype(np.uint8)
        parts.append(np.diff(bytes_, axis=0, prepend=np.zeros_like(bytes_[:1])).tobytes())
    return {
        "name": source.name,
        "points": len(states.points),
        "quads": len(quads),
        "coloured": coloured,
        "hinges": _hinges(source, states),
    }


def _at_points(states: States) -> Floats:
    """Plastic strain at the points, mean of the walls around each, (n_states, n_points)."""
    values = np.nan_to_num(states.cell_data[STRAIN]).reshape(len(states.times), -1)
    corners = states.quads.reshape(-1)
    number = np.maximum(np.bincount(corners, minlength=len(states.points)), 1)
    return np.stack([np.bincount(corners, np.repeat(row, 4), len(states.points)) / number for row in values])


def _hinges(source: Source, states: States) -> list[dict[str, Any]]:
    """Positions and states of the hinges at every frame."""
    places = hinge_places(source.result, states)
    found = []
    for motion in (*source.hinges, *source.extra):
        place = places.get(motion.name)
        if place is None:
            place = _fold_place(states, motion)
        found.append(
            {
                "name": motion.name,
                "place": np.round(place, 5).tolist(),
                "state": hinge_states(motion, states.times),
                "rotation": np.round(np.interp(states.times, motion.time, motion.rotation), 5).tolist(),
            }
        )
    return found


def _fold_place(states: States, motion: HingeMotion) -> Floats:
    """Centre of the section nearest to a fold, (n_states, 3)."""
    own = np.flatnonzero(states.member == states.member_names.index(motion.member))
    station = states.station[own]
    near = own[np.abs(station - motion.station) <= np.abs(station - motion.station).min() + 1e-9]
    return np.asarray((states.points[near] + states.displacement[:, near]).mean(axis=1))


def hinge_states(motion: HingeMotion, times: Floats) -> list[int]:
    """Closed, turning or at rest at given times [s]."""
    plastic = np.maximum.accumulate(np.maximum(motion.sense * motion.plastic_rotation, 0.0))
    rate = np.gradient(plastic, motion.time) if motion.time.size > 1 else np.zeros_like(plastic)
    fast = float(np.max(rate, initial=0.0))
    now, speed = np.interp(times, motion.time, plastic), np.interp(times, motion.time, rate)
    if not motion.fold:
        return [CLOSED] * len(times)
    state = np.where(now < OPEN, CLOSED, np.where(speed > TURNS * fast, TURNING, RESTING))
    return [int(value) for value in state]


def _view(view: View) -> dict[str, list[float]]:
    return {name: getattr(view, name).tolist() for name in ("right", "up", "towards")}
