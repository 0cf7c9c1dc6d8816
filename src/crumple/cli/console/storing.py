"""Results on the disk: completely or not at all; in a temporary folder if their own cannot be written."""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from crumple.cli.console.folder import results_errors
from crumple.errors import InputError

if TYPE_CHECKING:
    from crumple.analysis import LoadedInput
    from crumple.report import ReportInput
    from crumple.result import Result


def report_input(source: LoadedInput, fidelity: str | None = None) -> ReportInput:
    """The input as shown on a page, with the bounds of a solver's settings, where it is of one."""
    from crumple.analysis import canonical
    from crumple.report import ReportInput

    analysis = source.analysis
    bounds = {
        "multibody": analysis.multibody.energy_residual_bound,
        "shell": analysis.shell.energy_residual_bound,
    }
    return ReportInput(
        title=analysis.title,
        text=source.document.text,
        name=source.path.name,
        canonical=canonical(analysis),
        residual_bound=bounds.get(fidelity or ""),
        accuracy=analysis.multibody.accuracy if fidelity == "multibody" else None,
        structure=analysis.structure,
        outputs=analysis.outputs,
    )


def store(result: Result, source: LoadedInput, folder: Path, frames: Result | None = None) -> None:
    """Write a result and its page to a folder, see `stored`; `frames`: the same with more shapes."""
    from crumple.report import write_report
    from crumple.result import write

    drawn: list[Exception] = []

    def fill(place: Path) -> None:
        write(result, place)
        try:
            write_report(result, report_input(source, result.fidelity), place, frames=frames)
        except OSError:
            raise
        except Exception as error:
            # results are stored even if drawing them fails
            drawn.append(error)

    stored(folder, fill)
    if drawn:
        raise drawn[0]


def stored(folder: Path, fill: Callable[[Path], object], last: str = "summary.json") -> None:
    """Let `fill` write files for a folder; `last` names the one that shows that all are there.

    Raises
    ------
    InputError
        If the folder cannot be written; the files are then in a folder for temporary files, if that has room.
    """
    from crumple.result.publishing import published

    try:
        with results_errors(folder), published(folder, last) as staging:
            fill(staging)
    except InputError as error:
        spare = Path(tempfile.mkdtemp(prefix="crumple-results-"))
        try:
            fill(spare)
        except OSError:
            shutil.rmtree(spare, ignore_errors=True)
            raise error from None
        kept = f"the results are in {spare}: copy them from there"
        raise InputError([replace(problem, todo=kept) for problem in error.problems]) from None
