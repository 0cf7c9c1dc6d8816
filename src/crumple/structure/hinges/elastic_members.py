"""Elastic members: where a bar bends between its hinges, and the yielding of its walls there.

A bar (crumple.structure.hinges.runs.bars) with N segments has joints at the borders of N equal segments,
besides its hinges. Joints and hinges share the bending flexibility of the bar exactly for end loads
(crumple.structure.hinges.flexibility); the mass of each segment moves with it, so that the bar
vibrates. A joint yields as the section does with plane walls,

    theta_p(M) = l (kappa(M) - M/EI)        l: length of bar that yields there,

from first yield to the largest moment of the straight member's fold: what is beyond belongs to the hinges.
Theory and limits: docs/theory/elastic_members.md.
"""

from __future__ import annotations

import math
from typing import TypeVar

import numpy as np

from crumple.hinge import HingeRecord, build_law, record_of
from crumple.hinge.bending.estimate import automatic_type
from crumple.hinge.record.record import Form
from crumple.hinge.registry import Fold
from crumple.material import Material
from crumple.numeric.arrays import Floats
from crumple.section import Axis, Section
from crumple.structure.bending import bending_axis, planar
from crumple.structure.hinges.asked import any_automatic, automatic_of
from crumple.structure.hinges.law_choice import folding_slip, formula
from crumple.structure.hinges.lengthening.found import lengthening_members
from crumple.structure.hinges.runs.bars import rigid_along
from crumple.structure.hinges.runs.straight_runs import StraightRun, straight_run
from crumple.structure.keys.member import Member
from crumple.structure.parts import StructureParts
from crumple.structure.remembered import remembered
from crumple.structure.settings.multibody_settings import MultibodySettings
from crumple.text.names import listed
from crumple.units import format_quantity

Parts = TypeVar("Parts", bound=StructureParts)

CURVATURES = np.array([1.0, 1.03, 1.07, 1.12, 1.2, 1.3, 1.5, 2.0, 3.0, 5.0, 10.0, 30.0, 100.0])
"""Where the moment over curvature is sampled, over the curvature of first yield."""
CLEAR = 0.35
"""Least distance of a joint from a hinge, over the length of a segment: a body lies between them."""
DAMPING = 1.0
"""Constant of the damper beside each joint's spring over its stiffness, as a multiple of the time that a wave
takes across the section: with 50 mm of steel 0.01 ms, 1 % of critical damping at 330 Hz."""
LAW_TURNS = np.radians(np.arange(0.0, 41.0))
"""Rotations at which the largest moment of a fold is sought [rad]: walls that harden reach it later."""
LOST = 0.05
"""Share of its largest moment that a fold loses before walls that keep theirs count as too strong."""
SLENDER = 10.0
"""Length over depth from which the deflection by shear is neglected."""
ROUNDING = 1e-9
"""Share of the length that does not count there: many a member has ten depths."""
IMPACT = 0.5
"""Longest motion in which members bend unless the input says so [s]."""
KEPT = 1024
"""Records kept: equal members of a frame share one."""


def with_elastic_members(structure: Parts, settings: MultibodySettings, moving: float) -> Parts:
    """The structure with the members elastic that do not say otherwise, if the settings say so.

    `auto` says so where automatic hinges are asked for, in motions of up to `IMPACT`: in longer ones
    vibration takes most of the steps, and decays without effect.  Members that a run has shown to change
    their length do so from then on.

    Parameters
    ----------
    structure, settings
        As of the input.
    moving
        Time in motion, without quasi-static stages [s].
    """
    automatic = moving <= IMPACT and any_automatic(structure)
    rigid = settings.members == "rigid" or (settings.members == "auto" and not automatic)
    unsaid = [] if rigid else _unsaid(structure)
    longer = lengthening_members(structure, settings, moving)
    if not (unsaid or longer):
        return structure

    def bent() -> Parts:
        elastic = structure.with_elastic(
            {
                name: _elastic(spec, settings.segments) if name in unsaid else spec
                for name, spec in structure.members.items()
            }
        )
        own = {name: _lengthened(elastic, name) for name in longer}
        return elastic.model_copy(update={"members": {**elastic.members, **own}}) if longer else elastic

    # the solver, its checks, the range from the laws and the modes ask in turn: one copy, placed once
    return structure.kept.once("elastic members", (type(structure), settings.segments, rigid, longer), bent)


def rigid_for_long(structure: StructureParts, settings: MultibodySettings, moving: float) -> str:
    """Sentence on the members that do not bend for the only reason that the motion is long; else empty.

    Arguments as above.
    """
    names = _unsaid(structure)
    if settings.members != "auto" or moving <= IMPACT or not names or not any_automatic(structure):
        return ""
    some = f"{'Member' if len(names) == 1 else 'Members'} {listed(names)}"
    every = len(names) == len(structure.members)
    who = "Members are" if every else f"{some} {'is' if len(names) == 1 else 'are'}"
    whose = "its" if len(names) == 1 and not every else "their"
    longest, bend = format_quantity(IMPACT, "s"), "them bend" if whose == "their" else "it bend"
    return (
        f"{who} rigid between {whose} hinges, since the motion is longer than {longest}; "
        f"analysis.multibody.members: elastic lets {bend}."
    )


def _unsaid(structure: StructureParts) -> list[str]:
    """Members of which the input says neither that they are elastic nor that all of them is rigid."""
    return [
        name for name, spec in structure.members.items() if spec.elastic is None and spec.rigid is not True
    ]


def _lengthened(structure: StructureParts, name: str) -> Member:
    """A member as if the input gave it ``hinges: {axial: ..., spacing: ...}``.

    It shortens as a folding column, or yields, with a candidate in the middle of its straight run, where
    struts kink.
    """
    spec, asked = structure.members[name], automatic_of(structure, name)
    assert asked is not None  # of all members of a straight run
    half = straight_run(structure, name).length / 2.0
    update = {"axial": folding_slip(structure, name), "spacing": min(asked.spacing or half, half)}
    return spec.model_copy(update={"hinges": asked.model_copy(update=update)})


def _elastic(spec: Member, segments: int) -> Member:
    return spec.model_copy(update={"elastic": segments})


def segments_of(structure: StructureParts, bar: StraightRun) -> int:
    """Number of segments of an elastic bar, the largest that its members ask for; 0 of a rigid one."""
    if not bar.between:
        return structure.members[bar.first].elastic or 0
    return max(structure.members[name].elastic or 0 for name in bar.stretches)


def joint_stations(
    structure: StructureParts,
    bar: StraightRun,
    axis: Axis,
    hinges: tuple[float, ...],
    others: tuple[float, ...] = (),
) -> tuple[float, ...]:
    """Borders of a bar's segments [m] that are clear of its hinges, rigid parts and rigid joints.

    Parameters
    ----------
    structure, bar
        Elastic or not; a rigid one has none.
    axis
        About which it bends; in a plane it bends about one axis alone.
    hinges, others
        Distances from its start of its hinges about that axis, and of those about other axes alone [m].
    """
    number = segments_of(structure, bar)
    if number == 0 or (planar(structure) and axis != bending_axis(structure, bar.first)):
        return ()
    segment = bar.length / number
    rigid = rigid_along(structure, bar)
    # without hinges a joint lies in the middle of each segment
    shift = 0.5 if not hinges else 1.0
    borders = (segment * (i + shift) for i in range(number if not hinges else number - 1))
    return tuple(
        at
        for at in borders
        if all(abs(at - hinge) >= CLEAR * segment for hinge in (*hinges, *others))
        and not any(a <= at <= b for a, b in rigid)
    )


def shear_stretch(structure: StructureParts, bar: StraightRun, axis: Axis) -> float:
    """Square of the length at which an elastic bar shears as much as it bends, E I/(G A_s) [m^2].

    0 for rigid bars, and for those of at least `SLENDER` depths.
    """
    if segments_of(structure, bar) == 0:
        return 0.0
    from crumple.section.wall_section import walls_of  # noqa: PLC0415  (rigid members need no walls)

    member = bar.first
    section, material = structure.section_of(member), structure.material_of(member)
    depth = _depth(section, axis)
    if bar.length >= (1.0 - ROUNDING) * SLENDER * depth:
        return 0.0
    spec = structure.members[member]
    area = structure.kept.once(
        "shear area",
        (spec.section, spec.material, axis),
        lambda: walls_of(section).shear_area(axis, material),
    )
    return structure.flexural_rigidity(member, axis) / (material.shear_modulus * area)


def _depth(section: Section, axis: Axis) -> float:
    """Extent of a section across its axis [m]."""
    across = np.array([0.0, 1.0] if axis == "y" else [1.0, 0.0])
    return float(np.ptp(section.outer_outline() @ across))


def yielding_record(
    structure: StructureParts, member: str, axis: Axis, length: float, yields: float
) -> HingeRecord:
    """Record of a joint of a member: `length` bends elastically there, and `yields` yields [m]."""
    section, material = structure.section_of(member), structure.material_of(member)
    return _record(section, material, axis, structure.flexural_rigidity(member, axis), length, yields)


@remembered(KEPT)
def _record(
    section: Section, material: Material, axis: Axis, rigidity: float, length: float, yields: float
) -> HingeRecord:
    rotation, moment = _yielding(section, material, axis, rigidity)
    law = build_law(
        "table",
        section,
        material,
        axis,
        rotation=tuple((yields * rotation).tolist()),
        moment=tuple(moment.tolist()),
    )
    stiffness = rigidity / length
    crossed = _depth(section, axis) * math.sqrt(material.density / material.youngs_modulus)
    return record_of(
        law,
        form=Form.ELASTIC_PLASTIC,
        elastic_stiffness=stiffness,
        viscous_damping=DAMPING * crossed * stiffness,
    )


def _largest_moment(section: Section, material: Material, axis: Axis) -> float:
    """Largest moment [N m] that a fold reaches anywhere in a member, which ends the yielding of its walls.

    Folds in different places have different laws; walls that yielded at less than a fold beside them takes
    would do so without end in its place.
    """
    return max(float(moment.max()) for moment in _fold_moments(section, material, axis))


def folds_from(section: Section, material: Material, axis: Axis) -> float:
    """Rotation [rad] from which a fold anywhere in a member has lost `LOST` of its largest moment.

    Infinite for sections whose walls do not fold.
    """
    found = 0.0
    for moment in _fold_moments(section, material, axis):
        peak = int(np.argmax(moment))
        below = np.flatnonzero(moment[peak:] < (1.0 - LOST) * moment[peak])
        found = max(found, float(LAW_TURNS[peak + below[0]]) if below.size else np.inf)
    return found


def _fold_moments(section: Section, material: Material, axis: Axis) -> list[Floats]:
    """Moments [N m] at `LAW_TURNS` of the laws that folds in different places of a member have."""
    folds: tuple[Fold | None, ...] = ("free", "clamped", None)
    kinds = {automatic_type(section, material, axis, fold, build=formula) for fold in folds}
    return [formula(kind, section, material, axis).moment_capacity(LAW_TURNS) for kind in kinds]


@remembered(KEPT)
def _yielding(section: Section, material: Material, axis: Axis, rigidity: float) -> tuple[Floats, Floats]:
    """Plastic curvature from 0 [1/m] and moment [N m] of a section with plane walls, up to its fold."""
    from crumple.section import bending_moment  # noqa: PLC0415  (rigid members need no walls)

    curve = material.hardening
    stress = material.flow_stress if curve is None else curve.yield_stress
    curvature = CURVATURES * stress * section.elastic_section_modulus(axis) / rigidity
    moment = bending_moment(section, material, axis, curvature)
    moment = np.minimum(moment, _largest_moment(section, material, axis))
    plastic = np.maximum.accumulate(curvature - moment / rigidity)
    kept = np.concatenate([[True], np.diff(plastic) > 1e-9 * plastic[-1]])
    return plastic[kept] - plastic[0], moment[kept]
