"""The study file, format 1: variables, responses, constraints, an objective and a method."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Annotated, Literal

from pydantic import Field, ValidationError

from crumple.analysis import LoadedInput, load_input
from crumple.analysis.reading import read_file
from crumple.errors import InputError, Problem
from crumple.structure.schema.problems import Place, path_of, placed_problems, shown
from crumple.structure.schema.spec import Named, Spec, raise_all
from crumple.study.formula import Formula

MOST_ROWS = 1_000_000
"""Rows of one study."""
Value = float | str
"""A number, or a text: a quantity with its unit, or a name."""
OPTIMISERS = ("optimise",)


class Distribution(Spec):
    """How a variable scatters."""

    type: Literal["normal", "lognormal", "uniform", "table"]
    """Kind of distribution."""
    mean: Value | None = None
    """Mean (normal, lognormal)."""
    deviation: Value | None = None
    """Standard deviation (normal, lognormal)."""
    low: Value | None = None
    """Smallest value (uniform)."""
    high: Value | None = None
    """Largest value (uniform)."""
    values: tuple[Value, ...] = ()
    """Values of a table, increasing; between them the probability is interpolated."""
    cumulative: tuple[float, ...] = ()
    """Probability of being below each value of the table, from 0 to 1."""


class Variable(Spec):
    """A quantity of the input that a study varies."""

    path: str = ""
    """Path of the input, such as sections.tube.thickness, or a factor such as initial_velocity."""
    paths: tuple[str, ...] = ()
    """Several paths that get the same value."""
    low: Value | None = None
    """Smallest value."""
    high: Value | None = None
    """Largest value."""
    steps: Annotated[int, Field(ge=1, le=10_000)] | None = None
    """Number of values of a grid from low to high."""
    values: tuple[Value, ...] = ()
    """The only values: catalogue sizes, or names of sections or materials."""
    integer: bool = False
    """Whether only whole numbers are used."""
    distribution: Distribution | None = None
    """How it scatters, for monte_carlo and sobol_indices."""

    @property
    def places(self) -> tuple[str, ...]:
        """All its paths."""
        return (*((self.path,) if self.path else ()), *self.paths)


class Response(Spec):
    """A number that each row reports."""

    channel: str = ""
    """Name of a channel of the result, such as hinge.root.rotation."""
    take: Literal["final", "max", "at"] = "final"
    """Its last value, its value of largest magnitude with sign, or its value at a time."""
    time: Value | None = None
    """For 'at'."""
    mass: bool = False
    """Whether it is the mass of all members."""
    formula: str = ""
    """Arithmetic on variables and earlier responses in SI units."""


class Constraint(Spec):
    """A limit of a response."""

    response: str
    """Name of a response."""
    at_most: Value | None = None
    """Largest permitted value."""
    at_least: Value | None = None
    """Smallest permitted value."""


class Objective(Spec):
    """What an optimisation seeks."""

    minimise: str = ""
    """Response to make small."""
    maximise: str = ""
    """Response to make large."""


class Method(Spec):
    """How the points are chosen."""

    type: Literal["points", "grid", "latin_hypercube", "sobol", "monte_carlo", "sobol_indices", "optimise"]
    """Kind of method."""
    file: str = ""
    """CSV file of points: a column per variable, in SI units (points)."""
    rows: Annotated[int, Field(ge=1, le=MOST_ROWS)] = 256
    """Number of points; of blocks (sobol_indices); the largest number of rows (optimise)."""
    seed: Annotated[int, Field(ge=0, le=2**32 - 1)] = 0
    """Of the random numbers: the same seed gives the same rows."""


class Study(Spec):
    """Many runs of one base input, and what is learnt from them."""

    crumple_study: Literal[1] = 1
    """Version of the format."""
    title: Annotated[str, Field(max_length=200)] = ""
    """One line for people."""
    base: str = ""
    """Input file that the study varies; relative to the study file."""
    fidelity: Literal["multibody", "shell"] = "multibody"
    """Solver of the rows."""
    variables: Named[Variable]
    """What varies."""
    responses: Named[Response]
    """What each row reports."""
    constraints: tuple[Constraint, ...] = ()
    """Limits of responses."""
    objective: Objective | None = None
    """What an optimisation seeks."""
    method: Method
    """How the points are chosen."""


class LoadedStudy:
    """A study file with its base input.

    Parameters
    ----------
    path
        YAML file.

    Raises
    ------
    InputError
        With every mistake, each with file and line.
    """

    def __init__(self, path: Path) -> None:
        self.path, self._document = path, read_file(path)
        data = self._document.data
        if not isinstance(data, dict) or data.get("crumple_study") != 1:
            version = data.get("crumple_study") if isinstance(data, dict) else data
            what, todo = "this is not a study file", "write 'crumple_study: 1' as the first line"
            raise InputError(Problem(what, shown(version), "crumple_study: 1", todo, file=str(path), line=1))
        try:
            self.study = Study.model_validate(data, context={"file": True})
        except ValidationError as error:
            raise self.with_lines(placed_problems(error, Study)) from None
        if self._document.problems:
            raise self.with_lines([])
        if not self.study.base:
            what, todo = "the base input is missing", "write 'base: tube.yaml'"
            raise self.with_lines([(("base",), Problem(what, "", "the name of an input file", todo, "base"))])
        self.base: LoadedInput = load_input(path.parent / self.study.base)

    @property
    def folder(self) -> Path:
        """Folder that file names in it are relative to."""
        return self.path.parent

    @contextmanager
    def lines(self) -> Iterator[None]:
        """Give refusals of a block the file and their lines."""
        try:
            yield
        except InputError as error:
            raise self.with_lines(error) from None

    def with_lines(self, problems: list[tuple[Place, Problem]] | InputError) -> InputError:
        """Problems with the file and their lines."""
        if isinstance(problems, InputError):
            problems = [(path_of(problem.where), problem) for problem in problems.problems]
        placed = [
            problem
            if problem.line or problem.file
            else replace(problem, file=str(self.path), line=self._document.line_of(place))
            for place, problem in problems
        ]
        return InputError([*self._document.problems, *placed])


def refuse_contradictions(study: Study) -> None:
    """Refuse names that are used twice or do not exist, and keys that do not go together.

    Raises
    ------
    InputError
        With every mistake.
    """
    raise_all([*_variable_problems(study), *_response_problems(study), *_goal_problems(study)])


def _variable_problems(study: Study) -> Iterator[Problem]:
    kind = study.method.type
    if not study.variables:
        yield Problem("no variable is given", "", "at least one", "add one", "variables")
    for name, variable in study.variables.items():
        where = f"variables.{name}"
        scatters = variable.distribution is not None
        bounded = variable.low is not None and variable.high is not None
        if study.base and not variable.places:
            yield Problem("the path is missing", "", "a path of the input", "add 'path'", where)
        alike = [other for other in (*study.variables, *study.responses) if other.lower() == name.lower()]
        if len(alike) > 1:
            yield Problem("two variables or responses have this name", name, "", "choose another name", where)
        if kind == "monte_carlo" and not scatters and not (bounded or variable.values):
            yield Problem("the distribution is missing", "", "", "add 'distribution', or low and high", where)
        elif kind != "points" and not (scatters or bounded or variable.values):
            yield Problem("the range is missing", "", "", "add low and high, or values", where)
        elif kind in {"grid", "optimise"} and not (bounded or variable.values):
            yield Problem(f"'{kind}' needs a range", "", "", "add low and high, or values", where)
        elif kind == "grid" and not variable.values and variable.steps is None:
            yield Problem("the number of grid values is missing", "", "", "add 'steps', or values", where)


def _response_problems(study: Study) -> Iterator[Problem]:
    known = set(study.variables)
    if not study.responses:
        yield Problem("no response is given", "", "at least one", "add one", "responses")
    for name, response in study.responses.items():
        where = f"responses.{name}"
        given = [bool(response.channel), response.mass, bool(response.formula)]
        if study.base and sum(given) != 1:
            allowed = "one of channel, mass and formula"
            yield Problem("a response is one of three things", "", allowed, "keep one of them", where)
        if (response.take == "at") != (response.time is not None):
            yield Problem("'take: at' and 'time' belong together", "", "", "give both or none", where)
        if response.formula:
            try:
                unknown = sorted(Formula(response.formula).names - known)
            except InputError as error:
                yield replace(error.problems[0], where=f"{where}.formula")
            else:
                if unknown:
                    what, todo = "the formula has an unknown name", "name variables or earlier responses"
                    yield Problem(what, unknown[0], ", ".join(sorted(known)), todo, f"{where}.formula")
        known.add(name)


def _goal_problems(study: Study) -> Iterator[Problem]:
    allowed, objective = ", ".join(study.responses), study.objective
    for i, limit in enumerate(study.constraints):
        if limit.response not in study.responses:
            what = "there is no such response"
            yield Problem(what, limit.response[:60], allowed, "name one", f"constraints.{i}.response")
        if limit.at_most is None and limit.at_least is None:
            what = "the limit is missing"
            yield Problem(what, "", "at_most, at_least", "add one", f"constraints.{i}")
    if objective is not None:
        if bool(objective.minimise) == bool(objective.maximise):
            yield Problem("an objective has one goal", "", "minimise or maximise", "keep one", "objective")
        elif (objective.minimise or objective.maximise) not in study.responses:
            came = (objective.minimise or objective.maximise)[:60]
            yield Problem("there is no such response", came, allowed, "name one", "objective")
    elif study.method.type in OPTIMISERS:
        yield Problem("the objective is missing", "", "minimise or maximise", "add 'objective'", "method")
