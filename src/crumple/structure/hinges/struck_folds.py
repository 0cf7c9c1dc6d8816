"""Tubes that obstacles strike between their ends: laws of their folds there, and dents of their walls.

Laws in `crumple.hinge.bending.dented` and `crumple.hinge.dent`.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, cast

import numpy as np

from crumple.hinge import HingeLaw
from crumple.hinge.bending.dented import DentedLaw, WrappedLaw, wraps
from crumple.hinge.bending.pressed import Press, PressedLaw
from crumple.hinge.dent import ONE_CELL, Cells, Dent, dent_of, denting_force, left_by_dent, left_in_bending
from crumple.hinge.registry import AUTO
from crumple.material import Material
from crumple.numeric.arrays import Floats
from crumple.section import AXES, Axis, CircularTube, RectangularTube, Section, half_fold_length
from crumple.structure.hinges.asked import automatic_of
from crumple.structure.hinges.automatic import strikes_on
from crumple.structure.hinges.corner_laws import corner_laws
from crumple.structure.hinges.corners import leaving
from crumple.structure.hinges.law_choice import Surroundings, automatic_law, chosen_law, made_law, plain_law
from crumple.structure.hinges.runs.across import HeldEnd, held_end
from crumple.structure.hinges.runs.candidates import Strike
from crumple.structure.hinges.runs.ends import holds_rotation
from crumple.structure.hinges.runs.straight_runs import StraightRun, straight_run
from crumple.structure.keys.law import LawKeys, LawReference
from crumple.structure.keys.obstacles import CylinderObstacle, SphereObstacle
from crumple.structure.parts import StructureParts
from crumple.structure.struck_places import KINK, StruckPlace, struck_places, travel_to_joints

if TYPE_CHECKING:
    from crumple.section import MultiCellTube

TOGETHER = 1e-3
"""Difference of the travels of an obstacle to tubes that it strikes at the same time [m]."""
ACROSS = math.sin(math.radians(60.0))
"""Least sine of the angle between a tube and a pole that dents it."""
SQUARE = math.cos(math.radians(20.0))
"""Least cosine of the angle between a force and the normal of the wall that it dents, and of those between
the forces of one obstacle on several tubes."""


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
    tube, section = dent_at_fold(structure, member, name, axis), _walls(structure, member)
    if tube is None or section is None:
        return law
    strike, across = strikes_on(structure, member)[name], _across(structure, member, axis)
    # the struck wall is compressed: +z by a negative rotation about y, +y by a positive one about z
    sense = 1 if (float(tube.outwards @ across) > 0.0) == (axis == "z") else -1
    material, moment = _metal(structure, member), float(law.moment_capacity(0.0, sense))
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
    if not isinstance(structure.section_of(member), RectangularTube):
        return DentedLaw(law, left)
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


@dataclass(frozen=True, eq=False)
class DentedTube:
    """A tube in which an obstacle presses a dent.

    Attributes
    ----------
    obstacle
        Its name.
    member, station
        Where [m].
    nodes
        Nodes in the dent, between the ends of its straight run.
    outwards
        Unit vector from it to the obstacle, (3,).
    depth, dent
        Of its section along the force [m], and the law of the dent.
    """

    obstacle: str
    member: str
    station: float
    nodes: tuple[str, ...]
    outwards: Floats
    depth: float
    dent: Dent


def left_by(structure: StructureParts, tube: DentedTube, depth: float) -> float:
    """Share of the plastic moment that a dent of some depth [m] leaves, at most one to the middle."""
    section = _walls(structure, tube.member)
    assert section is not None
    return left_by_dent(section, min(depth, (tube.depth - section.thickness) / 2.0), tube.depth)


def dented_tubes(structure: StructureParts, obstacle: str) -> tuple[DentedTube, ...]:
    """Tubes that an obstacle dents: all that it strikes first and at the same time, or none.

    Parameters
    ----------
    structure, obstacle
        The obstacle's name.
    """
    return structure.kept.once("dented", obstacle, lambda: _dented_tubes(structure, obstacle))


def _dented_tubes(structure: StructureParts, obstacle: str) -> tuple[DentedTube, ...]:
    spec = structure.obstacles[obstacle]
    if not spec.dents or not isinstance(spec, CylinderObstacle | SphereObstacle):
        return ()
    tubes = [_dented(structure, member, place) for member, place in _struck_first(structure, obstacle)]
    found = tuple(
        tube for tube in tubes if tube is not None and _folds_there(structure, tube.member, obstacle)
    )
    if not found or len(found) < len(tubes):
        return ()
    towards = np.sum([tube.outwards for tube in found], axis=0)
    size = float(np.linalg.norm(towards))
    alike = size > 0.0 and all(float(tube.outwards @ towards) >= SQUARE * size for tube in found)
    return found if alike else ()


def undented_tubes(structure: StructureParts, obstacle: str) -> list[tuple[str, float, str]]:
    """Tubes with automatic hinges that an obstacle strikes first, and would dent if they could fold there.

    They cannot fold nearer to the end of a straight run than the fold at its end reaches.  Each with the
    distance of the place from an end of its run [m], and the node there; not those struck at a node.

    Parameters
    ----------
    structure, obstacle
        The obstacle's name.
    """
    spec, found = structure.obstacles[obstacle], []
    if not spec.dents or not isinstance(spec, CylinderObstacle | SphereObstacle):
        return []
    for member, place in _struck_first(structure, obstacle):
        if automatic_of(structure, member) is None or _folds_there(structure, member, obstacle):
            continue
        run = straight_run(structure, member)
        along = run.stretches[member].along(place.station)
        apart, node = min((along, run.nodes[0]), (run.length - along, run.nodes[1]))
        if apart > KINK and _dented(structure, member, place) is not None:
            found.append((member, apart, node))
    return found


def struck_without_dents(structure: StructureParts, obstacle: str) -> list[str]:
    """Members with automatic hinges that an obstacle strikes first and whose section has no law of dents.

    Parameters
    ----------
    structure, obstacle
        The obstacle's name.
    """
    if not structure.obstacles[obstacle].dents:
        return []
    struck = (member for member, _ in _struck_first(structure, obstacle))
    return [
        one for one in struck if automatic_of(structure, one) is not None and _walls(structure, one) is None
    ]


def _struck_first(structure: StructureParts, obstacle: str) -> Iterator[tuple[str, StruckPlace]]:
    """Members that an obstacle strikes first, one for each straight run; none if it meets a joint before."""
    places = {
        member: place
        for member in structure.members
        if structure.has_line(member)
        for place in struck_places(structure, member, ends=True)
        if place.obstacle == obstacle
    }
    first = min((place.travel for place in places.values()), default=0.0)
    if travel_to_joints(structure, obstacle) < first - TOGETHER:
        return
    runs = set()
    for member, place in places.items():
        run = next(iter(straight_run(structure, member).stretches))
        if place.travel <= first + TOGETHER and run not in runs:
            runs.add(run)
            yield member, place


def _dented(structure: StructureParts, member: str, place: StruckPlace) -> DentedTube | None:
    """Dent of a struck member; None if there is no law for it."""
    section = _walls(structure, member)
    outwards = np.asarray(place.outwards)
    if section is None or place.sine < ACROSS:
        return None
    if isinstance(section, CircularTube):
        depth, depth_along_y = section.diameter, False
    else:
        across = structure.frame_of(member).axes[1:] @ outwards
        # of a hat the crown alone
        hat = structure.section_of(member).kind == "closed_hat"
        struck = across[1:] if hat else np.abs(across)
        if isinstance(structure.obstacles[place.obstacle], SphereObstacle) or struck.max() < SQUARE:
            return None
        depth_along_y = abs(across[0]) > abs(across[1])
        depth = float(section.width if depth_along_y else section.depth)
    nodes = _nodes_in(structure, member, place.station)
    cells = _cells(structure.section_of(member), "y" if depth_along_y else "z")
    dent = dent_of(section, _metal(structure, member), depth, cells)
    return DentedTube(place.obstacle, member, place.station, nodes, outwards, depth, dent)


def _walls(structure: StructureParts, member: str) -> CircularTube | RectangularTube | None:
    """The tube whose walls an obstacle dents: of a closed hat crown and webs, of cells the outer walls.

    None of other sections.
    """
    section = structure.section_of(member)
    if isinstance(section, CircularTube | RectangularTube):
        return section
    from crumple.section import ClosedHat, MultiCellTube  # noqa: PLC0415  (their walls take time to load)

    if isinstance(section, ClosedHat | MultiCellTube):
        return RectangularTube(section.width, section.depth, section.thickness)
    return None


def _cells(section: Section, along: Axis) -> Cells:
    """Cells and webs of a section along a force."""
    if section.kind != "multi_cell_tube":
        return ONE_CELL
    tube = cast("MultiCellTube", section)
    count, across = (tube.columns, tube.rows) if along == "y" else (tube.rows, tube.columns)
    inner = (tube.inner_thickness or tube.thickness) / tube.thickness
    return Cells(count, 2.0 + (across - 1) * inner**2)


def _metal(structure: StructureParts, member: str) -> Material:
    """Metal of these walls."""
    own = getattr(structure.section_of(member), "hat_material", None)
    return structure.material_of(member) if own is None else own


def _nodes_in(structure: StructureParts, member: str, station: float) -> tuple[str, ...]:
    """Nodes between the ends of a straight run at most half a fold from a station of a member."""
    run, section = straight_run(structure, member), structure.section_of(member)
    half = max(half_fold_length(section, axis) for axis in AXES)
    along = run.stretches[member].along(station)
    return tuple(node for node, at in run.between.items() if abs(at - along) <= half)


def _folds_there(structure: StructureParts, member: str, obstacle: str) -> bool:
    """Whether a straight run has an automatic hinge where an obstacle strikes it."""
    return any(
        obstacle in strike.obstacles
        for other in straight_run(structure, member).stretches
        for strike in strikes_on(structure, other).values()
    )
