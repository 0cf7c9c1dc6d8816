"""`crumple study FILE`: solve a study and say what its rows show."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from crumple.study import Answer


def study(
    file: Annotated[Path, typer.Argument(help="Study file (YAML).", show_default=False)],
    *,
    out: Annotated[
        str | None, typer.Option(metavar="FOLDER", help="Folder for the rows.", show_default="out/FILE")
    ] = None,
    workers: Annotated[
        int | None, typer.Option(min=1, help="Threads or processes.", show_default="all cores")
    ] = None,
    resume: Annotated[bool, typer.Option("--resume", help="Keep the rows that the folder has.")] = False,
) -> None:
    """Solve many variants of one input: sampling, probabilities, Sobol' indices, optimisation."""
    from crumple.cli.console.folder import results_folder
    from crumple.cli.console.progress import progress_bar
    from crumple.portable import available_cores
    from crumple.study import LoadedStudy, run_study
    from crumple.study.table import FILE

    loaded = LoadedStudy(file)
    with results_folder(out, file) as folder:
        rows = folder / FILE
        if not resume:
            for old in (rows, rows.with_name(f"{FILE}-journal")):
                old.unlink(missing_ok=True)
        with progress_bar("solving") as progress:
            _, answer = run_study(loaded, folder, workers or available_cores(), progress=progress)
        _show(answer)
        typer.echo(f"Results: {folder}  (study.sqlite, study.csv, study.json)")
    if answer.complete == 0:
        raise typer.Exit(1)


def _show(answer: Answer) -> None:
    """Print what the rows say."""
    from crumple.units import format_quantity

    def text(value: float, name: str) -> str:
        return format_quantity(value, answer.units[name])

    typer.echo(f"{answer.rows} rows, {answer.complete} complete, {answer.solved} solved now")
    for status, count in answer.failures.items():
        typer.echo(f"  {count} rows: {status}")
    for name, found in answer.responses.items():
        if found:
            low, high = text(found["q2.5"], name), text(found["q97.5"], name)
            typer.echo(f"{name}: mean {text(found['mean'], name)}, 95 % of rows from {low} to {high}")
    for one in answer.probabilities:
        if "probability" in one:
            low, high = one["interval"]
            share = f"{one['probability']:.4g} (95 % interval {low:.4g} to {high:.4g})"
            typer.echo(f"probability that {one['response']} violates its limit, within this model: {share}")
    if isinstance(answer.indices, str):
        typer.echo(answer.indices)
    else:
        for name, indices in answer.indices.items():
            for variable, found in {} if isinstance(indices, str) else indices.items():
                values = f"first order {found['first']:.3f}, total {found['total']:.3f}"
                typer.echo(f"Sobol' indices of {name} for {variable}: {values}")
    if answer.best is not None:
        values = ", ".join(f"{key} {_plain(value)}" for key, value in answer.best["variables"].items())
        typer.echo(f"best row {answer.best['row']}: {values} (SI units)")
        for name, value in answer.best["responses"].items():
            typer.echo(f"  {name}: {text(value, name)}")


def _plain(value: float | str) -> str:
    return value if isinstance(value, str) else f"{value:.6g}"
