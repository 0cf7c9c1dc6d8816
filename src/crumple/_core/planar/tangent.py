"""Typed interface of a run with derivatives of its final values along directions of the parameters."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from crumple._core import _kernels
from crumple._core.outcome import Outcome
from crumple._core.planar.batch import TreeEnds
from crumple._core.planar.simulation import MINIMUM_STEP, TreeModel, kernel_model
from crumple._core.records import named
from crumple.numeric.arrays import Floats


@dataclass(frozen=True, eq=False)
class TreeDirection:
    """A parameter changed in both directions: models and initial motions above and below its value.

    The curves of the hinges must have the same places in all three models.
    """

    up: TreeModel
    down: TreeModel
    velocity_up: Floats
    velocity_down: Floats
    impulse_up: Floats
    impulse_down: Floats
    width: float
    """Difference of the parameter's values above and below."""


@dataclass(frozen=True, eq=False)
class TreeTangent:
    """Final values of a run and their derivatives: row 0 the values, row 1 + k those along direction k.

    Attributes
    ----------
    ends
        Rows.
    time
        Reached [s].
    """

    ends: TreeEnds
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
    """Run a model to time ``end`` [s] in the same steps as a plain run, with derivatives along directions.

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
    last = parts[-1]
    return TreeTangent(
        TreeEnds(**named(_joined([part["ends"] for part in parts], len(model.bodies)))),
        time=last["time"],
        outcome=Outcome(last["outcome"]),
        reason=last["reason"],
        residual=last["residual"],
        steps=last["steps"],
    )


def _joined(parts: Sequence[dict[str, Any]], bodies: int) -> dict[str, Any]:
    """The values, then all derivatives, of answers that share their values: (..., 1 + directions, values)."""
    joined: dict[str, Any] = {}
    for name, first in parts[0].items():
        derivatives = [part[name][..., 1:, :] for part in parts]
        rows = np.concatenate([first[..., :1, :], *derivatives], axis=-2)
        joined[name] = rows.reshape(len(rows), bodies, 3) if name in ("pose", "velocity") else rows
    joined["energy"] = joined["energy"][..., 0]
    return joined


def _slopes(ends: Sequence[tuple[Floats, Floats, float]], shape: tuple[int, ...]) -> Floats:
    """Slopes of arrays along directions, (directions, *shape)."""
    slopes = [(up - down) / width for up, down, width in ends]
    return np.array(slopes).reshape(len(ends), *shape)
