"""Inputs in which nothing loads or moves the structure, so that all results are zero.

Nothing is refused for them.  What acts: an initial velocity or impulse of the run or of a stage, a load,
gravity, a driven support, and an obstacle that is driven or thrown; each only if it is not zero at some time
of the run, and not if it has no effect (`without_effect`).  Functions of time count from the start of each
stage, which may leave out obstacles and drives.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from typing import TypeVar

from crumple.function import TimeFunction
from crumple.structure.checks.obstacle_checks import prescribed
from crumple.structure.checks.unusual import Unusual
from crumple.structure.checks.without_effect import load_is_held, massless_nodes
from crumple.structure.keys.load import Load, NodalImpulse
from crumple.structure.keys.motion import InitialVelocity
from crumple.structure.keys.stages import Stage
from crumple.structure.parts import StructureParts

TEXT = (
    "Nothing loads or moves the structure, so that all results are zero: give an initial_velocity, impulses, "
    "loads, gravity, a support with a motion, or an obstacle with a velocity or motion. Values and functions "
    "of time that are zero during the whole run do not count."
)

Part = TypeVar("Part")


def nothing_acts(
    structure: StructureParts, duration: float, stages: Sequence[Stage] = ()
) -> Iterator[Unusual]:
    """One sentence if nothing acts on the structure.

    Parameters
    ----------
    structure
        Checked.
    duration
        Of the run [s].
    stages
        Of the run; empty for one dynamic stage.
    """
    during = [(stage.duration, stage.drive, stage.obstacles) for stage in stages] or [(duration, None, None)]
    acts = (
        any(structure.gravity)
        or _start_acts(structure, structure.initial_velocity, structure.impulses)
        or any(_start_acts(structure, stage.initial_velocity, stage.impulses) for stage in stages)
        or any(_acts_within(structure, *one) for one in during)
    )
    if not acts:
        yield Unusual("structure", 0.0, 0.0, "1", TEXT, "nothing_acts")


def _start_acts(
    structure: StructureParts, fields: Iterable[InitialVelocity], impulses: Iterable[NodalImpulse]
) -> bool:
    """Whether velocity fields or impulses set anything in motion."""
    return any(
        (any(field.translation) or field.rotation) and _moves_something(structure, field) for field in fields
    ) or any(any(one.impulse) or any(one.angular_impulse) for one in impulses)


def _moves_something(structure: StructureParts, field: InitialVelocity) -> bool:
    """Whether a field names members, a node with a mass, or neither, so that it moves everything."""
    nodes = field.nodes or ()
    return field.everywhere or bool(field.members) or len(massless_nodes(structure, field)) < len(nodes)


def _acts_within(
    structure: StructureParts,
    time: float,
    drive: Collection[str] | None,
    obstacles: Collection[str] | None,
) -> bool:
    """Whether loads, drives or obstacles act within a time [s]; `drive`, `obstacles`: as in a stage."""
    present = _named(structure.obstacles, obstacles)
    driven = _named(present, drive).values()
    acting = [load for load in structure.loads if not load_is_held(structure, load, time)]
    functions = [
        *(function for load in acting for function in _components(load)),
        *(one for part in _named(structure.supports, drive).values() for one in part.driven.values()),
        *(function for obstacle in driven for _, function in prescribed(obstacle)),
    ]
    return (
        any(any(obstacle.velocity) for obstacle in present.values() if obstacle.mass is not None)
        or any(any(obstacle.velocity) for obstacle in driven)
        or any(function.largest(0.0, time) > 0.0 for function in functions)
    )


def _named(parts: Mapping[str, Part], names: Collection[str] | None) -> dict[str, Part]:
    """Parts with these names; None: all."""
    return {name: part for name, part in parts.items() if names is None or name in names}


def _components(load: Load) -> Iterator[TimeFunction]:
    for part in (load.force, load.moment):
        yield from (function for function in (part.x, part.y, part.z) if function is not None)
