"""Histories: rotation and angular velocity, energy against rotation, the energy ledger, requested outputs.

Curves over time are drawn where something happens, see `drawing.window`.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes

from crumple.numeric.arrays import Floats
from crumple.numeric.ranking import largest_first
from crumple.report.drawing.scales import display_unit, largest, output_groups, spread, time_unit
from crumple.report.drawing.style import (
    HALF,
    MUTED,
    RULE,
    WARNING,
    Line,
    add_axes,
    draw_lines,
    label_room,
    name_axes,
    new_figure,
    short,
    to_svg,
)
from crumple.report.drawing.window import happening
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
    return largest_first({name: hinge.energy for name, hinge in result.hinges.items()})


def panel(
    name: str,
    description: str,
    lines: Sequence[Line],
    axes_names: tuple[str, str],
    *,
    over: Floats | None = None,
) -> str | None:
    """Curves on axes of half the width of a page as SVG; None without any.

    Parameters
    ----------
    name, description
        Of the figure, see `to_svg`.
    lines
        In display units; the names of several are written at their ends.
    axes_names
        Of x and y; over time, x is named by `over`.
    over
        Times [s] if the curves are over time; their x is then in its unit.
    """
    if not lines or not len(lines[0].x):
        return None
    labels = sum(not line.faint for line in lines) > 1
    figure = new_figure(HALF, _HEAD + _PANEL + _FOOT)
    right = label_room([line.name for line in lines if not line.faint]) if labels else _EDGE
    axes = add_axes(figure, _LEFT, _FOOT, HALF - _LEFT - right, _PANEL)
    if over is not None:
        over_time(axes, over, lines, axes_names[1], labels=labels)
    else:
        axes.set_xlim(*spread([line.x for line in lines], margin=0.04))
        axes.set_ylim(*spread([line.y for line in lines]))
        name_axes(axes, *axes_names)
        draw_lines(axes, lines, labels=labels)
    return to_svg(figure, name, description)


def rotation(result: Result) -> str | None:
    """Rotation of the hinges against time, as SVG."""
    turned = _hinge_lines(result, "rotation", _DEGREES)
    if len(turned) != 1:
        text = "Rotation of the hinges against time."
        return panel("rotation", text, turned, ("", "Rotation, deg"), over=_shown_times(result))
    figure = new_figure(HALF, _HEAD + _PANEL + _FOOT)
    # radians stand right of it
    axes = add_axes(figure, _LEFT, _FOOT, HALF - 2 * _LEFT, _PANEL)
    if not len(result.time):
        return None
    over_time(axes, _shown_times(result), turned, "Rotation, deg")
    _radians_on_the_right(axes)
    return to_svg(figure, "rotation", "Rotation of the hinge against time.")


def angular_velocity(result: Result) -> str | None:
    """Angular velocity of the hinges against time, as SVG."""
    turning = _hinge_lines(result, "rotation_rate", 1.0)
    text = "Angular velocity of the hinges against time."
    names = ("", "Angular velocity, rad/s")
    return panel("angular-velocity", text, turning, names, over=_shown_times(result))


def energy_over_rotation(result: Result) -> str | None:
    """Energy dissipated in each hinge against its rotation, as SVG."""
    lines = []
    peak = largest([e for h in result.hinges if (e := hinge_channel(result, h, "energy")) is not None])
    unit, factor = display_unit("J", peak)
    for index, name in enumerate(ranked_hinges(result)[:DRAWN]):
        rotation, energy = (hinge_channel(result, name, quantity) for quantity in ("rotation", "energy"))
        if rotation is not None and energy is not None and result.hinges[name].bends:
            x = sense(result, name) * rotation * _DEGREES
            lines.append(Line(name, x, energy / factor, index, faint=index >= NAMED))
    text = "Energy dissipated in each hinge against its rotation."
    return panel("energy-rotation", text, lines, ("rotation, deg", f"Dissipated energy, {unit}"))


def energies(result: Result) -> str | None:
    """Kinetic, elastic and dissipated energy and so on against time, as SVG."""
    shown = [(name, result.channels[key], index) for name, key, index in _LEDGER if key in result.channels]
    if not shown or not len(result.time):
        return None
    peak = largest([channel.values for _, channel, _ in shown])
    unit, factor = display_unit("J", peak)
    part = happening(result)
    lines = [Line(name, _times(result), channel.values[part] / factor, i) for name, channel, i in shown]
    # energies that stay below a thousandth of the total would lie on the axis
    lines = [line for line in lines if largest([line.y]) > 1e-3 * peak / factor] or lines[:1]
    text = "Kinetic, elastic and dissipated energy and external work against time."
    return panel("energy", text, lines, ("", f"Energy, {unit}"), over=_shown_times(result))


def residual(result: Result, bound: float | None = None) -> str | None:
    """Residual of the energy balance with its bound, as SVG.

    Parameters
    ----------
    result
        Its channels ``energy.*`` are drawn.
    bound
        Largest residual allowed, over the energy input [-]; None if unknown.
    """
    share = residual_share(result) if len(result.time) else None
    if share is None:
        return None
    figure = new_figure(HALF, _HEAD + _PANEL + _FOOT)
    axes = add_axes(figure, _LEFT + 0.1, _FOOT, HALF - _LEFT - 0.1 - _EDGE, _PANEL)
    _draw_residual(axes, result.time, 100 * share, None if bound is None else 100 * bound)
    return to_svg(figure, "residual", "Residual of the energy balance against time.")


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


def outputs(result: Result) -> list[str | None]:
    """Requested channels against time, the directions of a vector together, each as SVG."""
    found = []
    for i, group in enumerate(output_groups(result)[0][:MAX_OUTPUTS], 1):
        unit, factor = display_unit(group.unit, largest([channel.values for _, channel in group.channels]))
        lines = [
            Line(
                label,
                _times(result),
                channel.values[happening(result)] / factor,
                max("xyz".find(label), 0) if label else 0,
            )
            for label, channel in group.channels
        ]
        name = f"{short(group.name, 44)}, {unit}" if unit else short(group.name, 44)
        text = "A requested output against time."
        found.append(panel(f"output-{i}", text, lines, ("", name), over=_shown_times(result)))
    return found


def _shown_times(result: Result) -> Floats:
    """Output times that are shown [s]."""
    return result.time[happening(result)]


def _times(result: Result) -> Floats:
    """Times that are shown, in the unit of the time axis."""
    shown = _shown_times(result)
    return shown / time_unit(float(shown[-1]))[1] if len(shown) else shown


def _hinge_lines(result: Result, quantity: str, factor: float) -> list[Line]:
    lines = []
    for index, name in enumerate(ranked_hinges(result)[:DRAWN]):
        values = hinge_channel(result, name, quantity)
        if values is not None and result.hinges[name].bends:
            shown = values[happening(result)] * factor
            lines.append(Line(name, _times(result), shown, index, faint=index >= NAMED))
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
