"""Collapse laws in one figure: moment against rotation, pale beyond the range of validity of each law."""

from __future__ import annotations

import numpy as np

from crumple.hinge import HingeLaw
from crumple.numeric.arrays import Floats
from crumple.report.drawing.scales import display_unit, largest, spread
from crumple.report.drawing.style import (
    WIDTH,
    Line,
    add_axes,
    draw_lines,
    drawing,
    name_axes,
    new_figure,
    to_svg,
)

LABELS = 1.35  # room for the names at the ends of the lines [in]


def law_figure(laws: dict[str, HingeLaw], rotation: Floats, title: str) -> str:
    """Laws side by side as SVG.

    Parameters
    ----------
    laws
        By the name that the figure shows.
    rotation
        Rotations at which they are drawn [rad], increasing from 0, shape (n,).
    title
        Section and axis.
    """
    curves = {name: law.moment_capacity(rotation) for name, law in laws.items()}
    unit, factor = display_unit("N*m", largest(list(curves.values())))
    with drawing():
        figure = new_figure(WIDTH, 3.4)
        axes = add_axes(figure, 0.45, 0.4, WIDTH - 0.45 - LABELS, 2.6)
        angles = np.rad2deg(rotation)
        axes.set_xlim(0.0, angles[-1])
        axes.set_ylim(*spread([curve / factor for curve in curves.values()]))
        name_axes(axes, "rotation, deg", f"{title}: moment capacity, {unit}")
        lines = []
        for index, (name, law) in enumerate(laws.items()):
            moment = curves[name] / factor
            valid = np.where(rotation <= law.validity.rotation_max, moment, np.nan)
            lines += [Line(name, angles, moment, faint=True), Line(name, angles, valid, index)]
        draw_lines(axes, lines)
        return to_svg(figure, "hinge-laws", f"Moment capacity against rotation of {', '.join(laws)}.") + "\n"
