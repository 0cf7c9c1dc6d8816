"""Report of a run: one self-contained HTML page with figures, tables and key figures."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from crumple.hinge.law_use import INPUT
from crumple.portable import write_text

if TYPE_CHECKING:
    from crumple.report.drawing.plots import Plots
    from crumple.report.scene.scene import Scene
    from crumple.report.wording.wording import Table
    from crumple.result import Result
    from crumple.structure import Outputs, Structure

MAX_INPUT = 60_000
"""Most characters of input printed; longer input is cut, and the page states this."""


@dataclass(frozen=True)
class ReportInput:
    """Parts of the analysis that the page shows; every field is optional.

    Attributes
    ----------
    title
        Of the page; the result's own when empty.
    text
        The input file as written.
    name
        Of that file.
    canonical
        The input as it was read, printed if there is no text.
    residual_bound
        Largest energy residual allowed, over the energy input [-].
    accuracy
        Requested from the stepper [-].
    structure
        What was described: its obstacles, masses and supports are shown with the shapes.
    outputs
        What was requested: intrusions, clearances and filtered channels have figures of their own.
    """

    title: str = ""
    text: str = ""
    name: str = ""
    canonical: Mapping[str, Any] | None = None
    residual_bound: float | None = None
    accuracy: float | None = None
    structure: Structure | None = None
    outputs: Outputs | None = None


@dataclass(frozen=True)
class _Figure:
    number: int
    panels: tuple[Any, ...]
    caption: str


def write_report(
    result: Result, source: ReportInput, directory: Path | str, *, frames: Result | None = None
) -> Path:
    """Draw the figures, write them to ``figures/`` and write ``report.html`` around them.

    Parameters
    ----------
    result
        Of either fidelity, complete or not.
    source
        What to show of the analysis.  Its bound and accuracy default to the result's settings of that name.
    directory
        Made when absent.
    frames
        The same run with more shapes, for a smoother motion in the viewer.

    Returns
    -------
    Path
        The page.

    Raises
    ------
    OSError
        If the folder cannot be written.
    """
    from crumple.report.drawing.plots import flat  # noqa: PLC0415
    from crumple.report.page_figures import draw  # noqa: PLC0415
    from crumple.report.scene.page import store_scene  # noqa: PLC0415
    from crumple.report.scene.paraview import write_surroundings  # noqa: PLC0415

    folder = Path(directory)
    settings = result.provenance.settings
    bound = (
        source.residual_bound if source.residual_bound is not None else settings.get("energy_residual_bound")
    )
    accuracy = source.accuracy if source.accuracy is not None else settings.get("accuracy")
    drawn = draw(result, bound, source.structure, source.outputs)
    write_figures(folder, flat(drawn))
    scene = _scene(frames or result, source)
    store_scene(scene, folder)
    write_surroundings(scene, folder)
    page = folder / "report.html"
    write_text(page, _render(result, source, drawn, (bound, accuracy), scene))
    return page


def _scene(result: Result, source: ReportInput) -> Scene | None:
    """The scene of one result."""
    from crumple.report.scene.hinges import hinges_of_result  # noqa: PLC0415
    from crumple.report.scene.scene import Shown, write_scene  # noqa: PLC0415

    shown = Shown(result.fidelity, result, partial(hinges_of_result, result), source.structure)
    return write_scene([shown], source.title or result.title)


def write_figures(folder: Path, drawn: Sequence[tuple[str, str, str]]) -> None:
    """Write figures, each a file name, its SVG and its caption, to ``figures/`` of a folder."""
    for name, svg, _ in drawn:
        write_text(folder / "figures" / f"{name}.svg", '<?xml version="1.0" encoding="utf-8"?>\n' + svg)


def _render(
    result: Result,
    source: ReportInput,
    drawn: Sequence[Plots],
    limits: tuple[float | None, float | None],
    scene: Scene | None,
) -> str:
    from jinja2 import Environment, FileSystemLoader, StrictUndefined  # noqa: PLC0415
    from markupsafe import Markup  # noqa: PLC0415

    from crumple.report.drawing.window import window_sentence  # noqa: PLC0415
    from crumple.report.page_figures import MAX_MOMENT_FIGURES  # noqa: PLC0415
    from crumple.report.scene.page import page_parts  # noqa: PLC0415
    from crumple.report.wording import along, wording  # noqa: PLC0415
    from crumple.report.wording.answer import MOST_CAUTIONS, grouped, members_of, one_mode, three_sentences  # noqa: PLC0415
    from crumple.report.wording.key_figures import key_figures  # noqa: PLC0415
    from crumple.report.wording.law_range import range_table  # noqa: PLC0415
    from crumple.report.wording.scatter import criterion_sentences  # noqa: PLC0415

    # the figures and the style are our own; everything else is escaped
    figures = {
        figure.name: _Figure(i, tuple(Markup(svg) for _, svg in figure.panels), figure.caption)
        for i, figure in enumerate(drawn, 1)
    }
    here = Path(__file__).parent / "templates"
    environment = Environment(
        loader=FileSystemLoader(here),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
    )
    text = embedded(source)
    named = ("scatter", "answers", "hinges", "deformation", "moments", "welds", "energy", "outputs")
    verdict = wording.verdict(result, *limits)
    return environment.get_template("page.html.jinja").render(
        **page_parts(scene),
        title=source.title or result.title or "Crash analysis",
        meta=_meta(result, source),
        verdict=verdict,
        sentences=[*three_sentences(result, verdict), *one_mode(result), *criterion_sentences(result)],
        cautions=grouped(verdict.warnings, [*result.hinges, *members_of(result)]),
        most_cautions=MOST_CAUTIONS,
        shown_times=window_sentence(result),
        key_figures=key_figures(result),
        figures={
            **{name: figures.get(name) for name in named},
            "folds": [figure for name, figure in figures.items() if name.startswith("fold_")],
        },
        omitted_hinges=max(len(result.hinges) - MAX_MOMENT_FIGURES, 0),
        hinge_table=wording.hinge_table(result),
        crush_table=along.crush_table(result),
        crushing_law_table=along.crushing_law_table(result),
        stretch_table=along.stretch_table(result),
        crumpled_table=along.crumpled_table(result),
        dent_table=along.dent_table(result),
        collapse_table=wording.collapse_table(result),
        stage_table=wording.stage_table(result),
        output_table=wording.output_table(result),
        fall_table=wording.fall_table(result),
        law_table=wording.law_table(result, source.name or INPUT),
        range_table=range_table(result),
        assumptions=result.assumptions,
        provenance_table=_provenance(result, wording.Table),
        input_text=text[:MAX_INPUT],
        input_cut=MAX_INPUT if len(text) > MAX_INPUT else 0,
        input_name=source.name,
    )


def _meta(result: Result, source: ReportInput) -> list[str]:
    provenance = result.provenance
    parts = [source.name, f"{result.fidelity} model", f"Crumple {provenance.version}"]
    return [part for part in (*parts, f"input {provenance.input_hash[:12]}") if part]


def embedded(source: ReportInput) -> str:
    """The input as written, else as it was read."""
    if source.text or source.canonical is None:
        return source.text
    return json.dumps(source.canonical, indent=2, ensure_ascii=False, default=str)


def _provenance(result: Result, table: type[Table]) -> Table:
    from crumple.units import format_quantity  # noqa: PLC0415

    provenance = result.provenance
    rows = [
        ("Crumple", provenance.version),
        ("Fidelity", result.fidelity),
        ("Input hash (SHA-256)", provenance.input_hash),
        ("Instruction set", provenance.isa),
        ("Threads", str(provenance.threads)),
        ("Solve time", format_quantity(result.solve_seconds, "s", 3)),
        ("Settings", ", ".join(f"{name} {value}" for name, value in provenance.settings.items())),
    ]
    return table("", ("Item", "Value"), [row for row in rows if row[1]], frozenset({1}))
