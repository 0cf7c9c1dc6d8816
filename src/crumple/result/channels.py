"""Every output channel, one line each: name, unit, meaning and which solver gives it.

`python -m crumple.result.channels docs/conventions.md` writes the table of that page again; a test compares
the page with it.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np

from crumple.numeric.arrays import Floats
from crumple.result.result import Channel

AXES = ("x", "y", "z")
BEGIN = "<!-- written by `python -m crumple.result.channels docs/conventions.md`: begin -->"
END = "<!-- end -->"


class Kind(NamedTuple):
    """One kind of channel.

    Attributes
    ----------
    name
        With NAME for a name of the input, and ``xyz`` for a channel along or about each axis.
    unit
        SI unit.
    meaning
        For people.
    given_by
        M: the multibody solver alone; MS: its spatial kernel; S: the shell solver; empty: every solver.
    """

    name: str
    unit: str
    meaning: str
    given_by: str = ""


KINDS = (
    Kind(
        "hinge.NAME.rotation",
        "rad",
        "rotation, elastic part included; of several rotations the length of their vector, as below",
    ),
    Kind("hinge.NAME.rotation_rate", "rad/s", "rate of the rotation"),
    Kind(
        "hinge.NAME.plastic_rotation",
        "rad",
        "part of the rotation that remains when the moment is removed",
    ),
    Kind("hinge.NAME.moment", "N*m", "resisting moment, including stop and damper"),
    Kind(
        "hinge.NAME.capacity",
        "N*m",
        "largest moment that the law allows at present; of several rotations no limit, as below",
        "M",
    ),
    Kind("hinge.NAME.energy", "J", "energy absorbed so far"),
    Kind(
        "hinge.NAME.rotation.xyz",
        "rad",
        "rotation about each axis of a hinge with several (see below)",
        "MS, S",
    ),
    Kind("hinge.NAME.rotation_rate.xyz", "rad/s", "its rate", "MS, S"),
    Kind("hinge.NAME.plastic_rotation.xyz", "rad", "its plastic part", "MS, S"),
    Kind("hinge.NAME.moment.xyz", "N*m", "moment about each axis", "MS, S"),
    Kind("hinge.NAME.capacity.xyz", "N*m", "capacity about each axis if nothing else loads the hinge", "MS"),
    Kind(
        "hinge.NAME.slip.x.travel",
        "m",
        "axial slip of a hinge along its member, elastic part included, positive in lengthening",
        "MS",
    ),
    Kind("hinge.NAME.slip.x.rate", "m/s", "rate of the axial slip", "MS"),
    Kind(
        "hinge.NAME.slip.x.plastic_travel",
        "m",
        "part of the axial slip that remains when the force is removed",
        "MS",
    ),
    Kind("hinge.NAME.slip.x.force", "N", "axial force of the hinge, positive in tension", "MS"),
    Kind(
        "hinge.NAME.slip.x.capacity",
        "N",
        "largest axial force at present if nothing else loads the hinge",
        "MS",
    ),
    Kind(
        "member.NAME.energy",
        "J",
        "energy absorbed by a member: its hinges, what yields between them, and dents in its walls",
        "M",
    ),
    Kind(
        "node.NAME.displacement.xyz",
        "m",
        "displacement from the start position, global axes; at a mitred corner the mean of both ends; "
        "in a dent with the mean of the walls",
    ),
    Kind("node.NAME.velocity.xyz", "m/s", "velocity, global axes"),
    Kind(
        "node.NAME.acceleration.xyz",
        "m/s^2",
        "mean acceleration between outputs; an impulsive motion has no instantaneous acceleration",
    ),
    Kind(
        "node.NAME.rotation.xyz",
        "rad",
        "rotation vector of the body that carries the node; at a mitred corner the mean of both ends",
    ),
    Kind("node.NAME.rotation_rate.xyz", "rad/s", "angular velocity of this body"),
    Kind(
        "cut.NAME.force.xyz",
        "N",
        "force that the second side of a hinge exerts on the first, global axes",
        "MS, S",
    ),
    Kind("cut.NAME.moment.xyz", "N*m", "moment of the same about the middle of the cut", "MS, S"),
    Kind(
        "joint.NAME.force.xyz",
        "N",
        "force that a node exerts on its member at a joint, global axes",
        "MS",
    ),
    Kind("joint.NAME.moment.xyz", "N*m", "moment of the same about the joint", "MS"),
    Kind(
        "support.NAME.force.xyz",
        "N",
        "force that the structure exerts on a support, global axes",
        "MS, S",
    ),
    Kind(
        "support.NAME.moment.xyz",
        "N*m",
        "moment of the same about the node (multibody) or about the middle of the held sections (shells)",
        "MS, S",
    ),
    Kind(
        "obstacle.NAME.force.xyz",
        "N",
        "resultant contact force of the structure on an obstacle; mean since the last output",
        "MS, S",
    ),
    Kind(
        "obstacle.NAME.displacement.xyz",
        "m",
        "displacement of an obstacle from its start position, before its rotation (`turning`) is "
        "applied; in the multibody solver of moving obstacles only",
        "MS, S",
    ),
    Kind("obstacle.NAME.velocity.xyz", "m/s", "velocity of this displacement", "MS, S"),
    Kind(
        "obstacle.NAME.dent", "m", "depth of the dents that it presses into tubes; where it dents any", "MS"
    ),
    Kind("weld.NAME.failed", "1", "fraction of the spot welds of an entry that have failed", "S"),
    Kind(
        "weld.NAME.normal_force",
        "N",
        "largest force normal to the sheets, tension positive, of the spots that hold",
        "S",
    ),
    Kind(
        "weld.NAME.shear_force",
        "N",
        "largest force in the plane of the sheets of the spots that hold",
        "S",
    ),
    Kind("weld.NAME.use", "1", "largest (Fn/Sn)^2 + (Fs/Ss)^2 of any spot so far; a spot fails at 1", "S"),
    Kind("energy.kinetic", "J", "kinetic energy of all bodies"),
    Kind(
        "energy.elastic",
        "J",
        "elastic energy of hinges, springs and stops (multibody), or of the walls (shells)",
    ),
    Kind(
        "energy.dissipated",
        "J",
        "energy absorbed by hinges, what yields between them, and dents (multibody), or plastic work of the "
        "walls (shells)",
    ),
    Kind(
        "energy.contact",
        "J",
        "energy lost in impacts (multibody, where contact can occur), or minus the work of the "
        "contact forces (shells)",
        "MS, S",
    ),
    Kind("energy.friction", "J", "work of friction, where contact can occur", "MS"),
    Kind("energy.hourglass", "J", "hourglass energy", "S"),
    Kind(
        "energy.damping",
        "J",
        "kinetic energy that quasi-static stages remove (multibody), or work of mass-proportional"
        " damping (shells); only where it occurs",
        "MS, S",
    ),
    Kind(
        "energy.eroded",
        "J",
        "elastic energy of deleted elements, contained in `energy.elastic`; only where elements fail",
        "S",
    ),
    Kind(
        "energy.external_work",
        "J",
        "work done since the start by loads, prescribed motion of supports and obstacles, "
        "gravity, and the motion that later stages add",
    ),
    Kind("energy.gravity", "J", "part of the external work that gravity does, where gravity is given", "M"),
    Kind("energy.residual", "J", "error of the energy balance, see below"),
)
_UNITS = {kind.name: kind.unit for kind in KINDS}


def channel(name: str, values: Floats) -> Channel:
    """One channel with the unit of its kind; requested outputs have names and units of their own.

    Parameters
    ----------
    name
        In full, for example ``hinge.root.moment``.
    values
        (n,).

    Raises
    ------
    LookupError
        If no kind has such a name: it needs a line in `KINDS`.
    """
    kind = kind_of(name)
    if kind not in _UNITS:
        raise LookupError(f"no kind of channel is called {kind}: give it a line in {__name__}.KINDS")
    return Channel(name, _UNITS[kind], values)


def channels_along(name: str, values: Floats) -> Iterator[Channel]:
    """Channels along, or about, the three axes, from values (n, 3)."""
    for i, axis in enumerate(AXES):
        yield channel(f"{name}.{axis}", np.ascontiguousarray(values[:, i]))


def kind_of(name: str) -> str:
    """Name of the kind of a channel."""
    parts = name.split(".")
    if len(parts) > 2:
        parts[1] = "NAME"
    if parts[-1] in AXES:
        parts[-1] = "xyz"
    return ".".join(parts)


def unit_of(name: str) -> str | None:
    """SI unit of a channel with such a name, requested outputs apart; None if there is no such kind."""
    return _UNITS.get(kind_of(name))


def names_of(family: str, name: str) -> Iterator[str]:
    """Names of the channels of one hinge, node or obstacle, without those of a hinge's components."""
    for kind in KINDS:
        head, _, rest = kind.name.partition(".NAME.")
        quantity = rest.removesuffix(".xyz")
        along = quantity != rest
        component = along and f"{family}.NAME.{quantity}" in _UNITS
        if head == family and "." not in quantity and not component:
            stem = f"{family}.{name}.{quantity}"
            yield from (f"{stem}.{axis}" for axis in AXES) if along else (stem,)


def channel_table() -> str:
    """Markdown table of every kind."""
    rows = [("Channel", "Unit", "Meaning", "Given by"), ("---",) * 4]
    for kind in KINDS:
        spelt = f"`{kind.name[:-3]}x` … `.z`" if kind.name.endswith(".xyz") else f"`{kind.name}`"
        rows.append((spelt, kind.unit, kind.meaning, kind.given_by))
    return "\n".join(f"| {' | '.join(row)} |".replace("|  |", "| |") for row in rows)


def main(path: Path) -> None:
    """Write the table again between the marks of a file."""
    before, _, rest = path.read_text(encoding="utf-8").partition(BEGIN)
    after = rest.partition(END)[2]
    path.write_text(f"{before}{BEGIN}\n\n{channel_table()}\n\n{END}{after}", encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
