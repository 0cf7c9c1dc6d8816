"""Hinges whose automatic law is of another type from one variant of an input to the next.

A law is chosen by section, material, and what is beside the fold: where a variant crosses a border of the
library, its hinges have a formula or an estimate from there on, and its answers jump by what these differ.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from crumple.analysis.analysis import Analysis
from crumple.errors import InputError
from crumple.numeric.arrays import Floats
from crumple.structure import Structure, changed, law_types_of, with_elastic_members
from crumple.text.names import listed

NO_HINGE = "no hinge"
"""In place of a type of law, where a variant does not have the hinge."""

Values = Mapping[str, float | str]
"""Values of a variant by path."""


@dataclass(frozen=True)
class LawChange:
    """Hinges whose laws change in the same way between the same variants.

    Attributes
    ----------
    hinges
        Their names.
    laws
        Types of their law on both sides.
    variants
        Numbers of the two variants closest to each other that have them.
    counts
        Numbers of variants that have them, of those that were looked at.
    """

    hinges: tuple[str, ...]
    laws: tuple[str, str]
    variants: tuple[int, int]
    counts: tuple[int, int]

    def sentence(self, kind: str, values: tuple[str, str]) -> str:
        """The change as a caution.

        Parameters
        ----------
        kind
            What a variant is called, such as ``row``.
        values
            Those of the two variants, as people write them.
        """
        several = len(self.hinges) > 1
        named = f"hinge{'s' if several else ''} {listed(self.hinges)}"
        law = f"laws of {named} change" if several else f"law of {named} changes"
        before, after = (
            f"{law} ({count} {kind}{'s' if count > 1 else ''})"
            for law, count in zip(self.laws, self.counts, strict=True)
        )
        first, second = (
            f"{kind} {number} ({told})" for number, told in zip(self.variants, values, strict=True)
        )
        todo = "results may jump there; a law that the input names is the same in all of them"
        return (
            f"caution: the {law} between {kind}s, from {before} to {after}; the closest are {first} and "
            f"{second}: {todo}"
        )


def as_solved(analysis: Analysis) -> Structure:
    """The structure whose variants are solved: its members are elastic or not in all of them."""
    return with_elastic_members(analysis.structure, analysis.multibody, analysis.time_in_motion)


def law_types_at(base: Structure, values: Values) -> dict[str, str] | None:
    """Types of the laws of all hinges of a variant, by name; None if it is refused."""
    try:
        return law_types_of(changed(base, dict(values)))
    except InputError:
        return None


def law_changes(
    types: Mapping[int, Mapping[str, str]],
    places: Mapping[int, Sequence[float]],
    alike: Mapping[int, int],
) -> list[LawChange]:
    """Where laws change between variants of one input.

    Parameters
    ----------
    types
        Types of the laws by hinge, by number of the variant.
    places
        Values of the variants, each over its range: they say which variants are close.
    alike
        How many variants each stands for.

    Returns
    -------
    list
        Of three types of a hinge's law the two closest changes between them.
    """
    numbers = list(types)
    points = np.array([places[number] for number in numbers], float).reshape(len(numbers), -1)
    columns: dict[tuple[str, ...], list[str]] = defaultdict(list)
    for name in dict.fromkeys(name for own in types.values() for name in own):
        columns[tuple(types[number].get(name, NO_HINGE) for number in numbers)].append(name)
    found = []
    for column, hinges in columns.items():
        count = dict.fromkeys(column, 0)
        for kind, number in zip(column, numbers, strict=True):
            count[kind] += alike[number]
        for pair in _changes(column, points):
            first, second = sorted(pair, key=lambda i: numbers[i])
            laws = column[first], column[second]
            ends = numbers[first], numbers[second]
            found.append(LawChange(tuple(hinges), laws, ends, (count[laws[0]], count[laws[1]])))
    return found


def _changes(column: tuple[str, ...], points: Floats) -> list[tuple[int, int]]:
    """The closest pairs of variants that connect all types of a column."""
    rows = {kind: np.flatnonzero([own == kind for own in column]) for kind in dict.fromkeys(column)}
    pairs = []
    for before, after in combinations(rows, 2):
        apart = np.abs(points[rows[before]][:, None, :] - points[rows[after]][None, :, :]).sum(axis=2)
        i, j = divmod(int(np.argmin(apart)), apart.shape[1])
        pairs.append((float(apart[i, j]), int(rows[before][i]), int(rows[after][j])))
    connected = {kind: {kind} for kind in rows}
    found = []
    for _, i, j in sorted(pairs):
        one, other = connected[column[i]], connected[column[j]]
        if one is not other:
            connected |= dict.fromkeys(one | other, one | other)
            found.append((i, j))
    return found
