"""The block `uncertainty` of an input: which of its numbers scatter, how, and who says so."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Annotated, Any

from pydantic import Field

from crumple.analysis.distribution import Distribution, numbers_of, unit_at
from crumple.errors import InputError, Problem
from crumple.structure import Structure, hinge_places, value_at
from crumple.structure.schema.problems import one_of
from crumple.structure.schema.spec import Named, Spec

MOST_VARIANTS = 100_000
"""Largest number of variants of one run."""
FACTORS = ("initial_velocity", "impulses", "loads", "gravity")
"""In addition: ``hinges.NAME.capacity``."""


class Scattering(Spec):
    """A number of the input that scatters."""

    path: str = ""
    """Path of the input, such as sections.tube.thickness, or a factor such as initial_velocity."""
    paths: tuple[str, ...] = ()
    """Several paths that get the same value."""
    distribution: Distribution
    """How it scatters."""
    source: Annotated[str, Field(min_length=1, max_length=300)]
    """Where the distribution is from, reported: a standard and tolerance, a measurement, an assumption."""

    @property
    def places(self) -> tuple[str, ...]:
        """All its paths."""
        return (*((self.path,) if self.path else ()), *self.paths)


class Uncertainty(Spec):
    """Scatter of the input, solved as variants of the run."""

    variables: Named[Scattering]
    """What scatters, by name; independent of each other."""
    rows: Annotated[int, Field(ge=2, le=MOST_VARIANTS)] = 200
    """Number of variants."""
    seed: Annotated[int, Field(ge=0, le=2**32 - 1)] = 1
    """Of the random numbers: the same seed gives the same variants."""


def in_si(
    given: Uncertainty | None, data: object, structure: Structure
) -> tuple[Uncertainty | None, list[Problem]]:
    """The block with all quantities in SI, and its mistakes.

    Parameters
    ----------
    given
        As written.
    data
        The file as written: quantities have the dimension that it has at their paths.
    structure
        Of the file.
    """
    if given is None:
        return None, []
    variables, problems = {}, []
    for name, one in given.variables.items():
        where = f"uncertainty.variables.{name}"
        wrong = list(_wrong_places(one, structure, where))
        if not wrong:
            try:
                units = {unit_at(data, place, f"{where}.path") or "1" for place in one.places}
                numbers: dict[str, Any] = numbers_of(one.distribution, min(units), f"{where}.distribution")
                distribution = one.distribution.model_copy(update=numbers)
                variables[name] = one.model_copy(update={"distribution": distribution})
            except InputError as error:
                wrong = error.problems
        problems += wrong
    if not given.variables:
        what = "no variable scatters"
        problems.append(Problem(what, "", "at least one", "add one", "uncertainty.variables"))
    if problems:
        return given, problems
    return given.model_copy(update={"variables": variables}), []


def _wrong_places(one: Scattering, structure: Structure, where: str) -> Iterator[Problem]:
    hinges = [f"hinges.{place.name}.capacity" for place in hinge_places(structure)]
    if not one.places:
        yield Problem("the path is missing", "", "a path of the input", "add 'path'", where)
    for place in one.places:
        if place in FACTORS or place in hinges:
            continue
        if "." not in place or place.startswith("hinges."):
            allowed = one_of([*FACTORS, *hinges])
            yield Problem("there is no such factor", place[:80], allowed, "correct it", f"{where}.path")
            continue
        try:
            value_at(structure, place)
        except InputError as error:
            yield replace(error.problems[0], where=f"{where}.path")
