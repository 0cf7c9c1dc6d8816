"""Colours of plastic strain on walls, and the key that explains them."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import to_rgb

from crumple.numeric.arrays import Floats
from crumple.report.drawing.style import MUTED
from crumple.result import States

FIELD = "plastic_strain"
"""Field of the walls that is drawn."""
SCALE = ("#9db3c8", "#e8d9a0", "#e8a33d", "#c1461b", "#701a16")
"""Colours from plain walls to the largest strain; lightness decreases from the second one on."""
QUANTILE = 0.995
"""Share of the walls that the scale spans, so that a single torn corner does not determine it."""
LEAST = 1e-4
"""Strain below which nothing is coloured."""


def largest_strain(states: States | None) -> float:
    """Strain at the end of the scale; 0 if no wall has a plastic strain to draw."""
    if states is None or FIELD not in states.cell_data or not states.cell_data[FIELD].size:
        return 0.0
    strain = np.nan_to_num(states.cell_data[FIELD])
    yielding = strain[strain > LEAST]
    return float(np.quantile(yielding, QUANTILE)) if yielding.size else 0.0


def wall_colours(states: States, state: int, top: float) -> Floats:
    """Colour of every wall in one state, red, green and blue from 0 to 1, (n_quads, 3)."""
    strain = np.nan_to_num(states.cell_data[FIELD][state])
    share = np.clip(strain / top, 0.0, 1.0)
    steps = np.linspace(0.0, 1.0, len(SCALE))
    colours = np.array([to_rgb(colour) for colour in SCALE])
    return np.stack([np.interp(share, steps, colours[:, i]) for i in range(3)], axis=1)


def draw_key(axes: Axes, top: float, left: float, bottom: float, width: float = 1.4) -> None:
    """Colour scale with its ends, at a place in the axes' own coordinates [in]."""
    steps = np.linspace(0.0, 1.0, 65)
    colours = np.array([to_rgb(colour) for colour in SCALE])
    scale = np.stack(
        [np.interp(steps, np.linspace(0, 1, len(SCALE)), colours[:, i]) for i in range(3)], axis=1
    )
    for i, colour in enumerate(scale[:-1]):
        x = left + width * np.array([steps[i], steps[i + 1]])
        axes.fill_between(x, bottom, bottom + 0.08, color=tuple(colour), linewidth=0.2)
    axes.text(left, bottom + 0.11, "0", fontsize=7.0, color=MUTED, va="bottom")
    axes.text(
        left + width, bottom + 0.11, f"{100 * top:.2g} %", fontsize=7.0, color=MUTED, va="bottom", ha="right"
    )
    axes.text(
        left + width / 2, bottom + 0.11, "plastic strain", fontsize=7.0, color=MUTED, va="bottom", ha="center"
    )
