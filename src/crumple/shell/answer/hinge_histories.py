"""Rotations, moments and plastic work of hinges, measured in the walls, and the order in which they opened.

A hinge about one axis has the part of the rotation vector along this axis, with its sign.  One about several
has the components about its own axes, as the multibody solver gives them, and the lengths of these vectors.
Its moment is resolved in the frame halfway between its two sides, in which the multibody solver has it too.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping

import numpy as np

from crumple.numeric.arrays import Floats
from crumple.numeric.crossing import first_above
from crumple.numeric.rotation import inverse, relative_rotation, relative_vector, turned, vector_quaternion
from crumple.result import Channel, HingeSummary, Opening
from crumple.result.channels import AXES, channel
from crumple.shell.answer.record import Record, Sampler, slope
from crumple.shell.model.places import HingeZone

Columns = dict[str, Floats]
"""Histories of one hinge by name, (n,) each."""
Parts = tuple[Floats, Floats, Floats]

AT_REST = 2e-3
"""Share of a hinge's plastic work that may follow after its time of rest: vibration adds as much."""
OPEN = math.radians(0.5)
"""Plastic rotation from which a hinge that yielded counts as open [rad]: the largest threshold of the
multibody solver; the elastic part of a measured rotation is not known well enough for less."""


def hinge_channels(sampler: Sampler, record: Record) -> Iterator[Channel]:
    """Rotation between the sections on both sides, moment in the cut, plastic work between."""
    for name, columns in hinge_histories(sampler, record).items():
        yield from (channel(f"hinge.{name}.{column}", values) for column, values in columns.items())


def hinge_histories(sampler: Sampler, record: Record) -> dict[str, Columns]:
    """Columns of every hinge, (n,) each; of one with several components also those of each."""
    time, rings, cuts, work = (record[name] for name in ("time", "ring", "cut", "zone"))
    found = {}
    for k, zone in enumerate(sampler.case.zones):
        first, last = (rings[:, sampler.rings.index(ring)] for ring in (zone.first, zone.last))
        columns = _columns(zone, time, first, last, cuts[:, k, 3:6])
        found[zone.place.name] = columns | {"energy": work[:, k]}
    return found


def _columns(zone: HingeZone, time: Floats, first: Floats, last: Floats, moment: Floats) -> Columns:
    """All columns but the plastic work.

    Parameters
    ----------
    zone
        Of the hinge.
    time
        [s], (n,).
    first, last
        Rotations of its sections from the start, (n, 3, 3) each.
    moment
        In the cut, global axes [N m], (n, 3).
    """
    several = len(zone.turns) > 1
    rotation, plastic, resisting = (_about_several if several else _about_one)(zone, first, last, moment)
    parts = {
        "rotation": rotation,
        "rotation_rate": slope(rotation, time),
        "plastic_rotation": plastic,
        "moment": resisting,
    }
    columns = {
        name: np.linalg.norm(values, axis=1) if several else values[:, 0] for name, values in parts.items()
    }
    if zone.place.keys.single:
        return columns
    axes = [AXES[k] for k in zone.turns]
    return columns | {
        f"{name}.{axis}": np.ascontiguousarray(values[:, i])
        for name, values in parts.items()
        for i, axis in enumerate(axes)
    }


def _about_one(zone: HingeZone, first: Floats, last: Floats, moment: Floats) -> Parts:
    """Rotation, plastic rotation and moment about the axis as the first section carries it, (n, 1) each.

    The moment is what the second side exerts on the first: it has the sign of the rotation that it drives.
    """
    rotation = relative_rotation(first, last, zone.direction)
    along = np.einsum("ti,ti->t", moment, first @ zone.direction)
    return rotation[:, None], (rotation - along / zone.stiffness)[:, None], along[:, None]


def _about_several(zone: HingeZone, first: Floats, last: Floats, moment: Floats) -> Parts:
    """The same about each axis of a hinge that turns about several, (n, axes) each."""
    turns = list(zone.turns)
    vector = relative_vector(first, last)
    # from the first section's frame half the way on to the second's
    seen = np.einsum("tji,tj->ti", first, moment)
    halfway = turned(inverse(vector_quaternion(vector / 2.0)), seen)
    rotation, about = vector @ zone.axes[turns].T, halfway @ zone.axes[turns].T
    elastic = about @ zone.flexibility[np.ix_(turns, turns)]
    if turns[0] == 0:
        # of walls that cannot warp G J is too soft, of open sections by an order of magnitude
        twist = rotation[:, 0]
        elastic[:, 0] = np.clip(elastic[:, 0], np.minimum(twist, 0.0), np.maximum(twist, 0.0))
    return rotation, rotation - elastic, about


def summaries(sampler: Sampler, record: Record, hinges: Mapping[str, Columns]) -> dict[str, HingeSummary]:
    """Summary of every hinge, from the histories of `hinge_histories`."""
    found = {}
    for zone in sampler.case.zones:
        columns = hinges[zone.place.name]
        rotation, energy = columns["rotation"], columns["energy"]
        found[zone.place.name] = HingeSummary(
            rotation_max=float(np.abs(rotation).max()),
            rotation_final=float(rotation[-1]),
            time_of_rest=_rest(record["time"], energy),
            energy=float(energy[-1]),
            moment_max=float(np.abs(columns["moment"]).max()),
            position=tuple(float(value) for value in zone.position),  # type: ignore[arg-type]
        )
    return found


def openings(time: Floats, hinges: Mapping[str, Columns]) -> tuple[Opening, ...]:
    """Hinges that opened, in the order in which they did, from the histories of `hinge_histories`."""
    found = []
    for name, columns in hinges.items():
        plastic, energy = columns["plastic_rotation"], columns["energy"]
        # before the walls between its sections yield, what M/k leaves is no plastic rotation
        when = first_above(time, np.where(energy > 0.0, np.abs(plastic), 0.0), OPEN)
        if when is not None:
            found.append(Opening(name, when, float(plastic[-1]), float(energy[-1])))
    return tuple(sorted(found, key=lambda opening: opening.time))


def _rest(time: Floats, energy: Floats) -> float | None:
    """Time after which almost no plastic work was done [s]; None if it continues at the end."""
    final = float(energy[-1])
    if final <= 0.0:
        return 0.0
    rest = int(np.argmax(energy >= (1.0 - AT_REST) * final))
    return None if rest >= len(time) - 2 else float(time[rest])
