"""Deformation patterns: the member walls at the picture times, side by side at one scale."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PathCollection, PolyCollection
from matplotlib.colors import to_rgb
from matplotlib.path import Path
from numpy.typing import NDArray

from crumple.numeric.arrays import Floats
from crumple.report.drawing.narrow_walls import without_narrow_walls
from crumple.report.drawing.strain import draw_key, largest_strain, wall_colours
from crumple.report.drawing.style import (
    INK,
    MUTED,
    RASTER,
    RULE,
    SERIES,
    WIDTH,
    add_axes,
    new_figure,
    short,
    to_svg,
)  # fmt: skip
from crumple.report.drawing.view import View, choose_view, ring_centres
from crumple.result import Result, States
from crumple.units import format_quantity

_WALL = to_rgb("#9db3c8")
_GHOST = "#e9ecef"
_CREASE = math.cos(math.radians(30.0))  # walls that meet at more than this get an edge between them
_RASTER_FROM = 4000  # walls in all pictures together, from which they become an image to keep the page small
_HAIR = 0.3 / 72.0  # thickness of a member in the picture, below which its centre line is drawn [in]
_NARROW = 2.0 / RASTER  # width of a wall in an image [in], below which two cannot be told from one
_CENTRE_LINE = "#3c5268"
_NAMED_HINGES = 8
_NEAREST = 8  # points of the walls that carry a hinge
_LETTER = 4.0  # width of a letter of a hinge's name, at most [pt]

Rings = tuple[Floats, NDArray[np.int64]]
"""Section centres in every state, undeformed first, and the ring of each point, see `ring_centres`."""


@dataclass(frozen=True)
class Surface:
    """Data of all pictures that do not depend on time.

    Attributes
    ----------
    rings, ring
        Section centres, (n_states + 1, n_rings, 3), and the ring of each point, (n_points,).
    edges
        Point pairs of all wall edges, (n_edges, 2).
    sides
        The two walls at each edge, (n_edges, 2); the same wall twice at a free edge.
    sharp
        Whether the walls meet at an angle or end there, (n_edges,).
    """

    rings: Floats
    ring: NDArray[np.int64]
    edges: NDArray[np.int64]
    sides: NDArray[np.int64]
    sharp: NDArray[np.bool_]


def deformation(result: Result) -> str | None:
    """The figure as SVG, or None when the result has no states."""
    states = finite_states(result.states)
    if states is None:
        return None
    view = choose_view(states)
    drawn = view.flat(np.concatenate([states.points[None], states.points + states.displacement]))
    low, high = drawn.reshape(-1, 2).min(axis=0), drawn.reshape(-1, 2).max(axis=0)
    size = np.maximum(high - low, 1e-3 * np.max(high - low))
    low, high = low - 0.06 * size.max(), high + 0.06 * size.max()
    width, height = high - low
    columns = _columns(width / height, len(states.times))
    rows = math.ceil(len(states.times) / columns)
    gap, label, foot = 0.12, 0.2, 0.34
    panel_width = (WIDTH - gap * (columns - 1)) / columns
    panel_height = min(panel_width * height / width, 3.2)
    total = rows * (panel_height + label) + foot
    figure = new_figure(WIDTH, total)
    hinges = hinge_places(result, states)
    raster = len(states.quads) * len(states.times) > _RASTER_FROM
    inches_per_metre = min(panel_width / width, panel_height / height)
    rings = ring_centres(states)
    # walls that are thinner in the picture than a line show nothing, and take long where they are many
    thin = raster and _thickness(states, rings) * inches_per_metre < _HAIR
    if raster:
        states = without_narrow_walls(states, _NARROW / inches_per_metre)
    surface = None if thin else surface_of(states, rings)
    for i, time in enumerate(states.times):
        row, column = divmod(i, columns)
        bottom = total - (row + 1) * (panel_height + label)
        axes = add_axes(figure, column * (panel_width + gap), bottom, panel_width, panel_height)
        axes.set_axis_off()
        axes.set_xlim(low[0], high[0])
        axes.set_ylim(low[1], high[1])
        axes.set_aspect("equal", anchor="W")
        for state in (None, i):
            if surface is None:
                draw_centre_lines(axes, states, rings, view, state)
            else:
                draw_walls(axes, states, surface, view, state, raster)
        last = i == len(states.times) - 1
        draw_hinges(axes, {name: view.flat(places[i]) for name, places in hinges.items()}, named=last)
        axes.text(
            0,
            1,
            picture_time(float(time)),
            transform=axes.transAxes,
            va="bottom",
            fontsize=8.5,
            color=INK,
        )
    scale = add_axes(figure, 0, 0, WIDTH, foot)
    if top := largest_strain(states):
        draw_key(scale, top, WIDTH - 1.5, 0.1)
    draw_scale(scale, view, inches_per_metre, panel_width, foot)
    return to_svg(figure, "deformation", _description(states))


def finite_states(states: States | None) -> States | None:
    """The states that can be drawn: those in which every point has a place; None without any."""
    if states is None or not len(states.quads) or np.ptp(states.points, axis=0).max() == 0.0:
        return None
    keep = np.isfinite(states.displacement).all(axis=(1, 2))
    if not keep.any():
        return None
    cells = {name: values[keep] for name, values in states.cell_data.items()}
    return replace(states, times=states.times[keep], displacement=states.displacement[keep], cell_data=cells)


def _description(states: States) -> str:
    times = ", ".join(picture_time(float(time)) for time in states.times)
    return (
        f"Deformed shape of the member walls at {times}, over the undeformed shape in grey, all at one scale."
    )


def picture_time(time: float) -> str:
    """Time of a picture [s] in readable units."""
    return f"{time:.4g} s" if time > 2.0 else f"{time * 1e3:.4g} ms"


def _columns(aspect: float, n: int) -> int:
    """Panels in a row: few when they are flat, many when they are tall."""
    target = 2 if aspect > 3.5 else 3 if aspect > 0.8 else 4 if aspect > 0.45 else 6
    return max(1, min(target, n))


def _thickness(states: States, rings: Rings) -> float:
    """Largest distance of a wall from the centre line of its member, twice [m]."""
    centres, ring = rings
    return 2.0 * float(np.linalg.norm(states.points - centres[0][ring], axis=1).max())


def draw_centre_lines(axes: Axes, states: States, rings: Rings, view: View, state: int | None) -> None:
    """Centre lines of the members of one state; None: undeformed, grey."""
    centres, ring = rings
    flat = view.flat(centres[0 if state is None else state + 1])
    member = np.zeros(len(flat), dtype=np.int64)
    member[ring] = states.member
    # rings follow each other along a member, and member by member
    pairs = np.stack([flat[:-1], flat[1:]], axis=1)[member[:-1] == member[1:]]
    colour = _GHOST if state is None else _CENTRE_LINE
    lines: Any = pairs  # an array is taken whole; the annotations require a list
    axes.add_collection(
        LineCollection(
            lines, colors=colour, linewidths=0.8, rasterized=True, zorder=1 if state is None else 2
        ),
        autolim=False,
    )


def surface_of(states: States, rings_of_states: Rings | None = None) -> Surface:
    """Rings, edges and creases of a surface."""
    rings, ring = ring_centres(states) if rings_of_states is None else rings_of_states
    pairs = np.stack([states.quads, np.roll(states.quads, -1, axis=1)], axis=2).reshape(-1, 2)
    owner = np.repeat(np.arange(len(states.quads)), 4)
    edges, first, inverse = np.unique(np.sort(pairs, axis=1), axis=0, return_index=True, return_inverse=True)
    sides = np.stack([owner[first], owner[first]], axis=1)
    sides[inverse.reshape(-1), 1] = owner
    normals = _normals(states.points, states.quads)
    meeting = np.einsum("ij,ij->i", normals[sides[:, 0]], normals[sides[:, 1]])
    return Surface(rings, ring, edges, sides, (np.abs(meeting) < _CREASE) | (sides[:, 0] == sides[:, 1]))


def _normals(points: Floats, quads: NDArray[np.int64]) -> Floats:
    corners = points[quads]
    normals: Floats = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
    normals /= np.maximum(np.linalg.norm(normals, axis=1), 1e-300)[:, None]
    return normals


def draw_walls(
    axes: Axes, states: States, surface: Surface, view: View, state: int | None, raster: bool
) -> None:
    """Walls of one state, farthest first, edged where they meet or turn away; None: undeformed, grey."""
    points = states.points if state is None else states.points + states.displacement[state]
    quads = states.quads
    normals = _normals(points, quads)
    centres = points[quads].mean(axis=1)
    # outwards is away from the centre line, whatever order the corners came in
    middle = surface.rings[0 if state is None else state + 1][surface.ring[quads]].mean(axis=1)
    normals *= np.where(np.einsum("ij,ij->i", normals, centres - middle) < 0, -1.0, 1.0)[:, None]
    facing = view.depth(normals)
    flat = view.flat(points)
    corners: Any = flat[quads]  # an array is taken whole, which is quick; the annotations require a list
    # walls seen edge-on have nothing to fill
    seen = np.flatnonzero(np.abs(facing) > 1e-6)
    front = facing > 1e-9
    a, b = surface.sides[:, 0], surface.sides[:, 1]
    shown = (front[a] | front[b]) & (surface.sharp | (front[a] != front[b]))
    edges = _joined(flat[surface.edges[shown]])
    if state is None:
        paint: Any = {"facecolors": (_GHOST, "none"), "edgecolors": ("none", _GHOST), "linewidths": 0.4}
        ghost = PathCollection([_area(corners[seen]), edges], rasterized=raster, zorder=1, **paint)
        axes.add_collection(ghost, autolim=False)
        return
    order = seen[np.argsort(view.depth(centres[seen]), kind="stable")]
    light = np.abs(normals @ (0.75 * view.towards + 0.6 * view.up))
    shade = np.clip(0.62 + 0.5 * light, 0.0, 1.15)[:, None]
    top = largest_strain(states)
    base = wall_colours(states, state, top) if top else np.tile(_WALL, (len(quads), 1))
    colours = np.clip(1.0 - (1.0 - base) * (1.9 - shade), 0.0, 1.0)
    # a viewer smooths the edges of walls, and would show the gaps between them; an image is drawn without,
    # where lines around the walls would take most of the time
    walls = PolyCollection(
        corners[order],
        facecolors=colours[order],
        edgecolors="none" if raster else colours[order],
        linewidths=0.3,
        antialiaseds=not raster,
        rasterized=raster,
        zorder=2,
    )
    paint = {"facecolors": "none", "edgecolors": "#3c5268", "linewidths": 0.5}
    axes.add_collection(walls, autolim=False)
    axes.add_collection(PathCollection([edges], rasterized=raster, zorder=3, **paint), autolim=False)


def _joined(lines: Floats) -> Path:
    """Lines from a point to another, (n, 2, 2), as one path: drawn at once, and short in the file."""
    return Path(lines.reshape(-1, 2), np.tile([Path.MOVETO, Path.LINETO], len(lines)))


def _area(corners: Floats) -> Path:
    """Everything that quadrilaterals cover, (n, 4, 2), as one path; all run round in the same sense."""
    across, along = corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1]
    back = across[:, 0] * along[:, 1] < across[:, 1] * along[:, 0]
    rings = np.where(back[:, None, None], corners[:, ::-1], corners)
    closed = np.concatenate([rings, rings[:, :1]], axis=1).reshape(-1, 2)
    return Path(closed, np.tile([Path.MOVETO, *[Path.LINETO] * 3, Path.CLOSEPOLY], len(rings)))


class Neighbours:
    """Points in order along the axis of their largest extent: the nearest to a place lie next to it there."""

    def __init__(self, points: Floats) -> None:
        self._points = points
        self._axis = int(np.argmax(np.ptp(points, axis=0)))
        self._order = np.argsort(points[:, self._axis], kind="stable")
        self._along = points[self._order, self._axis]

    def nearest(self, place: Floats) -> tuple[NDArray[np.int64], Floats]:
        """The nearest points and their distances [m], of equal ones those with the lower number."""
        here, count = float(place[self._axis]), len(self._order)
        middle, reach = int(np.searchsorted(self._along, here)), 8 * _NEAREST
        while True:
            low, high = max(middle - reach, 0), min(middle + reach, count)
            window = np.sort(self._order[low:high])
            distance = np.linalg.norm(self._points[window] - place, axis=1)
            chosen = np.argsort(distance, kind="stable")[:_NEAREST]
            below = here - float(self._along[low - 1]) if low else math.inf
            above = float(self._along[high]) - here if high < count else math.inf
            # nothing outside the window can be nearer than its ends
            if high - low == count or distance[chosen[-1]] < min(below, above):
                return window[chosen], distance[chosen]
            reach *= 2


def hinge_places(result: Result, states: States) -> dict[str, Floats]:
    """Place of every hinge in every state, (n_states, 3): it moves with the walls around it."""
    places = {}
    around = Neighbours(states.points)
    for name, hinge in result.hinges.items():
        start = np.array(hinge.position)
        near, distance = around.nearest(start)
        weight = 1.0 / (distance + 1e-6) ** 2
        moved = np.einsum("j,ijk->ik", weight / weight.sum(), states.displacement[:, near])
        places[name] = start + moved
    return places


def draw_hinges(axes: Axes, places: dict[str, Floats], *, named: bool) -> None:
    """Circles at the hinges, with their names where there are few."""
    if not places:
        return
    spots = np.array(list(places.values()))
    axes.plot(
        spots[:, 0],
        spots[:, 1],
        "o",
        markersize=4.0 if len(places) <= _NAMED_HINGES else 2.2,
        markerfacecolor="white",
        markeredgecolor=SERIES[1],
        markeredgewidth=1.1,
        zorder=4,
        clip_on=False,
    )
    if named and len(places) <= _NAMED_HINGES:
        (left, right), wide = axes.get_xlim(), 72 * axes.get_window_extent().width / axes.figure.dpi
        for name, (x, y) in places.items():
            label = short(name, 20)
            room = wide * (right - x) / (right - left)
            before = room < 5 + _LETTER * len(label) < wide
            axes.annotate(
                label,
                (x, y),
                (-5 if before else 5, -4),
                textcoords="offset points",
                ha="right" if before else "left",
                va="top",
                color=SERIES[1],
                fontsize=7.0,
                zorder=5,
                annotation_clip=False,
                bbox={"facecolor": "white", "edgecolor": "none", "alpha": 0.75, "pad": 0.4},
            )


def draw_scale(axes: Axes, view: View, inches_per_metre: float, panel: float, height: float) -> None:
    """Scale bar on the left, directions of the world axes beside it."""
    axes.set_axis_off()
    axes.set_xlim(0, WIDTH)
    axes.set_ylim(0, height)
    target = 0.3 * panel / inches_per_metre
    power = 10.0 ** math.floor(math.log10(target))
    length = next(step * power for step in (5.0, 2.0, 1.0) if step * power <= target)
    inches = length * inches_per_metre
    y = 0.1
    axes.plot(
        [0.02, 0.02, 0.02 + inches, 0.02 + inches], [y + 0.04, y, y, y + 0.04], color=MUTED, linewidth=0.8
    )
    axes.text(0.02, y + 0.06, format_quantity(length, "m"), va="bottom", color=MUTED, fontsize=7.5)
    x = 0.02 + max(inches, 0.5) + 0.45
    for name, (right, up) in view.axis_arrows():
        axes.annotate(
            "",
            (x + 0.2 * right, y + 0.2 * up),
            (x, y),
            arrowprops={"arrowstyle": "-|>", "color": RULE, "linewidth": 0.8, "shrinkA": 0, "shrinkB": 0},
        )
        axes.text(x + 0.27 * right, y + 0.27 * up, name, color=MUTED, fontsize=7.0, ha="center", va="center")
