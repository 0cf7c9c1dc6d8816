"""Figures of several layouts: their last shapes at one scale, and their histories on shared axes."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from crumple.report.drawing.scales import display_unit, largest, time_unit
from crumple.report.drawing.style import INK, WIDTH, Line, add_axes, new_figure, short, to_svg
from crumple.report.drawing.view import choose_view
from crumple.report.figures.curves import over_time
from crumple.report.figures.shape import (
    draw_hinges,
    draw_scale,
    draw_walls,
    finite_states,
    hinge_places,
    surface_of,
)
from crumple.result import Result, States

Solved = Sequence[tuple[str, Result]]

_RASTER_FROM = 4000  # walls in all pictures together, from which they become an image
_LEFT, _RIGHT, _HEAD, _FOOT, _PANEL = 0.46, 0.9, 0.3, 0.34, 1.6  # around and height of a panel [in]


def shapes(solved: Solved) -> str | None:
    """Last state of every layout over its undeformed shape, in the view of the first, as SVG."""
    drawn = [(name, result, states) for name, result in solved if (states := finite_states(result.states))]
    if not drawn:
        return None
    view = choose_view(drawn[0][2])
    spots = np.concatenate([view.flat(_ends(states)).reshape(-1, 2) for _, _, states in drawn])
    low, high = spots.min(axis=0), spots.max(axis=0)
    margin = 0.06 * float(max(high - low))
    low, high = low - margin, high + margin
    columns = min(3, len(drawn))
    rows = math.ceil(len(drawn) / columns)
    gap, label, foot = 0.12, 0.2, 0.34
    panel = (WIDTH - gap * (columns - 1)) / columns
    height = min(panel * (high[1] - low[1]) / (high[0] - low[0]), 3.2)
    total = rows * (height + label) + foot
    figure = new_figure(WIDTH, total)
    raster = sum(len(states.quads) for *_, states in drawn) > _RASTER_FROM
    for i, (name, result, states) in enumerate(drawn):
        row, column = divmod(i, columns)
        axes = add_axes(figure, column * (panel + gap), total - (row + 1) * (height + label), panel, height)
        axes.set_axis_off()
        axes.set_xlim(low[0], high[0])
        axes.set_ylim(low[1], high[1])
        axes.set_aspect("equal", anchor="W")
        surface, last = surface_of(states), len(states.times) - 1
        draw_walls(axes, states, surface, view, None, raster)
        draw_walls(axes, states, surface, view, last, raster)
        places = hinge_places(result, states)
        draw_hinges(axes, {hinge: view.flat(place[last]) for hinge, place in places.items()}, named=False)
        axes.text(0, 1, short(name), transform=axes.transAxes, va="bottom", fontsize=8.5, color=INK)
    inches = min(panel / (high[0] - low[0]), height / (high[1] - low[1]))
    draw_scale(add_axes(figure, 0, 0, WIDTH, foot), view, float(inches), panel, foot)
    return to_svg(figure, "shapes", "Last shape of each layout over its undeformed shape in grey.")


def energies(solved: Solved) -> str | None:
    """Energy dissipated in every layout against time, as SVG."""
    return _panels(solved, ["energy.dissipated"], "energy")


def outputs(solved: Solved, names: Sequence[str]) -> str | None:
    """Outputs of every layout against time, one panel each, two in a row, as SVG."""
    return _panels(solved, names, "outputs")


def _ends(states: States) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
    """Points of the first and the last shape, (2, n, 3)."""
    return np.stack([states.points, states.points + states.displacement[-1]])


def _panels(solved: Solved, names: Sequence[str], prefix: str) -> str | None:
    names = [name for name in names if any(name in result.channels for _, result in solved)]
    if not names:
        return None
    columns = min(2, len(names))
    rows = math.ceil(len(names) / columns)
    figure = new_figure(WIDTH, rows * (_HEAD + _PANEL + _FOOT))
    end = max(float(result.time[-1]) for _, result in solved)
    longest = max((result.time for _, result in solved), key=lambda time: float(time[-1]))
    for i, name in enumerate(names):
        row, column = divmod(i, columns)
        bottom = (rows - row - 1) * (_HEAD + _PANEL + _FOOT) + _FOOT
        width = WIDTH / columns - _LEFT - _RIGHT
        axes = add_axes(figure, _LEFT + column * WIDTH / columns, bottom, width, _PANEL)
        having = [(i, layout, r) for i, (layout, r) in enumerate(solved) if name in r.channels]
        peak = largest([result[name] for _, _, result in having])
        unit, factor = display_unit(having[0][2].channels[name].unit, peak)
        lines = [
            Line(layout, result.time / time_unit(end)[1], result[name] / factor, index)
            for index, layout, result in having
        ]
        over_time(axes, longest, lines, f"{short(name, 40)}, {unit}" if unit else short(name, 40))
    return to_svg(figure, prefix, f"{', '.join(names)} of each layout against time.")
