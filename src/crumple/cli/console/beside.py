"""Runs beside a run on the command line: variants of the block `uncertainty`, and modes of collapse."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from crumple.analysis import LoadedInput
    from crumple.result import Result

Uncertain = Annotated[
    bool,
    typer.Option(
        "--uncertainty/--no-uncertainty",
        help="Solve also the variants of the input's block 'uncertainty', if it has one.",
    ),
]
Moded = Annotated[
    bool | None,
    typer.Option(
        "--modes/--no-modes",
        help="Of an impact, solve also with changed capacities, friction, contact points and stiffness, and "
        "report the modes of collapse that appear; by default if the run took less than 5 s of processor "
        "time.",
        show_default=False,
    ),
]


def with_scatter(result: Result, source: LoadedInput, threads: int, cancel: Callable[[], bool]) -> Result:
    """A multibody result with its scatter; what is solved is kept if it cannot be computed."""
    if source.analysis.uncertainty is None:
        return result
    from crumple.cli.console.progress import progress_bar
    from crumple.errors import CancelledError, InputError
    from crumple.study import with_uncertainty

    try:
        with progress_bar("solving variants") as progress:
            return with_uncertainty(result, source.analysis, threads, progress, cancel)
    except CancelledError:
        typer.echo("Stopped: the scatter is not known. Writing the results of the run itself.", err=True)
        return result
    except InputError as error:
        problem = source.with_lines(error).problems[0]
        typer.echo(f"The scatter is not known: {problem.what} ({problem.where})", err=True)
        return result


def with_its_modes(result: Result, source: LoadedInput, threads: int, cancel: Callable[[], bool]) -> Result:
    """The result with the modes of collapse; what is solved is kept if they cannot be computed."""
    from crumple.analysis import with_modes
    from crumple.cli.console.progress import progress_bar
    from crumple.errors import CancelledError, InputError

    try:
        with progress_bar("solving modes") as progress:
            return with_modes(result, source.analysis, threads, progress, cancel)
    except CancelledError:
        typer.echo("Stopped: the modes of collapse are not known", err=True)
        return result
    except InputError as error:
        typer.echo(f"The modes of collapse are not known: {error.problems[0].what}", err=True)
        return result


def say_no_modes(source: LoadedInput) -> None:
    """Say why a run that was asked for its modes of collapse has none."""
    off = source.analysis.multibody.mechanism_check == "off"
    why = (
        "analysis.multibody.mechanism_check is off"
        if off
        else "they are of impacts on structures with two automatic hinges or more"
    )
    typer.echo(f"No modes of collapse (--modes): {why}", err=True)
