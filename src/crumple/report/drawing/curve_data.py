"""Data of a figure's curves as attributes of its SVG: numbers to keep, and where its axes over time lie."""

from __future__ import annotations

import csv
import io
import json
from itertools import zip_longest
from math import isfinite
from xml.sax.saxutils import quoteattr

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

MOST_VALUES = 12_000
"""Most values of a figure that are kept in it; one with more has none (the result's files have all)."""
_SECONDS = {"s": 1.0, "ms": 1e-3, "µs": 1e-6, "us": 1e-6}


def data_attributes(figure: Figure) -> str:
    """Attributes ``data-csv`` (curves, columns x and y by turns) and ``data-time`` (axes over time).

    ``data-time`` lists left, right, top, bottom [pt, as in the SVG] and the times at left and right [s].
    """
    axes = [one for one in figure.axes if "\n" in str(one.get_label())]
    found = [place for one in axes if (place := _time_axes(one, figure)) is not None]
    text = _csv(axes)
    attributes = f" data-time={quoteattr(json.dumps(found))}" if found else ""
    if text:
        # line breaks of an attribute are kept only as references
        attributes += f" data-csv={quoteattr(text, {chr(10): '&#10;'})}"
    return attributes


def _time_axes(axes: Axes, figure: Figure) -> list[float] | None:
    name = str(axes.get_label()).split("\n")[0]
    unit = _SECONDS.get(name.removeprefix("time, "))
    if unit is None or not name.startswith("time, "):
        return None
    width, height = (72.0 * size for size in figure.get_size_inches())
    box = axes.get_position()
    start, end = axes.get_xlim()
    places = (box.x0 * width, box.x1 * width, (1 - box.y1) * height, (1 - box.y0) * height)
    return [*(round(place, 2) for place in places), unit * float(start), unit * float(end)]


def _csv(axes: list[Axes]) -> str:
    """Curves that were drawn with a name; each has its own x, since curves may have their own times."""
    columns: list[list[str]] = []
    for one in axes:
        x_name, y_name = str(one.get_label()).split("\n")[:2]
        bars = [bar.get_width() for bar in one.patches if isinstance(bar, Rectangle)]
        if one.containers:
            columns.append(["", *(label.get_text() for label in one.get_yticklabels())])
            columns.append([y_name, *map(_number, bars)])
        for line in one.lines:
            label = str(line.get_label())
            if label.startswith(" "):
                name = f"{label[1:]}: {y_name}" if label[1:] else y_name
                columns.append([x_name, *map(_number, np.asarray(line.get_xdata(), float))])
                columns.append([name, *map(_number, np.asarray(line.get_ydata(), float))])
    if not columns or sum(map(len, columns)) > MOST_VALUES:
        return ""
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows(zip_longest(*columns, fillvalue=""))
    return text.getvalue()


def _number(value: float) -> str:
    return f"{value:.6g}" if isfinite(value) else ""
