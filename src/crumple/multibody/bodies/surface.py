"""What of a structure obstacles can touch: capsules, corners, and the faces of ends that crumple."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from crumple._core.spatial.model import SpatialCapsule
from crumple.multibody.bodies.capsules import (
    end_body,
    end_corners,
    member_capsules,
    pieces_by_length,
    with_folds,
)
from crumple.multibody.bodies.crumpling_ends import CrumplingEnd, crumpling_ends
from crumple.multibody.bodies.edges import Edge, edges_of
from crumple.multibody.bodies.linkage import GROUND, Linkage
from crumple.multibody.bodies.obstacles.sunk_walls import SunkWall
from crumple.structure import DentedTube, Obstacle, PlaneObstacle, Structure, gap
from crumple.structure.hinges.runs.straight_runs import straight_run


@dataclass(frozen=True, eq=False)
class Surface:
    """What can be touched of members, in the order of the model's capsules.

    Attributes
    ----------
    whole, member
        Capsules of members, and the member of each.
    shortened
        Capsules that replace one of these, an index, for the plane on which an end crumples.
    edges
        Of rolled members.
    corners
        As `end_corners`.
    faces
        Points of ends that crumple.
    walls
        Capsules of walls into which a pole sinks, and what is left beside them of capsules that this pole
        meets no more, by their indices.
    """

    whole: list[SpatialCapsule]
    member: list[str]
    shortened: list[tuple[CrumplingEnd, int, SpatialCapsule | None]]
    edges: list[Edge]
    corners: list[tuple[SpatialCapsule, set[str], str | None]]
    faces: list[tuple[CrumplingEnd, SpatialCapsule]]
    walls: list[tuple[SunkWall, set[int], list[SpatialCapsule]]]

    @property
    def capsules(self) -> tuple[SpatialCapsule, ...]:
        """All of them."""
        rest = [capsule for *_, capsule in self.shortened if capsule is not None]
        rest += [capsule for *_, of in self.walls for capsule in of]
        rest += [edge.capsule for edge in self.edges]
        return (*self.whole, *rest, *(ball for ball, *_ in self.corners), *(ball for _, ball in self.faces))

    @property
    def members(self) -> tuple[str, ...]:
        """Member of every capsule before the corners."""
        further = [end.member for end, _, rest in self.shortened if rest is not None]
        further += [wall.tube.member for wall, _, of in self.walls for _ in of]
        return (*self.member, *further, *(edge.member for edge in self.edges))

    @property
    def points(self) -> dict[int, CrumplingEnd]:
        """Ends by the indices of their points."""
        return dict(enumerate((end for end, _ in self.faces), len(self.members) + len(self.corners)))

    def owners(self, name: str, obstacle: Obstacle) -> list[set[str]]:
        """Members that an obstacle touches with every capsule; what is held stops nothing but a mass."""
        replaced = {index for end, index, _ in self.shortened if end.obstacle == name}
        replaced.update(*(cut for wall, cut, _ in self.walls if wall.tube.obstacle == name))
        nodes = {end.node for end, _ in self.faces if end.obstacle == name}
        found = [
            {of} if index not in replaced and _meets(capsule, obstacle) else set()
            for index, (capsule, of) in enumerate(zip(self.whole, self.member, strict=True))
        ]
        found += [_of(end, name) for end, _, rest in self.shortened if rest is not None]
        found += [_of(wall.tube, name) for wall, _, of in self.walls for _ in of]
        crumpling = {end.member for end, _ in self.faces if end.obstacle == name}
        found += [
            {edge.member} if name in edge.obstacles and edge.member not in crumpling else set()
            for edge in self.edges
        ]
        if isinstance(obstacle, PlaneObstacle):
            # what starts inside is met with the round ends of capsules, which are less far out
            found += [
                of
                if free not in nodes
                and _meets(ball, obstacle)
                and (free or float(gap(obstacle, ball.first)) > ball.radius)
                else set()
                for ball, of, free in self.corners
            ]
            found += [_of(end, name) for end, _ in self.faces]
        return found


def _meets(capsule: SpatialCapsule, obstacle: Obstacle) -> bool:
    return capsule.body != GROUND or obstacle.mass is not None


def _of(part: CrumplingEnd | DentedTube, obstacle: str) -> set[str]:
    return {part.member} if part.obstacle == obstacle else set()


def surface_of(
    structure: Structure,
    linkage: Linkage,
    moving: list[SpatialCapsule],
    member: list[str],
    walls: Sequence[SunkWall],
) -> Surface:
    """What obstacles can touch; `moving` and `member` are the capsules of all pieces that move."""
    capsules, owners = list(moving), list(member)
    edges = list(edges_of(structure, linkage.pieces))
    corners = list(end_corners(structure, linkage.pieces))
    # other obstacles are held or driven themselves
    heavy = any(obstacle.mass is not None for obstacle in structure.obstacles.values())
    if heavy or structure.member_contact is not None:
        fixed = pieces_by_length(linkage, fixed=True)
        held, owner = member_capsules(structure, fixed, held=True)
        capsules, owners = capsules + held, owners + owner
        if heavy:
            edges += edges_of(structure, fixed, held=True)
            corners += end_corners(structure, linkage.pieces, held=True)
    of = with_folds(structure, linkage, [edge.capsule for edge in edges], [edge.member for edge in edges])
    edges = [replace(edge, capsule=capsule) for edge, capsule in zip(edges, of, strict=True)]
    ends = [
        (end, body)
        for end in crumpling_ends(structure)
        if (body := end_body(structure, linkage.pieces[end.member], end.node)) != GROUND
    ]
    shortened = [
        (end, index, end.shortened(capsule))
        for end, _ in ends
        for index, capsule in enumerate(moving)
        if member[index] == end.member and end.reaches(capsule)
    ]
    faces = [(end, ball) for end, body in ends for ball in end.face(structure, body)]
    sunk = [(wall, *_beside(structure, wall, capsules, owners)) for wall in walls]
    return Surface(capsules, owners, shortened, edges, corners, faces, sunk)


def _beside(
    structure: Structure, wall: SunkWall, capsules: list[SpatialCapsule], member: list[str]
) -> tuple[set[int], list[SpatialCapsule]]:
    """Which capsules of its straight run a wall cuts, and what is left of them, with those of the wall."""
    run = straight_run(structure, wall.tube.member).stretches
    cut, left = set(), list(wall.capsules(structure))
    for index, (capsule, of) in enumerate(zip(capsules, member, strict=True)):
        rest = wall.rest_of(capsule) if of in run else capsule
        if rest is not capsule:
            cut.add(index)
            left += [] if rest is None else [rest]
    return cut, left
