"""What the process that solves does: an input text becomes mistakes, or shapes, curves and sentences.

Jobs and answers are plain data, so that a defect here ends this process and not the server.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from crumple.errors import InputError, Problem
from crumple.processes import Report

if TYPE_CHECKING:
    from crumple.analysis import LoadedInput
    from crumple.report.scene.scene import Scene, Shown
    from crumple.result import Result

Stopped = Callable[[], bool]
FAST = 1
"""Compression of shapes that do not leave this machine."""
QUICK_FRAMES = 31
"""Shapes over a run while a number is dragged."""
MOST_PROBLEMS = 50
"""Mistakes that are given."""


@dataclass(frozen=True)
class Job:
    """One request.

    Attributes
    ----------
    kind
        ``solve``; ``figures``, ``forms`` and ``bands`` of what was solved last; ``shell`` or ``beside``.
    texts
        Path and text of the input, for ``beside`` of several; files that it names are in its folder or below.
    numbers
        Whether the numbers of the text are wanted.
    threads
        Of the shell run.
    quick
        Whether a number is being dragged: there are fewer shapes, and the error and whether the mechanism is
        unique, which take up to five more solves, are left out.
    """

    kind: str
    texts: tuple[tuple[str, str], ...] = ()
    numbers: bool = False
    threads: int = 1
    quick: bool = False


class Answering:
    """Does jobs one after the other and remembers the last result, whose figures may be wanted."""

    def __init__(self) -> None:
        self._last: tuple[LoadedInput, Result] | None = None

    def __call__(self, job: Job, report: Report, stopped: Stopped) -> dict[str, Any]:
        """Answer to a job, as the page gets it; with ``stopped`` if it was told to stop."""
        numbers: dict[str, Any] = {}
        if job.numbers:
            from crumple.app.numbers import scalars_of  # noqa: PLC0415

            numbers = {**scalars_of(job.texts[0][1])}
        try:
            return {"problems": [], **numbers, **self._answer(job, report, stopped)}
        except InputError as error:
            found = [_plain(problem) for problem in error.problems[:MOST_PROBLEMS]]
            return {"problems": found, "more": max(len(error.problems) - MOST_PROBLEMS, 0), **numbers}

    def _answer(self, job: Job, report: Report, stopped: Stopped) -> dict[str, Any]:
        if job.kind in ("figures", "forms", "bands"):
            return {job.kind: None if self._last is None else _of_last(job.kind, *self._last, stopped)}
        if job.kind == "shell":
            return _shell(job, report, stopped)
        if job.kind == "beside":
            return _beside(job, stopped)
        source = load_text_of(job)
        result, shown = _solved(source, stopped, quick=job.quick)
        if not result.time.size:
            return {"stopped": True}
        self._last = (source, result)
        from crumple.report.exploration import SAMPLES, curves_of  # noqa: PLC0415

        return {
            **_scene([shown], source.analysis.title),
            **_said(result, source),
            "curves": {"end": float(result.time[-1]), "samples": SAMPLES, "all": curves_of([result])},
            "seconds": result.solve_seconds,
        }


def load_text_of(job: Job, number: int = 0) -> LoadedInput:
    """One of the inputs of a job."""
    from crumple.analysis import load_text  # noqa: PLC0415

    path, text = job.texts[number]
    return load_text(text, path)


def _solved(source: LoadedInput, stopped: Stopped, *, quick: bool = False) -> tuple[Result, Shown]:
    """Result of the multibody solver, and what the viewer shows of it."""
    from crumple.analysis import solve_with_frames  # noqa: PLC0415
    from crumple.report.scene.hinges import hinges_of_result  # noqa: PLC0415
    from crumple.report.scene.scene import Shown  # noqa: PLC0415

    most = QUICK_FRAMES if quick else None
    try:
        result, frames = solve_with_frames(source.analysis, most=most, checks=not quick, cancel=stopped)
    except InputError as error:
        raise source.with_lines(error) from None
    return result, Shown(
        source.path.stem, frames, partial(hinges_of_result, frames), source.analysis.structure
    )


def _scene(shown: list[Shown], title: str) -> dict[str, Any]:
    from crumple.report.scene.scene import write_scene  # noqa: PLC0415

    return _plain_scene(write_scene(shown, title, compression=FAST))


def _plain_scene(scene: Scene | None) -> dict[str, Any]:
    """A scene as the page reads it: its header is a text, as on other pages."""
    return {"scene": None if scene is None else {"header": scene.header, "payload": scene.payload}}


def _said(result: Result, source: LoadedInput) -> dict[str, Any]:
    """Level of trust, and the sentences with which a page begins."""
    from crumple.report.wording.answer import MOST_CAUTIONS, grouped, members_of, three_sentences  # noqa: PLC0415
    from crumple.report.wording.scatter import criterion_sentences  # noqa: PLC0415
    from crumple.report.wording.wording import verdict  # noqa: PLC0415

    settings = source.analysis.multibody
    found = verdict(result, settings.energy_residual_bound, settings.accuracy)
    cautions = grouped(found.warnings, [*result.hinges, *members_of(result)])
    return {
        "level": found.level,
        "headline": found.headline,
        "sentences": [*three_sentences(result, found), *criterion_sentences(result)],
        "cautions": cautions[:MOST_CAUTIONS],
        "more_cautions": max(len(cautions) - MOST_CAUTIONS, 0),
    }


def _of_last(kind: str, source: LoadedInput, result: Result, stopped: Stopped) -> Any:
    """What is wanted of the last result when nothing changes."""
    if kind == "figures":
        return _figures(source, result)
    if kind == "forms":
        from crumple.app.forms import forms_of  # noqa: PLC0415

        return forms_of(source.analysis.structure)
    from crumple.app.bands import bands_of  # noqa: PLC0415

    return bands_of(source, result, stopped)


def _figures(source: LoadedInput, result: Result) -> list[dict[str, Any]]:
    """Every figure that the page of a run has."""
    from crumple.report.page_figures import draw  # noqa: PLC0415

    analysis = source.analysis
    drawn = draw(result, analysis.multibody.energy_residual_bound, analysis.structure, analysis.outputs)
    return [
        {"caption": one.caption, "panels": [{"name": name, "svg": svg} for name, svg in one.panels]}
        for one in drawn
    ]


def _shell(job: Job, report: Report, stopped: Stopped) -> dict[str, Any]:
    """The shell result beside the multibody result, and what their comparison says."""
    from crumple.comparison import solve_and_compare  # noqa: PLC0415
    from crumple.errors import CancelledError  # noqa: PLC0415
    from crumple.report import ReportInput  # noqa: PLC0415
    from crumple.report.comparison_page import scene_of  # noqa: PLC0415
    from crumple.report.wording.answer import MOST_CAUTIONS  # noqa: PLC0415

    source = load_text_of(job)

    def share(done: float) -> None:
        report(done)

    try:
        found = solve_and_compare(
            source.analysis, threads=job.threads, variants=False, progress=share, cancel=stopped
        )
    except CancelledError:
        return {"stopped": True}
    except InputError as error:
        raise source.with_lines(error) from None
    if stopped() or not found.reference.result.time.size:
        return {"stopped": True}
    shown = ReportInput(title=source.analysis.title, structure=source.analysis.structure)
    trust = found.trust
    return {
        **_plain_scene(scene_of(found, shown)),
        "level": trust.level,
        "headline": trust.headline,
        # the last one says where on the page of a comparison the warnings are
        "sentences": [fact for fact in trust.facts if "of the page" not in fact],
        "cautions": list(trust.cautions[:MOST_CAUTIONS]),
        "more_cautions": max(len(trust.cautions) - MOST_CAUTIONS, 0),
        "seconds": found.reference.result.solve_seconds,
    }


def _beside(job: Job, stopped: Stopped) -> dict[str, Any]:
    """Several inputs side by side."""
    shown, sentences = [], []
    for number in range(len(job.texts)):
        source = load_text_of(job, number)
        result, one = _solved(source, stopped)
        if not result.time.size:
            return {"stopped": True}
        shown.append(one)
        said = _said(result, source)
        sentences.append(f"{source.path.stem}: {' '.join([said['headline'], *said['sentences'][:2]])}")
    return {
        **_scene(shown, "Layouts"),
        "level": "",
        "headline": f"{len(shown)} layouts",
        "sentences": sentences,
        "cautions": [],
        "more_cautions": 0,
    }


def _plain(problem: Problem) -> dict[str, Any]:
    """A mistake without the path of its file, which the page knows by its name."""
    return {
        "what": problem.what,
        "came": problem.came,
        "allowed": problem.allowed,
        "todo": problem.todo,
        "where": problem.where,
        "file": Path(problem.file).name,
        "line": problem.line,
    }
