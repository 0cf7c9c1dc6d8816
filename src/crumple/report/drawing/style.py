"""Appearance of figures: sizes, colours, axes, labels at the ends of lines, and SVG output.

Every figure is drawn once, with matplotlib's objects and no pyplot.  Text stays text in the SVG, so it takes
the font of the page and can be searched and copied.  Axes are placed in inches, so that figures line up.
"""

from __future__ import annotations

import io
import re
import threading
import warnings
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from crumple.numeric.arrays import Floats
from crumple.report.drawing.curve_data import data_attributes
from crumple.report.drawing.scales import thinned

WIDTH = 7.0  # of the text column of an A4 page [in]
HALF = 3.42  # of two figures side by side [in]

RASTER = 200.0
"""Resolution of parts that are drawn as an image because they are too many [1/in]."""

INK = "#1c2733"
MUTED = "#5a6672"
RULE = "#aab4be"
GRID = "#e6eaee"
OUTSIDE = "#f1ede6"
WARNING = "#9a4a12"

SERIES = ("#1f5f9e", "#c1561b", "#2a7d61", "#77509c", "#96741a", "#2f8fa8", "#9b3150", "#566a2c")
"""Colours of lines; with order and labels they are distinguishable for any colour vision."""
DASHES: tuple[tuple[float, tuple[float, ...]] | str, ...] = (
    "-",
    (0, (5, 1.5)),
    (0, (1.5, 1.2)),
    (0, (6, 1.5, 1.5, 1.5)),
)
"""Dashes as a second mark besides the colour, for prints without colour."""

FONTS = "Inter, 'Segoe UI', 'Helvetica Neue', 'Liberation Sans', Arial, sans-serif"

_SETTINGS: dict[Any, Any] = {
    "svg.fonttype": "none",
    "svg.hashsalt": "crumple",
    "text.parse_math": False,  # a dollar sign in a name is a dollar sign
    "font.family": "DejaVu Sans",  # comes with matplotlib; only its widths are used
    "font.size": 8.0,
    "text.color": INK,
    "axes.edgecolor": RULE,
    "axes.labelcolor": MUTED,
    "axes.linewidth": 0.6,
    "xtick.color": RULE,
    "ytick.color": RULE,
    "xtick.labelcolor": MUTED,
    "ytick.labelcolor": MUTED,
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "xtick.major.size": 3.0,
    "ytick.major.size": 0.0,
    "xtick.labelsize": 7.5,
    "ytick.labelsize": 7.5,
    "lines.linewidth": 1.4,
    "lines.solid_capstyle": "round",
    "grid.color": GRID,
    "grid.linewidth": 0.6,
}
_LABEL = 20  # characters of a name at the end of a curve
_LOCK = threading.Lock()  # matplotlib keeps its settings in one global table
_TAG = re.compile(r"<[^>]+>")
_FONT = re.compile(r"(font-family:|font: [^;\"]*?[\d.]+px) [^;\"]+")
_PATH = re.compile(r'(?<= )d="[^"]+"')
_LONG_NUMBER = re.compile(r"\d+\.\d{3,}")
_IDENTITY = re.compile(r"""( id="|url\(#|href="#)""")
_CONTROL = re.compile(r"[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f\ud800-\udfff￾￿]")


@dataclass(frozen=True)
class Line:
    """A curve to draw: name, x and y in display units, shape (n,), colour and dash by index; faint: grey."""

    name: str
    x: Floats
    y: Floats
    index: int = 0
    faint: bool = False


@contextmanager
def drawing() -> Iterator[None]:
    """Set matplotlib's defaults and ours for the block, whatever the user's own settings are."""
    with _LOCK, mpl.rc_context(), warnings.catch_warnings():
        mpl.rcdefaults()
        mpl.rcParams.update(_SETTINGS)
        # the reader's fonts draw the text; the local ones only measure it, and may lack a script
        warnings.filterwarnings("ignore", message="Glyph .* missing from")
        warnings.filterwarnings("ignore", message="Matplotlib currently does not support")
        yield


def new_figure(width: float, height: float) -> Figure:
    """An empty figure of a size in inches."""
    figure = Figure(figsize=(width, height), dpi=RASTER)
    FigureCanvasSVG(figure)
    figure.patch.set_alpha(0)
    return figure


def add_axes(figure: Figure, left: float, bottom: float, width: float, height: float) -> Axes:
    """Plain axes at a position in inches: a base line, horizontal grid, no box."""
    w, h = figure.get_size_inches()
    axes: Axes = figure.add_axes((left / w, bottom / h, width / w, height / h))
    axes.patch.set_alpha(0)
    for side in ("top", "right", "left"):
        axes.spines[side].set_visible(False)
    axes.grid(visible=True, axis="y")
    axes.set_axisbelow(True)
    axes.xaxis.set_major_locator(MaxNLocator(6, steps=[1, 2, 2.5, 5, 10]))
    axes.yaxis.set_major_locator(MaxNLocator(5, steps=[1, 2, 2.5, 5, 10]))
    return axes


def name_axes(axes: Axes, x: str, y: str) -> None:
    """Name both axes horizontally: y above its axis, x below at its right end."""
    x, y = short(x, 60), short(y, 60)
    offset: dict[str, Any] = {"textcoords": "offset points", "annotation_clip": False, "fontsize": 8.0}
    axes.set_label(f"{x}\n{y}")
    # matplotlib would measure all numbers again to place its own names and title, which stay empty
    axes.set_title("", y=1.0)
    axes.xaxis.set_label_coords(0.5, 0.0)
    axes.yaxis.set_label_coords(0.0, 0.5)
    axes.annotate(y, (0, 1), (0, 7), xycoords="axes fraction", ha="left", va="bottom", color=INK, **offset)
    axes.annotate(x, (1, 0), (0, -16), xycoords="axes fraction", ha="right", va="top", color=MUTED, **offset)


def draw_lines(axes: Axes, lines: Sequence[Line], *, labels: bool = True) -> None:
    """Draw curves and write each name at the end of its curve; names that would overlap are moved apart."""
    several = sum(not line.faint for line in lines) > 1
    for line in lines:
        x, y = thinned(line.x, line.y)
        if line.faint:
            axes.plot(x, y, color=RULE, linewidth=0.7, zorder=1.5)
        else:
            dash = DASHES[line.index % len(DASHES)] if several else "-"
            colour = SERIES[line.index % len(SERIES)]
            axes.plot(x, y, color=colour, linestyle=dash, dash_capstyle="butt", label=f" {line.name}")
    if labels:
        _label_ends(axes, [line for line in lines if not line.faint])


def label_room(names: Sequence[str]) -> float:
    """Space for names at the ends of curves [in]."""
    return 0.1 + 0.056 * max((len(short(name, _LABEL)) for name in names), default=0)


def _label_ends(axes: Axes, lines: Sequence[Line]) -> None:
    low, high = axes.get_ylim()
    height = axes.get_window_extent().height / axes.figure.dpi * 72
    gap = 9.0 / height  # of one line of text, as a fraction of the axes
    ends = []
    for line in lines:
        finite = np.flatnonzero(np.isfinite(line.x) & np.isfinite(line.y))
        if finite.size:
            ends.append(((line.y[finite[-1]] - low) / (high - low), line.x[finite[-1]], line))
    ends.sort(key=lambda end: end[0])
    places = [end[0] for end in ends]
    # from below push up, then from the top push back down
    for i in range(1, len(places)):
        places[i] = max(places[i], places[i - 1] + gap)
    for i in range(len(places) - 1, -1, -1):
        limit = 1.0 if i == len(places) - 1 else places[i + 1] - gap
        places[i] = min(places[i], limit)
    edge = axes.get_xlim()[1]
    for place, (height, x, line) in zip(places, ends, strict=True):
        colour = SERIES[line.index % len(SERIES)]
        # a hairline leads from a curve that ends inside to its name at the edge
        transform = axes.get_xaxis_transform()
        if x < 0.98 * edge:
            axes.plot([x, edge], [height, place], color=colour, linewidth=0.4, transform=transform)
        axes.annotate(
            short(line.name, _LABEL),
            (edge, place),
            (4, 0),
            xycoords=transform,
            textcoords="offset points",
            va="center",
            color=colour,
            fontsize=7.5,
            annotation_clip=False,
        )


def short(text: str, limit: int = 32) -> str:
    """Text without control characters, cut to a length that fits into a figure."""
    clean = _CONTROL.sub("", text)
    return clean if len(clean) <= limit else clean[: limit - 1] + "…"


def to_svg(figure: Figure, name: str, description: str) -> str:
    """The figure as a self-contained SVG element, ready for a file and for the page alike.

    Parameters
    ----------
    figure
        Drawn here, and only here.
    name
        Prefix of every id, so that several figures live on one page.
    description
        Text for readers who cannot see the figure.
    """
    text = io.StringIO()
    figure.canvas.print_svg(text)  # type: ignore[attr-defined]
    svg = text.getvalue()
    svg = re.sub(r"<metadata>.*?</metadata>", "", svg[svg.index("<svg") :], flags=re.DOTALL)
    svg = re.sub(r"<style[^>]*>.*?</style>", "", svg, flags=re.DOTALL)
    svg = re.sub(r"<!--.*?-->", "", svg, flags=re.DOTALL)

    def adapt(tag: re.Match[str]) -> str:
        text = _IDENTITY.sub(rf"\g<1>{name}-", tag[0])
        text = _FONT.sub(rf"\g<1> {FONTS}", text)
        # a hundredth of a point cannot be seen
        return _PATH.sub(
            lambda path: _LONG_NUMBER.sub(lambda n: f"{float(n[0]):.2f}", " ".join(path[0].split())), text
        )

    svg = _TAG.sub(adapt, svg)
    width, height = (72 * size for size in figure.get_size_inches())
    data = _CONTROL.sub("", data_attributes(figure))
    head = (
        f'<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" '
        f'viewBox="0 0 {width:g} {height:g}" role="img" aria-labelledby="{name}-title" '
        f'style="stroke-linejoin: round"{data}>\n<title id="{name}-title">{_escaped(description)}</title>'
    )
    return head + re.sub(r"\n\s*\n+", "\n", svg[svg.index(">") + 1 :]).strip() + "\n"


def _escaped(text: str) -> str:
    clean = _CONTROL.sub("", text)
    return clean.replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")
