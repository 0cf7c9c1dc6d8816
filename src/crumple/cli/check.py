"""`crumple check FILE`: every mistake of an input file at once, without solving it."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer


def check(file: Annotated[Path, typer.Argument(help="Input file (YAML).", show_default=False)]) -> None:
    """Report every mistake in an input file. Each with its place, what came, what is allowed, what to do."""
    from crumple.analysis import check as problems_of
    from crumple.errors import InputError

    problems = problems_of(file)
    if problems:
        raise InputError(problems)
    typer.echo(f"{file}: no mistakes found")
