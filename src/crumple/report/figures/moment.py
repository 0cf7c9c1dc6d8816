"""Moment over rotation of one hinge: its law with its band and range of validity, and the path of the run."""

from __future__ import annotations

import math

import numpy as np
from matplotlib.axes import Axes

from crumple.numeric.arrays import Floats
from crumple.report.drawing.scales import display_unit, largest, spread, thinned
from crumple.report.drawing.style import (
    HALF,
    INK,
    OUTSIDE,
    RULE,
    SERIES,
    WARNING,
    add_axes,
    name_axes,
    new_figure,
    short,
    to_svg,
)
from crumple.report.figures.curves import hinge_channel, sense
from crumple.result import HingeSummary, Result

_DEGREES = math.degrees(1.0)
_BEYOND = 1.25  # length of the rotation axis over the largest rotation, if the law continues
_RANGE_WITHIN = 2.2  # the end of the range is shown if it is within this multiple of the largest rotation


def moment_over_rotation(result: Result, hinge: str, name: str) -> str | None:
    """Law and path of one hinge as SVG, or None if the result has neither.

    Parameters
    ----------
    result
        With the channels of the hinge and its summary with the envelope.
    hinge
        Its name.
    name
        Of the figure; safe as an id and as part of a file name.
    """
    summary = result.hinges[hinge]
    turned, moment = hinge_channel(result, hinge, "rotation"), hinge_channel(result, hinge, "moment")
    path = (turned, moment) if turned is not None and moment is not None and len(turned) else None
    if path is None and "rotation" not in summary.envelope:
        return None
    side = sense(result, hinge)
    reached = max(largest([path[0]]) if path else 0.0, 1e-3)
    limits = _rotation_limits(path[0] * side if path else None, reached, summary.validity_rotation)
    curves = _envelopes(summary, side, limits)
    unit, factor = display_unit("N*m", largest([*(y for _, y in curves), *([path[1]] if path else [])]))
    band = summary.law_use.band if summary.law_use is not None else None
    figure = new_figure(HALF, 2.35)
    axes = add_axes(figure, 0.42, 0.34, HALF - 0.42 - 0.12, 1.75)
    axes.set_xlim(limits[0] * _DEGREES, limits[1] * _DEGREES)
    heights = [(1.0 + (band or 0.0)) * y / factor for _, y in curves] + (
        [path[1] * side / factor] if path else []
    )
    axes.set_ylim(*spread(heights, margin=0.08))
    low, high = axes.get_ylim()
    if low < 0 < high:
        axes.axhline(0.0, color=RULE, linewidth=0.6, zorder=1.5)
    name_axes(axes, "rotation, deg", f"Moment in {short(hinge, 20)}, {unit}")
    _shade_outside(axes, summary.validity_rotation, limits)
    for x, y in curves:
        if band:
            least, most = (1.0 - band) * y / factor, (1.0 + band) * y / factor
            axes.fill_between(x * _DEGREES, least, most, color=INK, alpha=0.12, linewidth=0, zorder=1)
        axes.plot(x * _DEGREES, y / factor, color=INK, linewidth=0.9, linestyle=(0, (4, 2)), zorder=3)
    if path:
        _draw_path(axes, path[0] * side * _DEGREES, path[1] * side / factor)
    _key(axes, law=bool(curves), path=path is not None)
    return to_svg(figure, name, f"Moment against rotation of hinge {short(hinge)}: law and path travelled.")


def _rotation_limits(turned: Floats | None, reached: float, validity: float | None) -> tuple[float, float]:
    """Limits of the rotation axis [rad]: the path, some of the law beyond, the end of its range if near."""
    low = 0.0
    if turned is not None and np.isfinite(turned).any():
        low = min(0.0, float(np.nanmin(turned)))
    high = _BEYOND * reached
    if validity is not None and validity < _RANGE_WITHIN * reached:
        high = max(high, _BEYOND * validity)
    return (1.1 * low if low < -0.02 * reached else -0.02 * high), high


def _envelopes(
    summary: HingeSummary, side: float, limits: tuple[float, float]
) -> list[tuple[Floats, Floats]]:
    """Capacity in both senses within the axes; the second sense only if the hinge rotated back."""
    rotation = summary.envelope.get("rotation")
    curves: list[tuple[Floats, Floats]] = []
    if rotation is None:
        return curves
    for direction in (1.0, -1.0):
        capacity = summary.envelope.get("positive" if side * direction > 0 else "negative")
        end = limits[1] if direction > 0 else -limits[0]
        if capacity is None or (direction < 0 and end < 0.1 * limits[1]):
            continue
        # every corner of the curve inside the axes, and its value at their edge; constant beyond its end
        x = np.append(rotation[rotation < end], end)
        curves.append((direction * x, direction * np.interp(x, rotation, capacity)))
    return curves


def _shade_outside(axes: Axes, validity: float | None, limits: tuple[float, float]) -> None:
    if validity is None or not math.isfinite(validity) or validity >= limits[1]:
        return
    edge = max(validity, 0.0) * _DEGREES
    axes.axvspan(edge, limits[1] * _DEGREES, color=OUTSIDE, linewidth=0, zorder=0)
    axes.axvline(edge, color=WARNING, linewidth=0.6, linestyle=(0, (2, 2)), zorder=1.5)
    axes.annotate(
        "outside the range",
        (edge, 0.0),
        (4, 4),
        xycoords=axes.get_xaxis_transform(),
        textcoords="offset points",
        rotation=90,
        ha="left",
        va="bottom",
        color=WARNING,
        fontsize=7.0,
    )


def _draw_path(axes: Axes, turned: Floats, moment: Floats) -> None:
    x, y = thinned(turned, moment)
    axes.plot(x, y, color=SERIES[0], linewidth=1.8, zorder=4, solid_joinstyle="round")
    finite = np.flatnonzero(np.isfinite(x) & np.isfinite(y))
    if finite.size:
        end = finite[-1]
        axes.plot(
            x[end], y[end], "o", markersize=3.6, markerfacecolor="white", markeredgecolor=SERIES[0], zorder=5
        )


def _key(axes: Axes, *, law: bool, path: bool) -> None:
    """Legend of the two kinds of lines, in one row above the axes."""
    entries = [("— path", SERIES[0])] * path + [("– – law", INK)] * law
    for i, (text, colour) in enumerate(entries):
        axes.annotate(
            text,
            (1, 1),
            (-38 * i, 7),
            xycoords="axes fraction",
            textcoords="offset points",
            ha="right",
            va="bottom",
            color=colour,
            fontsize=7.5,
            annotation_clip=False,
        )
