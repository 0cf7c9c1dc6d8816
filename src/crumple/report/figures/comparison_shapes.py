"""Deformation patterns of two results at chosen times, side by side in one view at one scale."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from crumple.comparison import Comparison
from crumple.numeric.arrays import Floats
from crumple.report.drawing.style import INK, MUTED, WIDTH, add_axes, new_figure, to_svg
from crumple.report.drawing.view import View, choose_view
from crumple.report.figures.shape import (
    draw_hinges,
    draw_scale,
    draw_walls,
    finite_states,
    hinge_places,
    picture_time,
    surface_of,
)
from crumple.result import States

_TALLEST = 8.6  # of the figure, to fit a page [in]
_GAP, _LABEL, _FOOT, _HEAD = 0.12, 0.18, 0.34, 0.2
_RASTER_FROM = 4000


def shapes_side_by_side(comparison: Comparison, times: Sequence[float]) -> str | None:
    """Candidate and reference at the times [s] that both reached, as SVG; None without shapes of both."""
    results = (comparison.candidate.result, comparison.reference.result)
    names = (comparison.candidate.name, comparison.reference.name)
    found = [finite_states(result.states) for result in results]
    if any(states is None for states in found):
        return None
    both = [states for states in found if states is not None]
    end = min(float(states.times[-1]) for states in both)
    shown = np.array([t for t in times if t <= end * (1 + 1e-9)])
    if not shown.size:
        return None
    chosen = [states.at_times(shown) for states in both]
    view = choose_view(both[1])
    low, high = _limits(chosen, view)
    width, height = high - low
    pairs = 1 if _height(1, len(shown), height / width) <= _TALLEST else 2
    columns, rows = 2 * pairs, math.ceil(len(shown) / pairs)
    panel = (WIDTH - _GAP * (columns - 1)) / columns
    tall = min(panel * height / width, (_TALLEST - _FOOT - _HEAD) / rows - _LABEL)
    total = rows * (tall + _LABEL) + _FOOT + _HEAD
    figure = new_figure(WIDTH, total)
    surfaces = [surface_of(states) for states in chosen]
    hinges = [hinge_places(result, states) for result, states in zip(results, chosen, strict=True)]
    for i, time in enumerate(shown):
        row, pair = divmod(i, pairs)
        bottom = total - _HEAD - (row + 1) * (tall + _LABEL)
        for k, states in enumerate(chosen):
            axes = add_axes(figure, (2 * pair + k) * (panel + _GAP), bottom, panel, tall)
            axes.set_axis_off()
            axes.set_xlim(low[0], high[0])
            axes.set_ylim(low[1], high[1])
            axes.set_aspect("equal", anchor="W")
            raster = len(states.quads) * len(shown) > _RASTER_FROM
            draw_walls(axes, states, surfaces[k], view, None, raster)
            draw_walls(axes, states, surfaces[k], view, i, raster)
            if k == 0:
                places = {name: view.flat(place[i]) for name, place in hinges[k].items()}
                draw_hinges(axes, places, named=False)
                label = picture_time(float(time))
                axes.text(0, 1, label, transform=axes.transAxes, va="bottom", fontsize=8.5, color=INK)
            if row == 0:
                axes.text(
                    1, 1 + _LABEL / tall, names[k], transform=axes.transAxes, ha="right", va="bottom",
                    fontsize=8.5, color=MUTED, clip_on=False,
                )  # fmt: skip
    scale = add_axes(figure, 0, 0, WIDTH, _FOOT)
    draw_scale(scale, view, min(panel / width, tall / height), panel, _FOOT)
    when = ", ".join(picture_time(float(t)) for t in shown)
    caption = f"Deformed shapes, {names[0]} left and {names[1]} right, at {when}."
    return to_svg(figure, "shapes", caption)


def _height(pairs: int, times: int, aspect: float) -> float:
    panel = (WIDTH - _GAP * (2 * pairs - 1)) / (2 * pairs)
    return math.ceil(times / pairs) * (panel * aspect + _LABEL) + _FOOT + _HEAD


def _limits(chosen: Sequence[States], view: View) -> tuple[Floats, Floats]:
    """Corners of the picture that holds every shape, with a margin."""
    moved = [np.concatenate([s.points[None], s.points + s.displacement]).reshape(-1, 3) for s in chosen]
    flat = view.flat(np.concatenate(moved))
    low, high = flat.min(axis=0), flat.max(axis=0)
    size = np.maximum(high - low, 1e-3 * float(np.max(high - low)))
    return low - 0.03 * size.max(), low + size + 0.03 * size.max()
