"""Inverse design: the lightest walls with which each of several structures keeps its criteria.

A target is written as an ordinary study of each base: its thicknesses are the variables, the mass of the
members is the objective, and the criteria are the constraints.
"""

from __future__ import annotations

import copy
import csv
import json
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import Executor
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import Field, ValidationError

from crumple.analysis import LoadedInput, load_input
from crumple.analysis.criteria import Criterion
from crumple.analysis.distribution import Value
from crumple.errors import InputError, Problem
from crumple.portable import replacing
from crumple.structure.schema.problems import placed_problems
from crumple.structure.schema.spec import Named, Spec
from crumple.study.answer import Answer
from crumple.study.running import check_study, run_study
from crumple.study.study_file import MOST_ROWS, LoadedStudy, Study, StudyDocument, Verify

MASS = "mass"
"""Name of the response that is made small."""
RANKING = "ranking"
"""Files of a target: ranking.csv and ranking.json."""


class Target(Spec):
    """What the lightest walls shall achieve."""

    criteria: Named[Criterion]
    """Limits that the structure shall keep, by name, as in an input."""
    sections: tuple[str, ...] = ()
    """Sections whose thickness is sought; none: all that have one."""
    sizes: tuple[Value, ...] = ()
    """The only thicknesses: catalogue sizes."""
    low: Value | None = None
    """Smallest thickness, without sizes."""
    high: Value | None = None
    """Largest thickness, without sizes."""
    rows: Annotated[int, Field(ge=1, le=MOST_ROWS)] = 2000
    """Largest number of variants that are solved for one base."""
    seed: Annotated[int, Field(ge=0, le=2**32 - 1)] = 0
    """Of the optimiser."""


class TargetFile(Spec):
    """Lightest walls of one or several structures."""

    crumple_study: Literal[1] = 1
    """Version of the format."""
    title: Annotated[str, Field(max_length=200)] = ""
    """One line for people."""
    base: str = ""
    """Input file; relative to the study file."""
    bases: tuple[str, ...] = ()
    """Several input files, which are ranked."""
    target: Target
    """What is sought."""
    verify: Verify | None = None
    """Whether the lightest variants of each base are solved again by a slower model."""


@dataclass(frozen=True)
class Ranked:
    """The lightest variant of one base; SI units.

    Attributes
    ----------
    name
        Of the base's file, without ending.
    answer
        Of its study; its best row has thicknesses by section, mass and criteria. None without a variant that
        keeps all criteria.
    reason
        Why there is none.
    """

    name: str
    answer: Answer
    reason: str = ""

    @property
    def mass(self) -> float:
        """Of the members [kg]; infinite without a best row."""
        return float("inf") if self.best is None else float(self.best["responses"][MASS])

    @property
    def best(self) -> Mapping[str, Any] | None:
        """Row, thicknesses by section, mass and criteria: with `verify` those of the slower model."""
        return self.answer.best if self.answer.verification is None else _confirmed(self.answer)


class LoadedTarget:
    """A study file with a target, and its bases.

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
            self.file = TargetFile.model_validate(self.document.data, context={"file": True})
        except ValidationError as error:
            raise self.document.with_lines(placed_problems(error, TargetFile)) from None
        names = (*((self.file.base,) if self.file.base else ()), *self.file.bases)
        with self._lines():
            _refuse(self.file.target, names)
        self.studies = {Path(name).stem: self._study(load_input(path.parent / name)) for name in names}

    @contextmanager
    def _lines(self) -> Iterator[None]:
        try:
            yield
        except InputError as error:
            raise self.document.with_lines(error) from None

    def _study(self, base: LoadedInput) -> LoadedStudy:
        """The study of one base."""
        with self._lines():
            return _Part(self.document, _study_of(self.file, base), base)


class _Part(LoadedStudy):
    """Study of a base that a target describes; its refusals name the target's keys."""

    def __init__(self, document: StudyDocument, study: Study, base: LoadedInput) -> None:
        self.document, self.study, self.base = copy.copy(document), study, base
        self.bases = {base.path.stem: base}
        names = list(study.responses)

        def placed(where: str) -> str:
            kind, _, rest = where.partition(".")
            first, _, key = rest.partition(".")
            if kind == "constraints":
                return f"target.criteria.{names[int(first)]}.{key}"
            return f"target.criteria.{rest}" if kind == "responses" else "target"

        self.document.places = placed


def is_target(path: Path) -> bool:
    """Whether a study file has a target."""
    data = StudyDocument(path).data
    return isinstance(data, dict) and "target" in data


def check_target(target: LoadedTarget) -> None:
    """Refuse what `run_target` would refuse before its first row.

    Raises
    ------
    InputError
        With file and line.
    """
    for study in target.studies.values():
        check_study(study)


def run_target(
    target: LoadedTarget,
    out: Path,
    workers: int = 1,
    progress: Callable[[float], None] | None = None,
    *,
    executor: Executor | None = None,
) -> list[Ranked]:
    """Lightest walls of every base, the lightest first; those that cannot keep the criteria come last.

    Parameters
    ----------
    target
        With its bases.
    out
        Folder of ``ranking.csv`` and ``ranking.json``, and of a folder with the study of each base.
    workers, progress, executor
        As in `crumple.study.run_study`.
    """
    found, count = [], len(target.studies)
    for i, (name, study) in enumerate(target.studies.items()):
        folder = out / name
        folder.mkdir(parents=True, exist_ok=True)

        def share(own: float, done: int = i) -> None:
            if progress is not None:
                progress((done + own) / count)

        _, answer = run_study(study, folder, workers, executor=executor, progress=share)
        one = Ranked(name, answer)
        if one.best is None:
            confirms = "the slower model confirms none of the lightest variants"
            none = f"no variant of {answer.rows} keeps all criteria"
            one = replace(one, reason=confirms if answer.best is not None else none)
        found.append(one)
    found.sort(key=lambda one: one.mass)
    _write(found, list(target.file.target.criteria), out)
    return found


def _confirmed(answer: Answer) -> Mapping[str, Any] | None:
    """The verified best row with its values by the slower model; None if there is none."""
    best = None if answer.verification is None else answer.verification["best"]
    return None if best is None else {**best, "responses": best["slow"]}


def _refuse(target: Target, names: tuple[str, ...]) -> None:
    problems = []
    if not names:
        problems.append(Problem("the base input is missing", "", "a file", "write 'base: tube.yaml'", "base"))
    if len({Path(name).stem for name in names}) < len(names):
        problems.append(Problem("two bases have the same name", "", "", "rename one of the files", "bases"))
    if bool(target.sizes) == (target.low is not None and target.high is not None):
        what, allowed = "the thicknesses are not given", "sizes, or low and high"
        problems.append(Problem(what, "", allowed, "give one of the two", "target"))
    if not target.criteria:
        what = "no criterion is given"
        problems.append(Problem(what, "", "at least one", "add one", "target.criteria"))
    if MASS in target.criteria:
        what = f"a criterion is called '{MASS}', as what is made small"
        problems.append(Problem(what, "", "", "choose another name", f"target.criteria.{MASS}"))
    if problems:
        raise InputError(problems)


def _study_of(file: TargetFile, base: LoadedInput) -> Study:
    """The target as a study of one base."""
    target = file.target
    sections = base.analysis.structure.sections
    walls = [name for name, one in sections.items() if "thickness" in one.key_names]
    wanted = [name for name in target.sections or walls if name in walls]
    if not wanted:
        what = f"{base.path.name} has none of these sections with a thickness"
        came = ", ".join(target.sections)
        raise InputError(Problem(what, came, ", ".join(walls), "name a section", "target.sections"))
    range_of: dict[str, Any] = {"values": target.sizes} if target.sizes else {}
    range_of |= {} if target.sizes else {"low": target.low, "high": target.high}
    variables = {name: {"path": f"sections.{name}.thickness", **range_of} for name in wanted}
    responses: dict[str, Any] = {}
    constraints = []
    for name, one in target.criteria.items():
        responses[name] = {"channel": one.channel, "take": one.take, "time": one.time}
        constraints.append({"response": name, "at_most": one.at_most, "at_least": one.at_least})
    clash = [name for name in target.criteria if name.lower() in {wall.lower() for wall in wanted}]
    if clash:
        what = f"a criterion has the name of a section of {base.path.name}"
        raise InputError(Problem(what, clash[0], "", "rename it", f"target.criteria.{clash[0]}"))
    method = {"type": "lightest" if target.sizes else "optimise", "rows": target.rows, "seed": target.seed}
    return Study.model_validate(
        {
            "base": str(base.path),
            "variables": variables,
            "responses": {**responses, MASS: {"mass": True}},
            "constraints": constraints,
            "objective": {"minimise": MASS},
            "method": method,
            "verify": file.verify,
        }
    )


def _write(found: list[Ranked], criteria: list[str], out: Path) -> None:
    plain = [
        {"rank": i, "name": one.name, "reason": one.reason, "rows": one.answer.rows, "best": one.best}
        for i, one in enumerate(found, 1)
    ]
    text = json.dumps(plain, indent=2, allow_nan=False) + "\n"
    (out / f"{RANKING}.json").write_text(text, encoding="utf-8")
    with replacing(out / f"{RANKING}.csv") as file, file.open("w", encoding="utf-8", newline="") as stream:
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow(["rank", "name", MASS, *criteria, "rows", "thicknesses", "reason"])
        for i, one in enumerate(found, 1):
            best: Mapping[str, Any] = one.best or {"responses": {}, "variables": {}}
            numbers = [best["responses"].get(key, "") for key in (MASS, *criteria)]
            walls = " ".join(f"{name}={value:.6g}" for name, value in best["variables"].items())
            writer.writerow([i, one.name, *numbers, one.answer.rows, walls, one.reason])
