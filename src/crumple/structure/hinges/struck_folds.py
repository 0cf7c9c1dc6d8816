"""Tubes that obstacles strike between their ends: laws of their folds there, and dents of their walls.

Laws in `crumple.hinge.bending.dented` and `crumple.hinge.dent`.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from crumple.hinge import HingeLaw
from crumple.hinge.bending.dented import DentedLaw, WrappedLaw, wraps
from crumple.hinge.bending.pressed import Press, PressedLaw
from crumple.hinge.dent import (
    denting_force,
    left_in_bending,
)
from crumple.hinge.registry import AUTO
from crumple.numeric.arrays import Floats
from crumple.section import AXES, Axis, CircularTube, RectangularTube, half_fold_length
from crumple.structure.hinges.automatic import strikes_on
from crumple.structure.hinges.corner_laws import corner_laws
from crumple.structure.hinges.corners import leaving
from crumple.structure.hinges.law_choice import Surroundings, automatic_law, chosen_law, made_law, plain_law
from crumple.structure.hinges.runs.across import HeldEnd, held_end
from crumple.structure.hinges.runs.candidates import Strike
from crumple.structure.hinges.runs.ends import holds_rotation
from crumple.structure.hinges.runs.straight_runs import StraightRun, straight_run
from crumple.structure.hinges.struck.dented_tubes import (
    SQUARE,
    DentedTube,
    dented_metal,
    dented_tubes,
    dented_walls,
)
from crumple.structure.keys.law import LawKeys, LawReference
from crumple.structure.keys.obstacles import CylinderObstacle, SphereObstacle
from crumple.structure.parts import StructureParts

LEAST_ON_FOLD = 0.25
"""Share of a pole's force on the fold from which it sinks: wider ones press beside the walls that would sink,
where a rough one finds no place to rest on."""
FIRST_BENDING = 0.1
"""Rotation up to which what holds a tube must carry more than the tube, for a dent to grow on [rad]."""


def with_dent(
    structure: StructureParts,
    member: str,
    name: str,
    axis: Axis,
    reference: LawReference | None,
    law: HingeLaw,
) -> HingeLaw:
    """Law of a hinge, lowered if it is an automatic one of a tube where an obstacle dents it.

    Parameters
    ----------
    structure, member, name, axis
        The hinge, and the axis of the section about which the law bends.
    reference, law
        What the input says of its law, which it may name itself; and the law.
    """
    if not structure.obstacles or automatic_law(structure, reference) is None:
        return law
    tube, section = dent_at_fold(structure, member, name, axis), dented_walls(structure, member)
    if tube is None or section is None:
        return law
    strike, across = strikes_on(structure, member)[name], _across(structure, member, axis)
    # the struck wall is compressed: +z by a negative rotation about y, +y by a positive one about z
    sense = 1 if (float(tube.outwards @ across) > 0.0) == (axis == "z") else -1
    material, moment = dented_metal(structure, member), float(law.moment_capacity(0.0, sense))
    run = straight_run(structure, member)
    ends = tuple(held_end(structure, run, end, tube.outwards) for end in (0, 1))
    bent = _Bent(ends, structure.frame_of(member).axis(axis), tube.outwards)
    held = _held(structure, bent, strike, moment)
    spans = strike.spans[0] + ends[0].further, strike.spans[1] + ends[1].further
    left = left_in_bending(section, tube.dent, tube.depth, moment, spans, held)
    pole = structure.obstacles[tube.obstacle]
    if isinstance(section, CircularTube) and isinstance(pole, CylinderObstacle):
        most = 2.0 * half_fold_length(section, axis) / (pole.radius + tube.depth / 2.0)
        if wraps(law, most, sense):
            return WrappedLaw(law, most)
    if not isinstance(structure.section_of(member), RectangularTube) or isinstance(pole, SphereObstacle):
        return DentedLaw(law, left, isinstance(section, CircularTube))
    assert isinstance(pole, CylinderObstacle)
    assert isinstance(section, RectangularTube)
    force, half = denting_force(section, material), half_fold_length(section, axis)
    press = Press(force, pole.radius, half, spans, (held[0] * moment, held[1] * moment))
    if press.on_fold < LEAST_ON_FOLD:
        return DentedLaw(law, left)
    # what presses beside the fold dents the tube as a force does that bends it later
    dented = DentedLaw(law, 1.0 - (1.0 - press.on_fold) * (1.0 - left))
    return PressedLaw(dented, press, sense)


def dent_at_fold(structure: StructureParts, member: str, name: str, axis: Axis) -> DentedTube | None:
    """Dent of a tube that lies at an automatic hinge and is bent there about an axis of the section, or None.

    Parameters
    ----------
    structure, member, name, axis
        The hinge, and the axis.
    """
    strike = strikes_on(structure, member).get(name)
    if strike is None:
        return None
    stretches, across = straight_run(structure, member).stretches, _across(structure, member, axis)
    round_tube = isinstance(structure.section_of(member), CircularTube)
    return next(
        (
            tube
            for obstacle in strike.obstacles
            for tube in dented_tubes(structure, obstacle)
            if tube.member in stretches and (round_tube or abs(float(tube.outwards @ across)) >= SQUARE)
        ),
        None,
    )


def _across(structure: StructureParts, member: str, axis: Axis) -> Floats:
    """Axis of a section across the one about which it bends, (3,)."""
    return structure.frame_of(member).axis("z" if axis == "y" else "y")


@dataclass(frozen=True)
class _Bent:
    """A tube that a dent bends: what holds its ends, about which direction, where the obstacle is (3,)."""

    ends: tuple[HeldEnd, ...]
    about: Floats
    outwards: Floats


def _held(structure: StructureParts, bent: _Bent, strike: Strike, moment: float) -> tuple[float, float]:
    """Shares of a moment [N m] that is carried at both ends."""
    first, last = (
        min(1.0, _carried(structure, bent, end) / moment) if holds or end.further else 0.0
        for end, holds in zip(bent.ends, strike.held, strict=True)
    )
    return first, last


def _carried(structure: StructureParts, bent: _Bent, end: HeldEnd) -> float:
    """Moment [N m] that a support, the corner or other members carry at an end."""
    own, node = end.run.stretches, end.node
    if holds_rotation(structure, node, bent.about):
        return _beside_a_joint(structure, end.run.first, bent.about) if end.further else math.inf
    corner, keys = corner_laws(structure).get(node, (None, None))
    if corner is not None and keys is not None and abs(float(bent.about @ np.array(corner.normal))) >= SQUARE:
        other = corner.second if corner.first in own else corner.first
        # pressed towards the other member, the run turns away from it at the corner
        opens = float(leaving(structure, other, node) @ bent.outwards) > 0.0
        return _most(structure, corner.first, corner.axis, keys, -corner.sense if opens else corner.sense)
    return sum(
        _beside_a_joint(structure, name, bent.about) for name in _held_beyond(structure, end.run, node)
    )


def _held_beyond(structure: StructureParts, run: StraightRun, node: str) -> Iterator[str]:
    """Members beyond an end of a run that something keeps from turning with it: no limb with a free end."""
    for name in structure.members_at.get(node, ()):
        if name not in run.stretches and not _is_limb(structure, name, node, set(run.stretches)):
            yield name


def _is_limb(structure: StructureParts, member: str, node: str, behind: set[str]) -> bool:
    """Whether a member and all beyond it, seen from a node, hang on that node alone and carry no mass."""
    run = straight_run(structure, member)
    far = run.nodes[0] if run.nodes[1] == node else run.nodes[1]
    if structure.supports_at.get(far) or structure.masses_at.get(far) or far == node:
        return False
    behind |= run.stretches.keys()
    others = [name for name in structure.members_at.get(far, ()) if name not in run.stretches]
    return all(name not in behind and _is_limb(structure, name, far, behind) for name in others)


def _beside_a_joint(structure: StructureParts, member: str, about: Floats) -> float:
    """Moment [N m] that a member carries beside a joint about a direction; if it is twisted, any."""
    frame, plain = structure.frame_of(member), plain_law(AUTO)
    if abs(float(about @ frame.x)) >= SQUARE:
        return math.inf
    parts = []
    for axis in AXES:
        keys = chosen_law(structure, member, axis, plain, Surroundings("clamped"))
        most = min(_most(structure, member, axis, keys, sense) for sense in (1, -1))
        parts.append(float(about @ frame.axis(axis)) * most)
    return math.hypot(*parts)


def _most(structure: StructureParts, member: str, axis: Axis, keys: LawKeys, sense: int) -> float:
    """Largest moment [N m] of a law in a sense up to the rotation of a first bending."""
    law = made_law(structure.section_of(member), structure.material_of(member), axis, keys)
    return float(law.moment_capacity(np.linspace(0.0, FIRST_BENDING, 21), sense).max())
