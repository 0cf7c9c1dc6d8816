"""Figures of the scatter of a run with its input: bands on curves, and a tornado."""

from __future__ import annotations

import math

import numpy as np

from crumple.report.drawing.plots import Plots, plots
from crumple.report.drawing.scales import display_unit, largest, time_unit
from crumple.report.drawing.style import (
    HALF,
    INK,
    MUTED,
    SERIES,
    Line,
    add_axes,
    new_figure,
    short,
    to_svg,
)
from crumple.report.figures.curves import over_time, ranked_hinges
from crumple.report.wording.scatter import scatter_sentences
from crumple.result import Result
from crumple.result.scatter import Scatter, Swing
from crumple.units import plain_number

MOST_BANDS = 4
"""Channels drawn with their band; bands.csv has all."""
MOST_RESPONSES = 3
"""Responses with a tornado."""
_LEFT, _RIGHT, _HEAD, _FOOT, _PANEL, _BAR = 0.5, 0.15, 0.3, 0.36, 1.7, 0.24  # [in]


def scatter_plots(result: Result) -> Plots:
    """Bands on the curves of the criteria, else of the hinges that absorbed most, and tornados."""
    scatter = result.scatter
    if scatter is None:
        return plots("scatter", [], "")
    names = _channels(result, scatter)
    panels = [(f"band_{i}", _band(result, scatter, name, f"band-{i}")) for i, name in enumerate(names, 1)]
    responses = list(dict.fromkeys(swing.response for swing in scatter.swings))[:MOST_RESPONSES]
    for i, response in enumerate(responses, 1):
        swings = [swing for swing in scatter.swings if swing.response == response]
        panels.append((f"tornado_{i}", _tornado(swings, f"tornado-{i}")))
    caption = (
        f"Bands: 2.5 % to 97.5 % of {scatter.complete} variants, with their median; grey: the run itself. "
        "Tornado: the response with one number at its 2.5 % and 97.5 % value, the others at their medians; "
        "blue: at the lower value. " + " ".join(scatter_sentences(result))
    )
    return plots("scatter", panels, caption)


def _channels(result: Result, scatter: Scatter) -> list[str]:
    asked = [criterion.channel for criterion in result.criteria]
    asked += [f"hinge.{name}.rotation" for name in ranked_hinges(result)[:2]]
    return [name for name in dict.fromkeys(asked) if name in scatter.bands][:MOST_BANDS]


def _band(result: Result, scatter: Scatter, name: str, figure_name: str) -> str:
    time = np.array(scatter.times)
    low, middle, high = (np.array(column) for column in scatter.bands[name])
    own = result.channels[name]
    unit, factor = _unit(own.unit, largest([low, high]))
    figure = new_figure(HALF, _HEAD + _PANEL + _FOOT)
    axes = add_axes(figure, _LEFT, _FOOT, HALF - _LEFT - _RIGHT, _PANEL)
    scale = time_unit(float(time[-1]))[1]
    axes.fill_between(time / scale, low / factor, high / factor, color=SERIES[0], alpha=0.2, linewidth=0)
    lines = [
        Line("run", result.time / scale, own.values / factor, faint=True),
        Line("2.5 %", time / scale, low / factor),
        Line("median", time / scale, middle / factor),
        Line("97.5 %", time / scale, high / factor),
    ]
    over_time(axes, time, lines, f"{short(name, 36)}, {unit}" if unit else short(name, 36), labels=False)
    return to_svg(figure, figure_name, f"Band of {name} over {scatter.complete} variants against time.")


def _tornado(swings: list[Swing], figure_name: str) -> str:
    unit, factor = _unit(swings[0].unit, max(max(abs(s.low), abs(s.high)) for s in swings))
    height = _HEAD + _BAR * len(swings) + _FOOT
    figure = new_figure(HALF, height)
    left = 1.0
    axes = add_axes(figure, left, _FOOT, HALF - left - _RIGHT, _BAR * len(swings))
    axes.grid(visible=False, axis="y")
    rows = np.arange(len(swings))[::-1]
    for row, swing in zip(rows, swings, strict=True):
        for i, end in enumerate((swing.low, swing.high)):
            axes.barh(
                row, (end - swing.middle) / factor, 0.6, swing.middle / factor, color=SERIES[i], linewidth=0
            )
    axes.axvline(swings[0].middle / factor, color=INK, linewidth=0.6)
    axes.set_yticks(rows, [short(swing.variable, 16) for swing in swings])
    axes.set_xlabel(
        f"{short(swings[0].response, 30)}, {unit}" if unit else short(swings[0].response, 30), color=MUTED
    )
    text = f"{swings[0].response} with one number at either end of its scatter: "
    text += ", ".join(
        f"{s.variable} {plain_number(s.low / factor)} to {plain_number(s.high / factor)} {unit}"
        for s in swings
    )
    return to_svg(figure, figure_name, f"{text}. First colour: lower value of the number.")


def _unit(si: str, size: float) -> tuple[str, float]:
    return ("°", math.radians(1.0)) if si == "rad" else display_unit(si, size)
