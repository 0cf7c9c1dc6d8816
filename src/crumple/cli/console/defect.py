"""An unexpected exception is a defect of Crumple: report it, and what to send."""

from __future__ import annotations

import sys
import tempfile
import traceback
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import typer

from crumple.errors import CrumpleError
from crumple.portable import SYSTEM
from crumple.version import __version__

NAME = "crumple-defect.txt"
EXIT_CODE = 3


class DefectError(Exception):
    """An unexpected exception, its cause, with the folder of the results that were being written."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        super().__init__(str(folder))


@contextmanager
def defects_into(folder: Path) -> Iterator[None]:
    """Attach the folder to unexpected exceptions of the block."""
    try:
        yield
    except (CrumpleError, OSError, MemoryError, DefectError):
        raise
    except Exception as error:
        # the command line's own: an exit code, a wrong option
        if type(error).__module__.split(".")[0] in {"click", "typer"}:
            raise
        raise DefectError(folder) from error


def show_defect(error: BaseException, folder: Path | None = None) -> None:
    """Report the defect on standard error: where its details are, and what to send."""
    text = (
        f"Crumple {__version__}, Python {sys.version}, {SYSTEM}\n"
        f"Command: {' '.join(sys.argv)}\n\n{''.join(traceback.format_exception(error))}"
    )
    path = _kept(text, folder)
    typer.secho("error: this is a defect of Crumple, not of your input", err=True, fg="red", bold=True)
    typer.echo(f"    what:    {type(error).__name__}: {str(error)[:200]}", err=True)
    if path is None:
        typer.echo(text, err=True)
    sent = "the lines above" if path is None else f"the file {path}"
    typer.echo(f"    send:    {sent} and your input file, to the developers of Crumple", err=True)


def _kept(text: str, folder: Path | None) -> Path | None:
    """Where the details were written: the folder of the results, else one for temporary files."""
    for place in (folder, Path(tempfile.gettempdir())):
        if place is None:
            continue
        try:
            (place / NAME).write_text(text, encoding="utf-8", errors="backslashreplace")
        except OSError:
            continue
        return place / NAME
    return None
