"""`crumple study FILE`: solve a study and say what its rows show."""

from __future__ import annotations

from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping
    from concurrent.futures import Executor

    from crumple.study import Answer, LoadedStudy, Table


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
    part: Annotated[
        str | None,
        typer.Option(metavar="K/N", help="Solve the K-th of N parts into its own file.", show_default=False),
    ] = None,
    merge: Annotated[bool, typer.Option("--merge", help="Join the parts that the folder has.")] = False,
    scheduler: Annotated[
        str | None,
        typer.Option(metavar="ADDRESS", help="Use this Dask cluster: tls://host:port.", show_default=False),
    ] = None,
    limit: Annotated[
        float, typer.Option(min=1.0, help="Seconds after which work goes to another worker of the cluster.")
    ] = 600.0,
    shapes: Annotated[
        int, typer.Option(min=0, max=50, help="Rows whose crash the page shows: the best, and a spread.")
    ] = 24,
    page: Annotated[bool, typer.Option("--page/--no-page", help="Write study.html.")] = True,
    parquet: Annotated[bool, typer.Option("--parquet", help="Write study.parquet (needs pyarrow).")] = False,
) -> None:
    """Solve many variants of one input: sampling, probabilities, Sobol' indices, optimisation."""
    from crumple.cli.console.folder import results_errors, results_folder
    from crumple.cli.console.progress import progress_bar
    from crumple.study import LoadedStudy, is_target, run_study

    if part is not None:
        if merge or is_target(file):
            raise typer.BadParameter("a part is of a study alone, and is merged later", param_hint="--part")
        with _executor(scheduler, limit, workers) as (executor, count):
            _part(file, out, part, count, executor, resume=resume)
        return
    if is_target(file):
        with _executor(scheduler, limit, workers) as (executor, count):
            _target(file, out, count, executor, resume=resume)
        return
    loaded = LoadedStudy(file)
    if parquet:
        from crumple.study.table import refuse_without_parquet

        # before rows are solved
        refuse_without_parquet()
    begun = results_folder(out, file), _executor(scheduler, limit, workers)
    with begun[0] as folder, _resumable(file, folder), begun[1] as (executor, count):
        if not resume:
            _forget(folder)
        with progress_bar("solving") as progress, results_errors(folder):
            table, answer = run_study(
                loaded, folder, count, executor=executor, progress=progress, merge=merge
            )
        _show(answer)
        typer.echo(f"Results: {folder}  (study.sqlite, study.csv, study.json)")
        with results_errors(folder):
            if parquet:
                table.to_parquet(folder / "study.parquet")
            (folder / "study.html").unlink(missing_ok=True)
            if page:
                typer.echo(_page(loaded, table, answer, folder, shapes))
    if answer.complete == 0:
        raise typer.Exit(1)


@contextmanager
def _executor(
    scheduler: str | None, limit: float, workers: int | None
) -> Iterator[tuple[Executor | None, int]]:
    """The cluster, None without one, and the number of workers."""
    from crumple.portable import available_cores

    if scheduler is None:
        yield None, workers or available_cores()
        return
    from crumple.study.cluster import ClusterExecutor

    with ClusterExecutor(scheduler, limit) as executor:
        yield executor, executor.workers


@contextmanager
def _resumable(file: Path, folder: Path, *more: str, rows: Path | None = None) -> Iterator[None]:
    """Say after Ctrl-C or SIGTERM whether rows are kept, and which command goes on.

    `rows`: the folder of the rows, if it is not that of the command.
    """
    from crumple.portable import command_line, exit_code_of_stop, interrupt_on_termination
    from crumple.study.table import has_rows

    try:
        with interrupt_on_termination():
            yield
    except KeyboardInterrupt:
        again = ("crumple", "study", file, "--out", folder, *more)
        if has_rows(rows or folder):
            said = f"Stopped; the rows so far are kept. Go on with: {command_line(*again, '--resume')}"
        else:
            said = f"Stopped before the first row was kept. Begin again with: {command_line(*again)}"
        typer.echo(said, err=True)
        raise typer.Exit(exit_code_of_stop()) from None


def _part(
    file: Path, out: str | None, part: str, workers: int, executor: Executor | None, *, resume: bool
) -> None:
    """One part of a study; parts may be solved at the same time, each in a folder of its own."""
    from crumple.cli.console.folder import results_errors, results_folder
    from crumple.cli.console.progress import progress_bar
    from crumple.study import LoadedStudy, run_part
    from crumple.study.parts import part_file, read_part

    wanted, loaded = read_part(part), LoadedStudy(file)
    whole = Path(out) if out is not None else Path("out") / file.stem
    place = part_file(whole, wanted)
    with results_folder(place.parent, file) as folder, _resumable(file, whole, "--part", part, rows=folder):
        if not resume:
            _forget(folder, (place.name,))
        with progress_bar("solving") as progress, results_errors(place.parent):
            rows, solved = run_part(loaded, whole, wanted, workers, executor=executor, progress=progress)
    typer.echo(f"Part {part}: {rows} rows, {solved} solved now")
    typer.echo(f"Results: {place}  (join all parts with --merge)")


def _page(study: LoadedStudy, table: Table, answer: Answer, folder: Path, shapes: int) -> str:
    """Write ``study.html`` with the crash of at most so many rows, and say what it has."""
    from crumple.report.study_page import write_study_page
    from crumple.study.page_data import page_data, rows_alike
    from crumple.study.shapes import chosen_for_shapes, solved_for_shapes

    data = page_data(study, table, answer)
    rows = chosen_for_shapes(study, table, answer, shapes) if shapes else []
    data["alike"] = rows_alike(table, data["rows"], rows)
    page, shown = write_study_page(data, solved_for_shapes(study, table, rows), folder)
    said = f"{len(data['rows'])} of {len(table.rows)} rows, the crash of {len(shown)}"
    return f"Page: {page}  ({said})"


def _forget(folder: Path, names: tuple[str, ...] = ()) -> None:
    """Remove the rows of an earlier study, or these files of rows."""
    from crumple.study.table import FILE, VERIFY_FILE

    for name in names or (FILE, VERIFY_FILE):
        for old in (folder / name, folder / f"{name}-journal"):
            old.unlink(missing_ok=True)


def _target(file: Path, out: str | None, workers: int, executor: Executor | None, *, resume: bool) -> None:
    """Lightest walls of each base, ranked."""
    from crumple.cli.console.folder import results_errors, results_folder
    from crumple.cli.console.progress import progress_bar
    from crumple.study import LoadedTarget, run_target
    from crumple.units import format_quantity

    loaded = LoadedTarget(file)
    with results_folder(out, file) as folder, _resumable(file, folder):
        for name in loaded.studies if not resume else ():
            _forget(folder / name)
        with progress_bar("solving") as progress, results_errors(folder):
            found = run_target(loaded, folder, workers, progress, executor=executor)
        for i, one in enumerate(found, 1):
            rows = f"{one.answer.rows} variants solved"
            if one.best is None:
                typer.echo(f"{i}. {one.name}: {one.reason}")
                continue
            walls = ", ".join(
                f"{name} {format_quantity(value, 'm')}" for name, value in one.best["variables"].items()
            )
            kept = ", ".join(
                f"{name} {format_quantity(one.best['responses'][name], one.answer.units[name])}"
                for name in loaded.file.target.criteria
            )
            typer.echo(f"{i}. {one.name}: {format_quantity(one.mass, 'kg')} with {walls}; {kept} ({rows})")
            for change in one.answer.law_changes:
                typer.echo(f"   {change['text']}")
        typer.echo(f"Results: {folder}  (ranking.csv, ranking.json, a folder for each base)")
    if all(one.best is None for one in found):
        raise typer.Exit(1)


def _show(answer: Answer) -> None:
    """Print what the rows say."""
    from crumple.study.answer import remarks
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
    for remark in remarks(answer):
        typer.echo(remark)
    _show_indices(answer.indices)
    if answer.best is not None:
        values = ", ".join(f"{key} {_plain(value)}" for key, value in answer.best["variables"].items())
        typer.echo(f"best row {answer.best['row']}: {values} (SI units)")
        for name, value in answer.best["responses"].items():
            typer.echo(f"  {name}: {text(value, name)}")
    _show_front(answer, text)
    if answer.verification is not None:
        _show_verification(answer.verification, text)


def _show_indices(indices: Mapping[str, Any] | str) -> None:
    """Print Sobol' indices, or why there are none."""
    if isinstance(indices, str):
        typer.echo(indices)
        return
    for name, by_variable in indices.items():
        for reason in {found["reason"] for found in by_variable.values() if "reason" in found}:
            typer.echo(f"no Sobol' indices of {name}: {reason}")
        for variable, found in by_variable.items():
            if "reason" not in found:
                values = f"first order {found['first']:.3f}, total {found['total']:.3f}"
                typer.echo(f"Sobol' indices of {name} for {variable}: {values}")


def _show_front(answer: Answer, text: Callable[[float, str], str]) -> None:
    """Print the ends of the Pareto front."""
    if not answer.front:
        return
    typer.echo(f"Pareto front of {len(answer.front)} rows (front.csv), its ends:")
    for one in (answer.front[0], answer.front[-1]):
        values = ", ".join(f"{name} {text(value, name)}" for name, value in one["responses"].items())
        typer.echo(f"  row {one['row']}: {values}")


def _show_verification(found: Mapping[str, Any], text: Callable[[float, str], str]) -> None:
    """Print what the slower model says."""
    for name, one in found["responses"].items():
        if "rms_error" not in one:
            typer.echo(f"verification of {name}: no row has both values")
            continue
        error, mean = text(one["rms_error"], name), text(one["mean_slow"], name)
        line = (
            f"verification of {name}, {one['rows']} rows: error {error} (root mean square) of {mean} (mean)"
        )
        if one["tau"] is not None:
            line += f"; rank correlation tau-b of {one['sample']} random rows {one['tau']:.2f}"
        if one["interval"] is not None:
            line += " (95 % interval {:.2f} to {:.2f})".format(*one["interval"])
        typer.echo(line)
    for row in found["rejected"]:
        typer.echo(f"rejected: row {row} does not keep the constraints by the slower model, or has no result")
    if found["best"] is not None:
        slow = ", ".join(f"{name} {text(value, name)}" for name, value in found["best"]["slow"].items())
        typer.echo(f"verified best row {found['best']['row']}: {slow}")


def _plain(value: float | str) -> str:
    return value if isinstance(value, str) else f"{value:.6g}"
