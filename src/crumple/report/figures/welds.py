"""Figures of spot welds over time: load over strength, and forces of the most loaded entries."""

from __future__ import annotations

import re

import numpy as np

from crumple.numeric.arrays import Floats
from crumple.numeric.ranking import largest_first
from crumple.report.drawing.scales import display_unit, largest, time_unit
from crumple.report.drawing.style import WARNING, WIDTH, Line, add_axes, label_room, new_figure, to_svg
from crumple.report.figures.curves import over_time
from crumple.result import Result

MOST_RATIOS, MOST_FORCES = 6, 3
"""Most entries whose load over strength, and whose two forces, are drawn: the most loaded."""

_ENTRY = re.compile(r"weld\.(.+)\.normal_force")
_PANEL, _HEAD, _FOOT, _LEFT = 1.75, 0.26, 0.34, 0.42  # [in]


def weld_entries(result: Result) -> list[str]:
    """Entries of spot welds of which the result has histories."""
    return [match[1] for name in result.channels if (match := _ENTRY.fullmatch(name))]


def weld_loads(result: Result) -> tuple[str, str] | None:
    """Load over strength and forces of spot welds over time, as SVG, and its caption; None without any.

    The load over strength is the root of (Fn/Sn)^2 + (Fs/Ss)^2, the largest so far of any spot of an entry;
    a spot fails at 1.
    """
    entries = weld_entries(result)
    if not entries or not result.time.size:
        return None
    panels = [panel for panel in (_ratios(result, entries), _forces(result, entries)) if panel]
    rooms = [label_room([line.name for line in lines]) for _, lines in panels]
    figure = new_figure(WIDTH, _HEAD + _PANEL + _FOOT)
    width = (WIDTH - sum(rooms) - len(panels) * _LEFT) / len(panels)
    left = 0.0
    for (name, lines), room in zip(panels, rooms, strict=True):
        axes = add_axes(figure, left + _LEFT, _FOOT, width, _PANEL)
        over_time(axes, result.time, lines, name, labels=True)
        if name == _RATIO and axes.get_ylim()[1] > 1.0:
            axes.axhline(1.0, color=WARNING, linewidth=0.8, zorder=1)
        left += _LEFT + width + room
    return to_svg(figure, "welds", "Loads of spot welds against time."), _caption(panels, len(entries))


_RATIO = "Load over strength so far"


def _ratios(result: Result, entries: list[str]) -> tuple[str, list[Line]] | None:
    """Load over strength of the entries that can fail, the most loaded first."""
    found = {n: c.values for n in entries if (c := result.channels.get(f"weld.{n}.use")) is not None}
    ranked = largest_first({name: float(found[name].max(initial=0.0)) for name in found})[:MOST_RATIOS]
    lines = [Line(name, _times(result), np.sqrt(found[name]), i) for i, name in enumerate(ranked)]
    return (_RATIO, lines) if lines else None


def _forces(result: Result, entries: list[str]) -> tuple[str, list[Line]]:
    """Largest forces across and along the sheets in an intact spot, of the most loaded entries."""
    found = {name: [result[f"weld.{name}.{key}_force"] for key in ("normal", "shear")] for name in entries}
    ranked = largest_first({name: _most(found[name]) for name in found})[:MOST_FORCES]
    unit, factor = display_unit("N", largest([force for name in ranked for force in found[name]]))
    lines = [
        Line(f"{name}, {way}", _times(result), force / factor, 2 * i + k)
        for i, name in enumerate(ranked)
        for k, (way, force) in enumerate(zip(("across", "along"), found[name], strict=True))
    ]
    return f"Largest force in a spot, {unit}", lines


def _times(result: Result) -> Floats:
    """In the unit of the axis."""
    return result.time / time_unit(float(result.time[-1]))[1]


def _most(forces: list[Floats]) -> float:
    return max(float(np.abs(force).max(initial=0.0)) for force in forces)


def _caption(panels: list[tuple[str, list[Line]]], number: int) -> str:
    sentences = []
    for name, lines in panels:
        if name == _RATIO:
            few = f" The {len(lines)} most loaded of {number} entries." if len(lines) < number else ""
            sentences.append(
                "Load over strength, the root of (Fn/Sn)^2 + (Fs/Ss)^2, the largest so far of any spot of "
                f"each entry: a spot fails at 1.{few}"
            )
        else:
            few = (
                f", of the {len(lines) // 2} most loaded of {number} entries"
                if len(lines) // 2 < number
                else ""
            )
            sentences.append(
                f"Largest force across (tension positive) and along the sheets in an intact spot{few}."
            )
    return f"Spot welds. {' '.join(sentences)}"
