"""Sections that move aside or twist where the multibody model does neither; shells do both.

Nothing is refused for them.

- Oblique axes: the product of inertia I_yz of a section couples its bending about y and z.  Along a force
  in z at the tip of a cantilever

      w = F L^3/(3 E I_y) * k,    v = w I_yz/I_z,    k = I_y I_z/(I_y I_z - I_yz^2),

  but the joints of elastic members and the hinges bend about y and z apart: k = 1 and v = 0.
- Shear centre: a force beside it twists the member.  Elastic members of open sections twist about it, and so
  do hinges of rigid ones, unless these also change their length: forces at the centroid do not twist those.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from crumple.numeric.arrays import Floats
from crumple.section.properties.properties import SectionProperties
from crumple.section.wall_section import walls_of
from crumple.structure.bending import planar
from crumple.structure.checks.unusual import Unusual
from crumple.structure.hinges.asked import automatic_of
from crumple.structure.hinges.places import first_axis, member_hinge_places
from crumple.structure.hinges.runs.bars import bar_of
from crumple.structure.hinges.shares import twists_as_one
from crumple.structure.parts import StructureParts
from crumple.structure.struck_places import struck_places
from crumple.text.names import listed

OBLIQUE = 0.05
"""|I_yz|/sqrt(I_y I_z) from which a section is oblique [-]: the motion aside that the model lacks is 5 % of
the other one if I_y = I_z, 10 % if I_y = 4 I_z, as much as bands of laws; the member is 0.25 % softer.
Outlines of tubes, hats and channels have 0 but for rounding."""
BESIDE = 0.1
"""Distance of a force from the shear centre over the largest side from which it is beside it."""
STEEP = math.cos(math.radians(45.0))
"""Least sine of the slope of a member that is called a post."""
ALONG_Z = 1e-3
"""Sine of the lean from z below which local z is global x, as in `crumple.structure.geometry`."""
TURNED = 5.0
"""Least angle [deg] between local z of a post, seen from above, and the nearest global axis."""
MOST_NAMED = 4
"""Members that a sentence names."""


def section_doubts(structure: StructureParts) -> tuple[Unusual, ...]:
    """Members that bend aside or twist in shells alone; one sentence for all of a section.

    Parameters
    ----------
    structure
        As the multibody solver has it, with its elastic members.
    """
    by_section: dict[str, list[str]] = {}
    for name, spec in structure.members.items():
        if spec.rigid is not True and (spec.elastic or automatic_of(structure, name) is not None):
            by_section.setdefault(spec.section, []).append(name)
    found: list[Unusual] = []
    for section, members in by_section.items():
        walled = walls_of(structure.section_of(members[0]))
        found += _oblique(walled.properties, section, members)
        if not walled.skeleton.cells:
            largest = float(np.ptp(walled.outer_outline(), axis=0).max())
            found += _beside(structure, np.array(walled.shear_centre), largest, members)
    return tuple(found)


def turned_posts(structure: StructureParts) -> str | None:
    """Leaning posts without `up` whose sections are turned with the direction of their lean, in a sentence.

    Local z is the part of global z across the member.  It lies in the vertical plane through the member, so
    that a rafter's section stands upright.  A post's plane is that in which it leans, at any angle to its
    neighbours, while an exactly vertical post has global x as local z.
    """
    if structure.bending_normal is not None:
        return None
    turned = {}
    for name, spec in structure.members.items():
        along = structure.frame_of(name).x
        lean = math.hypot(along[0], along[1])
        plain = spec.up is None and spec.roll == 0.0 and structure.section_of(name).kind != "circular_tube"
        if plain and lean > ALONG_Z and abs(along[2]) >= STEEP:
            angle = abs(_nearest(math.atan2(along[1], along[0])))
            if angle > TURNED:
                turned[name] = angle
    if not turned:
        return None
    worst = max(turned, key=lambda name: turned[name])
    own, are = ("its section is", "leans") if len(turned) == 1 else ("their sections are", "lean")
    have, at = ("has", "") if len(turned) == 1 else ("have", f", {worst} most")
    return (
        f"{_named(list(turned))} {are} and {have} no 'up': {own} turned with the direction of the lean, by "
        f"{turned[worst]:.3g} deg from the global axes{at}. If that is not meant, give 'up', as [1, 0, 0] "
        "for the section of a vertical post."
    )


def unnamed_axes(structure: StructureParts) -> str | None:
    """Listed hinges of structures in space that name no axis, in a sentence.

    Each bends about one axis, across the plane of its part or of what bends it first.
    """
    if planar(structure):
        return None
    hinges = [
        hinge.name
        for name, spec in structure.members.items()
        if automatic_of(structure, name) is None
        for hinge in spec.given_hinges
        if first_axis(hinge) is None and hinge.axes is None and hinge.axial is None
    ]
    if not hinges:
        return None
    who = (
        f"Hinge {hinges[0]} names no axes and bends"
        if len(hinges) == 1
        else (f"Hinges {listed(hinges)} name no axes and bend")
    )
    return (
        f"{who} about one axis alone, though the structure moves in space. Give 'axes: [y, z]', or the "
        "'axis' that is meant."
    )


def _oblique(metal: SectionProperties, section: str, members: list[str]) -> Iterator[Unusual]:
    about_y, about_z, both = metal.second_moment_y, metal.second_moment_z, metal.product_moment
    share = abs(both) / math.sqrt(about_y * about_z)
    if share <= OBLIQUE:
        return
    softer, aside = 1.0 / (1.0 - share**2), abs(both) / min(about_y, about_z)
    text = (
        f"{_named(members)}: the principal axes of section {section} lie "
        f"{abs(_nearest(metal.principal_angle)):.3g} deg from y and z. The multibody model bends it about y "
        f"and z apart; in truth it is {softer:.3g} times as soft and moves aside, by up to {aside:.2g} "
        "of its deflection. Solve with shells."
    )
    for name in members:
        yield Unusual(f"member {name}", share, OBLIQUE, "1", text, "oblique_axes")


def _nearest(angle: float) -> float:
    """Angle [deg] of the principal axis that is nearest to y, from y."""
    return (math.degrees(angle) + 45.0) % 90.0 - 45.0


def _beside(
    structure: StructureParts, centre: Floats, largest: float, members: list[str]
) -> Iterator[Unusual]:
    """Members of an open section that loads or obstacles meet beside its shear centre [m]."""
    if float(np.linalg.norm(centre)) <= BESIDE * largest:
        return
    arms = {
        name: max((abs(_arm(f, centre)) for f in _across(structure, name)), default=0.0) for name in members
    }
    beside = {
        name: arm
        for name, arm in arms.items()
        if arm > BESIDE * largest and not _twists_about_it(structure, name)
    }
    if not beside:
        return
    are = "is" if len(beside) == 1 else "are"
    most = 1e3 * max(beside.values())
    text = (
        f"{_named(list(beside))} {are} of open section and loaded or struck {most:.3g} mm beside the shear "
        "centre, which twists the walls. The hinges there do not twist about this centre: solve with "
        "shells, or hold the member against twist."
    )
    for name, arm in beside.items():
        yield Unusual(f"member {name}", arm, BESIDE * largest, "m", text, "beside_shear_centre")


def _twists_about_it(structure: StructureParts, name: str) -> bool:
    """Whether a member of an open section twists about its shear centre: at a joint, or at its hinges."""
    if twists_as_one(structure, bar_of(structure, name)):
        return True
    keys = [place.keys for place in member_hinge_places(structure, name)]
    return any("x" in (one.axes or ()) for one in keys) and all(one.axial is None for one in keys)


def _arm(direction: Floats, centre: Floats) -> float:
    """Arm about the shear centre [m] of a force through the centroid, for its direction in y and z, (2,)."""
    return float(centre[0] * direction[1] - centre[1] * direction[0])


def _across(structure: StructureParts, member: str) -> Iterator[Floats]:
    """Directions in y and z, (2,), of what loads or strikes a member; the part along it is left out."""
    frame, ends = structure.frame_of(member), structure.members[member].nodes
    forces = [
        np.array([float(getattr(load.force, axis) is not None) * (axis == other) for other in "xyz"])
        for load in structure.loads
        if load.node in ends
        for axis in "xyz"
    ]
    impulses = [np.asarray(one.impulse, float) for one in structure.impulses if one.node in ends]
    struck = [np.asarray(place.outwards, float) for place in struck_places(structure, member)]
    for vector in (*forces, *impulses, *struck):
        size = float(np.linalg.norm(vector))
        if size > 0.0:
            yield np.array([frame.y @ vector, frame.z @ vector]) / size


def _named(members: list[str]) -> str:
    return f"Member{'' if len(members) == 1 else 's'} {listed(members, MOST_NAMED)}"
