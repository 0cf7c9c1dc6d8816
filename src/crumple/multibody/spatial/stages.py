"""Stages for the spatial kernel: the loads, drives and obstacles of each, and the conditions that end it."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np

from crumple._core.spatial.simulation import SpatialRecord, SpatialUntil
from crumple._core.spatial.simulation import Until as Quantity
from crumple.errors import InputError, Problem
from crumple.multibody.bodies.linkage import Linkage
from crumple.multibody.bodies.mobility import floating_members, named_members
from crumple.multibody.bodies.obstacles.bodies import Touching
from crumple.multibody.run import Run
from crumple.structure import FREEDOMS, Stage, Structure, Until
from crumple.text.names import listed
from crumple.units import format_quantity

Conditions = list[tuple[Until, SpatialUntil]]
"""Conditions of the input and of the kernel: a displacement ends a stage in either sense."""


SAMPLES = 1001
"""Number of times in a stage at which its loads are evaluated."""
PASSED = 1.1
"""Force at the end of a stage over the one that ended it, above which both are said."""
MOST_LOADS = 3
"""Largest number of loads in a sentence."""


def stages_of(structure: Structure, run: Run) -> tuple[Stage, ...]:
    """The run's stages, or one for the whole; the structure's motion at the start belongs to the first."""
    stages = run.stages or (Stage(name="run", duration=run.duration),)
    first = stages[0]
    if first.kind == "dynamic":
        added = {
            "initial_velocity": (*structure.initial_velocity, *first.initial_velocity),
            "impulses": (*structure.impulses, *first.impulses),
        }
        return (first.model_copy(update=added), *stages[1:])
    return stages


def refuse_floating(structure: Structure, linkage: Linkage, stages: tuple[Stage, ...]) -> None:
    """Refuse quasi-static stages in which a pushed part floats and has nothing to rest against.

    Without inertia a floating part needs two things that press on it: two obstacles, or an obstacle and a
    load, its weight or another member.
    """
    floating = floating_members(linkage)
    if not floating:
        return
    pressing = bool(structure.loads or any(structure.gravity)) + (structure.member_contact is not None)
    problems = []
    for i, stage in enumerate(stages):
        there = structure.obstacles if stage.obstacles is None else stage.obstacles
        if stage.kind == "quasi-static" and len(there) + pressing < 2:
            what = f"nothing supports {named_members(floating)} in a quasi-static stage"
            todo = "support a node, let it rest against an obstacle, or make the stage dynamic"
            problems.append(
                Problem(what, stage.name, "parts that are held", todo, f"analysis.stages[{i}].kind")
            )
    if problems:
        raise InputError(problems)


def kernel_conditions(structure: Structure, linkage: Linkage, touching: Touching, stage: Stage) -> Conditions:
    """Conditions of a stage, each in the form that the kernel evaluates."""
    return [
        (until, condition)
        for until in stage.until
        for condition in _conditions(structure, linkage, touching, until)
    ]


def end_reason(stage: Stage, conditions: Conditions, record: SpatialRecord, obstacles: Sequence[str]) -> str:
    """Reason for the end of a stage, as a sentence; `obstacles`: names in the order of the record."""
    if math.isfinite(record.lost_time):
        return f"loss of equilibrium at {format_quantity(record.lost_time, 's', 4)}"
    if record.ended_by < 0:
        return f"after {format_quantity(stage.duration, 's', 3)}"
    until = conditions[record.ended_by][0]
    unit = {"force": "N", "energy": "J", "displacement": "m", "distance": "m"}[until.quantity]
    of = f" of {until.of}" if until.of else ""
    between = f" between {until.between[0]} and {until.between[1]}" if until.between else ""
    asked = format_quantity(until.value, unit, 3)
    if until.quantity == "force" and until.of in obstacles:
        last = float(np.linalg.norm(record.obstacle_force[-1, obstacles.index(until.of)]))
        if last > PASSED * until.value:
            found = format_quantity(last, unit, 3)
            return f"force{of} passed {asked} within a step, at the end of which it is {found}"
    return f"{until.quantity}{of}{between} reached {asked}"


def lost_equilibrium(structure: Structure, stage: Stage, begin: float, lost: float) -> str:
    """Time and loads at which a quasi-static stage lost its equilibrium, as a sentence.

    Parameters
    ----------
    structure, stage
        The structure, and the stage in which equilibrium was lost.
    begin, lost
        When the stage began, and when its equilibrium ended [s].
    """
    grid, since = np.linspace(0.0, stage.duration, SAMPLES), lost - begin
    loads = []
    for load in structure.loads:
        for what, unit, parts in (("force", "N", load.force), ("moment", "N*m", load.moment)):
            for axis in "xyz":
                function = getattr(parts, axis)
                if function is None:
                    continue
                value, largest = float(function(np.array([since]))[0]), float(np.abs(function(grid)).max())
                if largest > 0.0:
                    factor = f"{abs(value) / largest:.4g} of the largest in the stage"
                    loads.append(f"{what} {axis} on {load.node} {format_quantity(value, unit, 4)}, {factor}")
    under = listed(loads, MOST_LOADS, "; ") or "gravity alone"
    return (
        f"Equilibrium ended {format_quantity(since, 's', 4)} into stage {stage.name} ({under}). Later "
        "results only show the direction; to follow the motion use a dynamic stage, or a drive for the load."
    )


def _conditions(
    structure: Structure, linkage: Linkage, touching: Touching, until: Until
) -> Iterator[SpatialUntil]:
    if until.quantity == "energy":
        yield SpatialUntil(Quantity.WORK, until.value)
    elif until.between is not None:
        first, second = until.between
        bodies = (linkage.node_body[first], linkage.node_body[second])
        points = np.array([structure.nodes[first], structure.nodes[second]], float)
        yield SpatialUntil(Quantity.DISTANCE, until.value, bodies=bodies, points=points)
    elif until.quantity == "force" and until.of in structure.obstacles:
        yield SpatialUntil(Quantity.FORCE, until.value, list(structure.obstacles).index(str(until.of)))
    else:
        joint, freedom = _driven(structure, linkage, touching, str(until.of))
        if until.quantity == "force":
            yield SpatialUntil(Quantity.DRIVE_FORCE, until.value, joint)
        else:
            yield from (
                SpatialUntil(Quantity.DISPLACEMENT, sense * until.value, joint, freedom)
                for sense in (1.0, -1.0)
            )


def _driven(structure: Structure, linkage: Linkage, touching: Touching, name: str) -> tuple[int, int]:
    """Joint and first driven freedom of a support or moving obstacle."""
    if name in structure.supports:
        joint = next(i for i, c in enumerate(linkage.connections) if c.kind == "support" and c.name == name)
        return joint, min(FREEDOMS.index(freedom) for freedom in structure.supports[name].driven)
    joint = touching.joint[name]
    drives = [drive.freedom for drive in touching.model.drives if drive.joint == joint]
    return joint, min(drives, default=0)
