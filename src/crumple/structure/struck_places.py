"""Places between the nodes of a member at which an obstacle strikes it: a fold forms there.

Until they touch, an obstacle moves relative to a member along a straight line, from its place c in a
direction d.  With the member's line a + s x and a pole's axis c + u e, and n the unit vector along x cross e
that points from the member to the pole, they touch after a travel

    t = ((c - a).n - R)/(-d.n),     R: radius of the pole and reach of the section's outline along n,

at s = ((c + t d - a) cross e).(x cross e)/|x cross e|^2, and at u alike, which must not be beyond the ends of
the pole by more than its radius and the section's outline.  A ball is a pole of no length across its path
and the member, and so is the end of a pole that moves along its axis.  The edge of a plane is a pole of
radius 0, if -n lies between the plane's directions out of the solid.  Faces of planes strike nodes, or
members along their length.  What glances off at less than 10 degrees is left out.

The direction is that of the obstacle's initial or prescribed motion less the initial velocity of the
structure, if this is a translation of all.  Otherwise, and if nothing moves at the start, it leads from the
obstacle straight to the members that are nearest to it, and meets no others.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from crumple.numeric.arrays import Floats
from crumple.numeric.rotation import cross
from crumple.structure.geometry import NARROWEST, Frame
from crumple.structure.keys.obstacles import CylinderObstacle, Obstacle, PlaneObstacle, SphereObstacle, gap
from crumple.structure.parts import StructureParts

PLACES = np.linspace(0.0, 1.0, 41)
"""Where on a member the distance from an obstacle is taken, over its length: both ends are among them."""
TIMES = np.logspace(-5.0, 4.0, 91)
"""Times at which a prescribed motion is looked at for its direction [s]: from impacts to slow pushes."""
LEAST = 1e-6
"""Displacement that gives a direction, and difference of distances of members that are equally near [m]."""
KINK = 1e-3
"""Distance [m] beyond an end that still counts as the end: at a small kink a place is beyond both members."""


@dataclass(frozen=True)
class StruckPlace:
    """Where an obstacle meets a member; ends count within `KINK`.

    Attributes
    ----------
    obstacle
        Its name.
    station
        Distance from the member's first node [m].
    travel
        By how far the obstacle moves, relative to the member, before they touch [m].
    outwards
        Unit vector across the member from it to the obstacle, (3,).
    sine
        Of the angle between the member and the axis of the obstacle there.
    """

    obstacle: str
    station: float
    travel: float
    outwards: tuple[float, ...]
    sine: float


@dataclass(frozen=True)
class Core:
    """Axis of what strikes: from `start` to `end` from its centre; the normals of a plane at its edge."""

    centre: Floats
    axis: Floats
    radius: float
    start: float = -math.inf
    end: float = math.inf
    outwards: tuple[Floats, ...] = ()


def struck_places(structure: StructureParts, member: str, ends: bool = False) -> tuple[StruckPlace, ...]:
    """Places of a member's line in the paths of obstacles, in the order of the input.

    Parameters
    ----------
    structure, member
        What is struck.
    ends
        Whether the ends of the line count too.
    """
    found = structure.kept.once("struck places", "", lambda: _struck_places(structure)).get(member, ())
    length = structure.frame_of(member).length if found else 0.0
    return tuple(place for place in found if ends or LEAST < place.station < length - LEAST)


def _struck_places(structure: StructureParts) -> Mapping[str, tuple[StruckPlace, ...]]:
    found: dict[str, tuple[StruckPlace, ...]] = {}
    for name, obstacle in structure.obstacles.items():
        if isinstance(obstacle, PlaneObstacle) and obstacle.edge is None:
            continue
        members = [one for one in obstacle.members or structure.members if structure.is_whole(one)]
        path = _path(structure, obstacle)
        for member in members if path is not None else _nearest(structure, obstacle, members):
            place = _touches(structure, member, name, path)
            if place is not None and -KINK <= place.station <= structure.frame_of(member).length + KINK:
                found[member] = (*found.get(member, ()), place)
    return found


def travel_to_joints(structure: StructureParts, obstacle: str) -> float:
    """By how far a ball or a pole moves until it touches a joint [m]; infinite if it meets none.

    The joint is a ball about its node that reaches as far as the narrowest member there.
    """
    spec = structure.obstacles[obstacle]
    path = _path(structure, spec)
    if path is None or not isinstance(spec, SphereObstacle | CylinderObstacle):
        return math.inf
    least = math.inf
    for node, members in structure.members_at.items():
        outlines = (
            structure.section_of(name).outer_outline()
            for name in members
            if structure.is_whole(name) and (spec.members is None or name in spec.members)
        )
        reach = min((float(np.ptp(outline, axis=0).min()) / 2.0 for outline in outlines), default=None)
        if reach is not None:
            apart = np.asarray(structure.nodes[node], float) - np.asarray(spec.point, float)
            least = min(least, _travel_to_ball(spec, apart, path, spec.radius + reach))
    return least


def _travel_to_ball(obstacle: Obstacle, apart: Floats, path: Floats, distance: float) -> float:
    """Travel along a path until a point is at a distance from the centre of a ball or the axis of a pole."""
    whole, along = apart, path
    if isinstance(obstacle, CylinderObstacle):
        axis = _unit(np.asarray(obstacle.axis))
        apart, path = apart - (apart @ axis) * axis, path - (path @ axis) * axis
    closing, speed = float(apart @ path), float(path @ path)
    left = closing**2 - speed * (float(apart @ apart) - distance**2)
    if speed < LEAST or closing < 0.0 or left < 0.0:
        return math.inf
    travel = max(0.0, (closing - math.sqrt(left)) / speed)
    if isinstance(obstacle, CylinderObstacle) and obstacle.length is not None:
        beyond = float((whole - travel * along) @ _unit(np.asarray(obstacle.axis)))
        if not -distance <= beyond <= obstacle.length + distance:
            return math.inf
    return travel


def _path(structure: StructureParts, obstacle: Obstacle) -> Floats | None:
    """Unit vector along which an obstacle moves relative to the structure, (3,); None if there is none."""
    whole = all(
        field.nodes is None and field.members is None and not field.rotation
        for field in structure.initial_velocity
    )
    if obstacle.turning is not None or not whole:
        return None
    velocity = np.asarray(obstacle.velocity, float) - sum(
        (np.asarray(field.translation, float) for field in structure.initial_velocity), np.zeros(3)
    )
    if not velocity.any():
        velocity = first_displacement(obstacle)
    speed = float(np.linalg.norm(velocity))
    return velocity / speed if speed > 0.0 else None


def first_displacement(obstacle: Obstacle) -> Floats:
    """Prescribed displacement of an obstacle once there is any [m], (3,)."""
    functions = (obstacle.motion.x, obstacle.motion.y, obstacle.motion.z)
    moved = np.column_stack([np.zeros(len(TIMES)) if f is None else f(TIMES) for f in functions])
    there = np.linalg.norm(moved, axis=1) > LEAST
    return np.asarray(moved[int(np.argmax(there))] if there.any() else np.zeros(3))


def _nearest(structure: StructureParts, obstacle: Obstacle, members: list[str]) -> Iterator[str]:
    """Members nearest to an obstacle at the start; none to the edge of a plane, whose face may be nearer."""
    if isinstance(obstacle, PlaneObstacle) or not members:
        return
    gaps = axis_gaps(structure, obstacle, members).min(axis=1)
    yield from (name for name, own in zip(members, gaps, strict=True) if own <= gaps.min() + LEAST)


def axis_gaps(structure: StructureParts, obstacle: Obstacle, members: list[str]) -> Floats:
    """Distances of the axes of some members from an obstacle at the start [m], (members, places)."""
    frames = [structure.frame_of(name) for name in members]
    axes = np.array([[frame.position(share * frame.length) for share in PLACES] for frame in frames])
    return gap(obstacle, axes)


def _touches(
    structure: StructureParts, member: str, obstacle: str, path: Floats | None
) -> StruckPlace | None:
    """Where an obstacle touches a member's line first, also beyond its ends; None if it misses it."""
    frame, outline = structure.frame_of(member), structure.section_of(member).outer_outline()
    core = _core(structure.obstacles[obstacle], frame, path)
    return touch(frame, outline, core, path, obstacle)


def touch(
    frame: Frame, outline: Floats, core: Core, path: Floats | None, obstacle: str
) -> StruckPlace | None:
    """Where something with an axis touches a member's line first, also beyond its ends; None if it misses it.

    Parameters
    ----------
    frame, outline
        Of the member.
    core
        Axis and radius of what strikes.
    path
        Unit vector along which it moves; None: straight to the member.
    obstacle
        Its name.
    """
    normal = cross(frame.x, core.axis)
    sine = float(np.linalg.norm(normal))
    if sine < math.sin(NARROWEST):
        return None
    apart = core.centre - frame.origin
    towards = normal / sine * (1.0 if apart @ normal >= 0.0 else -1.0)
    path = -towards if path is None else path
    closing = -float(path @ towards)
    if closing < math.sin(NARROWEST) or any(side @ towards > LEAST for side in core.outwards):
        return None
    travel = (float(apart @ towards) - core.radius - reach_of(frame, outline, towards)) / closing
    travel = max(0.0, travel)
    apart = apart + travel * path
    along = float(cross(apart, frame.x) @ normal) / sine**2
    beside = core.radius + reach_of(frame, outline, core.axis)
    if along < core.start - beside or along > core.end + beside:
        return None
    station = float(cross(apart, core.axis) @ normal) / sine**2
    return StruckPlace(obstacle, station, travel, tuple(towards.tolist()), sine)


def _core(obstacle: Obstacle, frame: Frame, path: Floats | None) -> Core:
    """Axis of an obstacle that strikes a member; that of a ball lies across its path and the member."""
    centre, radius = np.asarray(obstacle.point, float), float(getattr(obstacle, "radius", 0.0))
    if isinstance(obstacle, PlaneObstacle) and obstacle.edge is not None:
        sides = (_unit(np.asarray(obstacle.normal)), _unit(np.asarray(obstacle.edge)))
        return Core(centre, cross(*sides), 0.0, outwards=sides)
    if isinstance(obstacle, CylinderObstacle):
        axis, length = _unit(np.asarray(obstacle.axis)), obstacle.length
        if length is None:
            return Core(centre, axis, radius)
        if path is None or abs(path @ axis) < math.cos(NARROWEST):
            return Core(centre, axis, radius, start=0.0, end=length)
        # it strikes with its round end
        centre = centre + (length if path @ axis > 0.0 else 0.0) * axis
    across = cross(frame.x, centre - frame.origin if path is None else path)
    return Core(centre, _unit(across), radius, start=0.0, end=0.0)


def reach_of(frame: Frame, outline: Floats, direction: Floats) -> float:
    """How far a section's outline reaches from the member's line in a direction [m]."""
    return float((outline @ (frame.axes[1:] @ direction)).max())


def _unit(vector: Floats) -> Floats:
    size = float(np.linalg.norm(vector))
    return np.asarray(vector / size if size > 0.0 else vector)
