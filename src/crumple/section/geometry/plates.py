"""Flats of a section as plates: held at bends, junctions and welds, free at the ends of walls."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from crumple.section.geometry.skeleton import Skeleton
from crumple.section.section import in_mm
from crumple.section.wall import Wall

# A flatter bend does not hold the plates beside it [rad]: chosen, no source.
HOLDING_BEND = math.radians(10.0)


@dataclass(frozen=True)
class Plate:
    """Straight run of edges between places that hold it.

    Attributes
    ----------
    name
        Wall and width, for people.
    edges
        Numbers of its edges, in order.
    stops
        Distances of their ends from the start of the plate [m], one more than edges.
    start, end
        Its ends, complex [m], in the coordinates of the walls.
    thickness
        Of its thinnest edge [m].
    held_at_start, held_at_end
        Whether that edge is held against buckling; the start always is where one of them is.
    """

    name: str
    edges: tuple[int, ...]
    stops: tuple[float, ...]
    start: complex
    end: complex
    thickness: float
    held_at_start: bool
    held_at_end: bool

    @property
    def width(self) -> float:
        """Distance of its ends along the mid-line [m]."""
        return self.stops[-1]

    @property
    def held(self) -> int:
        """How many of its two long edges are held."""
        return self.held_at_start + self.held_at_end


def plates_of(walls: Sequence[Wall], skeleton: Skeleton) -> list[Plate]:
    """All plates of walls and their skeleton; arcs belong to none."""
    through = {node for node in range(len(skeleton.nodes)) if _passes(skeleton, node)}
    plates: list[Plate] = []
    seen: set[int] = set()
    for half in range(2 * len(skeleton.pieces)):
        node = int(skeleton.ends[half >> 1, half & 1])
        if not _is_flat(skeleton, half) or node in through or half >> 1 in seen:
            continue
        run = [half]
        while (far := _far_node(skeleton, run[-1])) in through:
            run.append(next(h for h in skeleton.stars[far] if h != run[-1] ^ 1))
        seen.update(h >> 1 for h in run)
        plates.append(_plate(walls, skeleton, run))
    return plates


def _is_flat(skeleton: Skeleton, half: int) -> bool:
    piece = skeleton.pieces[half >> 1]
    return not piece.radius and piece.thickness > 0.0


def _far_node(skeleton: Skeleton, half: int) -> int:
    return int(skeleton.ends[half >> 1, 1 - (half & 1)])


def _passes(skeleton: Skeleton, node: int) -> bool:
    """Whether a plate goes on through a node as if it were not there."""
    star = skeleton.stars[node]
    if len(star) != 2 or not all(_is_flat(skeleton, half) for half in star):
        return False
    ratio = -skeleton.directions[star[1]] / skeleton.directions[star[0]]
    return abs(math.atan2(ratio.imag, ratio.real)) < HOLDING_BEND


def _plate(walls: Sequence[Wall], skeleton: Skeleton, run: list[int]) -> Plate:
    nodes = [int(skeleton.ends[run[0] >> 1, run[0] & 1]), _far_node(skeleton, run[-1])]
    held = [len(skeleton.stars[node]) > 1 for node in nodes]
    if held[1] and not held[0]:
        run, nodes, held = [half ^ 1 for half in reversed(run)], nodes[::-1], held[::-1]
    edges = tuple(half >> 1 for half in run)
    stops = [0.0]
    for edge in edges:
        stops.append(stops[-1] + float(skeleton.length[edge]))
    wall = walls[skeleton.pieces[edges[0]].wall]
    name = wall.name or f"walls[{skeleton.pieces[edges[0]].wall}]"
    start, end = (complex(skeleton.nodes[node]) for node in nodes)
    thickness = min(float(skeleton.thickness[edge]) for edge in edges)
    return Plate(f"{name}, {in_mm(stops[-1])} flat", edges, tuple(stops), start, end, thickness, *held)
