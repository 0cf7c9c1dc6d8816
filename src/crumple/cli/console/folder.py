"""The folder of a run's results: checked before the run; error messages name the user's path."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from crumple.errors import InputError, Problem
from crumple.portable import reader_left

FILES = ("result.vtkhdf", "histories.csv", "summary.json", "report.html")
"""Files of a run; a folder with one of these names is an error."""
FIGURES = "figures"


def results_folder(given: str | Path | None, file: Path) -> Path:
    """The folder, created and checked for write access; by default out/ and the input file's name.

    Raises
    ------
    InputError
        If it cannot be created or written to, or a folder in it has the name of a result file.
    """
    if given is not None and not str(given).strip():
        todo = "give a folder; . is the current one"
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
    return folder


@contextmanager
def results_errors(folder: Path) -> Iterator[None]:
    """Report what the system refuses inside the block, with the folder that the user named."""
    try:
        yield
    except OSError as error:
        if reader_left(error):
            raise
        # libraries give their own text, with temporary names, in place of the system's reason
        reason = os.strerror(error.errno) if error.errno else "the operating system refused"
        if isinstance(error, FileExistsError | NotADirectoryError):
            reason = "a file has this name, or the name of a folder above it"
        what = f"the results cannot be written to {folder}: {reason}"
        raise InputError(Problem(what, todo="choose another folder with --out")) from error
