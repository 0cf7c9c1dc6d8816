"""`crumple run --explore`: a grid of runs on one page with sliders."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import typer

from crumple.cli.console.fidelity import Fidelity

if TYPE_CHECKING:
    from crumple.analysis import LoadedInput
    from crumple.analysis.explore import Slider


def checked(wanted: str, source: LoadedInput, fidelity: Fidelity) -> tuple[Slider, ...]:
    """The numbers to explore.

    Raises
    ------
    BadParameter
        For another solver than the multibody solver.
    InputError
        If a number is not one of the input.
    """
    from crumple.analysis.explore import sliders_of

    if fidelity is not Fidelity.MULTIBODY:
        raise typer.BadParameter("only the multibody model is solved on a grid", param_hint="--explore")
    return sliders_of(wanted, source.analysis, source.document.data)


def explored(wanted: str | None, source: LoadedInput, folder: Path, *, quiet: bool) -> None:
    """Solve the grid and write its page; without one remove that of an earlier run."""
    from crumple.report.exploration import PAGE, sentence, write_exploration

    (folder / PAGE).unlink(missing_ok=True)
    if wanted is None:
        return
    from crumple.analysis.explore import explore, law_cautions
    from crumple.cli.console.folder import results_errors
    from crumple.cli.console.progress import progress_bar
    from crumple.portable import stop_on_interrupt

    sliders = checked(wanted, source, Fidelity.MULTIBODY)
    with stop_on_interrupt() as cancel, progress_bar("exploring") as progress:
        points = explore(source.analysis, sliders, progress, cancel)
    cautions = law_cautions(source.analysis, sliders, points)
    with results_errors(folder):
        page = write_exploration(points, sliders, source.analysis.title, folder, cautions)
    if not quiet:
        typer.echo(sentence(points, sliders))
        for caution in cautions:
            typer.echo(caution)
        typer.echo(f"Page with sliders: {page}")
