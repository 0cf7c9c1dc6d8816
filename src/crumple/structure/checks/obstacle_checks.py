"""Mistakes of obstacles and stages: names that do not exist, jumps, nodes that start inside a solid."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

import numpy as np

from crumple.errors import Problem
from crumple.function import TimeFunction
from crumple.structure.checks.start_checks import swallowed
from crumple.structure.keys.obstacles import Obstacle, gap
from crumple.structure.keys.stages import Stage, Until
from crumple.structure.parts import StructureParts
from crumple.structure.schema.problems import Names, unknown
from crumple.units import format_quantity

JUMP = 1e-12
"""Prescribed displacement [m] or rotation [rad] at the start that is still rounding."""
ALONG = np.linspace(0.0, 1.0, 201)
"""Places along a member at which its gap to an obstacle is checked, over the length."""
INSIDE = 1e-6
"""Depth [m] of a node in an obstacle that is still rounding."""

Defined = Mapping[str, Iterable[str]]


def obstacle_problems(structure: StructureParts, known: Mapping[str, Names]) -> Iterator[Problem]:
    """Members that do not exist, motions that start with a jump, nodes inside, names taken."""
    for name, obstacle in structure.obstacles.items():
        where = f"obstacles.{name}"
        for i, member in enumerate(obstacle.members or ()):
            yield from unknown("member", member, known["members"], f"{where}.members[{i}]")
        if name in known["supports"]:
            what, todo = f"a support and an obstacle are both called '{name}'", "rename one of them"
            yield Problem(what, name, "a name of its own", todo, where)
        for key, function in prescribed(obstacle):
            start = float(function(0.0))
            if abs(start) > JUMP:
                what, todo = "the prescribed motion starts with a jump", "let it start from 0"
                came = format_quantity(start, "rad" if key == "turning.angle" else "m")
                yield Problem(what, came, "0 at the start", todo, f"{where}.{key}")
        nodes = _touching_nodes(structure, obstacle)
        gaps = gap(obstacle, np.array([structure.nodes[node] for node in nodes], float).reshape(-1, 3))
        for i in np.flatnonzero(gaps < -INSIDE).tolist():
            what, todo = f"the node '{nodes[i]}' starts inside the obstacle", "move the node or the obstacle"
            yield Problem(what, f"{-1e3 * gaps[i]:.4g} mm deep", "outside it", todo, where)
        yield from _members_inside(structure, obstacle, dict(zip(nodes, gaps.tolist(), strict=True)), where)


def _members_inside(
    structure: StructureParts, obstacle: Obstacle, of_node: Mapping[str, float], where: str
) -> Iterator[Problem]:
    """Members whose line starts inside although their ends, whose gaps are given, do not."""
    for name in structure.members if obstacle.members is None else obstacle.members:
        if not structure.has_line(name):
            continue
        ends = structure.members[name].nodes
        first, second = (np.asarray(structure.nodes[node], float) for node in ends)
        # between two points the gap changes at most by their distance
        if sum(of_node[node] for node in ends) - float(np.linalg.norm(second - first)) >= -2.0 * INSIDE:
            continue
        gaps = gap(obstacle, first + ALONG[:, None] * (second - first))
        least = float(gaps.min())
        if min(gaps[0], gaps[-1]) >= -INSIDE > least:
            what, todo = f"the member '{name}' starts inside the obstacle", "move the member or the obstacle"
            yield Problem(what, f"{-1e3 * least:.4g} mm deep", "outside it", todo, where)


def stage_problems(
    stages: tuple[Stage, ...], structure: StructureParts, defined: Defined | None = None
) -> list[Problem]:
    """Every name in the stages that does not exist or is used twice.

    Parameters
    ----------
    stages
        In their order.
    structure
        Structure of the run.
    defined
        Names per kind that exist even if their parts are missing here.
    """

    def names(*kinds: str) -> Names:
        return Names(
            name for kind in kinds for name in (*getattr(structure, kind), *(defined or {}).get(kind, ()))
        )

    moving, nodes, obstacles = names("supports", "obstacles"), names("nodes"), names("obstacles")
    members = names("members")
    problems: list[Problem] = []
    for i, stage in enumerate(stages):
        where = f"analysis.stages[{i}]"
        if stage.name in [other.name for other in stages[:i]]:
            what = f"two stages are called '{stage.name}'"
            problems.append(Problem(what, stage.name, "a name of its own", "rename one", f"{where}.name"))
        problems += _thrown(stage, structure, where) if i == 0 else ()
        for j, name in enumerate(stage.drive or ()):
            problems += unknown("obstacle or support", name, moving, f"{where}.drive[{j}]")
            problems += _driven(name, structure, f"{where}.drive[{j}]")
        for j, name in enumerate(stage.obstacles or ()):
            problems += unknown("obstacle", name, obstacles, f"{where}.obstacles[{j}]")
        for j, until in enumerate(stage.until):
            problems += _until_problems(until, stage, structure, f"{where}.until[{j}]")
            if until.of is not None:
                problems += unknown("obstacle or support", until.of, moving, f"{where}.until[{j}].of")
            for k, node in enumerate(until.between or ()):
                problems += unknown("node", node, nodes, f"{where}.until[{j}].between[{k}]")
        problems += swallowed(structure, stage.impulses, stage.initial_velocity, f"{where}.")
        for j, struck in enumerate(stage.impulses):
            problems += unknown("node", struck.node, nodes, f"{where}.impulses[{j}].node")
        for j, field in enumerate(stage.initial_velocity):
            for k, node in enumerate(field.nodes or ()):
                problems += unknown("node", node, nodes, f"{where}.initial_velocity[{j}].nodes[{k}]")
            for k, member in enumerate(field.members or ()):
                place = f"{where}.initial_velocity[{j}].members[{k}]"
                problems += unknown("member", member, members, place)
        whole = set(moving) == {*structure.supports, *structure.obstacles}
        problems += _pushing(stage, structure, where) if i == 0 and whole and not problems else ()
    return problems


def _thrown(stage: Stage, structure: StructureParts, where: str) -> Iterator[Problem]:
    """Masses that would start with a velocity in a stage without inertia."""
    for name in structure.obstacles if stage.obstacles is None else stage.obstacles:
        obstacle = structure.obstacles.get(name)
        if stage.kind == "quasi-static" and obstacle is not None and obstacle.mass and any(obstacle.velocity):
            what = f"the obstacle '{name}' has a velocity, which a quasi-static stage does not support"
            todo = "make the stage dynamic, or remove the mass so that the obstacle is driven"
            yield Problem(what, name, "a driven obstacle, or a mass at rest", todo, f"{where}.kind")


def _driven(name: str, structure: StructureParts, where: str) -> Iterator[Problem]:
    """What a stage drives although it has no prescribed motion."""
    support, obstacle = structure.supports.get(name), structure.obstacles.get(name)
    kind, part = ("support", support) if support is not None else ("obstacle", obstacle)
    if part is None or part.driven:
        return
    if obstacle is not None and obstacle.mass is not None:
        what, todo = f"the obstacle '{name}' has a mass and is not driven", "remove its mass, or this name"
    else:
        what, todo = f"the {kind} '{name}' is not driven", "add 'motion' to it, or remove this name"
    yield Problem(what, name, "an obstacle or a support with a prescribed motion", todo, where)


def _pushing(stage: Stage, structure: StructureParts, where: str) -> Iterator[Problem]:
    """A first quasi-static stage in which nothing pushes; later ones may let elastic parts spring back."""
    if stage.kind == "dynamic" or structure.loads or any(structure.gravity):
        return
    parts = {**structure.supports, **structure.obstacles}
    if not any(part.driven for name, part in parts.items() if stage.drive is None or name in stage.drive):
        key = "kind" if stage.drive is None else "drive"
        came = stage.kind if stage.drive is None else f"[{', '.join(stage.drive)}]"
        what, todo = (
            "this quasi-static stage has no drive and no load",
            "drive an obstacle or a support, or add a load",
        )
        yield Problem(what, came, "a prescribed motion, a load or gravity", todo, f"{where}.{key}")


def _until_problems(until: Until, stage: Stage, structure: StructureParts, where: str) -> Iterator[Problem]:
    """Conditions that look at an obstacle that is not there or does not move."""
    there = structure.obstacles if stage.obstacles is None else stage.obstacles
    obstacle = structure.obstacles.get(until.of or "")
    if until.displacement is not None and obstacle is not None and not (obstacle.driven or obstacle.mass):
        what, todo = f"the obstacle '{until.of}' never moves", "add 'motion', 'velocity' or 'mass' to it"
        yield Problem(what, str(until.of), "an obstacle that moves", todo, f"{where}.of")
    if obstacle is not None and until.of not in there:
        what, todo = f"the obstacle '{until.of}' is not present in this stage", "add it to 'obstacles'"
        yield Problem(what, str(until.of), ", ".join(stage.obstacles or ()), todo, f"{where}.of")
    support = structure.supports.get(until.of or "")
    if support is not None and not support.driven:
        what, todo = f"the support '{until.of}' is not driven", "add 'motion' to it"
        yield Problem(what, str(until.of), "an obstacle or a driven support", todo, f"{where}.of")


def prescribed(obstacle: Obstacle) -> Iterator[tuple[str, TimeFunction]]:
    """Prescribed motion of an obstacle: keys with their functions of time, [m] or [rad] against [s]."""
    for axis in ("x", "y", "z"):
        function = getattr(obstacle.motion, axis)
        if function is not None:
            yield f"motion.{axis}", function
    if obstacle.turning is not None:
        yield "turning.angle", obstacle.turning.angle


def _touching_nodes(structure: StructureParts, obstacle: Obstacle) -> list[str]:
    """Nodes at the ends of the members that can touch an obstacle, in the structure's order."""
    members = structure.members if obstacle.members is None else obstacle.members
    ends = {node for name in members if name in structure.members for node in structure.members[name].nodes}
    return [node for node in structure.nodes if node in ends]
