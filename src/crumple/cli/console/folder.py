"""The folder of a run's results, tried and locked before the run; its errors name the user's path."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from crumple.cli.console.defect import defects_into
from crumple.errors import InputError, Problem
from crumple.portable import reader_left, refusal_of

if TYPE_CHECKING:
    from filelock import BaseFileLock

FILES = ("result.vtkhdf", "histories.csv", "summary.json", "report.html")
"""Files of a run; a folder with one of these names is an error."""
FIGURES = "figures"
LOCK = ".crumple.lock"
"""Held by the run that writes into a folder; the system releases it with the process, however that ends."""


@contextmanager
def results_folder(given: str | Path | None, file: Path, within: tuple[str, ...] = ()) -> Iterator[Path]:
    """Make, try and lock the folder, and folders within it; by default out/ and the input file's name.

    Unfinished files of an interrupted run are removed.  Unexpected exceptions of the block are wrapped with
    the folder, see `crumple.cli.console.defect`.

    Raises
    ------
    InputError
        If a folder cannot be made or written to, another run writes into it, or a file or folder of another
        kind has its name.
    """
    if given is not None and not str(given).strip():
        todo = "give a folder; . is the current one"
        raise InputError(Problem("the name of the results' folder is empty", todo=todo, where="--out"))
    folder = Path(given) if given is not None else Path("out") / file.stem
    with ExitStack() as held:
        for each in (folder, *(folder / name for name in within)):
            _try(each)
            held.enter_context(_locked(each))
            _tidy(each)
        held.enter_context(defects_into(folder))
        yield folder


def _try(folder: Path) -> None:
    """Make a folder and see that files can be written there, and under the names that results have."""
    with results_errors(folder):
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            pass
    blocked = [name for name in FILES if (folder / name).is_dir()]
    if (folder / FIGURES).exists() and not (folder / FIGURES).is_dir():
        blocked.append(FIGURES)
    if blocked:
        todo = "move it, or choose another folder with --out"
        problems = [
            Problem(
                f"{folder / name} is a folder, but a result file has this name",
                "a file" if name == FIGURES else "a folder",
                "",
                todo,
            )
            for name in blocked
        ]
        raise InputError(problems)


def _locked(folder: Path) -> BaseFileLock:
    """Lock of a folder, held."""
    from filelock import FileLock, Timeout

    lock = FileLock(folder / LOCK)
    try:
        with results_errors(folder):
            lock.acquire(blocking=False)
    except Timeout:
        what, todo = (
            f"another run is writing into {folder}",
            "wait for it, or choose another folder with --out",
        )
        raise InputError(Problem(what, todo=todo, where="--out")) from None
    return lock


def _tidy(folder: Path) -> None:
    from crumple.result.publishing import remove_left_over

    with results_errors(folder):
        remove_left_over(folder)


@contextmanager
def results_errors(folder: Path) -> Iterator[None]:
    """Report what the system refuses inside the block, with the folder that the user named."""
    try:
        yield
    except OSError as error:
        if reader_left(error) or isinstance(error, TimeoutError):
            raise
        what = f"the results cannot be written to {folder}: {refusal_of(error)}"
        raise InputError(Problem(what, todo="choose another folder with --out")) from error
