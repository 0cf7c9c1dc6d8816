"""Report of a run: one self-contained HTML page with figures, tables and key figures."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from math import isfinite
from pathlib import Path
from typing import TYPE_CHECKING, Any

from crumple.hinge.law_use import INPUT
from crumple.portable import write_text

if TYPE_CHECKING:
    from crumple.report.scene.scene import Scene
    from crumple.report.wording.wording import Table
    from crumple.result import Result
    from crumple.structure import Structure

MAX_MOMENT_FIGURES = 12
"""Most hinges drawn with their laws; each figure adds some 8 kB to the page."""
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
    """

    title: str = ""
    text: str = ""
    name: str = ""
    canonical: Mapping[str, Any] | None = None
    residual_bound: float | None = None
    accuracy: float | None = None
    structure: Structure | None = None


@dataclass(frozen=True)
class _Figure:
    number: int
    svg: Any
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
    from crumple.report.scene.page import store_scene  # noqa: PLC0415

    folder = Path(directory)
    settings = result.provenance.settings
    bound = (
        source.residual_bound if source.residual_bound is not None else settings.get("energy_residual_bound")
    )
    accuracy = source.accuracy if source.accuracy is not None else settings.get("accuracy")
    drawn = _draw(result, bound)
    write_figures(folder, drawn)
    scene = _scene(frames or result, source)
    store_scene(scene, folder)
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


def _draw(result: Result, bound: float | None) -> list[tuple[str, str, str]]:
    """File name, SVG and caption of every figure for which the result has data."""
    from crumple.report.drawing.style import drawing  # noqa: PLC0415
    from crumple.report.figures import curves, fold, moment, shape, welds  # noqa: PLC0415

    with drawing():
        loads = welds.weld_loads(result)
        figures = [
            (
                "deformation",
                shape.deformation(result),
                "Deformed member walls at the picture times over the undeformed shape in grey, "
                "all at one scale. Circles mark hinges.",
            ),
            *((f"fold_{i + 1}", svg, caption) for i, (svg, caption) in enumerate(fold.folds(result))),
            (
                "rotation",
                curves.rotations(result),
                "Rotation and angular velocity of the hinges over time."
                + _named(result, curves.NAMED, curves.DRAWN),
            ),
            (
                "energy_rotation",
                curves.energy_over_rotation(result),
                "Energy dissipated in each hinge over its rotation, "
                "positive in the sense of its largest rotation." + _named(result, curves.NAMED, curves.DRAWN),
            ),
            *_moment_figures(result, moment.moment_over_rotation),
            *([] if loads is None else [("welds", *loads)]),
            ("energy", curves.ledger(result, bound), _ledger_caption(result)),
            ("outputs", curves.outputs(result), "Requested outputs over time."),
        ]
    return [(name, svg, caption) for name, svg, caption in figures if svg is not None]


def _named(result: Result, named: int, drawn: int) -> str:
    count = len(result.hinges)
    only = f"Of {count} hinges the {drawn} that absorbed most energy are drawn. " if count > drawn else ""
    return f" {only}The {named} hinges that absorbed most energy are named." if count > named else ""


def _moment_figures(result: Result, draw: Any) -> list[tuple[str, str | None, str]]:
    from crumple.report.figures.curves import ranked_hinges  # noqa: PLC0415
    from crumple.report.wording.wording import angle, sentence_case  # noqa: PLC0415

    figures = []
    for i, hinge in enumerate(ranked_hinges(result)[:MAX_MOMENT_FIGURES]):
        summary = result.hinges[hinge]
        law = " and its law" if summary.law else ""
        parts = [f"Moment over rotation of hinge {hinge}: path of the run{law}."]
        named = (("Law", summary.law), ("Source", summary.source))
        parts += [sentence_case(f"{name}: {text}") for name, text in named if text]
        if summary.validity_rotation is not None and isfinite(summary.validity_rotation):
            parts.append(f"Range of validity: up to {angle(summary.validity_rotation)}.")
        figures.append((f"moment_{i + 1}", draw(result, hinge, f"moment-{i + 1}"), " ".join(parts)))
    return figures


def _ledger_caption(result: Result) -> str:
    shown = "Energies over time"
    if "energy.residual" not in result.channels:
        return f"{shown}."
    return (
        f"{shown} and, on the right, the residual of their balance: kinetic, elastic and dissipated energy"
        f"{_further_energies(result)} minus external work and the energy at the start. "
        "Dissipation is integrated independently."
    )


def _further_energies(result: Result) -> str:
    """Terms that only some solvers have."""
    named = [name for name in ("hourglass", "contact", "damping") if f"energy.{name}" in result.channels]
    return f", energy of {' and '.join(named)}," if named else ""


def _render(
    result: Result,
    source: ReportInput,
    drawn: list[tuple[str, str, str]],
    limits: tuple[float | None, float | None],
    scene: Scene | None,
) -> str:
    from jinja2 import Environment, FileSystemLoader, StrictUndefined  # noqa: PLC0415
    from markupsafe import Markup  # noqa: PLC0415

    from crumple.report.scene.page import page_parts  # noqa: PLC0415
    from crumple.report.wording import wording  # noqa: PLC0415
    from crumple.report.wording.law_range import range_table  # noqa: PLC0415

    # the figures and the style are our own; everything else is escaped
    figures = {name: _Figure(i + 1, Markup(svg), caption) for i, (name, svg, caption) in enumerate(drawn)}
    close_ups = [figure for name, figure in figures.items() if name.startswith("fold_")]
    moments = [figure for name, figure in figures.items() if name.startswith("moment_")]
    here = Path(__file__).parent / "templates"
    environment = Environment(
        loader=FileSystemLoader(here),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
    )
    text = embedded(source)
    named = ("deformation", "rotation", "energy_rotation", "welds", "energy", "outputs")
    return environment.get_template("page.html.jinja").render(
        **page_parts(scene),
        title=source.title or result.title or "Crash analysis",
        meta=_meta(result, source),
        verdict=wording.verdict(result, *limits),
        key_figures=wording.key_figures(result),
        figures={**{name: figures.get(name) for name in named}, "moments": moments, "folds": close_ups},
        omitted_hinges=max(len(result.hinges) - MAX_MOMENT_FIGURES, 0),
        hinge_table=wording.hinge_table(result),
        crush_table=wording.crush_table(result),
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
