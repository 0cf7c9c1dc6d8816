"""The command `crumple`: verbs by name, and what becomes of a refusal.

Nothing heavy is imported here or at the head of a verb's file: `crumple --help` must answer at once.
"""

from __future__ import annotations

import io
import sys
from typing import Annotated

import typer

from crumple.cli.check import check
from crumple.cli.compare import compare
from crumple.cli.console.defect import EXIT_CODE, DefectError, show_defect
from crumple.cli.console.refusal import show_refusal
from crumple.cli.hinge import hinge
from crumple.cli.layouts import layouts
from crumple.cli.run import run
from crumple.cli.schema import schema
from crumple.cli.section import section
from crumple.errors import CancelledError, InputError
from crumple.version import __version__

app = typer.Typer(
    name="crumple",
    help="Crash analysis at the concept stage for thin-walled structures.",
    epilog="Exit codes: 0 done; 1 a run ended without a result to trust; 2 the input, or the "
    "folder for the results, cannot be accepted; 3 a defect of Crumple; 130 ended by Ctrl-C, "
    "where no result was kept.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,  # rich takes 60 ms to import: a third of what help may take
)
for verb in (run, compare, layouts, check, schema, hinge, section):
    app.command()(verb)


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
    for stream in (sys.stdout, sys.stderr):
        # what the terminal cannot show is replaced; a title must not end a run
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="replace")
    try:
        app()
    except CancelledError as error:
        typer.echo(str(error), err=True)
        sys.exit(130)
    except InputError as error:
        show_refusal(error)
        sys.exit(2)
    except BrokenPipeError:
        # the reader of a pipe went away, as `| head` does
        sys.stderr.close()
        sys.exit(1)
    except OSError as error:
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
