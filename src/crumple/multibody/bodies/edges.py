"""Edges of rolled members: what obstacles meet of a section whose corner lies ahead of its capsules.

Capsules have the depth of a section across its sides, and round its corners off.  The depth of its outline in
a direction t is max(p . t) over its points p: of a square tube of side a that is rolled by an angle u
a/2 (cos u + sin u), up to 1.41 of that of its capsule.  So obstacles also touch the corners along such
members, as segments of a thousandth of the radius: the largest depth of a prism is that of its corners.

Where a side lies flush with an obstacle, capsule and corners have the same depth, and the capsule alone is
met.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from crumple._core.spatial.model import SpatialCapsule
from crumple.multibody.bodies.assembly import Piece
from crumple.multibody.bodies.capsules import POINT, capsule_rows, member_capsules, outermost, row_shifts
from crumple.numeric.arrays import Floats
from crumple.structure import PlaneObstacle, Structure, dented_tubes, gap
from crumple.structure.hinges.runs.straight_runs import straight_run
from crumple.structure.struck_places import struck_places

STANDS_OUT = 1.05
"""Depth of a corner over that of the capsules from which an obstacle meets it: a square tube rolled by 3
degrees.  Less is below a fortieth of its side, and a side that lies flush would be met by capsule and corner,
which takes several times the linear solves with the same result."""


@dataclass(frozen=True, eq=False)
class Edge:
    """Corner of the outline along a piece of a member.

    Attributes
    ----------
    capsule, member
        Its segment, and the name of its member.
    obstacles
        Names of those that meet it.
    shift
        Of its place from the member's axis at the start [m], (3,).
    """

    capsule: SpatialCapsule
    member: str
    obstacles: set[str]
    shift: Floats


def edges_of(
    structure: Structure, of_member: Mapping[str, tuple[Piece, ...]], *, held: bool = False
) -> Iterator[Edge]:
    """Edges of all pieces that move, or of all that are held; what is held meets nothing but a mass."""
    for member, pieces in of_member.items():
        met_at: dict[tuple[float, ...], set[str]] = defaultdict(set)
        for name, towards in _met_from(structure, member):
            if structure.obstacles[name].mass is not None or not held:
                for place in _ahead(structure, member, towards):
                    met_at[tuple(place.tolist())].add(name)
        if not met_at:
            continue
        spines, _ = member_capsules(structure, {member: pieces}, held=held)
        rows = row_shifts(structure, member)
        for spine in spines[:: len(rows)]:
            radius = POINT * spine.radius
            axis = np.array([spine.first, spine.second], float) - rows[0]
            for place, names in met_at.items():
                ends = axis + place
                # what starts inside is met with the capsules, which are less far out
                met = {one for one in names if float(gap(structure.obstacles[one], ends).min()) > radius}
                if met:
                    yield Edge(
                        SpatialCapsule(spine.body, ends[0], ends[1], radius), member, met, np.array(place)
                    )


def shifts(structure: Structure, edges: Sequence[Edge], member: str) -> Floats:
    """Places of a member's capsules and edges from its axis at the start [m], (n, 3)."""
    own = [edge.shift for edge in edges if edge.member == member]
    rows = row_shifts(structure, member)
    return np.vstack([rows, np.unique(own, axis=0)]) if own else rows


def _met_from(structure: Structure, member: str) -> Iterator[tuple[str, Floats]]:
    """Obstacles that can meet a member with its corners, and unit vectors from it to them, (3,).

    Of poles, balls and edges those that strike it at the start; walls that they dent give way instead.
    """
    for name, obstacle in structure.obstacles.items():
        if isinstance(obstacle, PlaneObstacle):
            yield name, -np.asarray(obstacle.normal, float) / np.linalg.norm(obstacle.normal)
    for place in struck_places(structure, member, ends=True):
        dented = (straight_run(structure, tube.member) for tube in dented_tubes(structure, place.obstacle))
        if not any(member in run.stretches for run in dented):
            yield place.obstacle, np.asarray(place.outwards)


def _ahead(structure: Structure, member: str, towards: Floats) -> Floats:
    """Corners of a member that lie well ahead of its capsules in a direction, from its axis, (n, 3) [m]."""
    outline = structure.section_of(member).outer_outline()
    across = structure.frame_of(member).axes[1:]
    radius = capsule_rows(outline)[1]
    farthest = int((outline @ (across @ towards)).argmax())
    corners = outline[np.union1d(outermost(outline), [farthest])]
    least = STANDS_OUT * (float((row_shifts(structure, member) @ towards).max()) + radius)
    middle = (outline.min(axis=0) + outline.max(axis=0)) / 2.0
    inner = corners - POINT * radius * np.sign(np.round(corners - middle, 9))
    return np.asarray((inner @ across)[corners @ (across @ towards) > least])
