"""Variants in space that cannot go on, solved again in the ways of `SpatialSolver.run`."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from crumple._core.records import arrays_of
from crumple._core.spatial.batch import SpatialEndValues
from crumple.multibody.run import CANNOT_GO_ON
from crumple.multibody.spatial.case import SpatialCase
from crumple.numeric.arrays import Floats, Integers

Solve = Callable[[Mapping[str, Floats], Sequence[SpatialCase], Integers], SpatialEndValues]
"""Solution of variants from values, cases and the number of the case of each."""


@dataclass(frozen=True, eq=False)
class Repeats:
    """Variants that were solved, and how; n of them.

    Attributes
    ----------
    solve, values, cases, case_of
        How they are solved, and what was solved.
    ends
        Their end values, in which those of repeated ones are put.
    """

    solve: Solve
    values: Mapping[str, Floats]
    cases: Sequence[SpatialCase]
    case_of: Integers
    ends: SpatialEndValues

    def run(self, bound: float) -> None:
        """Repeat what cannot go on; what then fails again stays as it was.

        As in `SpatialSolver.run`: aside of dead centres from which several ways go on, and then, also where
        the energy residual is above its `bound`, with walls that crush under contacts.
        """
        several = np.array([bool(case.dead_centres.aside) for case in self.cases])[self.case_of]
        touched = np.array([case.touched for case in self.cases])[self.case_of]
        aside = _failed(self.ends) & several
        self._again(np.flatnonzero(aside), aside, crushing=False)
        lost = _failed(self.ends) | (self.ends.residual > bound)
        self._again(np.flatnonzero(lost & touched), aside, crushing=True)

    def _again(self, rows: Integers, aside: NDArray[np.bool_], *, crushing: bool) -> None:
        """Solve some of the variants again, and keep what does not fail."""
        if not rows.size:
            return
        changed = [(int(self.case_of[row]), bool(aside[row])) for row in rows]
        distinct = list(dict.fromkeys(changed))
        cases = [self.cases[number].again(aside=moved, crushing=crushing) for number, moved in distinct]
        case_of = np.array([distinct.index(key) for key in changed])
        new = self.solve({name: column[rows] for name, column in self.values.items()}, cases, case_of)
        good = np.flatnonzero(~_failed(new))
        for kept, found in zip(arrays_of(self.ends), arrays_of(new), strict=True):
            # samples have several rows of each variant
            shape = len(kept) // self.case_of.size, *kept.shape[1:]
            kept.reshape(-1, *shape)[rows[good]] = found.reshape(-1, *shape)[good]


def _failed(ends: SpatialEndValues) -> NDArray[np.bool_]:
    return np.isin(ends.outcome, list(CANNOT_GO_ON))
