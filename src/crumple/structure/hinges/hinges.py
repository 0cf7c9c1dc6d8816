"""Law and stiffness of each hinge of a structure, for the solvers."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Literal

import numpy as np

from crumple import hinge
from crumple.cancelling import go_on
from crumple.errors import InputError, Problem
from crumple.hinge import (
    Form,
    HingeLaw,
    HingeRecord,
    SofteningVariable,
    SpatialHingeRecord,
    Stop,
)
from crumple.hinge.bending.edge_fold import BESIDE_A_CLAMP
from crumple.hinge.corner.in_plane import InPlaneLaw
from crumple.hinge.record.sampling import TOO_STEEP
from crumple.section import AXES, Axis
from crumple.section.section import in_mm
from crumple.structure.hinges.automatic import near_fold
from crumple.structure.hinges.corner.press import with_corner_press
from crumple.structure.hinges.corner.shift import with_corner_shift
from crumple.structure.hinges.corner.slip import with_corner_slip
from crumple.structure.hinges.corner.springs import with_corner_springs
from crumple.structure.hinges.corner_laws import corner_of, turned_corner
from crumple.structure.hinges.joints.elastic_joints import elastic_joints
from crumple.structure.hinges.joints.placed_hinge import PlacedHinge, direction_of, position_of
from crumple.structure.hinges.places import (
    MADE,
    HingePlace,
    law_of,
    law_spec,
    member_hinge_places,
)
from crumple.structure.hinges.runs.bars import bar_of
from crumple.structure.hinges.runs.straight_runs import StraightRun
from crumple.structure.hinges.shares import (
    AxisShares,
    HingeShares,
    about_axis,
    bar_shares,
    moment_free_ends,
)
from crumple.structure.hinges.spatial_hinges import APART, spatial_hinge_record
from crumple.structure.hinges.stored_loads import laws_of_loads, twist_law
from crumple.structure.hinges.t_joints import t_joint_name, t_laws
from crumple.structure.keys.law import LawKeys, Stops
from crumple.structure.parts import StructureParts
from crumple.structure.remembered import remembered

ANY = HingeShares({"y": 1.0, "z": 1.0})
"""Shares for results that do not depend on the length of a member."""
AXIS_ROW: dict[Axis, int] = {"y": 1, "z": 2}
"""Row of an axis among the axes of a hinge."""
STIFF = 0.1
"""Length of member over the side of its section that bends as a corner that states no flexibility."""
HELD = ("rectangular_tube", "closed_hat")
"""Kinds of section whose folds tension holds, in members that bend; round tubes' folds it does not."""
THINNEST = 1e-3
"""Wall thickness over the largest side from which the laws of all shapes have tables; some need a third."""
OWN_HINGES = ("placed hinges", "")
"""Where a structure keeps what `placed_hinges` found."""


def placed_hinges(structure: StructureParts) -> tuple[PlacedHinge, ...]:
    """Every hinge with its law, and after those of each member its elastic joints, ready for a solver.

    Raises
    ------
    InputError
        With every law that does not fit its section.
    """
    return structure.kept.once(*OWN_HINGES, lambda: _placed_hinges(structure))


def _placed_hinges(structure: StructureParts) -> tuple[PlacedHinge, ...]:
    problems: list[Problem] = []
    own: dict[str, list[PlacedHinge]] = {}
    bars: dict[str, tuple[StraightRun, dict[Axis, AxisShares]]] = {}
    free = moment_free_ends(structure)
    for member, spec in structure.members.items():
        places = member_hinge_places(structure, member)
        own[member] = []
        if not places and not spec.elastic:
            continue
        bar = bar_of(structure, member)
        shares, about = _shares(structure, bar, free)
        bars[bar.first] = bar, about
        for place in places:
            go_on()
            try:
                own[member].append(_placed(structure, place, shares[place.name]))
            except InputError as error:
                problems += [_of_hinge(structure, place, problem) for problem in error.problems]
    if problems:
        raise InputError(list(dict.fromkeys(problems)))
    joints: dict[str, list[PlacedHinge]] = defaultdict(list)
    for bar, about in bars.values():
        go_on()
        hinges = [hinge for name in bar.stretches for hinge in own[name]]
        for joint in elastic_joints(structure, bar, hinges, about):
            joints[joint.member].append(joint)
    return tuple(hinge for member, hinges in own.items() for hinge in (*hinges, *joints[member]))


def too_thin(structure: StructureParts, place: HingePlace) -> Problem:
    """Walls so thin that the moment of their fold has no table: it falls to nothing within a small angle."""
    name = structure.members[place.member].section
    section = structure.section_of(place.member)
    side = float(np.ptp(section.outer_outline(), axis=0).max())
    key = ".thickness" if "thickness" in getattr(structure.sections[name], "own", {}) else ""
    return Problem(
        "the walls are too thin: the moment of their folds falls too steeply",
        f"{in_mm(section.thickness)} with a largest side of {in_mm(side)}",
        f"a {1.0 / THINNEST:.0f}th of the side or more, here {in_mm(THINNEST * side)}",
        "check the unit, and give thicker walls",
        f"sections.{name}{key}",
    )


def _of_hinge(structure: StructureParts, place: HingePlace, problem: Problem) -> Problem:
    """Problem of a hinge's law, with the hinge, its member, and its path in the input."""
    if problem.what.endswith(TOO_STEEP):
        return too_thin(structure, place)
    key = f"{problem.where}: " if problem.where else ""
    what = f"hinge '{place.name}' of member '{place.member}': {key}{problem.what}"
    return replace(problem, what=what, where=place.where)


def plastic_hinges(structure: StructureParts) -> tuple[PlacedHinge, ...]:
    """The hinges of `placed_hinges` without elastic joints."""
    return tuple(hinge for hinge in placed_hinges(structure) if hinge.plastic)


def shares_left_out(structure: StructureParts) -> dict[str, dict[Axis, AxisShares]]:
    """Shares that rigid hinges would have if they were elastic, by member and bending axis."""
    free = moment_free_ends(structure)
    found: dict[str, dict[Axis, AxisShares]] = {}
    for member in structure.members:
        about = {}
        if member_hinge_places(structure, member):
            about = _shares(structure, bar_of(structure, member), free)[1]
        found[member] = {axis: shares for axis, shares in about.items() if shares.rigid}
    return found


def _shares(
    structure: StructureParts, bar: StraightRun, free: Callable[[str, Axis], tuple[bool, bool]]
) -> tuple[dict[str, HingeShares], dict[Axis, AxisShares]]:
    """See `bar_shares`; `free`: which ends of members carry no moment."""

    def free_about(axis: Axis) -> tuple[bool, bool]:
        (one, start), (other, end) = bar.ends
        first = free(one, axis)[structure.members[one].nodes.index(start)]
        return first, free(other, axis)[structure.members[other].nodes.index(end)]

    return structure.kept.once("shares", bar.first, lambda: bar_shares(structure, bar, free_about))


def _bending(
    structure: StructureParts, place: HingePlace, share: HingeShares, *, jams: bool = True
) -> tuple[HingeLaw, HingeRecord]:
    """Law and record about one axis of a hinge that stands for lengths of member [m].

    `jams`: whether walls of a corner come to lie on each other; those that are pressed straight do not.
    """
    spec = law_spec(structure, place)
    rigidity = structure.flexural_rigidity(place.member, place.axis)
    law = law_of(structure, place)
    if not jams and isinstance(law, InPlaneLaw):
        law = replace(law, jamming=0.0)
    record = _record(law, spec, rigidity)
    # hinges of a chain differ only in length, which only the elastic form uses
    by_length = spec.elastic_stiffness == "auto" and law.elastic_stiffness is None
    if record.form is Form.ELASTIC_PLASTIC and by_length:
        length = share.bending.get(place.axis, STIFF * _side(structure, place.member))
        stiffness = hinge.tributary_stiffness(rigidity, length)
        record = replace(record, elastic_stiffness=stiffness)
    return law, record


def spatial_record_of(
    structure: StructureParts, place: HingePlace, shares: HingeShares = ANY
) -> SpatialHingeRecord | None:
    """All components of a hinge, None if it bends about one axis alone.

    Parameters
    ----------
    structure, place
        The hinge.
    shares
        Lengths of member that it stands for.

    Raises
    ------
    InputError
        If its laws and axes do not fit the section or each other.
    """
    if place.keys.plain:
        return None

    corner = turned_corner(structure, place.name, place.keys.axes)
    plain = corner_of(structure, place.name) if corner is None else None
    metal = structure.section_of(place.member), structure.material_of(place.member)
    # in a plane a shortening of a corner of tubes counts as rotation
    slips = plain is not None and place.keys.axial is not None and metal[0].kind == "rectangular_tube"

    def record_about(axis: Axis) -> HingeRecord:
        return _bending(structure, about_axis(place, axis), shares, jams=not slips)[1]

    torsion = twist_law(structure, place)
    record = spatial_hinge_record(
        place.keys,
        record_about,
        place.axis,
        metal,
        shares,
        torsion=torsion,
        crush=laws_of_loads(structure, place).get("crush"),
    )
    if near_fold(structure, place.member, place.name).fold == "clamped":
        record = replace(record, edge_relief=BESIDE_A_CLAMP * record.edge_relief)
    squash = metal[1].yield_stress * metal[0].area
    if corner is None:
        return record if plain is None else with_corner_slip(record, plain, metal[0], squash)
    # a corner's twist is about another axis, and its law contains what its walls carry besides
    own = replace(record, shear_loss=(0.0, 0.0))
    elastic = bool(structure.members[place.member].elastic)
    # elastic members twist between their corners
    twisted = STIFF * _side(structure, place.member) if elastic else shares.twist
    sprung = with_corner_springs(own, corner, metal, twisted, torsion)
    shifted = with_corner_shift(sprung, corner, metal[0])
    straight = _bending(structure, about_axis(place, corner.axis), shares, jams=False)[1]
    return with_corner_press(shifted, corner, metal[0], squash, straight)


def _side(structure: StructureParts, member: str) -> float:
    """Largest side of a member's section [m]."""
    return float(np.ptp(structure.section_of(member).outer_outline(), axis=0).max())


def _placed(structure: StructureParts, place: HingePlace, shares: HingeShares) -> PlacedHinge:
    law, record = _bending(structure, place, shares)
    frame = structure.frame_of(place.member)
    corner = turned_corner(structure, place.name, place.keys.axes)
    if corner is None and place.keys.axial is not None and place.keys.axes is None:
        # in a plane a corner slips at right angles to its mitre
        corner = corner_of(structure, place.name)
    axes = None if corner is None else corner.axes(structure)
    spatial = spatial_record_of(structure, place, shares)
    about = () if spatial is None else place.keys.bending or ()
    # most members are chains of plain hinges
    plain = spatial is None or axes is not None
    return PlacedHinge(
        name=place.name,
        member=place.member,
        station=place.station,
        axis=place.axis,
        position=frame.position(place.station) if plain else position_of(structure, place, spatial),
        direction=direction_of(structure, place) if axes is None else axes[AXIS_ROW[place.axis]],
        tributary_length=shares.bending.get(place.axis, 0.0),
        law=law,
        record=record,
        spatial=spatial,
        axes=axes,
        laws={axis: law_of(structure, about_axis(place, axis)) for axis in about},
        flanges=_flanges(structure, place),
    )


def _flanges(structure: StructureParts, place: HingePlace) -> Mapping[str, float]:
    """Flanges about which tension holds a fold; laws of corners and joints are of loads that contain it."""
    if not structure.members[place.member].elastic or place.keys.coupling in APART:
        return {}
    section = structure.section_of(place.member)
    joint = corner_of(structure, place.name) or place.name in map(t_joint_name, t_laws(structure))
    if joint or section.kind not in HELD:
        return {}
    return {axis: (section.bending_depth(axis) - section.thickness) / 2.0 for axis in AXES}


@remembered(MADE)
def _record(law: HingeLaw, spec: LawKeys, rigidity: float) -> HingeRecord:
    """Record of a law; where its stiffness is that of a length of member, the length is one metre here."""
    stiffness = spec.elastic_stiffness
    return hinge.record_of(
        law,
        form=Form(spec.form),
        elastic_stiffness=None if isinstance(stiffness, str) else stiffness,
        flexural_rigidity=rigidity,
        tributary_length=1.0,
        softening=SofteningVariable(spec.softening),
        stops=_stop(spec.stops),
        regularisation_rate=spec.regularisation.rate,
        rate=spec.rate == "on",
        viscous_damping=spec.viscous_damping,
    )


def _stop(stops: Stops | Literal["law", "none"]) -> Stop | Literal["law"] | None:
    if not isinstance(stops, Stops):
        return "law" if stops == "law" else None
    damping = np.nan if isinstance(stops.damping, str) else stops.damping
    return Stop(stops.rotation, stops.stiffness, stops.exponent, damping, stops.penetration)
