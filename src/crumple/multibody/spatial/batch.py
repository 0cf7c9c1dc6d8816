"""Variants of a structure that the spatial kernel solves."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from crumple._core.spatial.batch import SpaceFinals, SpaceVariants, solve_many
from crumple.multibody.answer.solved import Poll
from crumple.multibody.run import Run
from crumple.multibody.spatial.case import SpaceLowered, lowered_in_space, space_arrays, space_raw_mass
from crumple.multibody.spatial.end_values import space_quantities
from crumple.multibody.variants.factors import masses_of
from crumple.numeric.arrays import Floats
from crumple.structure import Structure, changed, value_at


class SpaceBatch:
    """See `Batch`."""

    def __init__(self, run: Run) -> None:
        self._run = run

    def lower(self, structure: Structure, *, moved: bool = False) -> SpaceLowered:
        """See `Batch`; what lies in a plane moves in space all the same."""
        return lowered_in_space(structure, self._run)

    def hinges(self, model: SpaceLowered) -> list[str]:
        """See `Batch`."""
        return model.hinges

    def solve(
        self,
        values: Mapping[str, Floats],
        models: Sequence[SpaceLowered],
        model_of: NDArray[np.int64],
        threads: int,
        poll: Poll | None,
        *,
        led: bool = False,
    ) -> SpaceFinals:
        """See `Batch`; `led` as of the kernel's `solve_many`."""
        settings = self._run.settings
        return solve_many(
            self._variants(values, models, model_of),
            settings.accuracy,
            settings.minimum_time_step,
            settings.maximum_time_step,
            threads,
            poll=poll,
            led=led,
        )

    def quantities(self, model: SpaceLowered, finals: SpaceFinals) -> dict[str, Floats]:
        """See `Batch`."""
        return space_quantities(model, finals, self._run.outputs)

    def _variants(
        self, values: Mapping[str, Floats], models: Sequence[SpaceLowered], model_of: NDArray[np.int64]
    ) -> SpaceVariants:
        """The kernel's arrays: what each model has, with masses and factors."""
        count, base = model_of.size, models[0]
        one = np.ones(count)
        velocity = np.stack([model.velocity for model in models])[model_of]
        impulse = np.stack([model.impulse for model in models])[model_of]
        bodies = None
        masses = masses_of(values)
        if masses:
            about = np.stack([_centres(model) for model in models])
            raw = np.stack([space_raw_mass(model, _centres(model)) for model in models])[model_of]
            for name, column in masses.items():
                steps = np.stack([self._per_kilogram(model, name) for model in models])
                since = np.array([value_at(model.structure, name) for model in models])
                raw += (column - since[model_of])[:, None, None] * steps[model_of]
            bodies, velocity, impulse = space_arrays(raw, about[model_of])
        # thrown obstacles have a velocity of their own
        own = len(base.linkage.bodies)
        velocity[:, :, :own] *= values.get("initial_velocity", one)[:, None, None, None]
        impulse *= values.get("impulses", one)[:, None, None, None]
        scale = np.ones((count, len(base.hinges)))
        for k, name in enumerate(base.hinges):
            scale[:, k] = values.get(f"hinges.{name}.capacity", 1.0)
        loads = np.ones((count, len(base.model.loads))) * values.get("loads", one)[:, None]
        gravity = np.array([model.model.gravity for model in models])[model_of]
        gravity = gravity * values.get("gravity", one)[:, None]
        cases = [model.case for model in models]
        return SpaceVariants(cases, model_of, velocity, impulse, scale, loads, bodies, gravity)

    def _per_kilogram(self, model: SpaceLowered, name: str) -> Floats:
        """What one more kilogram of a lump adds to mass, moments and momentum, which are linear in it."""
        since = value_at(model.structure, name)
        more = lowered_in_space(changed(model.structure, {name: since + 1.0}), self._run)
        about = _centres(model)
        step: Floats = space_raw_mass(more, about) - space_raw_mass(model, about)
        return step


def _centres(model: SpaceLowered) -> Floats:
    return np.array([body.centre for body in model.model.bodies], float)
