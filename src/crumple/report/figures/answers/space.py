"""Crush of zones, intrusion and clearance, energy by zone, and acceleration through a CFC filter."""

from __future__ import annotations

import numpy as np

from crumple.errors import InputError
from crumple.numeric.arrays import Floats
from crumple.numeric.ranking import largest_first
from crumple.report.drawing.scales import display_unit, largest, time_unit
from crumple.report.drawing.style import (
    HALF,
    INK,
    SERIES,
    Line,
    add_axes,
    name_axes,
    new_figure,
    short,
    to_svg,
)
from crumple.report.drawing.window import happening
from crumple.report.figures.answers.force import Panel, over_path
from crumple.report.figures.curves import hinge_channel, panel
from crumple.result import Result
from crumple.structure import Outputs, Structure

MOST_ZONES = 4
"""Crush zones with a figure of their own."""
MOST_BARS = 10
"""Members, or hinges, in the figure of energies."""
MOST_NODES = 2
"""Nodes whose acceleration is filtered without a request."""
GRAVITY = 9.80665
"""Standard acceleration of free fall [m/s^2]."""


def crush_panels(result: Result) -> list[Panel]:
    """Axial force over shortening of the zones that absorbed most."""
    zones = {name: hinge.crush for name, hinge in result.hinges.items() if hinge.crush is not None}
    longest = max((zone.length for zone in zones.values()), default=0.0)
    ranked = largest_first(
        {name: zone.energy for name, zone in zones.items() if zone.length > 1e-3 * longest > 0.0}
    )
    found: list[Panel] = []
    for i, name in enumerate(ranked[:MOST_ZONES], 1):
        travel, force = (hinge_channel(result, name, f"slip.x.{what}") for what in ("travel", "force"))
        if travel is None or force is None or not (np.isfinite(travel).all() and np.isfinite(force).all()):
            continue
        label, zone = (f"Force of {short(name, 22)}", "N"), zones[name]
        # the work of the steps: a sum over the outputs errs in the peaks of the law and of closed folds
        known = zone.mean_force, zone.peak_force
        found.append((f"crush_{i}", over_path(f"crush-{i}", label, -travel, -force, "crush", known)))
    return found


def space_panels(result: Result, outputs: Outputs | None) -> list[Panel]:
    """Changes of distances, and clearances with the line of contact, over time."""
    if outputs is None or not len(result.time):
        return []
    text = "Changes of distances against time, negative if the points come nearer."
    found = [
        ("distances", _over_time(result, list(outputs.distances), "distances", "Change of distance", text))
    ]
    for i, name in enumerate(outputs.clearances, 1):
        text = f"Clearance of the space {short(name)} against time, negative inside."
        figure = f"clearance-{i}"
        found.append(
            (f"clearance_{i}", _over_time(result, [name], figure, f"Clearance of {short(name, 20)}", text))
        )
    return found


def pulse_panels(result: Result, structure: Structure | None, outputs: Outputs | None) -> list[Panel]:
    """Accelerations through CFC filters: those requested, else of the heaviest nodes through CFC 60."""
    if not len(result.time):
        return []
    requested = list(outputs.filters) if outputs is not None else []
    curves = {
        name: result.channels[name].values
        for name in requested
        if name in result.channels and result.channels[name].unit == "m/s^2"
    }
    head = "Filtered acceleration, g"
    if not curves and structure is not None:
        curves, head = _filtered(result, structure), "Acceleration, CFC 60, g"
    part = happening(result)
    times = _times(result)
    lines = [Line(name, times, values[part] / GRAVITY, i) for i, (name, values) in enumerate(curves.items())]
    text = "Acceleration through a channel frequency class against time."
    return [("pulse", panel("pulse", text, lines, ("", head), over=result.time[part]))]


def _filtered(result: Result, structure: Structure) -> dict[str, Floats]:
    """Largest component of the acceleration of the heaviest nodes with histories, through CFC 60."""
    masses = sorted(structure.masses.values(), key=lambda mass: -mass.mass)
    nodes = dict.fromkeys(m.node for m in masses if f"node.{m.node}.acceleration.x" in result.channels)
    found: dict[str, Floats] = {}
    for node in list(nodes)[:MOST_NODES]:
        filtered = {}
        for axis in "xyz":
            try:
                channel = result.filtered(f"node.{node}.acceleration.{axis}", 60)
            except InputError:
                # sampled too coarsely, or not equally
                return {}
            filtered[axis] = channel.values
        axis = largest_first({key: largest([filtered[key]]) for key in filtered})[0]
        if largest([filtered[axis]]) > 0.0:
            found[f"{node} {axis}"] = filtered[axis]
    return found


def zone_panels(result: Result) -> list[Panel]:
    """Energy absorbed by the members, or by the hinges of a result without it, as bars."""
    energies = {
        name.removeprefix("member.").removesuffix(".energy"): float(channel.values[-1])
        for name, channel in result.channels.items()
        if name.startswith("member.") and name.endswith(".energy") and len(channel.values)
    }
    what = "member"
    if len(energies) < 2:
        energies, what = {name: hinge.energy for name, hinge in result.hinges.items()}, "hinge"
    energies = {name: energy for name, energy in energies.items() if np.isfinite(energy)}
    if len(energies) < 2 or not max(energies.values()) > 0.0:
        return []
    return [("zones", _bars(energies, what))]


def _bars(energies: dict[str, float], what: str) -> str:
    """Horizontal bars, the longest above."""
    ranked = largest_first(energies)[:MOST_BARS]
    kept = [(name, energies[name]) for name in ranked if energies[name] > 1e-3 * energies[ranked[0]]]
    unit, factor = display_unit("J", kept[0][1])
    values = [energy / factor for _, energy in kept]
    figure = new_figure(HALF, 2.35)
    left = min(0.15 + 0.058 * max(len(short(name, 20)) for name, _ in kept), 1.35)
    axes = add_axes(figure, left, 0.34, HALF - left - 0.45, 1.75)
    rows = np.arange(len(kept))
    axes.barh(rows, values, height=0.62, color=SERIES[0], linewidth=0)
    axes.set_ylim(max(len(kept), 4) - 0.5, -0.5)
    axes.set_xlim(0.0, max(values))
    axes.set_yticks(rows, [short(name, 20) for name, _ in kept])
    axes.grid(visible=False, axis="y")
    axes.grid(visible=True, axis="x")
    total = sum(energies.values())
    for row, (value, (_, energy)) in enumerate(zip(values, kept, strict=True)):
        axes.annotate(
            f"{100 * energy / total:.0f} %", (value, row), (3, 0), textcoords="offset points",
            va="center", fontsize=7.5, color=INK, annotation_clip=False,
        )  # fmt: skip
    name_axes(axes, "", f"Energy absorbed by {what}, {unit}")
    return to_svg(figure, "zones", f"Energy absorbed by each {what}.")


def _over_time(result: Result, names: list[str], figure: str, head: str, text: str) -> str | None:
    """Channels of one unit against time."""
    shown = {n: result.channels[n].values[happening(result)] for n in names if n in result.channels}
    unit, factor = display_unit("m", largest(list(shown.values())))
    lines = [Line(name, _times(result), values / factor, i) for i, (name, values) in enumerate(shown.items())]
    return panel(figure, text, lines, ("", f"{head}, {unit}"), over=result.time[happening(result)])


def _times(result: Result) -> Floats:
    """Times that are shown, in the unit of the time axis."""
    shown = result.time[happening(result)]
    return np.asarray(shown / time_unit(float(shown[-1]))[1])
