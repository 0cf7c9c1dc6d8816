"""What cannot be a section: every mistake in the walls, each wall by name."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from crumple.errors import Problem
from crumple.numeric.arrays import Floats, Integers
from crumple.section.geometry.bends import Piece
from crumple.section.geometry.skeleton import Complexes, Skeleton
from crumple.section.section import in_mm
from crumple.section.wall import Wall, Weld

# Walls that leave a node closer together than this [rad] are folded onto each other, no corner.
SHARPEST_CORNER = math.radians(15.0)
# Parts of the sum of half thicknesses: closer mid-lines mean that two walls share metal; sheets that are
# welded flat on each other are exactly 1 apart.
TOUCHING = 0.99


def name_of(walls: Sequence[Wall], number: int) -> str:
    """What messages call a wall: its name, else its place in the list, counted from 0."""
    return walls[number].name or f"walls[{number}]"


def wall_problems(walls: Sequence[Wall]) -> list[Problem]:
    """Problems of single walls: numbers out of range, points that repeat."""
    if not walls:
        return [Problem("the section has no walls", "", "one wall or more", "give points and thickness")]
    return [problem for number in range(len(walls)) for problem in _of_one(walls, number)]


def _of_one(walls: Sequence[Wall], number: int) -> list[Problem]:
    wall, name, problems = walls[number], name_of(walls, number), []
    fewest = 3 if wall.closed else 2
    if not (math.isfinite(wall.thickness) and wall.thickness > 0.0):
        todo = "give the thickness of the sheet"
        problems.append(
            Problem("thickness must be positive", in_mm(wall.thickness), "> 0 mm", todo, f"{name}.thickness")
        )
    if not (math.isfinite(wall.corner_radius) and wall.corner_radius >= 0.0):
        todo = "give the outer radius of the bends, 0 mm for sharp ones"
        came = in_mm(wall.corner_radius)
        problems.append(
            Problem("corner radius must not be negative", came, ">= 0 mm", todo, f"{name}.corner_radius")
        )
    if len(wall.points) < fewest:
        todo = "give every corner of the mid-line"
        came = f"{len(wall.points)} points"
        problems.append(
            Problem("the wall has too few points", came, f"{fewest} or more", todo, f"{name}.points")
        )
        return problems
    points = np.array(wall.points)
    if not np.isfinite(points).all():
        problems.append(
            Problem("a point is not finite", "", "lengths", "give y and z of each point", f"{name}.points")
        )
        return problems
    following = np.roll(points, -1, axis=0) if wall.closed else points[1:]
    sides = np.linalg.norm(following - points[: len(following)], axis=1)
    shortest = 1e-6 * float(np.ptp(points, axis=0).sum())
    for k in np.flatnonzero(sides <= shortest).tolist():
        problems.append(
            Problem(
                "the wall has a side without length",
                f"point {k} and the next are {in_mm(sides[k])} apart",
                "points that differ",
                "remove the repeated point; a closed wall does not repeat its first point",
                f"{name}.points[{k}]",
            )
        )
    return problems


def bends_without_room(wall: Wall, number: int, short: list[int]) -> list[Problem]:
    """Problems of flats that are shorter than the bends at their ends need."""
    name = wall.name or f"walls[{number}]"
    return [
        Problem(
            "the corner radius does not fit the side",
            f"outer radius {in_mm(wall.corner_radius)} at the side that starts with point {k}",
            "bends that leave a flat between them, or just meet",
            "give a smaller radius, or a longer side",
            f"{name}.corner_radius",
        )
        for k in short
    ]


def weld_problems(
    pieces: list[Piece], walls: Sequence[Wall], welds: Sequence[Weld], tolerance: float
) -> list[Problem]:
    """Problems of welds that do not lie on two touching walls."""
    flats = [piece for piece in pieces if not piece.radius]
    starts, stops = (np.array([getattr(piece, end) for piece in flats]) for end in ("start", "end"))
    problems = []
    for number, weld in enumerate(welds):
        ends = [complex(*point) for point in (weld.first, weld.second)]
        halves = []
        for end, place in zip(ends, ("first", "second"), strict=True):
            distance = _distance(np.array([end]), starts, stops)[0]
            nearest = int(np.argmin(distance))
            halves.append(flats[nearest].thickness / 2.0)
            if distance[nearest] > tolerance:
                came = f"{in_mm(distance[nearest])} from the mid-line of "
                problems.append(
                    Problem(
                        "the weld is not on a wall",
                        came + name_of(walls, flats[nearest].wall),
                        "a point on the mid-line of a flat",
                        "move the point onto the mid-line",
                        f"welds[{number}].{place}",
                    )
                )
        apart = abs(ends[0] - ends[1])
        if abs(apart - sum(halves)) > 0.05 * sum(halves):
            problems.append(
                Problem(
                    "the welded walls do not touch",
                    f"mid-lines {in_mm(apart)} apart",
                    f"half the sum of their thicknesses, {in_mm(sum(halves))}",
                    "lay the walls flat on each other at the weld",
                    f"welds[{number}]",
                )
            )
    return problems


def graph_problems(skeleton: Skeleton, walls: Sequence[Wall]) -> list[Problem]:
    """Problems of walls among each other: crossings, overlaps, gaps, folds, stubs, loose parts."""
    flats = [edge for edge, piece in enumerate(skeleton.pieces) if not piece.radius and piece.thickness > 0.0]
    problems = _crossings(skeleton, walls, flats) if flats else []
    # a crossing is also an overlap: report it once
    problems = problems or (_overlaps(skeleton, walls, flats) if flats else [])
    problems += _gaps(skeleton, walls, flats)
    problems += _folds(skeleton, walls)
    problems = problems or [*_stubs(skeleton, walls), *_loose_parts(skeleton, walls)]
    return problems


def _pair(skeleton: Skeleton, walls: Sequence[Wall], first: int, second: int) -> str:
    names = [name_of(walls, skeleton.pieces[edge].wall) for edge in (first, second)]
    return f"{names[0]} and itself" if names[0] == names[1] else " and ".join(names)


def _ends(skeleton: Skeleton, flats: list[int]) -> tuple[Complexes, Complexes]:
    return skeleton.nodes[skeleton.ends[flats, 0]], skeleton.nodes[skeleton.ends[flats, 1]]


def _crossings(skeleton: Skeleton, walls: Sequence[Wall], flats: list[int]) -> list[Problem]:
    start, end = _ends(skeleton, flats)
    side = end - start

    def beside(points: Complexes) -> Floats:
        """On which side of flat i the point j lies."""
        return np.asarray((side.conj()[:, None] * (points[None, :] - start[:, None])).imag)

    small = 1e-9 * np.abs(side)[:, None] * np.abs(side).max()
    one, other = beside(start), beside(end)
    parted = (one * other < 0.0) & (np.abs(one) > small) & (np.abs(other) > small)
    return [
        Problem(
            f"walls cross: {_pair(skeleton, walls, flats[i], flats[j])}",
            "no common point where they cross",
            "walls that meet at points of both, or end on each other",
            "end the walls there, and continue with further walls from that point",
            f"walls[{skeleton.pieces[flats[i]].wall}]",
        )
        for i, j in zip(*np.nonzero(np.triu(parted & parted.T)), strict=True)
    ]


def _overlaps(skeleton: Skeleton, walls: Sequence[Wall], flats: list[int]) -> list[Problem]:
    start, end = _ends(skeleton, flats)
    thickness = skeleton.thickness[flats]
    near = np.minimum(_distance(start, start, end), _distance(end, start, end))
    near = np.minimum(near, near.T)
    number = _across_bends(skeleton)[skeleton.ends[flats]]
    joined = (number[:, None, :, None] == number[None, :, None, :]).any(axis=(2, 3))
    # two corners with a short wall between them: stubs are looked for elsewhere
    neighbours = np.zeros_like(joined)
    length = skeleton.length[flats]
    wanted = TOUCHING * (thickness[:, None] + thickness[None, :]) / 2.0
    for k in np.flatnonzero(length < thickness.max()).tolist():
        neighbours |= joined[k][:, None] & joined[k][None, :]
    bad = np.triu((near < wanted) & ~joined & ~neighbours, 1)
    return [
        Problem(
            f"walls overlap: {_pair(skeleton, walls, flats[i], flats[j])}",
            f"mid-lines {in_mm(near[i, j])} apart",
            f"half the sum of their thicknesses, {in_mm(wanted[i, j] / TOUCHING)}, or a common point",
            "move them apart, or let one end on the mid-line of the other",
            f"walls[{skeleton.pieces[flats[i]].wall}]",
        )
        for i, j in zip(*np.nonzero(bad), strict=True)
    ]


def _across_bends(skeleton: Skeleton) -> Integers:
    """Of each node a number that the two ends of a bend share."""
    number = np.arange(len(skeleton.nodes))
    for piece, (start, end) in zip(skeleton.pieces, skeleton.ends.tolist(), strict=True):
        if piece.radius:
            number[number == number[end]] = number[start]
    return number


def _distance(points: Complexes, start: Complexes, end: Complexes) -> Floats:
    """Distance of point i to flat j."""
    side = end - start
    local = (points[:, None] - start[None, :]) * (side.conj() / np.abs(side))[None, :]
    beyond = np.maximum(np.maximum(-local.real, local.real - np.abs(side)[None, :]), 0.0)
    return np.hypot(beyond, local.imag)


def _gaps(skeleton: Skeleton, walls: Sequence[Wall], flats: list[int]) -> list[Problem]:
    """Free ends that would run into another wall within a thickness, or stop just beside another end."""
    start, end = _ends(skeleton, flats)
    problems = []
    shared = _across_bends(skeleton)[skeleton.ends]
    free = [star[0] for star in skeleton.stars if len(star) == 1]
    for half in free:
        edge, point = half >> 1, complex(skeleton.nodes[skeleton.ends[half >> 1, half & 1]])
        own = skeleton.pieces[edge].thickness
        ahead = -skeleton.directions[half]
        for k, other in enumerate(flats):
            if set(shared[other]) & set(shared[edge]):
                continue
            reach = (own + skeleton.pieces[other].thickness) / 2.0
            local = np.array([start[k] - point, end[k] - point]) * ahead.conjugate()
            straddles = local[0].imag * local[1].imag < 0.0
            if straddles:
                share = local[0].imag / (local[0].imag - local[1].imag)
                hit = local[0].real + share * (local[1].real - local[0].real)
                gap = hit if 0.0 < hit <= 1.01 * reach else math.inf
            else:
                gap = min(abs(value) for value in local)
                gap = gap if gap < TOUCHING * reach else math.inf
            if math.isfinite(gap):
                problems.append(
                    Problem(
                        f"gap between {_pair(skeleton, walls, edge, other)}",
                        f"an end stops {in_mm(gap)} short of the other mid-line",
                        "a common point, or a gap wider than the walls are thick",
                        "give both the same point",
                        f"walls[{skeleton.pieces[edge].wall}]",
                    )
                )
                break
    return problems


def _folds(skeleton: Skeleton, walls: Sequence[Wall]) -> list[Problem]:
    problems = []
    for star in skeleton.stars:
        metal = [half for half in star if skeleton.pieces[half >> 1].thickness > 0.0]
        for position, half in enumerate(metal):
            following = metal[(position + 1) % len(metal)]
            ratio = skeleton.directions[following] / skeleton.directions[half]
            angle = abs(math.atan2(ratio.imag, ratio.real))
            if half != following and angle < SHARPEST_CORNER:
                problems.append(
                    Problem(
                        f"walls fold back on each other: {_pair(skeleton, walls, half >> 1, following >> 1)}",
                        f"{math.degrees(angle):.3g} deg between them",
                        f"{math.degrees(SHARPEST_CORNER):g} deg or more",
                        "draw sheets that lie on each other a thickness apart, and weld them",
                        f"walls[{skeleton.pieces[half >> 1].wall}]",
                    )
                )
    return problems


def _stubs(skeleton: Skeleton, walls: Sequence[Wall]) -> list[Problem]:
    """Flats that the corners at their ends use up."""
    left, right = skeleton.corners
    problems = []
    for edge, piece in enumerate(skeleton.pieces):
        if piece.radius or piece.thickness <= 0.0:
            continue
        along = skeleton.directions[2 * edge].conjugate()
        one = (along * (left[2 * edge + 1][-1] - right[2 * edge][-1])).real
        other = (along * (right[2 * edge + 1][-1] - left[2 * edge][-1])).real
        if min(one, other) <= 0.0:
            problems.append(
                Problem(
                    f"{name_of(walls, piece.wall)} is too thick for its length",
                    f"a side of {in_mm(piece.length)} with a thickness of {in_mm(piece.thickness)}",
                    "a side longer than the walls at its ends are thick",
                    "give a thinner wall or a longer side; mid-line points are wanted, not the surface",
                    f"walls[{piece.wall}]",
                )
            )
    return problems


def _loose_parts(skeleton: Skeleton, walls: Sequence[Wall]) -> list[Problem]:
    part = np.arange(len(skeleton.nodes))
    for _ in range(len(part)):
        before = part.copy()
        lowest = np.minimum(part[skeleton.ends[:, 0]], part[skeleton.ends[:, 1]])
        np.minimum.at(part, skeleton.ends[:, 0], lowest)
        np.minimum.at(part, skeleton.ends[:, 1], lowest)
        if (part == before).all():
            break
    number = part[skeleton.ends[:, 0]]
    groups = [
        sorted({name_of(walls, int(wall)) for wall in skeleton.wall[number == one] if wall >= 0})
        for one in np.unique(number)
    ]
    if len(groups) == 1:
        return []
    return [
        Problem(
            f"the section consists of {len(groups)} separate parts",
            "; ".join(", ".join(group) for group in groups),
            "walls that are all connected",
            "let walls end on each other's mid-lines, or weld them",
            "walls",
        )
    ]
