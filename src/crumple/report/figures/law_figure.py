"""A hinge law in one figure: capacity over rotation in both senses, its band and its range of validity."""

from __future__ import annotations

import math

import numpy as np

from crumple.hinge import HingeLaw
from crumple.report.drawing.scales import display_unit, largest
from crumple.report.drawing.style import (
    HALF,
    OUTSIDE,
    SERIES,
    WARNING,
    Line,
    add_axes,
    draw_lines,
    drawing,
    name_axes,
    new_figure,
    short,
    to_svg,
)

LEAST, MOST = math.radians(10.0), math.radians(90.0)
"""Ends of the rotation axis [rad]: beyond the range of validity, but within these."""
POINTS = 241


def law_figure(law: HingeLaw, name: str, about: str) -> str:
    """Law as SVG.

    Parameters
    ----------
    law
        Any.
    name
        Of the figure; safe as an id.
    about
        What bends about which axis, as ``tube about y``.
    """
    valid = law.validity.rotation_max
    end = min(max(1.25 * valid if math.isfinite(valid) else MOST, LEAST), MOST)
    kinks = [kink for sense in (1, -1) for kink in law.kinks(sense) if kink < end]
    rotation = np.unique(np.concatenate([np.linspace(0.0, end, POINTS), kinks]))
    senses = {"both senses": 1} if law.symmetric else {"positive": 1, "negative": -1}
    curves = {key: law.moment_capacity(rotation, sense) for key, sense in senses.items()}
    unit, factor = display_unit("N*m", largest(list(curves.values())))
    degrees, band = np.degrees(rotation), law.validity.uncertainty or 0.0
    with drawing():
        figure = new_figure(HALF, 2.35)
        axes = add_axes(figure, 0.42, 0.34, HALF - 0.42 - (0.12 if law.symmetric else 0.6), 1.75)
        axes.set_xlim(0.0, degrees[-1])
        axes.set_ylim(0.0, 1.08 * (1.0 + band) * largest(list(curves.values())) / factor)
        name_axes(axes, "rotation, deg", f"Capacity of {short(about, 22)}, {unit}")
        if valid < end:
            axes.axvspan(math.degrees(valid), degrees[-1], color=OUTSIDE, linewidth=0, zorder=0)
            axes.axvline(math.degrees(valid), color=WARNING, linewidth=0.6, linestyle=(0, (2, 2)), zorder=1.5)
        lines = []
        for i, (key, moments) in enumerate(curves.items()):
            moment = moments / factor
            if band:
                low, high = (1.0 - band) * moment, (1.0 + band) * moment
                axes.fill_between(degrees, low, high, color=SERIES[i], alpha=0.18, linewidth=0)
            lines.append(Line(key, degrees, moment, i))
        draw_lines(axes, lines, labels=not law.symmetric)
        return to_svg(figure, name, f"Moment capacity of {about} against rotation.")
