"""Histories by name: of a result and what is measured in it, or of a curve file."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from crumple.comparison.measure.motion import HingeMotion, rate_of
from crumple.comparison.measure.sections import Sections
from crumple.numeric.arrays import Floats
from crumple.result import Result
from crumple.structure import Structure
from crumple.structure.bending import bending_axis


@dataclass(frozen=True, eq=False)
class Signal:
    """One history: SI unit, times [s] and values, (n,) each."""

    name: str
    unit: str
    time: Floats
    values: Floats


_HINGE = (
    ("rotation", "rad", "rotation"),
    ("rotation_rate", "rad/s", "rotation_rate"),
    ("plastic_rotation", "rad", "plastic_rotation"),
    ("moment", "N*m", "moment"),
    ("energy", "J", "plastic_work"),
)


def signals_of(
    result: Result, measured: Sequence[HingeMotion], members: Sequence[Signal]
) -> dict[str, Signal]:
    """Channels of a result; histories measured in its shapes replace channels of the same name.

    Parameters
    ----------
    result
        With channels.
    measured
        Hinges measured in the shapes.
    members
        From `member_signals`.
    """
    found = {name: Signal(name, c.unit, result.time, c.values) for name, c in result.channels.items()}
    for motion in measured:
        for key, unit, attribute in _HINGE:
            name = f"hinge.{motion.name}.{key}"
            found[name] = Signal(name, unit, motion.time, getattr(motion, attribute))
    for signal in members:
        found.setdefault(signal.name, signal)
    return found


def member_signals(structure: Structure, sections: Mapping[str, Sections]) -> list[Signal]:
    """Rotation of every member about its bending axis: of the line between its ends, and of its end sections.

    ``member.NAME.chord_rotation`` and ``member.NAME.end_rotation`` with their rates ``..._rate``.
    """
    found = []
    for name, own in sections.items():
        axis = structure.frame_of(name).axis(bending_axis(structure, name))
        turned = own.rotation(axis)
        for key, values in (
            ("chord_rotation", own.chord_rotation(axis)),
            ("end_rotation", turned[:, -1] - turned[:, 0]),
        ):
            found.append(Signal(f"member.{name}.{key}", "rad", own.times, values))
            rate = rate_of(values, own.times)
            found.append(Signal(f"member.{name}.{key}_rate", "rad/s", own.times, rate))
    return found


def at(signal: Signal, time: Floats) -> Floats:
    """Values at other times, linearly between; NaN outside."""
    return np.asarray(np.interp(time, signal.time, signal.values, left=np.nan, right=np.nan))
