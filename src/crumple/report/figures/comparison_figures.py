"""Figures of a comparison: motion over time, histories of curve files, energy over rotation in two forms."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence

import numpy as np

from crumple.comparison import Comparison, Source, rate_of
from crumple.numeric.arrays import Floats
from crumple.report.drawing.scales import display_unit, largest, spread, time_unit
from crumple.report.drawing.style import (
    HALF,
    RULE,
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

_DEGREES = math.degrees(1.0)
_PANEL = 1.9  # height of the axes [in]
_HEAD, _FOOT = 0.26, 0.34
_LEFT, _RIGHT = 0.42, 0.95
_ORDER = (1, 0, 2, 3, 4, 5)
"""Colours of reference, candidate and further models, so that the first two keep theirs."""
MOST_CHANNELS = 4
"""Histories of curve files with a figure of their own."""
SAMPLES = 400
"""Number of points at which two curves are compared to find a shift."""


def motion_over_time(comparison: Comparison, name: str, figure_name: str) -> str | None:
    """Rotation and angular velocity of one hinge over time, in every source that contains it, as SVG."""
    unit = _time_factor(comparison)
    turned, turning = [], []
    for index, (label, time, rotation, rate) in enumerate(_measures(comparison, name)):
        turned.append(Line(label, time / unit, rotation * _DEGREES, index))
        turning.append(Line(label, time / unit, rate, index))
    if not turned:
        return None
    figure = new_figure(WIDTH, _HEAD + _PANEL + _FOOT)
    width = (WIDTH - 2 * _LEFT - _RIGHT - 0.15) / 2
    axes = add_axes(figure, _LEFT, _FOOT, width, _PANEL)
    _draw(axes, turned, _time_name(comparison), "Rotation, deg", labels=False)
    axes = add_axes(figure, 2 * _LEFT + width + 0.15, _FOOT, width, _PANEL)
    _draw(axes, turning, _time_name(comparison), "Angular velocity, rad/s", labels=True)
    return to_svg(figure, figure_name, f"Rotation and angular velocity of hinge {name} against time.")


def _measures(comparison: Comparison, name: str) -> list[tuple[str, Floats, Floats, Floats]]:
    """Lines of one hinge in its sense: label, time, rotation, rate; then those of curve files."""
    first, second = comparison.candidate, comparison.reference
    lines: list[tuple[str, Floats, Floats, Floats]] = []
    a, b = first.hinge(name), second.hinge(name)
    if a is not None:
        lines.append((first.name, a.time, a.sense * a.rotation, a.sense * a.rotation_rate))
    if b is not None:
        lines.append((f"{second.name}, near", b.time, b.sense * b.rotation, b.sense * b.rotation_rate))
        if b.far is not None:
            far = b.sense * b.far
            lines.append((f"{second.name}, far end", b.time, far, rate_of(far, b.time)))
    motion = b or a
    if motion is not None:
        for curve in comparison.curves:
            for key in (f"hinge.{name}.rotation", f"member.{motion.member}.chord_rotation"):
                signal = curve.signals.get(key)
                if signal is not None:
                    values = motion.sense * signal.values
                    lines.append((curve.name, signal.time, values, rate_of(values, signal.time)))
    return lines


def drawn_channels(comparison: Comparison) -> list[str]:
    """Histories of curve files that a result also has and no other figure shows, at most `MOST_CHANNELS`."""
    elsewhere = re.compile(r"hinge\..+\.rotation|member\..+\.chord_rotation")
    names = dict.fromkeys(name for curve in comparison.curves for name in curve.signals)
    return [
        name
        for name in names
        if not elsewhere.fullmatch(name)
        and any(p.channel == name and p.reference in _files(comparison) for p in comparison.pairs)
    ][:MOST_CHANNELS]


def _files(comparison: Comparison) -> set[str]:
    return {curve.name for curve in comparison.curves}


def history(comparison: Comparison, channel: str, figure_name: str) -> str:
    """One history against time in both results and every curve file that has it, as SVG."""
    sources = [(s.name, s.signals.get(channel)) for s in (comparison.candidate, comparison.reference)]
    curves = [(c.name, c.signals.get(channel)) for c in comparison.curves]
    unit_of_all = next(s.unit for _, s in curves if s is not None)
    found = [
        (name, s, i)
        for i, (name, s) in enumerate(sources + curves)
        if s is not None and s.unit == unit_of_all
    ]
    time = _time_factor(comparison)
    unit, factor = display_unit(unit_of_all, largest([s.values for _, s, _ in found]))
    # a curve that is longer than the runs is drawn up to their end
    end = max(float(s.result.time[-1]) for s in (comparison.candidate, comparison.reference)) * (1.0 + 1e-9)
    lines = [
        Line(name, s.time[s.time <= end] / time, s.values[s.time <= end] / factor, index)
        for name, s, index in found
    ]
    figure = new_figure(HALF, _HEAD + _PANEL + _FOOT)
    axes = add_axes(figure, _LEFT, _FOOT, HALF - _LEFT - _RIGHT, _PANEL)
    _draw(
        axes, [line for line in lines if len(line.x)], _time_name(comparison), f"{short(channel, 34)}, {unit}"
    )
    return to_svg(figure, figure_name, f"{channel} against time.")


def total_energy_shifted(comparison: Comparison, name: str, figure_name: str) -> tuple[str, str] | None:
    """Total energy over rotation with the candidate shifted in rotation, as SVG, and the shifts in words.

    The candidate's curve is moved by the mean horizontal distance to the reference's over the energies that
    both reach.  The shift represents the elastic bending that rigid bars lack.
    """
    first, second = comparison.candidate, comparison.reference
    a, b = first.hinge(name), second.hinge(name)
    if a is None or b is None or b.far is None:
        return None
    mine = (a.sense * a.rotation, total_energy(first, a.time))
    theirs = [
        (f"{second.name}, far end", b.sense * b.far, total_energy(second, b.time), 2),
        (f"{second.name}, near", b.sense * b.rotation, total_energy(second, b.time), 1),
    ]
    shifts = [horizontal_shift(*mine, x, y) for _, x, y, _ in theirs]
    unit, factor = display_unit("J", largest([mine[1], *(y for _, _, y, _ in theirs)]))
    lines = [Line(label, x * _DEGREES, y / factor, index) for label, x, y, index in theirs]
    lines.append(Line(f"{first.name}, shifted", (mine[0] + shifts[0]) * _DEGREES, mine[1] / factor, 0))
    svg = _energy_figure(lines, "rotation, deg", f"Total energy, {unit}", figure_name, name)
    by, near = (f"{shift * _DEGREES:.1f}°".replace("-", "−") for shift in shifts)
    words = (
        f"The {first.name} curve is shifted by {by} relative to the far end ({near} would fit the rotation "
        "near the hinge). The shift represents the elastic bending that rigid bars lack; it is a drawing "
        "aid, not a result."
    )
    return svg, words


def plastic_work_over_plastic_rotation(comparison: Comparison, name: str, figure_name: str) -> str | None:
    """Plastic work over plastic rotation, without a shift, as SVG."""
    lines = []
    found = [
        (s, m, i) for i, s in enumerate((comparison.candidate, comparison.reference)) if (m := s.hinge(name))
    ]
    unit, factor = display_unit("J", largest([m.plastic_work for _, m, _ in found]))
    for source, motion, index in found:
        plastic = np.maximum.accumulate(np.maximum(motion.sense * motion.plastic_rotation, 0.0))
        lines.append(Line(source.name, plastic * _DEGREES, motion.plastic_work / factor, index))
    if not lines:
        return None
    return _energy_figure(lines, "plastic rotation, deg", f"Plastic work, {unit}", figure_name, name)


def variants_over_rotation(comparison: Comparison, name: str) -> str | None:
    """Total energy over the rotation at the far end for every model, without shifts, as SVG."""
    lines = []
    sources = [s for s in comparison.sources if (m := s.hinge(name)) is not None and m.far is not None]
    peak = largest([total_energy(s, s.result.time) for s in sources])
    unit, factor = display_unit("J", peak)
    for index, source in enumerate(
        [comparison.reference, *(s for s in sources if s is not comparison.reference)]
    ):
        motion = source.hinge(name)
        if motion is not None and motion.far is not None:
            energy = total_energy(source, motion.time) / factor
            lines.append(Line(source.name, motion.sense * motion.far * _DEGREES, energy, _ORDER[index % 6]))
    if len(lines) < 2:
        return None
    figure = new_figure(WIDTH, _HEAD + _PANEL + 0.4 + _FOOT)
    axes = add_axes(figure, _LEFT, _FOOT, WIDTH - _LEFT - 1.5, _PANEL + 0.4)
    _draw(axes, lines, "rotation at the far end, deg", f"Total energy, {unit}", labels=True)
    return to_svg(figure, "variants", "Total energy over rotation of every model, without shifts.")


def velocity_of_models(comparison: Comparison, name: str) -> str | None:
    """Angular velocity of one hinge against time in every model, as SVG."""
    unit = _time_factor(comparison)
    shown = [comparison.reference, *(s for s in comparison.sources if s is not comparison.reference)]
    lines = [
        Line(source.name, motion.time / unit, motion.sense * motion.rotation_rate, _ORDER[index % 6])
        for index, source in enumerate(shown)
        if (motion := source.hinge(name)) is not None
    ]
    if len(lines) < 2:
        return None
    figure = new_figure(WIDTH, _HEAD + _PANEL + 0.4 + _FOOT)
    axes = add_axes(figure, _LEFT, _FOOT, WIDTH - _LEFT - 1.5, _PANEL + 0.4)
    _draw(axes, lines, _time_name(comparison), "Angular velocity near the fold, rad/s", labels=True)
    return to_svg(figure, "variants-velocity", f"Angular velocity of hinge {name} in every model.")


def total_energy(source: Source, time: Floats) -> Floats:
    """Elastic and dissipated energy of the structure [J] at given times."""
    names = [n for n in ("energy.elastic", "energy.dissipated") if n in source.result.channels]
    total = sum((source.result[n] for n in names), np.zeros_like(source.result.time))
    return np.asarray(np.interp(time, source.result.time, total))


def horizontal_shift(x: Floats, y: Floats, other_x: Floats, other_y: Floats) -> float:
    """Mean of other_x - x at equal y over the heights that both pass, from a tenth of them to nine tenths."""
    top = min(float(np.max(y)), float(np.max(other_y)))
    heights = np.linspace(0.1 * top, 0.9 * top, SAMPLES)
    return float(np.mean(_reached(other_x, other_y, heights) - _reached(x, y, heights)))


def _reached(x: Floats, y: Floats, heights: Floats) -> Floats:
    """Where a curve first reaches each height."""
    grown, first = np.unique(np.maximum.accumulate(y), return_index=True)
    return np.asarray(np.interp(heights, grown, x[first]))


def _energy_figure(lines: Sequence[Line], x: str, y: str, figure_name: str, hinge: str) -> str:
    figure = new_figure(HALF, _HEAD + _PANEL + _FOOT)
    right = max(_RIGHT, label_room([line.name for line in lines]))
    axes = add_axes(figure, _LEFT, _FOOT, HALF - _LEFT - right, _PANEL)
    _draw(axes, lines, x, y, labels=True)
    return to_svg(
        figure, figure_name, f"{y.partition(',')[0]} against {x.partition(',')[0]} of hinge {hinge}."
    )


def _draw(axes: object, lines: Sequence[Line], x: str, y: str, *, labels: bool = True) -> None:
    from matplotlib.axes import Axes  # noqa: PLC0415

    assert isinstance(axes, Axes)
    axes.set_xlim(*spread([line.x for line in lines], margin=0.02))
    axes.set_ylim(*spread([line.y for line in lines]))
    low, high = axes.get_ylim()
    if low < 0 < high:
        axes.axhline(0.0, color=RULE, linewidth=0.6, zorder=1)
        axes.spines["bottom"].set_visible(False)
    name_axes(axes, x, y)
    draw_lines(axes, lines, labels=labels)


def _time_factor(comparison: Comparison) -> float:
    return time_unit(float(comparison.candidate.result.time[-1]))[1]


def _time_name(comparison: Comparison) -> str:
    return f"time, {time_unit(float(comparison.candidate.result.time[-1]))[0]}"
