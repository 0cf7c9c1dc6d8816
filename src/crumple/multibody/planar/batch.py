"""Variants of a structure that the planar kernel solves."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from crumple._core.planar.batch import TreeFinals, TreeVariants, solve_many
from crumple.multibody.answer.end_values import final_quantities
from crumple.multibody.answer.solved import Poll
from crumple.multibody.kernel_choice import refuse_spatial
from crumple.multibody.planar.case import Lowered, RawMass, lowered, raw_mass, tree_arrays
from crumple.multibody.run import Run
from crumple.multibody.variants.factors import masses_of
from crumple.numeric.arrays import Floats
from crumple.structure import Structure, changed, value_at


class PlanarBatch:
    """See `Batch`."""

    def __init__(self, run: Run) -> None:
        self._run = run

    def lower(self, structure: Structure, *, moved: bool = False) -> Lowered:
        """See `Batch`."""
        if moved:
            refuse_spatial(structure, self._run)
        return lowered(structure, self._run.duration)

    def hinges(self, model: Lowered) -> list[str]:
        """See `Batch`."""
        return [name for name, _ in model.hinges]

    def solve(
        self,
        values: Mapping[str, Floats],
        models: Sequence[Lowered],
        model_of: NDArray[np.int64],
        threads: int,
        poll: Poll | None,
    ) -> TreeFinals:
        """See `Batch`."""
        settings = self._run.settings
        return solve_many(
            _variants(values, models, model_of),
            self._run.duration,
            settings.accuracy,
            settings.minimum_time_step,
            settings.maximum_time_step,
            threads,
            poll=poll,
        )

    def quantities(self, model: Lowered, finals: TreeFinals) -> dict[str, Floats]:
        """See `Batch`."""
        return final_quantities(model, finals, self._run.outputs)


def _variants(
    values: Mapping[str, Floats], models: Sequence[Lowered], model_of: NDArray[np.int64]
) -> TreeVariants:
    """The kernel's arrays: what each model has, with masses and factors."""
    count = model_of.size
    velocity = np.stack([model.start.velocity for model in models])[model_of]
    impulse = np.stack([model.start.impulse for model in models])[model_of]
    bodies = None
    masses = masses_of(values)
    if masses:
        raw = np.stack([raw_mass(model) for model in models])[model_of]
        for name, column in masses.items():
            steps = np.stack([_per_kilogram(model, name) for model in models])
            since = np.array([value_at(model.structure, name) for model in models])
            raw += (column - since[model_of])[:, None, None] * steps[model_of]
        bodies, velocity, impulse = tree_arrays(raw)
    velocity *= values.get("initial_velocity", np.ones(count))[:, None, None]
    impulse *= values.get("impulses", np.ones(count))[:, None, None]
    base = models[0]
    scale = np.ones((count, len(base.hinges)))
    for k, (name, _) in enumerate(base.hinges):
        scale[:, k] = values.get(f"hinges.{name}.capacity", 1.0)
    loads = np.ones((count, len(base.tree.loads))) * values.get("loads", np.ones(count))[:, None]
    gravity = np.stack([model.tree.gravity for model in models])[model_of]
    gravity = gravity * values.get("gravity", np.ones(count))[:, None]
    trees = [model.tree for model in models]
    return TreeVariants(trees, model_of, velocity, impulse, scale, loads, bodies, gravity)


def _per_kilogram(model: Lowered, name: str) -> RawMass:
    """What one more kilogram of a lump adds to mass, moments and momentum, which are linear in it."""
    since = value_at(model.structure, name)
    more = lowered(changed(model.structure, {name: since + 1.0}), 1.0)
    step: RawMass = raw_mass(more) - raw_mass(model)
    return step
