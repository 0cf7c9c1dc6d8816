"""Loads and driven supports, sampled over time; the same for both kernels."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from crumple.multibody.bodies.linkage import GROUND
from crumple.multibody.bodies.sampled_functions import sampled, sampled_motion
from crumple.numeric.arrays import Floats
from crumple.structure import FREEDOMS, Structure
from crumple.structure.keys.motion import Freedom


@dataclass(frozen=True, eq=False)
class AppliedLoad:
    """A force or moment on a node along one global axis: body, freedom, times [s] and values [N, N m]."""

    node: str
    body: int
    freedom: Freedom
    times: Floats
    values: Floats


@dataclass(frozen=True, eq=False)
class DrivenFreedom:
    """A freedom of a support's node with prescribed motion: displacement and rate over time."""

    support: str
    node: str
    freedom: Freedom
    times: Floats
    values: Floats
    rates: Floats


def applied_loads(
    structure: Structure, node_body: Mapping[str, int], duration: float
) -> Iterator[AppliedLoad]:
    """Loads on nodes that can move: for every node forces, then moments."""
    for load in structure.loads:
        body = node_body[load.node]
        if body == GROUND:
            continue
        for freedom in FREEDOMS:
            function = getattr(load.moment if freedom.startswith("r") else load.force, freedom[-1])
            if function is not None:
                yield AppliedLoad(load.node, body, freedom, *sampled(function, duration))


def driven_freedoms(structure: Structure, duration: float) -> Iterator[DrivenFreedom]:
    """Driven freedoms of all supports, in the order of the supports."""
    for name, support in structure.supports.items():
        for freedom, function in support.driven.items():
            yield DrivenFreedom(name, support.node, freedom, *sampled_motion(function, duration))
