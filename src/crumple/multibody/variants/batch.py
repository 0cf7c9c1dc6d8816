"""Solution of many variants of a structure in one call, for both kernels."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from crumple._core.planar import batch as planar_kernel
from crumple._core.planar.batch import TreeEndValues
from crumple._core.records import each_array
from crumple._core.spatial import batch as spatial_kernel
from crumple._core.spatial.batch import SpatialEndValues
from crumple._core.variants import Variants
from crumple.multibody.answer.end_values import OF_NODES, Ended, common_quantities, placed_quantities
from crumple.multibody.answer.solved import Poll
from crumple.multibody.kernel_choice import refuse_spatial
from crumple.multibody.planar.case import planar_case
from crumple.multibody.run import CHECK_FACTOR, Run
from crumple.multibody.spatial.case import spatial_case
from crumple.multibody.variants.factors import masses_of
from crumple.multibody.variants.repeats import Repeats
from crumple.numeric.arrays import Floats, Integers
from crumple.structure import Structure, changed, value_at

EndValues = TreeEndValues | SpatialEndValues


class Case(Ended, Protocol):
    """A structure in the form of one of the kernels."""

    @property
    def model(self) -> Any:
        """The kernel's model; it has `length`, `loads` and `gravity`."""

    @property
    def kernel_case(self) -> Any:
        """The kernel's own object for its batches."""

    @property
    def topology(self) -> tuple[object, ...]:
        """A description of the topology: equal for two cases that are variants of each other."""

    @property
    def velocity(self) -> Floats:
        """Motion that is added, at the centres of mass: (bodies, 3), or (stages, bodies, 6)."""

    @property
    def impulse(self) -> Floats:
        """Impulses, of the same shape."""

    @property
    def own_bodies(self) -> int:
        """Bodies that the factor on the initial velocity applies to; they come first."""

    @property
    def reference_points(self) -> Floats:
        """A fixed place of every body, about which `raw_mass` is taken."""

    @property
    def lumps(self) -> object:
        """Cases with equal ones have lumps at the same places with the same motion."""

    def moved_mass(self, raw: Floats, other: Any) -> Floats:
        """Raw mass of what has equal `lumps` in another case, about this one's reference points."""

    def raw_mass(self, about: Floats) -> Floats:
        """Mass, moments and momenta of every body about a fixed place, linear in masses, (bodies, k)."""

    @staticmethod
    def kernel_arrays(raw: Floats, about: Floats) -> tuple[Floats, Floats, Floats]:
        """Bodies, velocities and impulses as the kernel takes them, from raw masses of n variants."""


class Batch(ABC):
    """Many variants of a structure by one kernel.

    Parameters
    ----------
    run
        Duration, settings, stages and outputs.
    as_answer
        Take the steps of the answer of `solve_multibody`, at a quarter of the accuracy, so that a variant
        without changes has its bits; else those of its run that estimates the error.
    guided
        In space, all but the first take the lengths of its steps and the starts of their solution, as the
        runs of a mechanism check do; errors of elastic members are those of its steps then.
    """

    def __init__(self, run: Run, *, as_answer: bool = False, guided: bool = False) -> None:
        self.run, self.as_answer, self.guided = run, as_answer, guided
        self.accuracy = run.settings.accuracy / (CHECK_FACTOR if as_answer else 1.0)
        self.parts = 2 if as_answer else 1

    @abstractmethod
    def case(self, structure: Structure, *, moved: bool = False) -> Case:
        """Lower a structure; `moved`: its nodes are not at the places of the original structure's."""

    @abstractmethod
    def solve_many(
        self, variants: Variants[Any], threads: int, poll: Poll | None, led: bool, times: Sequence[float]
    ) -> EndValues:
        """Call the kernel."""

    def solve(
        self,
        values: Mapping[str, Floats],
        cases: Sequence[Case],
        case_of: Integers,
        threads: int,
        poll: Poll | None,
        *,
        led: bool = False,
        times: Sequence[float] = (),
    ) -> EndValues:
        """Solve variants, (n,), with `values` of the quick parameters, each with one of the cases.

        `led`: all but the first follow the first one's steps, see the spatial kernel's `solve_many`.
        `times`: states at these are kept too.
        """

        def again(values: Mapping[str, Floats], cases: Sequence[Case], case_of: Integers) -> EndValues:
            return self.solve_many(self._variants(values, cases, case_of), threads, poll, led, times)

        ends = again(values, cases, case_of)
        if not led:
            self.repeat(again, values, cases, case_of, ends)
        return ends

    @abstractmethod
    def repeat(
        self, again: Any, values: Mapping[str, Floats], cases: Any, case_of: Integers, ends: Any
    ) -> None:
        """Solve those by `again` that cannot go on and can be repeated, and put their values in `ends`."""

    def quantities(
        self,
        cases: Sequence[Case],
        case_of: NDArray[np.int64],
        ends: EndValues,
        of_nodes: Sequence[str] = OF_NODES,
    ) -> dict[str, Floats]:
        """Named quantities of variants, (n,) each; `of_nodes`: which motions of nodes are among them."""
        outputs = self.run.outputs
        # the values of a failed run have no meaning
        with np.errstate(all="ignore"):
            found = {name: values.copy() for name, values in common_quantities(cases[0], ends).items()}
            if not placed_quantities(cases[0], part_of(ends, np.arange(1)), outputs):
                return found | {"energy_residual": ends.residual.copy()}
            order = np.argsort(case_of, kind="stable")
            bounds = np.searchsorted(case_of[order], np.arange(len(cases) + 1))
            for i, case in enumerate(cases):
                rows = order[bounds[i] : bounds[i + 1]]
                if rows.size:
                    placed = placed_quantities(case, part_of(ends, rows), outputs, of_nodes)
                    for name, column in placed.items():
                        found.setdefault(name, np.zeros(case_of.size))[rows] = column
        return found | {"energy_residual": ends.residual.copy()}

    def _variants(
        self, values: Mapping[str, Floats], cases: Sequence[Case], case_of: Integers
    ) -> Variants[Any]:
        """The kernel's arrays: those of each variant's case, with masses and factors applied."""
        count, base = case_of.size, cases[0]
        one = np.ones(count)
        velocity = np.stack([case.velocity for case in cases])[case_of]
        impulse = np.stack([case.impulse for case in cases])[case_of]
        bodies = None
        masses = masses_of(values)
        if masses:
            about = np.stack([case.reference_points for case in cases])
            raw = np.stack([case.raw_mass(case.reference_points) for case in cases])[case_of]
            for name, column in masses.items():
                steps = self._per_kilogram(cases, name)
                since = np.array([value_at(case.structure, name) for case in cases])
                raw += (column - since[case_of])[:, None, None] * steps[case_of]
            bodies, velocity, impulse = base.kernel_arrays(raw, about[case_of])
        velocity[..., : base.own_bodies, :] *= _along(values.get("initial_velocity", one), velocity.ndim)
        impulse *= _along(values.get("impulses", one), impulse.ndim)
        scale = np.ones((count, len(base.model.hinges)))
        for k, recorded in enumerate(base.hinges):
            scale[:, k] = values.get(f"hinges.{recorded.hinge.name}.capacity", 1.0)
        loads = np.ones((count, len(base.model.loads))) * values.get("loads", one)[:, None]
        gravity = np.array([case.model.gravity for case in cases])[case_of]
        gravity = gravity * values.get("gravity", one)[:, None]
        kernel_cases = [case.kernel_case for case in cases]
        return Variants(kernel_cases, case_of, velocity, impulse, scale, loads, bodies, gravity)

    def _per_kilogram(self, cases: Sequence[Case], name: str) -> Floats:
        """Mass, moments and momentum that one more kilogram of a lump adds; these are linear in it."""
        known: dict[object, tuple[Floats, Case]] = {}
        found = []
        for case in cases:
            key = case.lumps
            if key not in known:
                more = self.case(changed(case.structure, {name: value_at(case.structure, name) + 1.0}))
                step = more.raw_mass(case.reference_points) - case.raw_mass(case.reference_points)
                known[key] = step, case
            found.append(case.moved_mass(*known[key]))
        return np.stack(found)


class PlanarBatch(Batch):
    """Batches of the planar kernel."""

    def case(self, structure: Structure, *, moved: bool = False) -> Case:
        """See `Batch`."""
        if moved:
            refuse_spatial(structure, self.run)
        return planar_case(structure, self.run)

    def solve_many(
        self, variants: Variants[Any], threads: int, poll: Poll | None, led: bool, times: Sequence[float]
    ) -> EndValues:
        """See `Batch`; it has exact derivatives in place of followers."""
        settings, end = self.run.settings, self.run.duration
        bounds = settings.minimum_time_step, settings.maximum_time_step
        return planar_kernel.solve_many(
            variants, end, self.accuracy, *bounds, threads, poll=poll, times=times, parts=self.parts
        )

    def repeat(
        self, again: Any, values: Mapping[str, Floats], cases: Any, case_of: Integers, ends: Any
    ) -> None:
        """See `Batch`; in a plane nothing is."""


class SpatialBatch(Batch):
    """Batches of the spatial kernel."""

    def case(self, structure: Structure, *, moved: bool = False) -> Case:
        """See `Batch`; a structure that lies in a plane can still move in space."""
        return spatial_case(structure, self.run)

    def solve_many(
        self, variants: Variants[Any], threads: int, poll: Poll | None, led: bool, times: Sequence[float]
    ) -> EndValues:
        """See `Batch`."""
        settings = self.run.settings
        longest = settings.maximum_time_step
        if self.as_answer and any(stage.kind == "quasi-static" for stage in self.run.stages):
            longest = min(longest, self.run.every / 2)
        bounds, parts = (settings.minimum_time_step, longest), self.parts
        return spatial_kernel.solve_many(
            variants,
            self.accuracy,
            *bounds,
            threads,
            poll=poll,
            led=led,
            times=times,
            parts=parts,
            guided=self.guided,
        )

    def repeat(
        self, again: Any, values: Mapping[str, Floats], cases: Any, case_of: Integers, ends: Any
    ) -> None:
        """See `Batch`; as `SpatialSolver.run` does."""
        Repeats(again, values, cases, case_of, ends).run(self.run.settings.energy_residual_bound)


def part_of(ends: EndValues, rows: NDArray[np.int64]) -> EndValues:
    """Some of the rows."""
    return each_array(ends, lambda column: column[rows])


def samples_of(ends: EndValues, count: int) -> EndValues:
    """The samples of runs at so many times as if each were the end of a run, (n count) rows."""
    repeated = each_array(ends, lambda column: np.repeat(column, count, axis=0))
    return replace(repeated, **ends.samples, samples={})


def hinge_names(case: Case) -> list[str]:
    """Names of the hinges in the kernel's order."""
    return [recorded.hinge.name for recorded in case.hinges]


def _along(factor: Floats, dimensions: int) -> Floats:
    """One factor per variant, for arrays whose rows are variants."""
    return factor.reshape(-1, *[1] * (dimensions - 1))
