"""The input file, format 1: every mistake at once, with its line."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Literal

from pydantic import BaseModel, ValidationError

from crumple.analysis.analysis import DEFAULT_INTERVALS, Analysis, Settings, Title, run_problems
from crumple.analysis.criteria import Criterion, criteria_in_si
from crumple.analysis.filters import filter_problems
from crumple.analysis.reading import Document, read_file, read_text
from crumple.analysis.solve import solved_alone
from crumple.analysis.uncertainty import Uncertainty, in_si
from crumple.errors import InputError, Problem
from crumple.portable import command_line
from crumple.structure import (
    Outputs,
    StoredLaws,
    Structure,
    hinge_places,
    history_problems,
    output_problems,
    problems_in,
    shell_problems,
    stage_problems,
    time_in_motion,
    with_elastic_members,
    with_used_laws,
)
from crumple.structure.parts import StructureParts
from crumple.structure.schema.mapping import frozen
from crumple.structure.schema.problems import Place, path_of, placed_problems, shown
from crumple.structure.schema.spec import Named

FORMAT = 1
"""Version of the format; a file with another version is refused."""
MOST_PROBLEMS = 100
"""Largest number of problems in one error message."""


class InputFile(StructureParts):
    """Keys of an input file: those of the structure, and the run."""

    crumple: Literal[1]
    """Version of the format."""
    title: Title = ""
    """One line for people."""
    analysis: Settings
    """What to do."""
    outputs: Outputs = Outputs()
    """What to report."""
    criteria: Named[Criterion] = frozen({})
    """Limits that the structure shall keep, by name."""
    uncertainty: Uncertainty | None = None
    """Which numbers scatter: `crumple run` solves variants and reports how the result scatters."""


_OF_THE_RUN = set(InputFile.model_fields) - set(StructureParts.model_fields)
"""Keys whose mistakes do not affect the structure."""


@dataclass(frozen=True)
class LoadedInput:
    """An input file as it was when it was read: this is solved and shown, even if the file changes.

    Attributes
    ----------
    analysis
        Complete: no file is needed any more.
    path
        Of the file.
    document
        Its text, and the line of every key.
    """

    analysis: Analysis
    path: Path
    document: Document

    def with_lines(self, error: InputError) -> InputError:
        """A solver's refusal of the analysis with the lines of the file."""
        structure = self.analysis.structure
        problems = [_where_written(problem, structure) for problem in error.problems]
        placed = [(path_of(problem.where), problem) for problem in problems]
        return InputError(_placed(placed, self.document, str(self.path)))

    def with_laws(self, store: Path) -> LoadedInput:
        """The input with the laws of a store, a folder or a file, in place of those it names.

        Raises
        ------
        InputError
            If there is no such store, or one of its laws cannot be read.
        """
        structure = self.analysis.structure.model_copy(update={"laws": StoredLaws.read(store)})
        analysis = self.analysis.model_copy(update={"structure": with_used_laws(structure)})
        return replace(self, analysis=analysis)

    def refusals(self, fidelity: str = "multibody") -> list[Problem]:
        """What a solver refuses of the analysis; it starts, but takes no step beyond the first."""
        begun: list[float] = []
        try:
            solved_alone(self.analysis, fidelity, progress=begun.append, cancel=lambda: bool(begun))
        except InputError as error:
            return self.with_lines(error).problems
        return []


def load(path: str | Path) -> Analysis:
    """Analysis that an input file describes.

    Parameters
    ----------
    path
        YAML file; paths of curve files are relative to it.

    Returns
    -------
    Analysis
        Complete: no further file is needed.

    Raises
    ------
    InputError
        With every mistake, each with file and line.
    """
    return load_input(path).analysis


def load_input(path: str | Path) -> LoadedInput:
    """Like `load`, with the text of the file."""
    path = Path(path)
    return _loaded(read_file(path), path)


def load_text(text: str, path: str | Path) -> LoadedInput:
    """Like `load_input` of a file with this content, which need not be there; it names no file elsewhere."""
    path = Path(path)
    return _loaded(read_text(text, str(path)), path)


def _loaded(document: Document, path: Path) -> LoadedInput:
    return LoadedInput(_analysis(document, str(path), path.parent), path, document)


def loads(text: str, *, file: str = "", directory: str | Path = ".") -> Analysis:
    """Analysis that a text describes; like `load` of a file with this content in ``directory``."""
    return _analysis(read_text(text, file), file, Path(directory))


def check(path: str | Path, fidelity: str = "multibody") -> list[Problem]:
    """Every mistake of an input file; empty if the solver accepts it.

    Parameters
    ----------
    path
        YAML file.
    fidelity
        Solver that checks the input; it starts, but stops after its first step.
    """
    try:
        return load_input(path).refusals(fidelity)
    except InputError as error:
        return error.problems


def _where_written(problem: Problem, structure: Structure) -> Problem:
    """Problem of a hinge, which a solver knows by name, with the path of the hinge in the input."""
    kind, _, name = problem.where.partition(".")
    if kind != "hinges" or not name:
        return problem
    written = {place.name: place.where for place in hinge_places(structure)}
    return replace(problem, where=written.get(name, "members"))


def _analysis(document: Document, file: str, directory: Path) -> Analysis:
    data = document.data
    if not isinstance(data, dict):
        what, allowed = "the file has no keys", "lines such as 'title: A tube'"
        raise InputError(
            Problem(what, shown(data), allowed, "start with the line 'crumple: 1'", file=file, line=1)
        )
    _check_format(document, file)
    context = {"file": True, "directory": str(directory)}
    found, problems = _validated(InputFile, data, context)
    whole = found if isinstance(found, InputFile) else None
    structure, defined = whole or _sound_part(data, context), _defined(data)
    complete = all(place and place[0] in _OF_THE_RUN for place, _ in problems)
    cross = problems_in(structure, defined, complete=complete)
    outputs = whole.outputs if whole else _validated(Outputs, data.get("outputs") or {}, context)[0]
    if isinstance(outputs, Outputs):
        cross += output_problems(outputs, structure, defined)
    if whole:
        duration = whole.analysis.total_duration
        interval = whole.outputs.every or duration / DEFAULT_INTERVALS
        samples = run_problems(whole.outputs, duration)
        cross += samples or history_problems(structure, whole.outputs, duration / interval)
        cross += shell_problems(whole.analysis.shell, structure, defined)
        cross += stage_problems(whole.analysis.stages, structure, defined)
    # elastic members have hinges where rigid ones have none
    settings = whole.analysis.multibody if whole else None
    moving = time_in_motion(duration, whole.analysis.stages) if whole else 0.0
    bending = with_elastic_members(structure, settings, moving) if settings else structure
    if whole and not cross:
        cross += filter_problems(bending, whole.outputs, duration, interval)
    scatter: Uncertainty | None = None
    criteria: dict[str, Criterion] = {}
    if whole and not cross:
        criteria, cross = criteria_in_si(whole.criteria, bending, whole.outputs, duration)
        sound = Structure.of_sound_parts(whole)
        bending = with_elastic_members(sound, whole.analysis.multibody, moving)
        scatter, wrong = in_si(whole.uncertainty, data, bending)
        cross += wrong
    # what is refused where a part is missing says nothing new
    told = {place for place, _ in problems}
    problems += [(path, problem) for problem in cross if (path := path_of(problem.where)) not in told]
    if problems or document.problems or whole is None:
        raise InputError(_placed(problems, document, file))
    # everything was checked above, with lines
    return Analysis.model_validate(
        {
            "structure": with_used_laws(Structure.of_sound_parts(whole)),
            "duration": whole.analysis.total_duration,
            "title": whole.title,
            "stages": whole.analysis.stages,
            "multibody": whole.analysis.multibody,
            "shell": whole.analysis.shell,
            "outputs": whole.outputs,
            "criteria": criteria,
            "uncertainty": scatter,
        },
        context={"checked": True},
    )


def _check_format(document: Document, file: str) -> None:
    """Refuse another format version before its keys are checked."""
    version = document.data.get("crumple")
    if version is None and "crumple_study" in document.data:
        what, line = "this is a study file, not an input file", document.line_of(("crumple_study",))
        todo = f"use: {command_line('crumple', 'study', file or 'FILE')}"
        raise InputError(Problem(what, "crumple_study", "an input file", todo, "", file, line))
    if version != FORMAT or isinstance(version, bool):
        what = "the format version is missing" if version is None else "this format version is not known"
        came, allowed, todo = shown(version), str(FORMAT), f"write 'crumple: {FORMAT}' as the first line"
        if isinstance(version, str) and version.strip() == allowed:
            what, came, allowed = "the format version is a text", f"'{came}'", f"{FORMAT} without quotes"
        line = document.line_of(("crumple",))
        raise InputError(Problem(what, came, allowed, todo, "crumple", file, line))


def _validated(
    model: type[BaseModel], data: Any, context: dict[str, Any]
) -> tuple[BaseModel | None, list[tuple[Place, Problem]]]:
    """Model or None, and every problem with its place."""
    try:
        return model.model_validate(data, context=context), []
    except ValidationError as error:
        return None, placed_problems(error, model)


def _sound_part(data: dict[str, Any], context: dict[str, Any]) -> StructureParts:
    """Structure of the valid parts, so that mistakes between them are reported too."""
    parts = {key: data[key] for key in StructureParts.model_fields if key in data}
    while True:
        structure, problems = _validated(StructureParts, parts, context)
        if isinstance(structure, StructureParts):
            return structure
        _remove(parts, [place for place, _ in problems])


def _remove(parts: dict[str, Any], places: Iterable[Place]) -> None:
    """Drop the named parts or list entries that problems lie in; the whole group where there are none."""
    dropped: dict[str, set[str | int]] = defaultdict(set)
    for place in places:
        kind = parts.get(str(place[0])) if place else None
        if len(place) > 1 and isinstance(kind, dict) and place[1] in kind:
            dropped[str(place[0])].add(place[1])
        elif place:
            parts.pop(str(place[0]), None)
        else:
            parts.clear()
    for key, names in dropped.items():
        if key in parts:
            parts[key] = {name: part for name, part in parts[key].items() if name not in names}


def _defined(data: dict[str, Any]) -> dict[str, list[str]]:
    """Names that the file defines, whether or not their parts are valid."""
    return {kind: list(parts) for kind, parts in data.items() if isinstance(parts, dict)}


def _placed(problems: Iterable[tuple[Place, Problem]], document: Document, file: str) -> list[Problem]:
    """Problems with file and line, in the order of the file, each once."""
    placed = [
        problem if problem.line else replace(problem, file=problem.file or file, line=document.line_of(place))
        for place, problem in problems
    ]
    every = sorted(
        dict.fromkeys([*document.problems, *placed]), key=lambda problem: (problem.file != file, problem.line)
    )
    rest = len(every) - MOST_PROBLEMS
    if rest > 0:
        every = [*every[:MOST_PROBLEMS], Problem(f"and {rest} more problems", file=file)]
    return every
