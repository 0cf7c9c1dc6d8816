"""The comparison as one self-contained page: figures, numbers, animation."""

from __future__ import annotations

import base64
import hashlib
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from crumple.comparison import Comparison
from crumple.report.report import MAX_INPUT, ReportInput, embedded, write_figures
from crumple.report.wording.curve_wording import curve_notes
from crumple.result.files import write_text

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
    folder = Path(directory)
    drawn = _draw(comparison, pictures)
    write_figures(folder, drawn)
    page = folder / "report.html"
    write_text(page, _render(comparison, source, drawn))
    return page


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


def _render(comparison: Comparison, source: ReportInput, drawn: list[tuple[str, str, str]]) -> str:
    from jinja2 import Environment, FileSystemLoader, StrictUndefined  # noqa: PLC0415
    from markupsafe import Markup  # noqa: PLC0415

    from crumple.report.figures.player import scene_of  # noqa: PLC0415
    from crumple.report.wording import comparison_wording as wording  # noqa: PLC0415

    here = Path(__file__).parent / "templates"
    figures = {name: _Figure(i + 1, Markup(svg), caption) for i, (name, svg, caption) in enumerate(drawn)}
    hinges = [
        {key: figures.get(f"{key}_{i}") for key in ("motion", "shifted", "plastic")}
        for i in range(1, MOST_HINGES + 1)
        if f"motion_{i}" in figures
    ]
    scene = scene_of(comparison)
    scripts = [_text(here / "copy.js")]
    if scene is not None:
        scripts = [_text(here.parent / "vendor" / "three.min.js"), _text(here / "player.js"), *scripts]
    environment = Environment(
        loader=FileSystemLoader(here), autoescape=True, undefined=StrictUndefined, trim_blocks=True
    )
    text = embedded(source)
    provenance = comparison.candidate.result.provenance
    return environment.get_template("comparison.html.jinja").render(
        version=provenance.version,
        title=source.title or comparison.title or "Comparison",
        meta=[
            p
            for p in (source.name, f"Crumple {provenance.version}", f"input {provenance.input_hash[:12]}")
            if p
        ],
        style=Markup(_text(here / "page.css") + _text(here / "comparison.css")),
        scripts=[Markup(script) for script in scripts],
        hashes=" ".join(_hash(script) for script in scripts),
        scene=None if scene is None else {"header": Markup(scene.header), "payload": Markup(scene.payload)},
        strain=0.0 if scene is None else scene.strain,
        trust=comparison.trust,
        names=(comparison.candidate.name, comparison.reference.name),
        key_figures=wording.key_figures(comparison),
        figures=figures,
        curve_figures=[figure for name, figure in figures.items() if name.startswith("curve_")],
        hinge_figures=hinges,
        hinge_tables=wording.hinge_tables(comparison),
        crush_table=wording.crush_table(comparison),
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


def _text(path: Path) -> str:
    return path.read_text(encoding="utf-8")


def _hash(script: str) -> str:
    """Hash by which the security policy of the page allows this script and no other."""
    # the browser hashes the text between the tags, including line breaks of the template
    digest = hashlib.sha256(f"\n{script}\n".encode()).digest()
    return f"'sha256-{base64.b64encode(digest).decode()}'"
