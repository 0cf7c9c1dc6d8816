"""The folder of a run's results: tried before the run, and its errors in the words of the user's path."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from crumple.errors import InputError, Problem
from crumple.portable import reader_left

FILES = ("result.vtkhdf", "histories.csv", "summary.json", "report.html")
"""Files of a run; a folder of such a name is in the way."""
FIGURES = "figures"


def results_folder(given: str | Path | None, file: Path) -> Path:
    """The folder, made and tried; by default out/ and the input file's name.

    Raises
    ------
    InputError
        If it cannot be made or written to, or something in it is in the way.
    """
    if given is not None and not str(given).strip():
        todo = "name a folder; . is the present one"
        raise InputError(Problem("the name of the results' folder is empty", todo=todo, where="--out"))
    folder = Path(given) if given is not None else Path("out") / file.stem
    with results_errors(folder):
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            pass
    blocked = [name for name in FILES if (folder / name).is_dir()]
    if (folder / FIGURES).exists() and not (folder / FIGURES).is_dir():
        blocked.append(FIGURES)
    if blocked:
        todo = "move it away, or choose another folder with --out"
        problems = [
            Problem(f"{folder / name} is in the way", "a file" if name == FIGURES else "a folder", "", todo)
            for name in blocked
        ]
        raise InputError(problems)
    return folder


@contextmanager
def results_errors(folder: Path) -> Iterator[None]:
    """Tell what the system refuses inside the block, by the folder that the user named."""
    try:
        yield
    except OSError as error:
        if reader_left(error):
            raise
        # libraries put their own words, with private names, where the system has a reason
        reason = os.strerror(error.errno) if error.errno else "the system refused"
        if isinstance(error, FileExistsError | NotADirectoryError):
            reason = "a file of this name, or above it, is in the way"
        what = f"the results cannot be written to {folder}: {reason}"
        raise InputError(Problem(what, todo="choose another folder with --out")) from error
