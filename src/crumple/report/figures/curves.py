"""Histories: rotation and angular velocity, energy against rotation, the energy ledger, requested outputs."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes

from crumple.numeric.arrays import Floats
from crumple.report.drawing.scales import display_unit, largest, output_groups, spread, time_unit
from crumple.report.drawing.style import (
    HALF,
    MUTED,
    RULE,
    WARNING,
    WIDTH,
    Line,
    add_axes,
    draw_lines,
    label_room,
    name_axes,
    new_figure,
    short,
    to_svg,
)
from crumple.result import Result

NAMED = 6
"""Hinges drawn in colour and named; the others are drawn faintly behind them."""
DRAWN = 100
"""Hinges whose curves are drawn at all: more hide each other, and thousands take a minute to draw."""
MAX_OUTPUTS = 12
"""Panels of requested outputs; the table and histories.csv hold the others."""

_DEGREES = math.degrees(1.0)
_PANEL = 1.75  # height of the axes of a panel [in]
_HEAD, _FOOT = 0.26, 0.34  # above the axes for their name, below them for the time axis [in]
_LEFT = 0.42  # for numbers [in]
_EDGE = 0.12  # for half of the last number of the time axis [in]

_LEDGER = (
    ("kinetic", "energy.kinetic", 0),
    ("elastic", "energy.elastic", 4),
    ("dissipated", "energy.dissipated", 1),
    ("external work", "energy.external_work", 2),
    ("hourglass", "energy.hourglass", 3),
    ("contact", "energy.contact", 5),
    ("damping", "energy.damping", 6),
)


def hinge_channel(result: Result, hinge: str, quantity: str) -> Floats | None:
    """Values of ``hinge.<name>.<quantity>``, or None."""
    channel = result.channels.get(f"hinge.{hinge}.{quantity}")
    return channel.values if channel is not None else None


def sense(result: Result, hinge: str) -> float:
    """+1 or -1: the sense of the largest rotation of a hinge."""
    rotation = hinge_channel(result, hinge, "rotation")
    if rotation is None or not np.isfinite(rotation).any():
        return 1.0
    return -1.0 if -np.nanmin(rotation) > np.nanmax(rotation) else 1.0


def ranked_hinges(result: Result) -> list[str]:
    """Hinges, those that absorbed most energy first; equal ones in the order of the input."""
    return sorted(result.hinges, key=lambda name: -result.hinges[name].energy)


def rotations(result: Result) -> str | None:
    """Rotation and angular velocity of the hinges against time, side by side, as SVG."""
    turned = _hinge_lines(result, "rotation", _DEGREES)
    turning = _hinge_lines(result, "rotation_rate", 1.0)
    if not turned or not len(result.time):
        return None
    figure = new_figure(WIDTH, _HEAD + _PANEL + _FOOT)
    # one hinge: radians stand right of its rotation; several: their names stand right of both
    room = label_room([line.name for line in turned if not line.faint])
    right = (_LEFT, _EDGE) if len(turned) == 1 else (room, room)
    width = (WIDTH - 2 * _LEFT - sum(right)) / 2
    axes = add_axes(figure, _LEFT, _FOOT, width, _PANEL)
    over_time(axes, result.time, turned, "Rotation, deg")
    if len(turned) == 1:
        _radians_on_the_right(axes)
    if turning:
        axes = add_axes(figure, WIDTH - width - right[1], _FOOT, width, _PANEL)
        over_time(axes, result.time, turning, "Angular velocity, rad/s")
    return to_svg(figure, "rotation", "Rotation and angular velocity of the hinges against time.")


def energy_over_rotation(result: Result) -> str | None:
    """Energy dissipated in each hinge against its rotation, as SVG."""
    lines = []
    peak = largest([e for h in result.hinges if (e := hinge_channel(result, h, "energy")) is not None])
    unit, factor = display_unit("J", peak)
    for index, name in enumerate(ranked_hinges(result)[:DRAWN]):
        rotation, energy = (hinge_channel(result, name, quantity) for quantity in ("rotation", "energy"))
        if rotation is not None and energy is not None:
            x = sense(result, name) * rotation * _DEGREES
            lines.append(Line(name, x, energy / factor, index, faint=index >= NAMED))
    if not lines or not len(result.time):
        return None
    figure = new_figure(HALF, _HEAD + _PANEL + _FOOT)
    right = label_room([line.name for line in lines if not line.faint]) if len(lines) > 1 else _EDGE
    axes = add_axes(figure, _LEFT, _FOOT, HALF - _LEFT - right, _PANEL)
    axes.set_xlim(*spread([line.x for line in lines], margin=0.04))
    axes.set_ylim(*spread([line.y for line in lines]))
    name_axes(axes, "rotation, deg", f"Dissipated energy, {unit}")
    draw_lines(axes, lines, labels=len(lines) > 1)
    return to_svg(figure, "energy-rotation", "Energy dissipated in each hinge against its rotation.")


def ledger(result: Result, bound: float | None = None) -> str | None:
    """Energies over time and, beside them, the residual of their balance with its bound, as SVG.

    Parameters
    ----------
    result
        Its channels ``energy.*`` are drawn.
    bound
        Largest residual allowed, over the energy input [-]; None if unknown.
    """
    shown = [(name, result.channels[key], index) for name, key, index in _LEDGER if key in result.channels]
    if not shown or not len(result.time):
        return None
    peak = largest([channel.values for _, channel, _ in shown])
    unit, factor = display_unit("J", peak)
    lines = [Line(name, _times(result), channel.values / factor, i) for name, channel, i in shown]
    # energies that stay below a thousandth of the total would lie on the axis
    lines = [line for line in lines if largest([line.y]) > 1e-3 * peak / factor] or lines[:1]
    share = residual_share(result)
    figure = new_figure(WIDTH, _HEAD + _PANEL + 0.15 + _FOOT)
    names = 0.9
    beside = 1.5 if share is not None else 0.0
    width = WIDTH - _LEFT - names - (0.5 + beside + _EDGE if beside else 0.0)
    axes = add_axes(figure, _LEFT, _FOOT, width, _PANEL + 0.15)
    over_time(axes, result.time, lines, f"Energy, {unit}", labels=True)
    if share is not None:
        axes = add_axes(figure, WIDTH - beside - _EDGE, _FOOT, beside, _PANEL + 0.15)
        _draw_residual(axes, result.time, 100 * share, None if bound is None else 100 * bound)
    description = "Kinetic, elastic and dissipated energy and external work against time, and their residual."
    return to_svg(figure, "energy", description)


def residual_share(result: Result) -> Floats | None:
    """Residual of the energy balance over the energy input [-], shape (n_times,); None if unknown."""
    residual = result.channels.get("energy.residual")
    if residual is None:
        return None
    start = sum(result[key][0] for key in ("energy.kinetic", "energy.elastic") if key in result.channels)
    work = result.channels.get("energy.external_work")
    put_in = float(start) + (largest([work.values]) if work is not None else 0.0)
    return residual.values / put_in if put_in > 0 else None


def _draw_residual(axes: Axes, time: Floats, percent: Floats, bound: float | None) -> None:
    """Residual on the scale of its bound, so that a small residual looks small."""
    line = Line("residual", time / time_unit(float(time[-1]))[1], percent, 0)
    over_time(axes, time, [line], "Residual, % of energy input", labels=False)
    reach = largest([percent])
    if bound is not None:
        size = 1.3 * max(bound, reach)
        axes.set_ylim(-size, size)
        for side in (-bound, bound):
            axes.axhline(side, color=WARNING, linewidth=0.6, linestyle=(0, (2, 2)))
        axes.annotate(
            "bound", (1, bound), (0, 2), xycoords=axes.get_yaxis_transform(), textcoords="offset points",
            ha="right", va="bottom", color=WARNING, fontsize=7.0,
        )  # fmt: skip
        axes.spines["bottom"].set_visible(False)
        axes.axhline(0.0, color=RULE, linewidth=0.6, zorder=1)
    elif reach < 1e-6:
        axes.set_ylim(-1e-6, 1e-6)
        axes.set_yticks([0.0])


def outputs(result: Result) -> str | None:
    """Requested channels against time, the directions of a vector together, two panels in a row, as SVG."""
    groups = output_groups(result)[0][:MAX_OUTPUTS]
    if not groups or not len(result.time):
        return None
    columns = 2
    rows = math.ceil(len(groups) / columns)
    height, head = 1.3, 0.36
    figure = new_figure(WIDTH, rows * (head + height + _FOOT))
    for i, group in enumerate(groups):
        row, column = divmod(i, columns)
        bottom = (rows - row - 1) * (head + height + _FOOT) + _FOOT
        labelled = any(label for label, _ in group.channels)
        width = WIDTH / columns - _LEFT - (0.24 if labelled else _EDGE)
        axes = add_axes(figure, _LEFT + column * WIDTH / columns, bottom, width, height)
        unit, factor = display_unit(group.unit, largest([channel.values for _, channel in group.channels]))
        lines = [
            Line(label, _times(result), channel.values / factor, max("xyz".find(label), 0) if label else 0)
            for label, channel in group.channels
        ]
        name = f"{short(group.name, 44)}, {unit}" if unit else short(group.name, 44)
        over_time(axes, result.time, lines, name, labels=labelled)
    return to_svg(figure, "outputs", "Requested outputs against time.")


def _times(result: Result) -> Floats:
    """Times in the unit of the time axis."""
    return result.time / time_unit(float(result.time[-1]))[1] if len(result.time) else result.time


def _hinge_lines(result: Result, quantity: str, factor: float) -> list[Line]:
    lines = []
    for index, name in enumerate(ranked_hinges(result)[:DRAWN]):
        values = hinge_channel(result, name, quantity)
        if values is not None:
            lines.append(Line(name, _times(result), values * factor, index, faint=index >= NAMED))
    return lines


def over_time(
    axes: Axes, time: Floats, lines: Sequence[Line], name: str, *, labels: bool | None = None
) -> None:
    """Lines over the whole time, with the zero line marked where it is inside."""
    unit, factor = time_unit(float(time[-1]))
    start, end = float(time[0]) / factor, float(time[-1]) / factor
    axes.set_xlim(start, end if end > start else start + 1.0)
    axes.set_ylim(*spread([line.y for line in lines]))
    low, high = axes.get_ylim()
    if low < 0 < high:
        axes.axhline(0.0, color=RULE, linewidth=0.6, zorder=1)
        axes.spines["bottom"].set_visible(False)
    name_axes(axes, f"time, {unit}", name)
    draw_lines(axes, lines, labels=len(lines) > 1 if labels is None else labels)


def _radians_on_the_right(axes: Axes) -> None:
    """The same rotation in radians, at round values right of the axes."""
    low, high = (limit / _DEGREES for limit in axes.get_ylim())
    ticks = [tick for tick in axes.yaxis.get_major_locator().tick_values(low, high) if low <= tick <= high]
    places = [("rad", 1.0, 11.5), *((f"{tick:.3g}".replace("-", "\u2212"), tick, 0.0) for tick in ticks)]
    for text, tick, rise in places:
        at = (1, 1) if rise else (1, tick * _DEGREES)
        axes.annotate(
            text,
            at,
            (4, rise),
            xycoords="axes fraction" if rise else axes.get_yaxis_transform(),
            textcoords="offset points",
            va="center",
            color=MUTED,
            fontsize=7.5,
            annotation_clip=False,
        )
