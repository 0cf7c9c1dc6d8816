"""The one scene format: header (JSON) and payload (compressed bytes); docs/scene.md describes every field.

Per model: walls as point numbers, and for every frame the positions of the points on a grid of 65536 steps
over the bounding box (0.02 mm on a metre), one byte of plastic strain per point, hinge positions and states.
Frames after the first contain differences; low and high bytes are separate, which compresses better.
"""

from __future__ import annotations

import base64
import json
import zlib
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from crumple.numeric.arrays import Floats
from crumple.report.drawing.view import View, choose_view
from crumple.report.figures.shape import finite_states
from crumple.report.scene.coarse import coarsened
from crumple.report.scene.surroundings import forces, masses, obstacles, supports
from crumple.result import Result, States
from crumple.structure import Structure

FORMAT, VERSION = "crumple-scene", 1
RAW_BYTES = 6_000_000
"""Bytes of all frames before compression; the page then has some 2 MB."""
MOST_FRAMES, FEWEST_FRAMES = 101, 9
"""Most frames, and the fewest that still show a motion: for fewer, walls are merged."""
MOST_POINTS = 60_000
"""Most points of all models together, after walls are merged."""
STEPS = 65535
STRAIN = "plastic_strain"
STRONGEST = 99.5
"""Percentile of plastic strain at the end of the colour scale, so that one wall does not determine it."""


@dataclass(frozen=True)
class Shown:
    """One model of a scene: its name, result, the hinges' description at the frames, and its structure.

    `hinges` maps states at the frame times to a list as `crumple.report.scene.hinges` makes it.
    """

    name: str
    result: Result
    hinges: Any
    structure: Structure | None = None


@dataclass(frozen=True)
class Scene:
    """Text for the page: header (JSON) and payload (base64 of zlib)."""

    header: str
    payload: str
    strain: float
    frames: int

    def text(self) -> str:
        """The content of ``scene.json``."""
        return json.dumps({**json.loads(self.header), "payload": self.payload}, ensure_ascii=True)


def write_scene(models: Sequence[Shown], title: str = "", *, compression: int = 7) -> Scene | None:
    """The scene of some results in step, or None if one of them has no shapes.

    Parameters
    ----------
    models
        Drawn side by side; the last one sets the times and the view.
    title
        Of the page.
    compression
        Level of zlib, 1 (fast) to 9 (small); 9 takes three times as long as 7 for 0.3 % less.
    """
    found = [finite_states(model.result.states) for model in models]
    states = [s for s in found if s is not None]
    if not states or len(states) < len(models):
        return None
    view = choose_view(states[-1])
    # a page that would become too large shows fewer walls, and says so
    most = min(MOST_POINTS, RAW_BYTES // (7 * FEWEST_FRAMES)) // len(states)
    drawn = [coarsened(s, most) for s in states]
    times = frame_times(drawn)
    if times is None:
        return None
    shown = [s.at_times(times) for s in drawn]
    moved = [s.points + s.displacement for s in shown]
    low = np.min([m.reshape(-1, 3).min(axis=0) for m in moved], axis=0)
    high = np.max([m.reshape(-1, 3).max(axis=0) for m in moved], axis=0)
    step = float(np.max(high - low)) / STEPS or 1.0
    strain = _strain_scale(shown)
    parts: list[bytes] = []
    described = [
        _model(model, s, np.round((m - low) / step).astype(np.uint16), strain, parts)
        | {"walls": len(whole.quads)}
        for model, s, m, whole in zip(models, shown, moved, states, strict=True)
    ]
    header = {
        "format": FORMAT,
        "version": VERSION,
        "title": title,
        "times": [float(t) for t in times],
        "origin": low.tolist(),
        "step": step,
        "size": (high - low).tolist(),
        "view": _view(view),
        "strain": strain,
        "models": described,
    }
    for model, mine in zip(models, described, strict=True):
        mine["obstacles"] = obstacles(model.structure, model.result, times, low, high)
    payload = base64.b64encode(zlib.compress(b"".join(parts), compression)).decode()
    # a text element of the page ends at this mark
    text = json.dumps(header, ensure_ascii=True, allow_nan=False).replace("<", "\\u003c")
    return Scene(text, payload, strain, len(times))


def frame_times(states: Sequence[States]) -> Floats | None:
    """Frame times: those of the last result that all results reached, thinned to the limit of the page."""
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
    model: Shown, states: States, grid: NDArray[np.uint16], strain: float, parts: list[bytes]
) -> dict[str, Any]:
    """Append one model's bytes and describe them."""
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
    first = np.searchsorted(states.member, np.arange(len(states.member_names)))
    in_order = bool(np.all(np.diff(states.member) >= 0))
    return {
        "name": model.name,
        "points": len(states.points),
        "quads": len(quads),
        "coloured": coloured,
        "members": list(states.member_names) if in_order else [],
        "first": [int(i) for i in first] if in_order else [],
        "hinges": model.hinges(states),
        "masses": masses(model.structure, states),
        "supports": supports(model.structure, states),
        "forces": forces(model.structure, model.result, states),
    }


def _at_points(states: States) -> Floats:
    """Plastic strain at the points, mean of the walls around each, (n_states, n_points)."""
    values = np.nan_to_num(states.cell_data[STRAIN]).reshape(len(states.times), -1)
    corners = states.quads.reshape(-1)
    number = np.maximum(np.bincount(corners, minlength=len(states.points)), 1)
    return np.stack([np.bincount(corners, np.repeat(row, 4), len(states.points)) / number for row in values])


def _view(view: View) -> dict[str, list[float]]:
    return {name: getattr(view, name).tolist() for name in ("right", "up", "towards")}
