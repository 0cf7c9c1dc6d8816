"""Close-ups of the folds of a shell run, coloured by plastic strain, seen from the side that folds."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from numpy.typing import NDArray

from crumple.numeric.arrays import Floats
from crumple.report.drawing.strain import FIELD, draw_key, largest_strain, wall_colours
from crumple.report.drawing.style import INK, MUTED, WIDTH, add_axes, new_figure, to_svg
from crumple.report.drawing.view import View
from crumple.result import Result, States
from crumple.units import format_quantity

MOST_FOLDS = 3
"""Folds drawn."""
REACH = 1.6
"""Half the length of member shown over the section's largest side."""
WORTH = 0.25
"""Share of the largest strain from which a further fold is drawn."""
VISIBLE = 2e-3
"""Plastic strain below which nothing has folded: the yield strain of steel."""


@dataclass(frozen=True)
class Fold:
    """Walls of one close-up: member, station of its middle [m], and the quads shown."""

    member: str
    station: float
    quads: NDArray[np.int64]


def folds(result: Result) -> list[tuple[str, str]]:
    """SVG and caption of the folds with large strain, the most strained first; none without strain."""
    states = result.states
    top = largest_strain(states)
    if states is None or top < VISIBLE or not np.isfinite(states.displacement).all():
        return []
    drawn = []
    for i, fold in enumerate(found_folds(states)):
        caption = (
            f"Member {fold.member} around {format_quantity(fold.station, 'm', 3)} from its first node, "
            "coloured by the largest plastic strain through the wall, seen from the side that folds."
        )
        drawn.append((_draw(states, fold, top, f"fold-{i + 1}"), caption))
    return drawn


def found_folds(states: States) -> list[Fold]:
    """Places of largest plastic strain at the last time, apart from each other."""
    strain = np.nan_to_num(states.cell_data[FIELD][-1]).copy()
    member = states.member[states.quads[:, 0]]
    station = states.station[states.quads].mean(axis=1)
    worth = max(WORTH * float(strain.max()), VISIBLE)
    found: list[Fold] = []
    while len(found) < MOST_FOLDS and strain.max() > worth:
        most = int(strain.argmax())
        here = member == member[most]
        near = np.abs(station - station[most]) <= REACH * _side(states, int(member[most]))
        shown = np.flatnonzero(here & near)
        found.append(Fold(states.member_names[member[most]], float(station[most]), shown))
        # neighbouring strain belongs to the same fold
        strain[shown] = 0.0
    return found


def _side(states: States, member: int) -> float:
    """Largest side of a member's first section [m]."""
    points = states.points[states.member == member]
    ring = states.station[states.member == member]
    return float(np.linalg.norm(np.ptp(points[ring == ring.min()], axis=0)))


def _view(states: States, fold: Fold) -> View:
    """From the strained side, somewhat from beside and along, z up where it can be."""
    quads = states.quads[fold.quads]
    points = states.points + states.displacement[-1]
    corners = points[quads].mean(axis=1)
    axis = np.linalg.svd(corners - corners.mean(axis=0))[2][0]
    weight = np.nan_to_num(states.cell_data[FIELD][-1][fold.quads])
    # in the reference shape, where the section has not folded in yet
    start = states.points[quads].mean(axis=1)
    out = weight @ (start - start.mean(axis=0)) / max(float(weight.sum()), 1e-30)
    out = out - (out @ axis) * axis
    size = float(np.linalg.norm(out))
    out = out / size if size > 1e-6 else np.array([0.0, 0.0, 1.0])
    towards = 0.62 * out + 0.62 * np.cross(axis, out) + 0.35 * axis
    if towards[1] > 0.0 and abs(towards[1]) > 0.3:
        # the eye stays on the side of -y, as in the pictures of the whole
        towards = 0.62 * out - 0.62 * np.cross(axis, out) + 0.35 * axis
    towards = towards / np.linalg.norm(towards)
    up = np.array([0.0, 0.0, 1.0]) if abs(towards[2]) < 0.95 else np.array([0.0, 1.0, 0.0])
    up = up - (up @ towards) * towards
    up = up / np.linalg.norm(up)
    return View(np.cross(up, towards), up, towards)


def _draw(states: States, fold: Fold, top: float, name: str) -> str:
    view = _view(states, fold)
    quads = states.quads[fold.quads]
    moved = [states.points + displacement for displacement in states.displacement]
    flat = [view.flat(points[quads]) for points in moved]
    low = np.min([shape.reshape(-1, 2).min(axis=0) - _centre(shape) for shape in flat], axis=0)
    high = np.max([shape.reshape(-1, 2).max(axis=0) - _centre(shape) for shape in flat], axis=0)
    width, height = 1.04 * (high - low)
    columns = min(3, len(flat))
    rows = math.ceil(len(flat) / columns)
    gap, label, foot = 0.15, 0.2, 0.34
    panel_width = (WIDTH - gap * (columns - 1)) / columns
    panel_height = min(panel_width * height / width, 2.6)
    total = rows * (panel_height + label) + foot
    figure = new_figure(WIDTH, total)
    for i, shape in enumerate(flat):
        row, column = divmod(i, columns)
        bottom = total - (row + 1) * (panel_height + label)
        axes = add_axes(figure, column * (panel_width + gap), bottom, panel_width, panel_height)
        axes.set_axis_off()
        middle = _centre(shape) + (low + high) / 2
        axes.set_xlim(middle[0] - width / 2, middle[0] + width / 2)
        axes.set_ylim(middle[1] - height / 2, middle[1] + height / 2)
        axes.set_aspect("equal", anchor="W")
        colours = wall_colours(states, i, top)[fold.quads]
        _draw_walls(axes, moved[i][quads], shape, view, colours)
        time = f"{states.times[i] * 1e3:.4g} ms"
        axes.text(0, 1, time, transform=axes.transAxes, va="bottom", fontsize=8.5, color=INK)
    scale = add_axes(figure, 0, 0, WIDTH, foot)
    _draw_foot(scale, min(panel_width / width, panel_height / height), panel_width, foot, top)
    return to_svg(figure, name, f"Close-up of the fold in member {fold.member}.")


def _centre(shape: Floats) -> Floats:
    return np.asarray(shape.reshape(-1, 2).mean(axis=0))


def _draw_walls(axes: Axes, corners: Floats, flat: Floats, view: View, colours: Floats) -> None:
    """Walls farthest first, shaded by how they face the eye, the inside darker."""
    normals = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
    normals /= np.maximum(np.linalg.norm(normals, axis=1), 1e-300)[:, None]
    light = np.abs(normals @ (0.75 * view.towards + 0.6 * view.up))
    shade = np.clip(0.55 + 0.5 * light, 0.0, 1.0)[:, None]
    order = np.argsort(view.depth(corners.mean(axis=1)), kind="stable")
    painted: Any = colours * shade
    shown: Any = flat[order]
    walls = PolyCollection(
        shown, facecolors=painted[order], edgecolors="#33445544", linewidths=0.15, rasterized=True, zorder=2
    )
    axes.add_collection(walls, autolim=False)


def _draw_foot(axes: Axes, inches_per_metre: float, panel: float, height: float, top: float) -> None:
    """Scale bar on the left, colour key beside it."""
    axes.set_axis_off()
    axes.set_xlim(0, WIDTH)
    axes.set_ylim(0, height)
    target = 0.3 * panel / inches_per_metre
    power = 10.0 ** math.floor(math.log10(target))
    length = next(step * power for step in (5.0, 2.0, 1.0) if step * power <= target)
    inches, y = length * inches_per_metre, 0.1
    axes.plot(
        [0.02, 0.02, 0.02 + inches, 0.02 + inches], [y + 0.04, y, y, y + 0.04], color=MUTED, linewidth=0.8
    )
    axes.text(0.02, y + 0.06, format_quantity(length, "m"), va="bottom", color=MUTED, fontsize=7.5)
    draw_key(axes, top, 1.6, y)
