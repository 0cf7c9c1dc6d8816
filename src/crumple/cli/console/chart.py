"""Curves on a terminal: a small character plot, one mark per curve."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from rich.text import Text

    from crumple.numeric.arrays import Floats

WIDTH, HEIGHT = 64, 16
MARKS = "*o+x#@%&"
COLOURS = ("cyan", "magenta", "yellow", "green", "blue", "red", "white", "bright_black")


def chart(x: Floats, curves: Sequence[Floats], x_text: tuple[str, str], y_text: str) -> Text:
    """Draw curves against a common axis from zero.

    Parameters
    ----------
    x
        Abscissa from 0, increasing, shape (n,).
    curves
        Ordinates >= 0, each of shape (n,); at most eight have different marks.
    x_text
        Label of the left and of the right end.
    y_text
        Label of the top.

    Returns
    -------
    Text
        Lines for a rich console.
    """
    from rich.text import Text

    top = max(float(np.max(curve)) for curve in curves)
    owner = np.full((HEIGHT, WIDTH), -1)
    columns = np.linspace(x[0], x[-1], WIDTH)
    # the first curve is drawn last, so that it stays visible where curves meet
    for index in reversed(range(len(curves))):
        levels = np.interp(columns, x, curves[index]) / (top or 1.0)
        rows = np.clip(np.round((1.0 - levels) * (HEIGHT - 1)).astype(int), 0, HEIGHT - 1)
        owner[rows, np.arange(WIDTH)] = index
    text = Text(f"{y_text}\n")
    for row in owner:
        text.append("|")
        for index in row:
            place = int(index) % len(MARKS)
            text.append(MARKS[place] if index >= 0 else " ", style=COLOURS[place] if index >= 0 else "")
        text.append("\n")
    left, right = x_text
    text.append("+" + "-" * WIDTH + "\n" + " " + left + right.rjust(WIDTH - len(left)))
    return text
