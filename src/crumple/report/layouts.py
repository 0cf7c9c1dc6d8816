"""Several layouts of one structure side by side: one page, one table; failed layouts are rows too."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from crumple.portable import write_text
from crumple.report.report import write_figures

if TYPE_CHECKING:
    from crumple.report.scene.scene import Scene
    from crumple.report.wording.wording import Table
    from crumple.result import Result
    from crumple.structure import Structure

OPEN = 1e-3
"""Largest rotation [rad] above which a hinge counts as open: a visible bend."""
MOST_SHOWN = 3
"""Most layouts that move side by side."""
MOST_OUTPUTS = 8
"""Most requested outputs with a panel in the figure; the table and the files contain all."""


@dataclass(frozen=True, eq=False)
class Layout:
    """One layout and its result.

    Attributes
    ----------
    name
        Short, unique among the layouts; the name of its folder.
    title
        Of its analysis.
    mass
        Of its members [kg], without lumped masses; None if the layout could not be read.
    result
        None if the solver refused it.
    reason
        Why there is no result.
    frames, structure
        The same result with more shapes, and what was described, for the viewer.
    """

    name: str
    title: str = ""
    mass: float | None = None
    result: Result | None = None
    reason: str = ""
    frames: Result | None = None
    structure: Structure | None = None

    @property
    def absorbed(self) -> float:
        """Energy that its structure dissipated [J]; NaN without a result."""
        if self.result is None or "energy.dissipated" not in self.result.channels:
            return float("nan")
        return float(self.result["energy.dissipated"][-1])

    @property
    def status(self) -> str:
        """Status of the layout, in words."""
        return self.result.status.value if self.result is not None else "refused"

    def range_of(self, quantity: str) -> tuple[float, float] | None:
        """Range of a quantity from the bands of its hinge laws [SI]; None if it has none."""
        known = self.result is not None and self.result.law_range is not None
        return self.result.law_range.of(quantity) if known else None  # type: ignore[union-attr]


def write_layouts(layouts: Sequence[Layout], title: str, directory: Path | str) -> Path:
    """Write ``layouts.csv``, ``figures/`` and ``report.html`` for several layouts.

    Parameters
    ----------
    layouts
        In the order of the table; the page of each is expected in a folder of its name.
    title
        Of the page.
    directory
        Made when absent.

    Returns
    -------
    Path
        The page.

    Raises
    ------
    OSError
        If the folder cannot be written.
    """
    folder = Path(directory)
    from crumple.report.scene.page import store_scene  # noqa: PLC0415

    names = common_outputs(layouts)
    write_text(folder / "layouts.csv", _csv(layouts, names))
    drawn = _draw(layouts, names)
    write_figures(folder, drawn)
    scene = _scene(layouts, title)
    store_scene(scene, folder)
    page = folder / "report.html"
    write_text(page, _render(layouts, title, (names, drawn), scene))
    return page


def common_outputs(layouts: Sequence[Layout]) -> list[str]:
    """Requested outputs of all solved layouts that are not zero in all of them, in the order of the first."""
    results = [layout.result for layout in layouts if layout.result is not None]
    if not results:
        return []
    shared = [name for name in results[0].output_names if all(name in result.outputs for result in results)]
    largest = {name: max(abs(result.outputs[name].max) for result in results) for name in shared}
    unit = {name: results[0].channels[name].unit for name in shared}
    most = {unit[name]: max(largest[n] for n in shared if unit[n] == unit[name]) for name in shared}
    return [name for name in shared if largest[name] > 1e-9 * most[unit[name]]]


def layout_table(layouts: Sequence[Layout]) -> Table:
    """One row per layout: mass, energy, hinges, each column in one unit."""
    from crumple.report.wording.wording import Table, column, percent  # noqa: PLC0415

    nan = float("nan")
    absorbed = [layout.absorbed for layout in layouts]
    masses = [nan if layout.mass is None else layout.mass for layout in layouts]
    heads, columns = ["Layout", "Status"], [[x.name for x in layouts], [x.status for x in layouts]]

    def add(head: str, values: Sequence[float], unit: str, suffix: str = "") -> None:
        shown, cells = column(values, unit)
        heads.append(f"{head}, {shown}{suffix}" if shown else head)
        columns.append(list(cells))

    add("Mass of members", masses, "kg")
    add("Energy absorbed", absorbed, "J")
    per_mass = [e / m if m else nan for e, m in zip(absorbed, masses, strict=True)]
    add("Energy by mass", per_mass, "J", "/kg")
    heads.append("Hinges open")
    columns.append([_open_hinges(layout) for layout in layouts])
    heads.append("Energy residual")
    columns.append([percent(x.result.energy_residual) if x.result else "—" for x in layouts])
    add("Solved in", [x.result.solve_seconds if x.result else nan for x in layouts], "s")
    rows = list(zip(*columns, strict=True))
    return Table("Mass and absorbed energy of each layout.", tuple(heads), rows, frozenset({1}))


def _output_table(layouts: Sequence[Layout], outputs: Sequence[str]) -> Table:
    """One row per requested output: its value of largest magnitude in every solved layout."""
    from crumple.report.wording.wording import Table, column  # noqa: PLC0415

    solved = [(layout.name, layout.result) for layout in layouts if layout.result is not None]
    rows = []
    for name in outputs:
        values = [result.outputs[name].max for _, result in solved]
        unit, cells = column(values, solved[0][1].channels[name].unit)
        rows.append((f"{name}, {unit}" if unit else name, *cells))
    heads = ("Output", *(name for name, _ in solved))
    return Table("Largest magnitude of each requested output.", heads, rows)


def _tables(layouts: Sequence[Layout], outputs: Sequence[str]) -> Iterator[Table]:
    """Those of the page; one may have no rows."""
    from crumple.report.wording.layout_order import order_table  # noqa: PLC0415

    yield layout_table(layouts)
    yield _output_table(layouts, outputs)
    yield order_table(_complete(layouts), _ordered_by(outputs))


def order_notes(layouts: Sequence[Layout]) -> list[str]:
    """Whether the order of the layouts changes within the bands of their hinge laws, by quantity."""
    from crumple.report.wording.layout_order import order_sentences  # noqa: PLC0415

    return order_sentences(_complete(layouts), _ordered_by(common_outputs(layouts)))


def _complete(layouts: Sequence[Layout]) -> dict[str, Result]:
    return {x.name: x.result for x in layouts if x.result is not None and x.result.status.ok}


def _ordered_by(outputs: Sequence[str]) -> list[str]:
    return [*outputs, "energy.dissipated"]


def _open_hinges(layout: Layout) -> str:
    if layout.result is None:
        return "—"
    hinges = layout.result.hinges
    return f"{sum(hinge.rotation_max > OPEN for hinge in hinges.values())} of {len(hinges)}"


def _csv(layouts: Sequence[Layout], outputs: Sequence[str]) -> str:
    """The table as data in SI, one row per layout; cells without a value are empty."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    units = {name: x.result.channels[name].unit for x in layouts if x.result for name in outputs}
    heads = ["layout", "title", "status", "reason", "mass [kg]", "energy absorbed [J]", "energy residual"]
    heads += ["solve time [s]"]
    ranged = ["energy.dissipated", *(n for n in outputs if any(x.range_of(n) for x in layouts))]
    units["energy.dissipated"] = "J"
    heads += [f"{name} {kind} [{units[name]}]" for name in outputs for kind in ("final", "max")]
    heads += [f"{name} final {kind} [{units[name]}]" for name in ranged for kind in ("least", "largest")]
    writer.writerow(heads)
    for layout in layouts:
        row: list[Any] = [layout.name, layout.title, layout.status, layout.reason, layout.mass]
        if layout.result is not None:
            row += [layout.absorbed, layout.result.energy_residual, layout.result.solve_seconds]
            summaries = (layout.result.outputs[name] for name in outputs)
            row += [value for output in summaries for value in (output.final, output.max)]
            row += [value for name in ranged for value in layout.range_of(name) or (None, None)]
        row += [None] * (len(heads) - len(row))
        writer.writerow(["" if value is None else value for value in row])
    return text.getvalue()


def _draw(layouts: Sequence[Layout], outputs: Sequence[str]) -> list[tuple[str, str, str]]:
    """File name, SVG and caption of every figure for which there are data."""
    from crumple.report.drawing.style import drawing  # noqa: PLC0415
    from crumple.report.figures import layouts_figures as figures  # noqa: PLC0415

    solved = [(layout.name, layout.result) for layout in layouts if layout.result is not None]
    with drawing():
        found = [
            ("shapes", figures.shapes(solved), "Last picture of each layout in one view and at one scale."),
            ("energy", figures.energies(solved), "Energy absorbed against time."),
            (
                "outputs",
                figures.outputs(solved, outputs[:MOST_OUTPUTS]),
                "Requested outputs that all layouts have, against time.",
            ),
        ]
    return [(name, svg, caption) for name, svg, caption in found if svg is not None]


def _scene(layouts: Sequence[Layout], title: str) -> Scene | None:
    """The first layouts with shapes, side by side, in step."""
    from crumple.report.scene.hinges import hinges_of_result  # noqa: PLC0415
    from crumple.report.scene.scene import Shown, write_scene  # noqa: PLC0415

    shown = [
        Shown(layout.name, result, partial(hinges_of_result, result), layout.structure)
        for layout in layouts
        if (result := layout.frames or layout.result) is not None and result.states is not None
    ]
    return write_scene(shown[:MOST_SHOWN], title)


def _warned(layouts: Sequence[Layout]) -> list[str]:
    """Failures and warnings of the layouts; alike ones in one line."""
    from crumple.report.wording.answer import grouped  # noqa: PLC0415

    lines = []
    for layout in layouts:
        if layout.result is None:
            lines.append(f"{layout.name}: {layout.reason}")
            continue
        if not layout.result.status.ok:
            told = (layout.name, layout.result.status.value, layout.result.reason)
            lines.append(": ".join(part for part in told if part))
        lines += [f"{layout.name}: {warning}" for warning in layout.result.warnings]
    return grouped(lines, [layout.name for layout in layouts])


def _render(
    layouts: Sequence[Layout],
    title: str,
    content: tuple[Sequence[str], list[tuple[str, str, str]]],
    scene: Scene | None,
) -> str:
    from urllib.parse import quote  # noqa: PLC0415

    from jinja2 import Environment, FileSystemLoader, StrictUndefined  # noqa: PLC0415
    from markupsafe import Markup  # noqa: PLC0415

    from crumple.report.scene.page import page_parts  # noqa: PLC0415

    outputs, drawn = content
    here = Path(__file__).parent / "templates"
    environment = Environment(
        loader=FileSystemLoader(here), autoescape=True, undefined=StrictUndefined, trim_blocks=True
    )
    figures = [
        {"number": i + 1, "svg": Markup(svg), "caption": caption} for i, (_, svg, caption) in enumerate(drawn)
    ]
    return environment.get_template("layouts.html.jinja").render(
        **page_parts(scene),
        title=title,
        tables=[table for table in _tables(layouts, outputs) if table.rows],
        order=order_notes(layouts),
        number=len(layouts),
        figures=figures,
        warned=_warned(layouts),
        pages=[(x.name, x.title, f"{quote(x.name)}/report.html") for x in layouts if x.result is not None],
    )
