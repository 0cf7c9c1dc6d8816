"""`crumple compare FILE`: solve an input file with both solvers and compare the results."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from crumple.cli.console.laws import Freeze, Laws, law_lines, with_store

if TYPE_CHECKING:
    from collections.abc import Iterator

    from crumple.analysis import Analysis, LoadedInput
    from crumple.comparison import Comparison
    from crumple.result import Result

PAGE = "report.html"
MOST_HINGES = 8
"""Number of hinges in the table, those with the largest absorbed energy; the page lists more."""


def compare(
    file: Annotated[Path, typer.Argument(help="Input file (YAML).", show_default=False)],
    *,
    out: Annotated[
        str | None, typer.Option(help="Folder for the results; by default out/ and the input file's name.")
    ] = None,
    curve: Annotated[
        list[str] | None,
        typer.Option(
            help="name=file.csv: histories from a test or another code; repeat for several.",
            show_default=False,
        ),
    ] = None,
    pair: Annotated[
        list[str] | None,
        typer.Option(
            help="column=history: pair a column of a curve file with a history; column=-history if "
            "it has the opposite sign.",
            show_default=False,
        ),
    ] = None,
    threads: Annotated[
        int | None,
        typer.Option(help="Threads of the shell run; by default all cores.", min=1, show_default=False),
    ] = None,
    second_mesh: Annotated[
        float | None,
        typer.Option(
            help="Solve the shell model again with the element size times this factor (2, 0.5): mesh "
            "sensitivity of the reference.",
            show_default=False,
        ),
    ] = None,
    variants: Annotated[
        bool,
        typer.Option(
            help="Solve also multibody models with elastic hinges and members, the range from the bands of "
            "the hinge laws, and the modes of an impact."
        ),
    ] = True,
    restart: Annotated[
        Path | None,
        typer.Option(
            help="Continue from the restart file of the shell run of an interrupted comparison.",
            show_default=False,
        ),
    ] = None,
    laws: Laws = None,
    freeze_laws: Freeze = None,
) -> None:
    """Solve with both engines and compare. Writes multibody/, shell/ and report.html to a folder."""
    from crumple.analysis import load_input
    from crumple.cli.console.curves import curves_of
    from crumple.cli.console.folder import results_folder
    from crumple.cli.console.shell_run import RESTART, remove_restart
    from crumple.cli.console.storing import report_input, stored
    from crumple.comparison import picture_times, with_mesh
    from crumple.portable import command_line, stop_on_interrupt
    from crumple.report import write_comparison

    source = with_store(load_input(file), laws, freeze_laws)
    curves = curves_of(curve or [], pair or [])
    if second_mesh is not None:
        # refused before the folder is made, and before the first mesh is solved
        _refuse_mesh(with_mesh(source.analysis, second_mesh), second_mesh)
    with results_folder(out, file, ("multibody", "shell")) as folder:
        options = {"curves": curves, "variants": variants, "second_mesh": second_mesh}
        with stop_on_interrupt() as cancel:
            found = _solve(source, folder, (threads, restart), cancel, options)
            shown, pictures = report_input(source), picture_times(source.analysis)
            stored(folder, lambda place: write_comparison(found, shown, place, pictures=pictures), PAGE)
        remove_restart(folder / "shell", found.reference.result)
        _show(found, folder, source)
        if (folder / "shell" / RESTART).exists():
            more = command_line("--restart", folder / "shell" / RESTART)
            typer.echo(f"Continue with the same command and {more}")
    if not all(s.result.status.ok for s in (found.candidate, found.reference)):
        raise typer.Exit(1)


def _solve(
    source: LoadedInput,
    folder: Path,
    how: tuple[int | None, Path | None],
    cancel: Callable[[], bool],
    options: Mapping[str, Any],
) -> Comparison:
    """Solve everything; each engine's result is on the disk as soon as there is one."""
    from crumple.cli.console.progress import progress_bar
    from crumple.cli.console.refusal import show_refusal
    from crumple.cli.console.shell_run import long_run_of
    from crumple.cli.console.storing import store
    from crumple.comparison import picture_times, solve_and_compare, with_pictures
    from crumple.errors import InputError
    from crumple.portable import available_cores

    threads, restart = how

    def keep(result: Result) -> None:
        # the page of an earlier comparison is not of these results
        (folder / PAGE).unlink(missing_ok=True)
        try:
            fewer = with_pictures(result, picture_times(source.analysis))
            store(fewer, source, folder / result.fidelity, result)
        except InputError as error:
            # what is solved can still be compared
            show_refusal(error)

    with progress_bar("solving") as progress:
        try:
            return solve_and_compare(
                source.analysis,
                threads=threads or available_cores(),
                progress=progress,
                cancel=cancel,
                long_run=long_run_of(folder / "shell", restart, progress),
                keep=keep,
                **options,
            )
        except InputError as error:
            raise source.with_lines(error) from None


def _refuse_mesh(analysis: Analysis, factor: float) -> None:
    """Refuse a second mesh that the shell solver does not accept."""
    from dataclasses import replace

    from crumple.cli.console.shell_run import shell_notes
    from crumple.errors import InputError

    try:
        shell_notes(analysis)
    except InputError as error:
        asked = f"--second-mesh {factor:g}"
        problems = [replace(p, what=f"{p.what}, with {asked}", where=asked) for p in error.problems]
        raise InputError(problems) from None


def _crush_lines(found: Comparison) -> Iterator[str]:
    """Crush length and mean force of every member that can shorten, in both results."""
    from rich.markup import escape

    names = found.candidate.name, found.reference.name
    for crush in found.crushes:
        figures = []
        for name, side in zip(names, (crush.first, crush.second), strict=True):
            length = f"{1e3 * side.length:.1f} mm" if side else "not known"
            force = f" at a mean force of {side.mean_force / 1e3:.2f} kN" if side and side.mean_force else ""
            figures.append(f"{length}{force} ({name})")
        yield f"Member {escape(crush.member)} is crushed by {figures[0]} and {figures[1]}"


def _contact_lines(found: Comparison) -> Iterator[str]:
    """Impulse and dissipation at the contacts of obstacles in both results, and what contact took."""
    from rich.markup import escape

    from crumple.comparison.measure.decisive import CONTACT_TARGETS
    from crumple.units import format_quantity

    names = found.candidate.name, found.reference.name
    dissipation = "dissipation at contact"
    for kind, unit in zip(CONTACT_TARGETS, ("N*s", "J"), strict=True):
        for figure in found.figures.get(kind, ()):
            values = (
                f"{format_quantity(value, unit, 4)} ({name})"
                for name, value in zip(names, (figure.model, figure.shell), strict=True)
            )
            mark = "" if figure.right else ", beyond its target"
            yield f"Obstacle {escape(figure.name)}, {kind}: {', '.join(values)}{mark}"
    if found.figures.get(dissipation):
        yield (
            f"{dissipation.capitalize()}: plastic work within one side of the section of the place of "
            "contact, with the energies of contact and friction if only one obstacle presses"
        )


def _show(found: Comparison, folder: Path, source: LoadedInput | None = None) -> None:
    """Print the verdict, a table of hinges, cautions, times, and where the files are."""
    import math

    from rich.console import Console
    from rich.markup import escape
    from rich.table import Table
    from rich.text import Text

    from crumple.report import curve_notes
    from crumple.report.wording.comparison_wording import busy_note, ranked, signed_percent, times_faster
    from crumple.report.wording.law_range import shell_range_sentence
    from crumple.units import format_quantity

    console = Console(highlight=False)
    console.print(Text(found.title, style="bold"))
    style = {"good": "green", "caution": "yellow"}.get(found.trust.level, "bold red")
    console.print(Text(found.trust.headline, style=style))
    first, second = found.candidate.name, found.reference.name
    table = Table()
    table.add_column("Hinge", overflow="fold")
    for head in (f"{first}, deg", f"{second}, deg", "Differs", "Energy differs", "Rating"):
        table.add_column(head, justify="right")
    for hinge in ranked(found)[:MOST_HINGES]:
        error = hinge.error("rotation_max")
        energy = max((abs(e) for e in hinge.energy_errors() if e is not None), default=None)
        channel = f"hinge.{hinge.name}.rotation"
        rated = next((p.rating for p in found.pairs if (p.channel, p.candidate) == (channel, first)), None)
        table.add_row(
            escape(hinge.name),
            *(f"{math.degrees(m.rotation_max):.2f}" if m else "-" for m in (hinge.first, hinge.second)),
            signed_percent(error),
            "-" if energy is None else f"{100 * energy:.1f} %",
            "-" if rated is None else f"{rated.overall:.2f}",
        )
    console.print(table)
    for line in (*_contact_lines(found), *_crush_lines(found)):
        console.print(line)
    if len(found.hinges) > MOST_HINGES:
        console.print(f"{MOST_HINGES} of {len(found.hinges)} hinges, those with the largest absorbed energy")
    if told := shell_range_sentence(found):
        console.print(f"Range from the hinge laws: {told[:1].lower()}{told[1:]}", markup=False)
    for line in () if source is None else law_lines(found.candidate.result, source):
        console.print(Text(line), soft_wrap=True)
    times = [
        f"{format_quantity(source.result.solve_seconds, 's', 3)} ({source.with_threads})"
        for source in (found.candidate, found.reference)
    ]
    ratio = f": {times_faster(found, found.candidate.result.solve_seconds)} times faster"
    console.print(f"Solved in {times[0]} and {times[1]}{ratio if found.speed_ratio else ''}")
    timing = found.timings.get(first)
    if timing is not None and found.speed_ratio:
        again = f"{format_quantity(timing.again, 's', 3)}: {times_faster(found, timing.again)} times faster"
        also = f"; stepping alone {times_faster(found, timing.stepping)} times" if timing.stepping else ""
        console.print(f"Solved again, {first} took {again}{also}")
    if waited := busy_note(found):
        console.print(waited)
    for curve, compared in curve_notes(found):
        console.print(Text(f"Curve {curve}", style="" if compared else "yellow"))
    for caution in found.trust.cautions:
        console.print(Text(f"Caution: {caution}", style="yellow"))
    console.print(Text(f"Results: {folder}  (open {folder / 'report.html'})"), soft_wrap=True)
