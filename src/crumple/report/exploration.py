"""A page that a reader can vary: shapes and curves of a grid of runs, with sliders."""

from __future__ import annotations

import json
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from crumple.analysis.explore import Explored, Slider
from crumple.errors import InputError, Problem
from crumple.portable import write_text
from crumple.report.drawing.scales import display_unit, largest, output_groups
from crumple.report.figures.curves import ranked_hinges
from crumple.units import format_quantity, plain_number

if TYPE_CHECKING:
    from crumple.report.scene.scene import Scene
    from crumple.result import Result

PAGE = "explore.html"
MOST_CURVES = 8
ROUNDING = 1e-9
"""Value in SI below which a curve is rounding."""
SAMPLES = 101
"""Values of a curve at every point of the grid."""


def write_exploration(
    points: Sequence[Explored],
    sliders: Sequence[Slider],
    title: str,
    directory: Path | str,
    cautions: Sequence[str] = (),
) -> Path:
    """Write ``explore.html``, which contains the shapes and curves of all points.

    Parameters
    ----------
    points
        Of the grid, the last number changing fastest.
    sliders
        Its numbers.
    title
        Of the page.
    directory
        Made when absent.
    cautions
        Sentences below the curves.

    Returns
    -------
    Path
        The page.

    Raises
    ------
    InputError
        If no point has a result with shapes.
    OSError
        If the page cannot be written.
    """
    from jinja2 import Environment, FileSystemLoader, StrictUndefined  # noqa: PLC0415

    from crumple.report.scene.page import REPORT, page_parts  # noqa: PLC0415

    scene = _scene(points, sliders, title)
    environment = Environment(
        loader=FileSystemLoader(REPORT / "templates"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
    )
    page = Path(directory) / PAGE
    failed = sum(not _usable(point) for point in points)
    template = environment.get_template("explore.html.jinja")
    parts = page_parts(scene, "explore.css", script="explore.js")
    parts["scene"] |= {"names": parts["scene"]["names"][:1], "notes": parts["scene"]["notes"][:1]}
    told = {"count": len(points), "failed": failed, "cautions": cautions}
    write_text(page, template.render(title=title or "Crash", **told, **parts))
    return page


def _usable(point: Explored) -> bool:
    return not point.reason and point.result is not None and point.result.states is not None


def _scene(points: Sequence[Explored], sliders: Sequence[Slider], title: str) -> Scene:
    """One scene with a model for every point that has a result."""
    from crumple.report.scene.hinges import hinges_of_result  # noqa: PLC0415
    from crumple.report.scene.scene import Scene, Shown, write_scene  # noqa: PLC0415

    good = [point for point in points if _usable(point)]
    shown = [
        Shown("multibody", run, partial(hinges_of_result, run), point.structure)
        for point in good
        if (run := point.frames or point.result) is not None
    ]
    scene = write_scene(shown, title)
    if scene is None:
        reasons = "; ".join(dict.fromkeys(point.reason for point in points if point.reason))
        what, todo = "no value of the grid has a result with shapes", "choose another range"
        raise InputError(Problem(what, reasons[:200], "", todo, "--explore"))
    header = json.loads(scene.header)
    header["explore"] = {
        "axes": [_axis(slider) for slider in sliders],
        "models": [good.index(point) if point in good else -1 for point in points],
        "reasons": [point.reason for point in points],
        "curves": curves_of([point.result for point in good if point.result is not None]),
        "times": np.linspace(0.0, min(header["times"][-1], _end(good)), SAMPLES).tolist(),
    }
    text = json.dumps(header, ensure_ascii=True, allow_nan=False).replace("<", "\\u003c")
    return Scene(text, scene.payload, scene.strain, scene.frames)


def _end(points: Sequence[Explored]) -> float:
    return min(float(point.result.time[-1]) for point in points if point.result is not None)


def _axis(slider: Slider) -> dict[str, Any]:
    """A number as its slider shows it, in the unit that the input has."""
    factor = slider.factor
    return {
        "name": slider.path,
        "unit": "" if slider.unit == "1" else slider.unit,
        "values": [float(f"{value / factor:.10g}") for value in slider.values],
    }


def curves_of(results: Sequence[Result]) -> list[dict[str, Any]]:
    """Histories that all results have: of the hinges that absorb most, the outputs and the energy."""
    first = results[len(results) // 2]
    bending = [name for name in ranked_hinges(first) if first.hinges[name].bends]
    names = ["energy.dissipated", *(f"hinge.{name}.rotation" for name in bending[:3])]
    names += [f"hinge.{name}.slip.x.travel" for name, hinge in first.hinges.items() if hinge.crush][:2]
    outputs = [channel for group in output_groups(first)[0] for _, channel in group.channels]
    # lengths first, which distances and clearances are; accelerations only through a filter
    outputs.sort(key=lambda channel: channel.unit != "m")
    names += [one.name for one in outputs if not one.name.startswith("node.") or one.unit != "m/s^2"]
    shared = [
        name
        for name in dict.fromkeys(names)
        if all(name in one.channels and np.isfinite(one[name]).all() for one in results)
        and largest([one[name] for one in results]) > ROUNDING
    ]
    end = min(float(result.time[-1]) for result in results)
    times = np.linspace(0.0, end, SAMPLES)
    found = []
    for name in shared[:MOST_CURVES]:
        values = [np.interp(times, result.time, result[name]) for result in results]
        unit, factor = display_unit(first.channels[name].unit, largest(values))
        rows = [[float(f"{value:.5g}") for value in row / factor] for row in values]
        found.append({"name": name, "unit": unit, "values": rows})
    return found


def sentence(points: Sequence[Explored], sliders: Sequence[Slider]) -> str:
    """What was solved, for the terminal."""
    ranges = []
    for slider in sliders:
        unit = slider.unit
        ends = (plain_number(slider.values[i] / slider.factor) for i in (0, -1))
        ranges.append(f"{slider.path} from {' to '.join(ends)}{'' if unit == '1' else ' ' + unit}")
    good = sum(_usable(point) for point in points)
    seconds = sum(point.result.solve_seconds for point in points if point.result is not None)
    return (
        f"{good} of {len(points)} variants solved in {format_quantity(seconds, 's', 3)}: {', '.join(ranges)}"
    )
