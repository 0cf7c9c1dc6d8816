"""Error messages on the terminal: every problem, on standard error."""

from __future__ import annotations

import typer

from crumple.errors import InputError


def show_refusal(error: InputError) -> None:
    """Print every problem and how many there are."""
    count = len(error.problems)
    typer.secho("error: the input cannot be accepted", err=True, fg="red", bold=True)
    for problem in error.problems:
        typer.echo(str(problem), err=True)
    if count > 1:
        typer.echo(f"{count} problems", err=True)
