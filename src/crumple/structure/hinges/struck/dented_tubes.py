"""Tubes that obstacles dent between their ends: which, where, and the law of the dent."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, cast

import numpy as np

from crumple.hinge.dent import LEAST_BALL, ONE_CELL, Cells, Dent, Striker, dent_of, left_by_dent
from crumple.material import Material
from crumple.numeric.arrays import Floats
from crumple.section import AXES, Axis, CircularTube, RectangularTube, Section, half_fold_length
from crumple.structure.hinges.asked import automatic_of
from crumple.structure.hinges.automatic import strikes_on
from crumple.structure.hinges.runs.straight_runs import straight_run
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
    section = dented_walls(structure, tube.member)
    assert section is not None
    deep = min(depth, (tube.depth - section.thickness) / 2.0)
    return left_by_dent(section, deep, tube.depth, tube.dent.takes)


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
        one
        for one in struck
        if automatic_of(structure, one) is not None and dented_walls(structure, one) is None
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
    section = dented_walls(structure, member)
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
        depth_along_y = abs(across[0]) > abs(across[1])
        depth = float(section.width if depth_along_y else section.depth)
        wall = section.width + section.depth - depth
        if struck.max() < SQUARE or not _dents_wall(structure, member, place.obstacle, wall):
            return None
    nodes = _nodes_in(structure, member, place.station)
    cells = _cells(structure.section_of(member), "y" if depth_along_y else "z")
    spec = structure.obstacles[place.obstacle]
    assert isinstance(spec, CylinderObstacle | SphereObstacle)
    striker = Striker(spec.radius, isinstance(spec, SphereObstacle))
    dent = dent_of(section, dented_metal(structure, member), depth, striker, cells)
    return DentedTube(place.obstacle, member, place.station, nodes, outwards, depth, dent)


def _dents_wall(structure: StructureParts, member: str, obstacle: str, width: float) -> bool:
    """Whether a flat wall of a width [m] has a law under an obstacle: a ball meets the webs beside it."""
    spec = structure.obstacles[obstacle]
    tube = isinstance(structure.section_of(member), RectangularTube)
    return not isinstance(spec, SphereObstacle) or (tube and spec.radius >= LEAST_BALL * width)


def dented_walls(structure: StructureParts, member: str) -> CircularTube | RectangularTube | None:
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


def dented_metal(structure: StructureParts, member: str) -> Material:
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
