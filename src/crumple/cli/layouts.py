"""`crumple layouts FILE FILE...`: solve several layouts of one structure and compare them in one table."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from crumple.cli.console.laws import Freeze, Laws, law_lines, with_range, with_store, write_frozen

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from crumple.analysis import LoadedInput
    from crumple.report import Layout

PAGE = "report.html"


def layouts(
    files: Annotated[list[Path], typer.Argument(help="Input files (YAML).", show_default=False)],
    *,
    out: Annotated[str, typer.Option(metavar="FOLDER", help="Folder for the results.")] = "out/layouts",
    title: Annotated[str, typer.Option(help="Title of the page.")] = "Layouts",
    laws: Laws = None,
    freeze_laws: Freeze = None,
    law_range: Annotated[
        bool,
        typer.Option(
            help="Solve also with the laws at the edges of their bands, and state whether the order of the "
            "layouts changes."
        ),
    ] = True,
) -> None:
    """Solve several layouts as multibody models and compare them. A layout that fails has a row."""
    from crumple.cli.console.folder import results_folder
    from crumple.cli.console.progress import progress_bar
    from crumple.cli.console.storing import stored
    from crumple.portable import stop_on_interrupt
    from crumple.report import write_layouts

    names = _names(files)
    with results_folder(out, files[0], tuple(names)) as folder:
        found: list[Layout] = []
        sources: dict[str, LoadedInput] = {}
        with stop_on_interrupt() as cancel:
            with progress_bar("solving") as progress:
                for i, (name, file) in enumerate(zip(names, files, strict=True)):
                    used = (laws, sources, law_range)
                    found.append(_solved(name, file, folder / name, cancel, used))
                    progress((i + 1) / len(files))
                    if cancel():
                        break
            stored(folder, lambda place: write_layouts(found, title, place), PAGE)
        _show(found, folder)
        _show_laws(found, sources)
        if freeze_laws is not None:
            write_frozen(list(sources.values()), freeze_laws)
    if not all(layout.result is not None and layout.result.status.ok for layout in found):
        raise typer.Exit(1)


def _names(files: list[Path]) -> list[str]:
    """A name for each file, its stem; numbered if two are the same."""
    stems = [file.stem for file in files]
    return [
        stem if stems.count(stem) == 1 else f"{stem}-{stems[: i + 1].count(stem)}"
        for i, stem in enumerate(stems)
    ]


def _solved(
    name: str,
    file: Path,
    folder: Path,
    cancel: Callable[[], bool],
    used: tuple[Path | None, dict[str, LoadedInput], bool],
) -> Layout:
    """One layout: read, solved and written to its folder; if it is refused, the reason is kept.

    `used`: store of laws; the inputs that were read, to which this one is added; whether a range is wanted.
    """
    from crumple.analysis import load_input, solve_with_frames
    from crumple.cli.console.storing import store
    from crumple.errors import InputError
    from crumple.portable import available_cores
    from crumple.report import Layout

    try:
        source = with_store(load_input(file), used[0])
        used[1][name] = source
        result, frames = solve_with_frames(source.analysis, cancel=cancel)
    except InputError as error:
        first, more = error.problems[0], len(error.problems) - 1
        place = f" ({first.where})" if first.where else ""
        return Layout(name, reason=f"{first.what}{place}" + (f", and {more} more problems" if more else ""))
    if not result.time.size:
        return Layout(name, reason=result.reason)
    if used[2] and result.status.ok:
        result = with_range(result, source, available_cores(), cancel)
    store(result, source, folder, frames)
    analysis = source.analysis
    return Layout(
        name,
        analysis.title,
        analysis.structure.mass_of_members,
        result,
        frames=frames,
        structure=analysis.structure,
    )


def _show_laws(found: list[Layout], sources: Mapping[str, LoadedInput]) -> None:
    """Print the origins of the laws of all layouts, each once."""
    lines = [
        line
        for layout in found
        if layout.result is not None
        for line in law_lines(layout.result, sources[layout.name])
    ]
    for line in dict.fromkeys(lines):
        typer.echo(line)


def _show(found: list[Layout], folder: Path) -> None:
    """Print the table, and where the files are."""
    from rich.console import Console
    from rich.markup import escape
    from rich.table import Table
    from rich.text import Text

    from crumple.report import layout_table, order_notes

    console = Console(highlight=False)
    content = layout_table(found)
    table = Table()
    for i, head in enumerate(content.heads):
        table.add_column(escape(head), justify="left" if i < 2 else "right")
    for row in content.rows:
        table.add_row(*(escape(cell) for cell in row))
    console.print(table)
    for line in order_notes(found):
        console.print(Text(line), soft_wrap=True)
    for layout in found:
        if layout.result is None:
            console.print(Text(f"{layout.name}: {layout.reason}", style="bold red"))
    console.print(Text(f"Results: {folder}  (open {folder / 'report.html'})"), soft_wrap=True)
