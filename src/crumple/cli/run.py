"""`crumple run FILE`: solve an input file, store the result and print a summary."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from crumple.cli.console.beside import Moded, Uncertain, say_no_modes, with_its_modes, with_scatter
from crumple.cli.console.fidelity import Fidelity
from crumple.cli.console.laws import Freeze, Laws, law_lines, range_lines, with_range, with_store

if TYPE_CHECKING:
    from crumple.analysis import LoadedInput
    from crumple.result import Result

QUICK = 5.0
"""Processor time of a run up to which range from the hinge laws and modes are computed unasked [s].
Wall time depends on what else the machine does, and what a run reports must not."""


def run(
    file: Annotated[Path, typer.Argument(help="Input file (YAML).", show_default=False)],
    *,
    out: Annotated[
        str | None,
        typer.Option(
            metavar="FOLDER", help="Folder for the results; by default out/ and the input file's name."
        ),
    ] = None,
    fidelity: Annotated[Fidelity, typer.Option(help="Which solver.")] = Fidelity.MULTIBODY,
    threads: Annotated[
        int | None, typer.Option(help="Threads; by default all cores.", min=1, show_default=False)
    ] = None,
    restart: Annotated[
        Path | None,
        typer.Option(help="Continue from the restart file of an interrupted shell run.", show_default=False),
    ] = None,
    laws: Laws = None,
    freeze_laws: Freeze = None,
    law_range: Annotated[
        bool | None,
        typer.Option(
            "--law-range/--no-law-range",
            help="Solve also with the laws at the edges of their bands: all low, all high, alternating; by "
            "default if the run took less than 5 s of processor time.",
            show_default=False,
        ),
    ] = None,
    modes: Moded = None,
    uncertainty: Uncertain = True,
    explore: Annotated[
        str | None,
        typer.Option(
            metavar="NUMBERS",
            help="Solve also a grid of one or two numbers of the input, as 'thickness,mass=200 kg..400 kg' "
            "(without a range +- 30 %), and write explore.html with sliders.",
            show_default=False,
        ),
    ] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print summary.json instead of the table.")] = False,
) -> None:
    """Solve an input file and report. Writes summary, histories, shapes, figures and a page to a folder."""
    from crumple.analysis import load_input
    from crumple.cli.console.folder import results_folder

    source = with_store(load_input(file), laws, freeze_laws)
    if restart is not None and fidelity is not Fidelity.SHELL:
        raise typer.BadParameter("only shell runs have restart files", param_hint="--restart")
    if explore is not None:
        from crumple.cli.console.exploring import checked

        checked(explore, source, fidelity)
    both = fidelity is Fidelity.BOTH
    within = tuple(one.value for one in fidelity.solvers) if both else ()
    with results_folder(out, file, within) as folder:
        also = (law_range, modes, uncertainty)
        good = _run(source, folder, (fidelity, threads, restart), also, as_json=as_json)
        from crumple.cli.console.exploring import explored

        explored(explore if good else None, source, folder, quiet=as_json)
    if not good:
        raise typer.Exit(1)


def _run(
    source: LoadedInput,
    folder: Path,
    how: tuple[Fidelity, int | None, Path | None],
    also: tuple[bool | None, bool | None, bool],
    *,
    as_json: bool,
) -> bool:
    """Solve with every requested solver and report; returns whether all results can be trusted."""
    from crumple.errors import Status

    fidelity, threads, restart = how
    summaries, good = {}, True
    for one in fidelity.solvers:
        place = folder / one.value if fidelity is Fidelity.BOTH else folder
        result = _solve(source, place, (one, threads, restart), also)
        good = good and result.status.ok
        if as_json:
            summaries[one.value] = _summary(result)
        else:
            _show(result, place, source)
            _show_restart(source.path, place)
        if result.status is Status.CANCELLED:
            # a user who stops the first run does not want the second one
            break
    if as_json:
        import json

        from crumple.portable import console_takes_all

        content = summaries if fidelity is Fidelity.BOTH else next(iter(summaries.values()))
        typer.echo(json.dumps(content, indent=2, ensure_ascii=not console_takes_all(), allow_nan=False))
    return good


def _solve(
    source: LoadedInput,
    folder: Path,
    how: tuple[Fidelity, int | None, Path | None],
    also: tuple[bool | None, bool | None, bool],
) -> Result:
    """Solve with one solver and write its files.

    `how`: solver, threads, restart file; `also`: whether range from the laws, modes and scatter are wanted.
    """
    from crumple.analysis import solve_with_frames
    from crumple.cli.console.progress import progress_bar
    from crumple.cli.console.shell_run import long_run_of, remove_restart
    from crumple.cli.console.storing import store
    from crumple.errors import CancelledError, InputError, Status
    from crumple.portable import available_cores, stop_on_interrupt

    fidelity, threads, restart = how
    is_shell = fidelity is Fidelity.SHELL
    with _discarding(), stop_on_interrupt() as cancel:
        begin = time.process_time()
        try:
            with progress_bar("solving") as progress:

                def asked() -> bool:
                    progress.preparing()
                    return cancel()

                result, frames = solve_with_frames(
                    source.analysis,
                    fidelity.value,
                    threads=threads or (available_cores() if is_shell else 1),
                    progress=progress,
                    cancel=asked,
                    long_run=long_run_of(folder, restart, progress) if is_shell else None,
                )
        except InputError as error:
            raise source.with_lines(error) from None
        if not result.time.size:
            raise CancelledError(result.reason)
        worked = time.process_time() - begin
        quick, sound = worked < QUICK, not is_shell and result.status.ok
        if sound and not quick:
            _say_left_out(worked, also)
        if sound and (quick if also[0] is None else also[0]):
            result = with_range(result, source, threads or available_cores(), cancel)
        if sound and (quick if also[1] is None else also[1]):
            result = with_its_modes(result, source, threads or available_cores(), cancel)
            if also[1] and result.modes is None:
                say_no_modes(source)
        if also[2] and sound:
            result = with_scatter(result, source, threads or available_cores(), cancel)
        # still inside: Ctrl-C while figures are drawn must not lose the result
        if result.status is Status.CANCELLED:
            typer.echo("Stopped. Writing the results so far; another Ctrl-C discards them.", err=True)
        store(result, source, folder, frames)
    if is_shell:
        remove_restart(folder, result)
    return result


def _say_left_out(seconds: float, also: tuple[bool | None, bool | None, bool]) -> None:
    """Say what a run that takes long goes without, unless that was decided."""
    from crumple.units import format_quantity

    words = {"--law-range": "the range from the laws", "--modes": "the modes of collapse"}
    left = [option for option, asked in zip(words, also, strict=False) if asked is None]
    if left:
        what = " and ".join(words[option] for option in left)
        took, quick = format_quantity(seconds, "s", 3), format_quantity(QUICK, "s")
        took += f" of processor time ({quick} at most)"
        typer.echo(f"Without {what}, since the run took {took}: {' '.join(left)}", err=True)


@contextmanager
def _discarding() -> Iterator[None]:
    """Report what is lost by a second Ctrl-C; the first is noted and stops the run."""
    from crumple.errors import CancelledError

    try:
        yield
    except KeyboardInterrupt:
        raise CancelledError("ended by a second Ctrl-C: no results of this run were kept") from None


def _summary(result: Result) -> dict[str, Any]:
    from crumple.result import summary

    return summary(result)


def _show_restart(file: Path, folder: Path) -> None:
    """Print the command that continues an interrupted shell run."""
    from crumple.cli.console.shell_run import RESTART
    from crumple.portable import command_line

    if (folder / RESTART).exists():
        words = ("--fidelity", "shell", "--out", folder, "--restart", folder / RESTART)
        typer.echo(f"Continue with: {command_line('crumple', 'run', file, *words)}")


def _show(result: Result, folder: Path, source: LoadedInput) -> None:
    """Print the table of hinges, the values of the whole run, the warnings, and the paths of the files."""
    from rich.console import Console
    from rich.text import Text

    from crumple.cli.tables import MOST_HINGES, hinge_tables, most_yielding, output_tables
    from crumple.report.wording.key_figures import between_hinges
    from crumple.report.wording.scatter import sentences as sentences_of_scatter
    from crumple.result import sentences
    from crumple.units import format_quantity

    console = Console(highlight=False)
    console.print(Text(result.title, style="bold"))
    status = result.status.value + (f": {result.reason}" if result.reason else "")
    console.print(Text(f"Status: {status}", style="green" if result.status.ok else "bold red"))
    # a violated law is already in the reason of the status
    first = sentences(caution for caution in result.cautions if not caution.violation)
    for caution in first:
        console.print(Text(f"Caution: {caution}", style="bold yellow"))
    bending = {name: hinge for name, hinge in result.hinges.items() if hinge.bends}
    crushing = {name: hinge for name, hinge in result.hinges.items() if hinge.crush is not None}
    for table in (
        *output_tables(result, source.analysis.outputs.clearances),
        *hinge_tables(result, bending, crushing),
    ):
        console.print(table)
    if max(len(bending), len(crushing)) > MOST_HINGES:
        console.print(
            f"At most {MOST_HINGES} of {len(result.hinges)} hinges, those with the largest absorbed energy"
        )
    if result.hinges and (rest := between_hinges(result)) > 0.0:
        where = most_yielding(result)
        console.print(f"Members absorbed {format_quantity(rest, 'J')} more between hinges{where}")
    for line in range_lines(result):
        console.print(Text(line), soft_wrap=True)
    if result.modes is not None and result.modes.unique:
        console.print(Text(result.modes.sentence), soft_wrap=True)
    for line in sentences_of_scatter(result):
        console.print(Text(line), soft_wrap=True)
    for line in law_lines(result, source):
        console.print(Text(line), soft_wrap=True)
    console.print(
        f"Energy residual {result.energy_residual:.2g} of the energy input; "
        f"solved in {format_quantity(result.solve_seconds, 's', 3)}"
    )
    for warning in result.warnings:
        if warning in first:
            continue
        console.print(Text(f"Warning: {warning}", style="yellow"))
    console.print(Text(f"Results: {folder}  (open {folder / 'report.html'})"), soft_wrap=True)
