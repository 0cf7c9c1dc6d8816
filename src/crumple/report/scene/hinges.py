"""Hinges of a scene: place, state and values at every frame."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from crumple.numeric.arrays import Floats
from crumple.report.figures.shape import hinge_places
from crumple.result import HingeSummary, Result, States

if TYPE_CHECKING:
    from crumple.comparison import HingeMotion, Source

CLOSED, TURNING, RESTING = 0, 1, 2
"""States of a hinge."""
TURNS = 0.02
"""Share of a hinge's largest plastic rotation rate above which it counts as rotating."""
OPEN = np.radians(0.5)
"""Plastic rotation [rad] below which a hinge counts as closed."""
SHORTER = 1e-3
"""Change of length [m] below which it counts as closed."""


def hinges_of_comparison(source: Source, states: States) -> list[dict[str, Any]]:
    """Positions and states of the hinges and measured folds of one side of a comparison at every frame."""
    places = hinge_places(source.result, states)
    found = []
    for motion in (*source.hinges, *source.extra):
        place = places.get(motion.name)
        if place is None:
            place = _fold_place(states, motion)
        state = hinge_states(motion, states.times)
        rotation = np.interp(states.times, motion.time, motion.rotation)
        found.append(_hinge(source.result, motion.name, place, state, rotation, states.times))
    return found


def hinges_of_result(result: Result, states: States) -> list[dict[str, Any]]:
    """Positions and states of the hinges of a result at every frame."""
    places = hinge_places(result, states)
    found = []
    for name in result.hinges:
        channels = [result.channels.get(f"hinge.{name}.{kind}") for kind in ("plastic_rotation", "rotation")]
        plastic, rotation = (np.zeros(len(result.time)) if c is None else c.values for c in channels)
        # with several axes the length of the vector can shrink; a hinge that opened stays open
        reached = np.maximum.accumulate(np.abs(np.nan_to_num(plastic)))
        state = _states(reached, result.time, states.times)
        travel = result.channels.get(f"hinge.{name}.slip.x.travel")
        if travel is not None:
            reached = np.maximum.accumulate(np.abs(np.nan_to_num(travel.values)))
            state = _either(state, _states(reached, result.time, states.times, SHORTER))
        shown = np.interp(states.times, result.time, np.nan_to_num(rotation))
        found.append(_hinge(result, name, places[name], state, shown, states.times))
    return found


def _hinge(
    result: Result, name: str, place: Floats, state: list[int], rotation: Floats, times: Floats
) -> dict[str, Any]:
    entry: dict[str, Any] = {
        "name": name,
        "place": np.round(place, 5).tolist(),
        "state": state,
        "rotation": np.round(rotation, 5).tolist(),
    }
    for kind, of in (("moment", "moment"), ("energy", "energy"), ("travel", "slip.x.travel")):
        channel = result.channels.get(f"hinge.{name}.{of}")
        if channel is not None and np.isfinite(channel.values).all():
            values = np.interp(times, result.time, channel.values)
            entry[kind] = [float(f"{value:.4g}") for value in values]
    summary = result.hinges.get(name)
    energy = None if summary is None else law_energy(summary)
    if energy is not None and "energy" in entry:
        entry["law_energy"] = float(f"{energy:.4g}")
    return entry


def law_energy(summary: HingeSummary) -> float | None:
    """Energy [J] that the law absorbs up to the end of its range of validity, or of its stored curve.

    The integral of the larger of both senses' capacities over the rotation; None without a stored curve.
    """
    envelope = summary.envelope
    if not {"rotation", "positive", "negative"} <= set(envelope) or len(envelope["rotation"]) < 2:
        return None
    rotation = np.asarray(envelope["rotation"], dtype=float)
    moment = np.maximum(np.abs(envelope["positive"]), np.abs(envelope["negative"]))
    end = summary.validity_rotation
    if end is not None and rotation[0] < end < rotation[-1]:
        moment = np.append(moment[rotation < end], np.interp(end, rotation, moment))
        rotation = np.append(rotation[rotation < end], end)
    energy = float(np.diff(rotation) @ (moment[1:] + moment[:-1])) / 2.0
    return energy if np.isfinite(energy) and energy > 0.0 else None


def _fold_place(states: States, motion: HingeMotion) -> Floats:
    """Centre of the section nearest to a fold, (n_states, 3)."""
    own = np.flatnonzero(states.member == states.member_names.index(motion.member))
    station = states.station[own]
    near = own[np.abs(station - motion.station) <= np.abs(station - motion.station).min() + 1e-9]
    return np.asarray((states.points[near] + states.displacement[:, near]).mean(axis=1))


def hinge_states(motion: HingeMotion, times: Floats) -> list[int]:
    """Closed, turning or at rest at given times [s]."""
    plastic = np.maximum.accumulate(np.maximum(motion.sense * motion.plastic_rotation, 0.0))
    if not motion.fold:
        return [CLOSED] * len(times)
    return _states(plastic, motion.time, times)


def _either(first: list[int], second: list[int]) -> list[int]:
    """State of a hinge that turns and changes its length: what moves goes before what rests."""
    order = (CLOSED, RESTING, TURNING)
    return [max(pair, key=order.index) for pair in zip(first, second, strict=True)]


def _states(plastic: Floats, time: Floats, times: Floats, least: float = OPEN) -> list[int]:
    """States at some times from the plastic rotation reached at others, which never decreases."""
    rate = np.gradient(plastic, time) if time.size > 1 else np.zeros_like(plastic)
    fast = float(np.max(rate, initial=0.0))
    now, speed = np.interp(times, time, plastic), np.interp(times, time, rate)
    state = np.where(now < least, CLOSED, np.where(speed > TURNS * fast, TURNING, RESTING))
    return [int(value) for value in state]
