"""Candidates for folds on straight runs, and what strikes them."""

from __future__ import annotations

import math
from bisect import bisect
from collections import defaultdict
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

import numpy as np

from crumple.hinge.registry import Fold
from crumple.section import Axis, half_fold_length
from crumple.structure.hinges.corners import corners, kink_at
from crumple.structure.hinges.joint_reach import joint_reach
from crumple.structure.hinges.law_choice import UNKNOWN, Surroundings, distance_of_fold
from crumple.structure.hinges.lengthening.braced import braced
from crumple.structure.hinges.lengthening.held_runs import pushed_runs
from crumple.structure.hinges.lengthening.pressed import kinks_pressed
from crumple.structure.hinges.lengthening.stopped import stopped
from crumple.structure.hinges.runs.ends import carries_moment, passes_moment
from crumple.structure.hinges.runs.straight_runs import StraightRun
from crumple.structure.parts import StructureParts
from crumple.structure.struck_members import places_struck_by_members
from crumple.structure.struck_places import struck_places

ASIDE = 0.001
"""Distance of a hinge from the place where an obstacle with friction strikes, over half a fold length: just
there both pieces would touch it at one point, which leaves the friction of each undetermined and takes three
times as long; a hundred times as far, one of them takes most of it and pushes the member aside."""

MOST_INSIDE = 0.3
"""Largest distance of a candidate from the end of its run, over the length of the run."""
SHORTEST, LONG, LEAST_INSIDE = 1.0, 3.0, 0.2
"""Spans over the largest side of the section between which a fold moves away from a clamp, and the share of
its distance in long ones that it has at least."""
STRAIGHT = 5e-3
"""Angle between members in line [rad] up to which a node between them is not a place of its own: far above
rounded coordinates, and far below the kinks by which a polygon stands for a curved member."""
KINKED = 3
"""Parts between the candidates of a member that may kink: shells have a fold beside one end and another 0.15
to 0.5 of the length from it."""
FREE = Surroundings("free")
"""Of a fold between those beside the ends of its run."""


@dataclass(frozen=True)
class Strike:
    """Obstacles that strike a run at a candidate.

    Attributes
    ----------
    obstacles
        Their names.
    spans
        Distances to what holds the run on both sides [m].
    held
        Whether the run carries a moment there.
    """

    obstacles: tuple[str, ...]
    spans: tuple[float, float]
    held: tuple[bool, bool]


@dataclass(frozen=True)
class Candidate:
    """A candidate for a fold.

    Attributes
    ----------
    member, name
        Its member, and its own name.
    station
        Distance from the member's first node [m].
    near
        Whether it lies between those beside the ends of the run, or beside what keeps the section there in
        shape: all but a mitre.
    strike
        What strikes it, if anything does.
    """

    member: str
    name: str
    station: float
    near: Surroundings = UNKNOWN
    strike: Strike | None = None


def candidates_on(
    structure: StructureParts, run: StraightRun, axes: tuple[Axis, ...], spacing: float | None
) -> Mapping[str, list[Candidate]]:
    """Candidates on a straight run, by their members.

    Parameters
    ----------
    structure, run
        Its members must have nodes that exist and are apart.
    axes
        Bending axes of the candidates: the longest of their folds counts.
    spacing
        Largest distance between candidates [m]; None: only at the ends, at kinks, in the middle of braced
        members and pushed runs, and where obstacles or members strike.
    """

    def find() -> Mapping[str, list[Candidate]]:
        found = defaultdict(list)
        for one in _candidates(structure, run, axes, spacing):
            found[one.member].append(one)
        return found

    return structure.kept.once("run", (next(iter(run.stretches)), axes, spacing), find)


def _candidates(
    structure: StructureParts, run: StraightRun, axes: tuple[Axis, ...], spacing: float | None
) -> Iterator[Candidate]:
    names = list(run.stretches)
    section = structure.section_of(names[0])
    half = max(half_fold_length(section, axis) for axis in axes)
    ends = list(zip((names[0], names[-1]), run.nodes, strict=True))
    first_held, last_held = (carries_moment(structure, *one) for one in ends)
    start, end = joint_reach(structure, *ends[0]), run.length - joint_reach(structure, *ends[1])
    # a run that is shorter than two folds has room for one
    if 4.0 * half >= end - start:
        if first_held or last_held:
            span = _span(end - start, [], first_held and last_held)
            near = Surroundings(_beside(structure, *run.nodes), span)
            yield replace(_candidate(run, "1", (start + end) / 2.0), near=near)
        return
    held = passes_moment(structure, *ends[0], axes), passes_moment(structure, *ends[1], axes)
    pressed = list(_struck(structure, run, half, ends=True))
    by_members = list(_struck_by_members(structure, run, half))
    loaded = [at for _, at in (*pressed, *by_members) if start < at < end]
    beside = [_beside(structure, node) for node in run.nodes]
    from_ends = [at - start for at in loaded], [end - at for at in loaded]
    spans = [_span(end - start, from_ends[i], held[1 - i]) for i in (0, 1)]
    inside = [_inside(structure, run, axes, *one) for one in zip(beside, spans, strict=True)]
    first, last = start + inside[0], end - inside[1]
    struck = [*_struck(structure, run, half, ends=False), *by_members]
    struck = [(_own_name(run, name), at) for name, at in struck if first < at < last]
    number = 1 if spacing is None else max(1, math.ceil((last - first) / spacing * (1.0 - 1e-9)))
    number = max(number, _least_parts(structure, run, bool(struck), first_held or last_held))
    between = np.linspace(first, last, number + 1)[1:-1].tolist()
    if first_held:
        near = Surroundings(beside[0], spans[0], inside[0])
        yield replace(_candidate(run, run.nodes[0], first), near=near)
    if last_held:
        near = Surroundings(beside[1], spans[1], inside[1])
        yield replace(_candidate(run, run.nodes[1], last), near=near)
    inner = [(str(i), at) for i, at in enumerate(between, 1)]
    taken = [first, *between, last]
    folding = {
        node
        for node, at in run.between.items()
        if any(abs(at - place) <= half for _, place in (*pressed, *by_members))
    }
    divided = [
        (node, at - ASIDE * half)
        for node, at in run.between.items()
        if node in folding or _ends_rigid(structure, node) or kink_at(structure, node) > STRAIGHT
    ]
    for name, at in (*inner, *struck, *divided):
        before = bisect(taken, at)
        around = taken[max(before - 1, 0) : before + 1]
        # what an obstacle strikes is dented and folds beside the fold at an end, too
        beside_end = half if (name, at) in struck else 2.0 * half
        apart = all(
            abs(at - other) > (beside_end if other in (first, last) else 2.0 * half) for other in around
        )
        if apart or (name, at) in inner:
            if apart:
                taken.insert(before, at)
            strikes = tuple(obstacle for obstacle, place in pressed if abs(at - place) <= half)
            strike = Strike(strikes, (at - start, end - at), held) if strikes else None
            yield replace(_candidate(run, name, at), near=FREE, strike=strike)


def _own_name(run: StraightRun, name: str) -> str:
    """Name of the candidate where something strikes; nodes and numbers name others."""
    return f"{name}-struck" if name in (*run.nodes, *run.between) or name.isdigit() else name


def _least_parts(structure: StructureParts, run: StraightRun, struck: bool, held: bool) -> int:
    """Parts into which candidates divide what lies between those at the ends of a run, if not asked for more.

    Parameters
    ----------
    structure, run
        The run.
    struck
        Whether an obstacle strikes it between its ends, and so places the fold of a strut.
    held
        Whether one of its ends can carry a moment.
    """
    name = run.first
    if not struck and kinks_pressed(structure, name):
        return KINKED
    struts = braced(structure) | pushed_runs(structure)
    buckles = not struck and not struts.isdisjoint(run.stretches)
    # what is pressed between free ends folds somewhere
    pressed = not held and bool(structure.members[name].elastic) and stopped(structure)
    return 2 if buckles or pressed else 1


def _candidate(run: StraightRun, name: str, along: float) -> Candidate:
    member = run.member_at(along)
    return Candidate(member, f"{member}-{name}", run.stretches[member].station(along))


def _inside(
    structure: StructureParts, run: StraightRun, axes: tuple[Axis, ...], fold: Fold | None, span: float
) -> float:
    """Distance of a candidate from the end of its run [m]; there is room between two of them.

    In short spans the fold of shells moves to the clamp.
    """
    furthest = max(distance_of_fold(structure, run.first, axis, fold) for axis in axes)
    side = float(np.ptp(structure.section_of(run.first).outer_outline(), axis=0).max())
    far = (span / side - SHORTEST) / (LONG - SHORTEST)
    return min(furthest * min(max(far, LEAST_INSIDE), 1.0), MOST_INSIDE * run.length)


def _span(length: float, loaded: list[float], other_end: bool) -> float:
    """Distance from one end of a run to where it carries no moment [m], as in a beam that folds there.

    Parameters
    ----------
    length, loaded
        Of the run, and distances of what loads it in between from this end [m].
    other_end
        Whether the other end takes a moment: what loads the run first, or that end, then folds the other way.
    """
    return min([length, *loaded]) / 2.0 if other_end else length


def _ends_rigid(structure: StructureParts, node: str) -> bool:
    """Whether a member at a node has rigid parts, at whose ends it folds."""
    return any(structure.members[name].rigid for name in structure.members_at[node])


def _beside(structure: StructureParts, *nodes: str) -> Fold | None:
    """Kind of a fold beside nodes."""
    return "clamped" if corners(structure).keys().isdisjoint(nodes) else None


def _struck(
    structure: StructureParts, run: StraightRun, half: float, *, ends: bool
) -> Iterator[tuple[str, float]]:
    """Obstacles that strike a run, and where [m]: beside it where they rub.  `ends`: also at nodes."""
    for member, stretch in run.stretches.items():
        for place in struck_places(structure, member, ends):
            rubs = structure.obstacles[place.obstacle].friction > 0.0
            at = stretch.along(place.station)
            yield place.obstacle, at + (_aside(run, at, half) if rubs else 0.0)


def _struck_by_members(
    structure: StructureParts, run: StraightRun, half: float
) -> Iterator[tuple[str, float]]:
    """Members that strike a run between the ends of its members, and where [m]: beside it where they rub."""
    contact = structure.member_contact
    rubs = contact is not None and contact.friction > 0.0
    taken = set(structure.obstacles)
    for member, stretch in run.stretches.items():
        for place in places_struck_by_members(structure, member):
            at = stretch.along(place.station)
            if place.obstacle not in taken:
                taken.add(place.obstacle)
                yield place.obstacle, at + (_aside(run, at, half) if rubs else 0.0)


def _aside(run: StraightRun, at: float, half: float) -> float:
    """How far beside a place a hinge lies [m]: towards the nearer end of its run, however that leads."""
    return math.copysign(ASIDE * half, at - run.length / 2.0)
