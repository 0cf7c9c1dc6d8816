"""The study file, format 1: variables, responses, constraints, an objective and a method."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Annotated, Literal

from pydantic import Field, ValidationError

from crumple.analysis import LoadedInput, load_input
from crumple.analysis.distribution import Distribution, Value
from crumple.analysis.reading import read_file
from crumple.errors import InputError, Problem
from crumple.structure.schema.problems import Place, path_of, placed_problems, shown
from crumple.structure.schema.spec import Named, Spec, raise_all
from crumple.study.formula import Formula

MOST_ROWS = 1_000_000
"""Rows of one study."""
OPTIMISERS = ("optimise", "lightest")


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

    @property
    def response(self) -> str:
        """Its response."""
        return self.minimise or self.maximise

    @property
    def sign(self) -> float:
        """Factor that makes a small value the better one."""
        return -1.0 if self.maximise else 1.0


class Method(Spec):
    """How the points are chosen."""

    type: Literal[
        "points", "grid", "latin_hypercube", "sobol", "monte_carlo", "sobol_indices", "optimise", "lightest"
    ]
    """Kind of method."""
    file: str = ""
    """CSV file of points: a column per variable, in SI units (points)."""
    rows: Annotated[int, Field(ge=1, le=MOST_ROWS)] = 256
    """Number of points; of blocks (sobol_indices); the largest number of rows (optimise, lightest)."""
    seed: Annotated[int, Field(ge=0, le=2**32 - 1)] = 0
    """Of the random numbers: the same seed gives the same rows."""
    gradient: bool = False
    """Whether 'optimise' goes downhill from the base's values, with the derivatives of the kernels."""


class Verify(Spec):
    """Rows that are solved again by a slower model."""

    best: Annotated[int, Field(ge=0, le=1000)] = 3
    """Number of the best rows, by objective and constraints."""
    sample: Annotated[int, Field(ge=0, le=10_000)] = 20
    """Number of random rows, for errors and the rank correlation."""
    fidelity: Literal["multibody", "shell"] = "shell"
    """Solver, with its settings in the base."""
    reserve: Annotated[float, Field(ge=0.0, le=0.9)] = 0.0
    """Share by which the fast model must stay clear of each limit, which the slower one keeps as it is."""


class Study(Spec):
    """Many runs of one base input, and what is learnt from them."""

    crumple_study: Literal[1] = 1
    """Version of the format."""
    title: Annotated[str, Field(max_length=200)] = ""
    """One line for people."""
    base: str = ""
    """Input file that the study varies; relative to the study file."""
    bases: tuple[str, ...] = ()
    """Several input files in its place; a variable with the path 'base' chooses among their names."""
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
    objectives: tuple[Objective, ...] = ()
    """Several goals at once, in place of 'objective': the answer is the front of the best compromises."""
    method: Method
    """How the points are chosen."""
    verify: Verify | None = None
    """Whether the best rows and random ones are solved again by a slower model."""

    @property
    def goals(self) -> tuple[Objective, ...]:
        """All objectives, none, one or several."""
        return (self.objective,) if self.objective is not None else self.objectives


class StudyDocument:
    """Content of a study file, and the lines of its keys.

    Parameters
    ----------
    path
        YAML file.

    Attributes
    ----------
    places
        From the key that a refusal names to the key of the file.

    Raises
    ------
    InputError
        If it cannot be read, or is not a study file.
    """

    def __init__(self, path: Path) -> None:
        self.path, self._document = path, read_file(path)
        self.places: Callable[[str], str] = str
        data = self.data = self._document.data
        if not isinstance(data, dict) or data.get("crumple_study") != 1:
            version = data.get("crumple_study") if isinstance(data, dict) else data
            what, todo = "this is not a study file", "write 'crumple_study: 1' as the first line"
            came, allowed = shown(version), "crumple_study: 1"
            if version == "1":
                what, came, allowed = "the format version is a text", "'1'", "1 without quotes"
            raise InputError(Problem(what, came, allowed, todo, file=str(path), line=1))

    def refuse_unreadable(self) -> None:
        """Raise for mistakes of the text itself."""
        if self._document.problems:
            raise self.with_lines([])

    def with_lines(self, problems: list[tuple[Place, Problem]] | InputError) -> InputError:
        """Problems with the file and their lines."""
        if isinstance(problems, InputError):
            named = [replace(problem, where=self.places(problem.where)) for problem in problems.problems]
            problems = [(path_of(problem.where), problem) for problem in named]
        placed = [
            problem
            if problem.line or problem.file
            else replace(problem, file=str(self.path), line=self._document.line_of(place))
            for place, problem in problems
        ]
        return InputError([*self._document.problems, *placed])


LAYOUT = "base"
"""Path of the variable that chooses among several base inputs."""


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
        self.document = StudyDocument(path)
        try:
            self.study = Study.model_validate(self.document.data, context={"file": True})
        except ValidationError as error:
            raise self.document.with_lines(placed_problems(error, Study)) from None
        self.document.refuse_unreadable()
        names = (*((self.study.base,) if self.study.base else ()), *self.study.bases)
        if not names:
            what, todo = "the base input is missing", "write 'base: tube.yaml'"
            problem = Problem(what, "", "the name of an input file", todo, "base")
            raise self.document.with_lines([(("base",), problem)])
        self.bases = {Path(name).stem: load_input(path.parent / name) for name in names}
        self.base: LoadedInput = next(iter(self.bases.values()))
        self.study = self._with_layouts(len(names))

    def _with_layouts(self, count: int) -> Study:
        """The study with the names of its bases as values of the variable that chooses among them."""
        study, problems = self.study, []
        chosen = [name for name, variable in study.variables.items() if LAYOUT in variable.places]
        if len(self.bases) < count:
            problems.append(
                Problem("two bases have the same name", "", "", "rename one of the files", "bases")
            )
        if (count > 1 or chosen) and (count < 2 or len(chosen) != 1):
            what, todo = (
                "one variable chooses among several bases",
                "write 'layout: {path: base}' and 'bases'",
            )
            problems.append(Problem(what, ", ".join(chosen), "", todo, "bases" if count > 1 else "variables"))
        for name in chosen:
            unknown = [str(value) for value in study.variables[name].values if value not in self.bases]
            if unknown:
                what, where = "there is no such base", f"variables.{name}.values"
                problems.append(Problem(what, unknown[0][:60], ", ".join(self.bases), "name one", where))
        if count > 1 and (study.method.gradient or study.method.type == "lightest"):
            what, todo = "this method has one base", "use 'optimise' without gradient, or a target"
            problems.append(Problem(what, study.method.type, "", todo, "method"))
        if problems:
            raise self.document.with_lines(InputError(problems))
        names = {
            name: variable.model_copy(update={"values": variable.values or tuple(self.bases)})
            for name, variable in study.variables.items()
            if name in chosen
        }
        return study.model_copy(update={"variables": {**study.variables, **names}})

    @property
    def folder(self) -> Path:
        """Folder that file names in it are relative to."""
        return self.document.path.parent

    @contextmanager
    def lines(self) -> Iterator[None]:
        """Give refusals of a block the file and their lines."""
        try:
            yield
        except InputError as error:
            raise self.document.with_lines(error) from None


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
        elif kind == "lightest" and not variable.values:
            yield Problem("'lightest' needs values", "", "catalogue sizes", "add values", where)
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
        yield from _objective_problems(study, objective, "objective")
        if study.objectives:
            what, todo = "there are 'objective' and 'objectives'", "keep one of them"
            yield Problem(what, "", "one of the two", todo, "objectives")
    elif study.method.type in OPTIMISERS and not study.objectives:
        yield Problem("the objective is missing", "", "minimise or maximise", "add 'objective'", "method")
    for i, one in enumerate(study.objectives):
        yield from _objective_problems(study, one, f"objectives.{i}")
    names = [one.response for one in study.objectives]
    if len(names) == 1 or len(set(names)) < len(names):
        what, todo = "several objectives are several responses", "write one as 'objective'"
        yield Problem(what, ", ".join(names)[:60], "two or more different ones", todo, "objectives")
    if study.method.gradient and (
        study.method.type != "optimise" or study.objective is None or not study.base
    ):
        what, todo = "'gradient' is for 'optimise' with one objective", "leave it out"
        yield Problem(what, study.method.type, "", todo, "method.gradient")
    if study.objectives and study.method.type == "lightest":
        what, todo = "'lightest' has one objective, the mass", "write 'objective', or use 'optimise'"
        yield Problem(what, "", "", todo, "objectives")


def _objective_problems(study: Study, objective: Objective, where: str) -> Iterator[Problem]:
    if bool(objective.minimise) == bool(objective.maximise):
        yield Problem("an objective has one goal", "", "minimise or maximise", "keep one", where)
    elif objective.response not in study.responses:
        allowed = ", ".join(study.responses)
        yield Problem("there is no such response", objective.response[:60], allowed, "name one", where)
    elif study.method.type == "lightest" and not _is_mass(study, objective.minimise):
        what, todo = "'lightest' makes the mass small", "minimise a response with 'mass: true'"
        yield Problem(what, objective.response, "", todo, where)


def _is_mass(study: Study, name: str) -> bool:
    return name in study.responses and study.responses[name].mass
