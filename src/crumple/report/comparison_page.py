"""The comparison as one self-contained page: figures, numbers, animation."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from crumple.portable import write_text
from crumple.report.report import MAX_INPUT, ReportInput, embedded, write_figures
from crumple.report.wording.curve_wording import curve_notes

if TYPE_CHECKING:
    from crumple.comparison import Comparison
    from crumple.report.scene.scene import Scene

MOST_HINGES = 4
"""Number of hinges with figures, those that absorbed most energy."""


@dataclass(frozen=True)
class _Figure:
    number: int
    svg: Any
    caption: str


def write_comparison(
    comparison: Comparison, source: ReportInput, directory: Path | str, *, pictures: Sequence[float] = ()
) -> Path:
    """Draw the figures, write them to ``figures/`` and write ``report.html`` around them.

    Parameters
    ----------
    comparison
        What to show.
    source
        Title, input text and its name.
    directory
        Made when absent.
    pictures
        Times of the deformation patterns [s]; by default six over the run.

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
    drawn = _draw(comparison, pictures)
    write_figures(folder, drawn)
    scene = scene_of(comparison, source)
    store_scene(scene, folder)
    page = folder / "report.html"
    write_text(page, _render(comparison, source, drawn, scene))
    return page


def scene_of(comparison: Comparison, source: ReportInput) -> Scene | None:
    """Both results in step, or None if one has no shapes."""
    from crumple.report.scene.hinges import hinges_of_comparison  # noqa: PLC0415
    from crumple.report.scene.scene import Shown, write_scene  # noqa: PLC0415

    models = [
        Shown(one.name, one.result, partial(hinges_of_comparison, one), source.structure)
        for one in (comparison.candidate, comparison.reference)
    ]
    return write_scene(models, source.title or comparison.title)


def _draw(comparison: Comparison, pictures: Sequence[float]) -> list[tuple[str, str, str]]:
    """File name, SVG and caption of every figure for which there are data."""
    import numpy as np  # noqa: PLC0415

    from crumple.report.drawing.style import drawing  # noqa: PLC0415
    from crumple.report.figures import comparison_figures as figures  # noqa: PLC0415
    from crumple.report.figures.comparison_shapes import shapes_side_by_side  # noqa: PLC0415
    from crumple.report.figures.welds import weld_loads  # noqa: PLC0415
    from crumple.report.wording.comparison_wording import ranked  # noqa: PLC0415

    times = pictures or tuple(np.linspace(0.0, float(comparison.reference.result.time[-1]), 6))
    first, second = comparison.candidate.name, comparison.reference.name
    found: list[tuple[str, str | None, str]] = []
    with drawing():
        caption = (
            f"Deformed walls, {first} left and {second} right, in one view and at one scale. Circles: hinges."
        )
        found.append(("shapes", shapes_side_by_side(comparison, times), caption))
        for i, hinge in enumerate(ranked(comparison)[:MOST_HINGES], 1):
            name = hinge.name
            caption = (
                f"Rotation and angular velocity of hinge {name} over time. The {second} rotation is measured "
                "near the fold, between section planes on both sides of it, and at the far end, from the "
                "line between the ends of the member."
            )
            found.append((f"motion_{i}", figures.motion_over_time(comparison, name, f"motion-{i}"), caption))
            shifted = figures.total_energy_shifted(comparison, name, f"shifted-{i}")
            if shifted is not None:
                caption = (
                    f"Hinge {name} in the form of earlier papers: total energy over rotation. {shifted[1]}"
                )
                found.append((f"shifted_{i}", shifted[0], caption))
            svg = figures.plastic_work_over_plastic_rotation(comparison, name, f"plastic-{i}")
            caption = f"Hinge {name}: plastic work over plastic rotation (rotation minus M/k)."
            found.append((f"plastic_{i}", svg, caption))
        loads = weld_loads(comparison.reference.result)
        if loads is not None:
            found.append(("welds", *loads))
        for i, channel in enumerate(figures.drawn_channels(comparison), 1):
            caption = f"{channel} over time, with the curves from files."
            found.append((f"curve_{i}", figures.history(comparison, channel, f"curve-{i}"), caption))
        if comparison.variants and comparison.hinges:
            svg = figures.variants_over_rotation(comparison, ranked(comparison)[0].name)
            caption = "Total energy over the rotation at the far end for every model, without shifts."
            found.append(("variants", svg, caption))
            svg = figures.velocity_of_models(comparison, ranked(comparison)[0].name)
            caption = (
                f"Angular velocity of hinge {ranked(comparison)[0].name} near the fold in every model, from "
                "the rotations of successive shapes. With rigid bars it is smooth; with elastic members it "
                "contains their bending vibration."
            )
            found.append(("variants_velocity", svg, caption))
    return [(name, svg, caption) for name, svg, caption in found if svg is not None]


def _render(
    comparison: Comparison,
    source: ReportInput,
    drawn: list[tuple[str, str, str]],
    scene: Scene | None,
) -> str:
    from jinja2 import Environment, FileSystemLoader, StrictUndefined  # noqa: PLC0415
    from markupsafe import Markup  # noqa: PLC0415

    from crumple.report.scene.page import page_parts  # noqa: PLC0415
    from crumple.report.wording import comparison_wording as wording  # noqa: PLC0415
    from crumple.report.wording.law_range import shell_range_table  # noqa: PLC0415

    here = Path(__file__).parent / "templates"
    figures = {name: _Figure(i + 1, Markup(svg), caption) for i, (name, svg, caption) in enumerate(drawn)}
    hinges = [
        {key: figures.get(f"{key}_{i}") for key in ("motion", "shifted", "plastic")}
        for i in range(1, MOST_HINGES + 1)
        if f"motion_{i}" in figures
    ]
    environment = Environment(
        loader=FileSystemLoader(here), autoescape=True, undefined=StrictUndefined, trim_blocks=True
    )
    text = embedded(source)
    provenance = comparison.candidate.result.provenance
    return environment.get_template("comparison.html.jinja").render(
        title=source.title or comparison.title or "Comparison",
        meta=[
            p
            for p in (source.name, f"Crumple {provenance.version}", f"input {provenance.input_hash[:12]}")
            if p
        ],
        **page_parts(scene, "comparison.css"),
        trust=comparison.trust,
        names=(comparison.candidate.name, comparison.reference.name),
        key_figures=wording.key_figures(comparison),
        figures=figures,
        curve_figures=[figure for name, figure in figures.items() if name.startswith("curve_")],
        hinge_figures=hinges,
        hinge_tables=wording.hinge_tables(comparison),
        contact_table=wording.contact_table(comparison),
        crush_table=wording.crush_table(comparison),
        range_table=shell_range_table(comparison),
        omitted=max(len(comparison.hinges) - wording.MOST_HINGES, 0),
        rating_table=wording.rating_table(comparison),
        opening_table=wording.opening_table(comparison),
        model_table=wording.model_table(comparison),
        speed_table=wording.speed_table(comparison),
        curves=[text for text, _ in curve_notes(comparison)],
        notes=_notes(comparison),
        input_text=text[:MAX_INPUT],
        input_cut=MAX_INPUT if len(text) > MAX_INPUT else 0,
        input_name=source.name,
    )


def _notes(comparison: Comparison) -> list[tuple[str, tuple[str, ...], tuple[str, ...]]]:
    """Warnings and assumptions of every result."""
    return [(s.name, s.result.warnings, s.result.assumptions) for s in comparison.sources]
