"""Members that are laid out as few engineers mean them: mostly a joint that was forgotten.

Nothing is refused for them.  What ends or crosses inside the walls of a member without a common node or welds
is not joined to it.  The rules, each with what is left out because it may be meant:

- Unjoined node: an end of a member lies inside the outline of another member.  Not: ends of members that also
  end at a node of the other one, whose walls overlap at every joint, and pairs with spot welds.
- Crossing: the line of a member passes through another one nearer than half a side to its line, with both
  going on.  Not: members that a common node, a member of both, or welds join.
- Double: two members between the same two nodes, or one that lies along another from their common node on.
- Loose part: one of several parts that has neither supports nor motion, loads or impulses of its own, so that
  it stays where it is.  Not: a part that others may strike (`member_contact`), or that falls on an obstacle.
- Short: a member shorter than the largest side of its section.  Not: pieces of a longer straight line of
  members, and rigid members, which need no theory of beams.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from crumple.hinge.corner.in_plane import SMALLEST
from crumple.numeric.arrays import Floats
from crumple.structure.checks.at_rest import nothing_acts
from crumple.structure.checks.standing import standing_doubts
from crumple.structure.checks.unusual import Unusual, unusual_values
from crumple.structure.checks.without_effect import without_effect
from crumple.structure.geometry import NARROWEST
from crumple.structure.hinges.corners import leaving
from crumple.structure.keys.stages import Stage
from crumple.structure.parts import StructureParts
from crumple.text.names import listed
from crumple.units import format_quantity

MOST_NAMED = 4
"""Places that a sentence names."""
MOST_PAIRS = 20_000_000
"""Pairs of members that are looked at, in some seconds; more have thousands of members across each other."""
AT_ONCE = 500_000
"""Pairs in one array: some 100 MB for all that is worked out of them."""
ASKEW = np.array([0.26726, 0.53452, 0.80178])
"""Direction across which few nodes of a drawing lie in one plane; of about unit length."""

Pair = tuple[int, int]


@dataclass(frozen=True, eq=False)
class _Lines:
    """Members as segments with the outlines of their sections.

    Attributes
    ----------
    names, ends
        Of members and of their nodes.
    start, along
        First nodes [m] and vectors to the second ones [m], (n, 3).
    axes
        Unit vectors of local x, y, z, (n, 3, 3).
    low, high
        Limits of the outline in local y and z [m], (n, 2).
    """

    names: list[str]
    ends: list[frozenset[str]]
    start: Floats
    along: Floats
    axes: Floats
    low: Floats
    high: Floats

    @property
    def length(self) -> Floats:
        """[m], (n,)."""
        return np.asarray(np.linalg.norm(self.along, axis=1))

    @property
    def half(self) -> Floats:
        """Half of the smaller side [m], (n,)."""
        return np.asarray((self.high - self.low).min(axis=1) / 2.0)

    @property
    def reach(self) -> Floats:
        """Largest distance of the outline from the line [m], (n,)."""
        return np.asarray(np.hypot(*np.maximum(np.abs(self.low), np.abs(self.high)).T))


def doubtful_members(structure: StructureParts) -> tuple[Unusual, ...]:
    """Members that are probably not laid out as meant, kind by kind; alike ones have one sentence.

    Parameters
    ----------
    structure
        Checked.
    """
    lines = _lines(structure)
    on, along = _nodes_on_members(structure, lines)
    across = _crossing(structure, lines)
    named = {name for node, member, _, _ in on for name in (member, *structure.members_at[node])}
    named |= {name for one, other, _, _ in across for name in (one, other)}
    return (
        *_unjoined(on),
        *_crossed(across),
        *_loose(structure, named),
        *_double(structure, along),
        *_short(structure, lines),
    )


def input_doubts(
    structure: StructureParts, duration: float, stages: Sequence[Stage] = ()
) -> tuple[Unusual, ...]:
    """What is to be said of an input before it is solved.

    That nothing acts, or has no effect, unusual values, doubtful members, and standing masses.

    Parameters
    ----------
    structure
        Checked.
    duration
        Of the run [s].
    stages
        Of the run.
    """
    return (
        *nothing_acts(structure, duration, stages),
        *without_effect(structure, duration, stages),
        *unusual_values(structure, duration),
        *doubtful_members(structure),
        *standing_doubts(structure, stages),
    )


def double_members(structure: StructureParts) -> frozenset[str]:
    """Members of which another one has the same two nodes: what each of them carries is not determined."""
    return frozenset(name for names in _alike(structure) for name in names)


def _alike(structure: StructureParts) -> list[list[str]]:
    """Groups of members with the same two nodes."""
    ends = {name: frozenset(spec.nodes) for name, spec in structure.members.items()}
    several = [pair for pair, number in Counter(ends.values()).items() if number > 1]
    return [[name for name, own in ends.items() if own == pair] for pair in several]


def _lines(structure: StructureParts) -> _Lines:
    names = list(structure.members)
    frames = [structure.frame_of(name) for name in names]
    limits: dict[str, tuple[Floats, Floats]] = {}
    for name, spec in structure.members.items():
        if spec.section not in limits:
            outline = structure.section_of(name).outer_outline()
            limits[spec.section] = outline.min(axis=0), outline.max(axis=0)
    boxes = [limits[structure.members[name].section] for name in names]
    axes = np.array([frame.axes for frame in frames]).reshape(-1, 3, 3)
    length = np.array([frame.length for frame in frames])
    return _Lines(
        names=names,
        ends=[frozenset(structure.members[name].nodes) for name in names],
        start=np.array([frame.origin for frame in frames]).reshape(-1, 3),
        along=length[:, None] * axes[:, 0],
        axes=axes,
        low=np.array([low for low, _ in boxes]).reshape(-1, 2),
        high=np.array([high for _, high in boxes]).reshape(-1, 2),
    )


def _near(low: Floats, high: Floats, place: Floats) -> Iterator[tuple[NDArray[np.int64], NDArray[np.int64]]]:
    """Pairs (i, j), in arrays, with low[i] <= place[j] <= high[i]."""
    order = np.argsort(place)
    first = np.searchsorted(place[order], low)
    count = np.searchsorted(place[order], high, side="right") - first
    if count.sum() > MOST_PAIRS:
        return
    # so many of the intervals at a time
    batch = np.cumsum(count) // AT_ONCE
    for chosen in (np.flatnonzero(batch == k) for k in np.unique(batch)):
        here = count[chosen]
        offset = np.arange(here.sum()) - np.repeat(np.cumsum(here) - here, here)
        yield np.repeat(chosen, here), order[np.repeat(first[chosen], here) + offset]


def _welded(structure: StructureParts) -> set[frozenset[str]]:
    """Pairs of members that spot welds join."""
    return {frozenset(welds.members) for welds in structure.spot_welds.values()}


def _nodes_on_members(
    structure: StructureParts, lines: _Lines
) -> tuple[list[tuple[str, str, float, float]], list[tuple[str, str]]]:
    """Nodes inside members that are not joined to them, and pairs of members that lie along each other.

    Of a node: the member, the node's distance from its line and half of its smaller side [m].
    """
    nodes = list(structure.nodes)
    points = np.array([structure.nodes[node] for node in nodes], float).reshape(-1, 3)
    # tubes that have contact may rest on each other; without it a node on the face has no other meaning
    slack = (-1.0 if structure.member_contact is not None else 1.0) * 1e-3
    welded = _welded(structure)
    place = np.stack([lines.start @ ASKEW, (lines.start + lines.along) @ ASKEW])
    reach, length, half = lines.reach + abs(slack), lines.length, lines.half
    on, along = [], []
    for i, j in _near(place.min(axis=0) - reach, place.max(axis=0) + reach, points @ ASKEW):
        local = np.einsum("nij,nj->ni", lines.axes[i], points[j] - lines.start[i])
        inside = (local[:, 0] > 0.0) & (local[:, 0] < length[i])
        inside &= (local[:, 1:] > lines.low[i] - slack).all(axis=1)
        inside &= (local[:, 1:] < lines.high[i] + slack).all(axis=1)
        for k in np.flatnonzero(inside).tolist():
            member, node = lines.names[i[k]], nodes[j[k]]
            if node in lines.ends[i[k]]:
                continue
            at = structure.members_at[node]
            if any(frozenset((member, name)) in welded for name in at):
                continue
            meeting = [name for name in at if not lines.ends[i[k]].isdisjoint(structure.members[name].nodes)]
            if not meeting:
                on.append((node, member, float(np.hypot(*local[k, 1:])), float(half[i[k]])))
            along += [(member, name) for name in meeting if _is_along(structure, member, name)]
    return on, along


def _is_along(structure: StructureParts, one: str, other: str) -> bool:
    """Whether two members leave their one common node in the same direction."""
    first, second = structure.members[one].nodes, structure.members[other].nodes
    common = set(first) & set(second)
    if len(common) != 1:
        return False
    (node,) = common
    return float(leaving(structure, one, node) @ leaving(structure, other, node)) > math.cos(NARROWEST)


def _crossing(structure: StructureParts, lines: _Lines) -> list[tuple[str, str, float, float]]:
    """Pairs of members that pass through each other, the distance of their lines and its limit [m]."""
    welded = _welded(structure)
    place = np.stack([lines.start @ ASKEW, (lines.start + lines.along) @ ASKEW])
    low, high, half = place.min(axis=0), place.max(axis=0), lines.half
    found = []
    # of two intervals that overlap, one holds the beginning of the other
    for i, j in _near(low - half, high + half, low):
        a, b, between = lines.along[i], lines.along[j], lines.start[j] - lines.start[i]
        normal = np.cross(a, b)
        square = np.einsum("ni,ni->n", normal, normal)
        sine = np.sqrt(square) / (lines.length[i] * lines.length[j])
        safe = np.where(sine > math.sin(NARROWEST), square, np.inf)
        s, t = (np.einsum("ni,ni->n", np.cross(between, c), normal) / safe for c in (b, a))
        apart = np.abs(np.einsum("ni,ni->n", between, normal)) / np.sqrt(safe)
        limit = np.minimum(half[i], half[j])
        meets = (sine > math.sin(NARROWEST)) & (apart < limit) & (s > 0.0) & (s < 1.0) & (t > 0.0) & (t < 1.0)
        for k in np.flatnonzero(meets).tolist():
            first, second = sorted((int(i[k]), int(j[k])))
            pair = lines.names[first], lines.names[second]
            if not _are_joined(structure, pair) and frozenset(pair) not in welded:
                found.append((*pair, float(apart[k]), float(limit[k])))
    return sorted(set(found), key=lambda one: lines.names.index(one[0]))


def _are_joined(structure: StructureParts, pair: tuple[str, str]) -> bool:
    """Whether two members share a node, or another member ends at a node of each of them."""
    ends, others = (frozenset(structure.members[name].nodes) for name in pair)
    beside = {node for end in ends for m in structure.members_at[end] for node in structure.members[m].nodes}
    return not beside.isdisjoint(others)


def _unjoined(on: list[tuple[str, str, float, float]]) -> Iterator[Unusual]:
    """One sentence for all nodes that lie on members which do not end there."""
    if not on:
        return
    pairs = listed((f"node {node} on member {member}" for node, member, _, _ in on), MOST_NAMED, "; ")
    node, member, _, _ = on[0]
    where = f"{member} at {node}" if len(on) == 1 else "each member at this node"
    text = (
        f"Not joined: {pairs}. A member is joined at its own nodes only: divide {where}, or move the node "
        "out of its walls."
    )
    for node, _, distance, half in on:
        yield Unusual(f"node {node}", distance, half, "m", text, "unjoined_node")


def _crossed(across: list[tuple[str, str, float, float]]) -> Iterator[Unusual]:
    """One sentence for all members that cross without a common node."""
    if not across:
        return
    pairs = listed((f"{first} and {second}" for first, second, _, _ in across), MOST_NAMED, "; ")
    text = (
        f"Members {pairs} cross without a common node: they are not joined there. Divide both at a node "
        "where they cross, or move one of them aside by its depth if they pass each other."
    )
    for first, _, distance, limit in across:
        yield Unusual(f"member {first}", distance, limit, "m", text, "crossing_members")


def _loose(structure: StructureParts, named: set[str]) -> Iterator[Unusual]:
    """Parts that nothing holds or moves, but for those with a sentence about a joint that they lack."""
    if structure.member_contact is not None or (any(structure.gravity) and structure.obstacles):
        return
    parts = structure.separate_parts
    if len(parts) < 2:
        return
    acting = {part.node for parts in (structure.supports.values(), structure.loads) for part in parts}
    acting |= {impulse.node for impulse in structure.impulses}
    for field in structure.initial_velocity:
        if any(field.translation) or field.rotation:
            whole = field.nodes is None and field.members is None
            acting |= {*(structure.nodes if whole else field.nodes or ())}
            acting |= {node for name in field.members or () for node in structure.members[name].nodes}
    for part in parts:
        ends = (node for name in part for node in structure.members[name].nodes)
        if acting.isdisjoint(ends) and named.isdisjoint(part):
            are, them = ("is", "it") if len(part) == 1 else ("are", "them")
            text = (
                f"{_members(part)} {are} joined to nothing else, and nothing holds or moves {them}: no "
                f"support, initial velocity, load or impulse. Join {them} to the structure at a common node, "
                f"or remove {them}."
            )
            yield Unusual(f"member {part[0]}", float(len(part)), 0.0, "1", text, "loose_part")


def _double(structure: StructureParts, along: list[tuple[str, str]]) -> Iterator[Unusual]:
    """Members in the place of others."""
    for names in _alike(structure):
        first, second = structure.members[names[0]].nodes
        text = (
            f"{_members(names)} lie between the same nodes, {first} and {second}: they are in one place, and "
            "how they share a load is not determined. Remove all but one, or describe their walls as one "
            "section."
        )
        yield Unusual(f"member {names[1]}", float(len(names)), 1.0, "1", text, "double_member")
    for pair in sorted({tuple(sorted(pair)) for pair in along}):
        text = (
            f"{_members(pair)} lie along each other from their common node on: their walls are in one place "
            "twice. Divide the longer one at the end of the shorter one, or move a node."
        )
        yield Unusual(f"member {pair[1]}", 2.0, 1.0, "1", text, "double_member")


def _short(structure: StructureParts, lines: _Lines) -> Iterator[Unusual]:
    """One sentence for all members that are shorter than their sections are large."""
    sides, lengths = (lines.high - lines.low).max(axis=1), lines.length
    found = {}
    for k in np.flatnonzero(lengths < sides).tolist():
        name, side = lines.names[k], float(sides[k])
        if structure.members[name].rigid is False and _length_in_line(structure, name) < side:
            found[name] = float(lengths[k]), side
    if not found:
        return
    cases = (
        f"{name} ({format_quantity(length, 'm', 3)} of {format_quantity(side, 'm', 3)})"
        for name, (length, side) in found.items()
    )
    text = (
        f"Shorter than the largest side of its section: {listed(cases, MOST_NAMED)}. Bending and folds of "
        "beams need at least this length: make one node of both, or give the member 'rigid: true'."
    )
    for name, (length, side) in found.items():
        yield Unusual(f"member {name}", length, side, "m", text, "short_member")


def _length_in_line(structure: StructureParts, member: str) -> float:
    """Length of the straight line of members that a member is part of [m]."""
    total, seen = structure.frame_of(member).length, {member}
    for end in (0, 1):
        last, node = member, structure.members[member].nodes[end]
        while further := _next_in_line(structure, last, node, seen):
            last = further
            seen.add(last)
            total += structure.frame_of(last).length
            first, second = structure.members[last].nodes
            node = second if node == first else first
    return total


def _next_in_line(structure: StructureParts, member: str, node: str, seen: set[str]) -> str | None:
    """A member that goes on beyond a node in the direction of another one, with no corner between them."""
    way = -leaving(structure, member, node)
    for name in structure.members_at[node]:
        if name not in seen and float(way @ leaving(structure, name, node)) > math.cos(SMALLEST):
            return name
    return None


def _members(names: Iterable[str]) -> str:
    found = list(names)
    return f"Member{'' if len(found) == 1 else 's'} {listed(found, MOST_NAMED)}"
