"""The command `crumple`: commands by name, and error handling.

No large package is imported here or at the top of a command's file, so that `crumple --help` is fast.
"""

from __future__ import annotations

import gc
import os
import sys
from typing import Annotated

import typer

from crumple.cli.app import app as app_verb
from crumple.cli.characterise import characterise
from crumple.cli.check import check
from crumple.cli.compare import compare
from crumple.cli.completion import completion, prepare_answers
from crumple.cli.console.defect import EXIT_CODE, DefectError, show_defect
from crumple.cli.console.refusal import show_refusal
from crumple.cli.hinge import hinge
from crumple.cli.layouts import layouts
from crumple.cli.run import run
from crumple.cli.schema import schema
from crumple.cli.section import section
from crumple.cli.study import study
from crumple.cli.view import view
from crumple.errors import CancelledError, InputError
from crumple.portable import exit_code_of_stop, prepare_consoles, reader_left
from crumple.version import __version__

COLLECTED_EVERY = 50_000
"""New objects between two searches for reference cycles; Python's own 700 cost a third of the time for which
a large input is read and checked, and find nothing there.  Some 25 MB more at most wait to be freed."""

app = typer.Typer(
    name="crumple",
    help="Crash analysis at the concept stage for thin-walled structures.",
    epilog="Exit codes: 0 done; 1 a run ended without a reliable result; 2 the input, or the "
    "folder for the results, cannot be accepted; 3 a defect of Crumple; 130 ended by Ctrl-C "
    "without a stored result, 143 by SIGTERM.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,  # rich takes 60 ms to import: a third of the time allowed for --help
)
for verb in (
    run,
    compare,
    layouts,
    study,
    app_verb,
    view,
    check,
    schema,
    hinge,
    section,
    characterise,
    completion,
):
    app.command(verb.__name__)(verb)


def _print_version(wanted: bool) -> None:
    if wanted:
        typer.echo(f"crumple {__version__}")
        raise typer.Exit


@app.callback()
def _options(
    version: Annotated[
        bool, typer.Option("--version", callback=_print_version, is_eager=True, help="Print the version.")
    ] = False,
) -> None:
    """Crash analysis at the concept stage for thin-walled structures."""


def main() -> None:
    """Run the command; a refusal ends with exit code 2, a defect of Crumple with 3, none with a traceback."""
    prepare_consoles()
    prepare_answers()
    # before numpy is imported: threads that wait for small matrices take a fifth of the processor time
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    gc.set_threshold(COLLECTED_EVERY, *gc.get_threshold()[1:])
    try:
        app()
    except CancelledError as error:
        typer.echo(str(error), err=True)
        sys.exit(exit_code_of_stop())
    except InputError as error:
        show_refusal(error)
        sys.exit(2)
    except OSError as error:
        if reader_left(error):
            sys.stderr.close()
            sys.exit(1)
        typer.echo(f"error: {error.filename or 'file'}: {error.strerror or error}", err=True)
        sys.exit(2)
    except MemoryError:
        typer.echo("error: this machine has too little memory for the model", err=True)
        sys.exit(2)
    except DefectError as error:
        show_defect(error.__cause__ or error, error.folder)
        sys.exit(EXIT_CODE)
    except Exception as error:
        show_defect(error)
        sys.exit(EXIT_CODE)
