"""Typed face of a run with derivatives of where it ends along directions in the space of parameters."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from crumple._core import _kernels
from crumple._core.planar.simulation import MINIMUM_STEP, Outcome, TreeModel, kernel_model
from crumple.numeric.arrays import Floats


@dataclass(frozen=True, eq=False)
class TreeDirection:
    """A parameter moved either way: models and motions at the start with it above and below its value.

    The curves of the hinges must have the same places in all three models.
    """

    up: TreeModel
    down: TreeModel
    velocity_up: Floats
    velocity_down: Floats
    impulse_up: Floats
    impulse_down: Floats
    width: float
    """Parameter above less parameter below."""


@dataclass(frozen=True, eq=False)
class TreeTangent:
    """Where a run ended, and the derivatives of that: row 0 the values, row 1 + k those along direction k.

    Attributes
    ----------
    q, w
        (1 + k, dofs).
    pose, velocity
        (1 + k, bodies, 3).
    hinge, summary
        (1 + k, hinges, 6) and (1 + k, hinges, 5), as in `TreeRecord`.
    energy
        (1 + k, 6).
    """

    q: Floats
    w: Floats
    pose: Floats
    velocity: Floats
    hinge: Floats
    summary: Floats
    energy: Floats
    time: float
    outcome: Outcome
    reason: str
    residual: float
    steps: int


def solve_tangent(
    model: TreeModel,
    velocity: Floats,
    impulse: Floats,
    directions: Sequence[TreeDirection],
    end: float,
    accuracy: float = 1e-3,
    *,
    minimum_step: float = MINIMUM_STEP,
    maximum_step: float = math.inf,
    poll: Callable[[float], bool] | None = None,
) -> TreeTangent:
    """Run a model to time ``end`` [s] in the very steps of a plain run, with derivatives along directions.

    Directions are taken a few at a time, each time with the whole run.
    """
    kernel = _kernels.planar.tangent
    parts = []
    for first in range(0, max(len(directions), 1), kernel.directions):
        some = directions[first : first + kernel.directions]
        out = kernel.solve(
            kernel_model(model, kernel.Model),
            [kernel_model(direction.up, kernel.Model) for direction in some],
            [kernel_model(direction.down, kernel.Model) for direction in some],
            [direction.width for direction in some],
            np.ascontiguousarray(velocity),
            _slopes([(d.velocity_up, d.velocity_down, d.width) for d in some], velocity.shape),
            np.ascontiguousarray(impulse),
            _slopes([(d.impulse_up, d.impulse_down, d.width) for d in some], impulse.shape),
            end,
            accuracy,
            minimum_step,
            maximum_step,
            poll,
        )
        parts.append(out)
    bodies, hinges = len(model.bodies), len(model.hinges)
    shapes = {"pose": (bodies, 3), "velocity": (bodies, 3), "hinge": (hinges, 6), "summary": (hinges, 5)}
    joined = {}
    for name in ("q", "w", "pose", "velocity", "hinge", "summary", "energy"):
        rows = np.concatenate([parts[0][name][:1], *(part[name][1:] for part in parts)])
        joined[name] = rows.reshape(len(rows), *shapes.get(name, (-1,)))
    last = parts[-1]
    return TreeTangent(
        **joined,
        time=last["time"],
        outcome=Outcome(last["outcome"]),
        reason=last["reason"],
        residual=last["residual"],
        steps=last["steps"],
    )


def _slopes(ends: Sequence[tuple[Floats, Floats, float]], shape: tuple[int, ...]) -> Floats:
    """Slopes of arrays along directions, (directions, *shape)."""
    slopes = [(up - down) / width for up, down, width in ends]
    return np.array(slopes).reshape(len(ends), *shape)
