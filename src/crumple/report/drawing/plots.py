"""A figure of a page: one or more pictures under one caption."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass


@dataclass(frozen=True)
class Plots:
    """Pictures that belong together.

    Attributes
    ----------
    name
        By which the page places them.
    panels
        File name and SVG of each.
    caption
        Of all of them.
    """

    name: str
    panels: tuple[tuple[str, str], ...]
    caption: str


def plots(name: str, panels: Sequence[tuple[str, str | None]], caption: str) -> Plots:
    """A figure of the panels for which there were data."""
    return Plots(name, tuple((file, svg) for file, svg in panels if svg is not None), caption)


def flat(figures: Sequence[Plots]) -> list[tuple[str, str, str]]:
    """File name, SVG and caption of every picture."""
    return [(file, svg, figure.caption) for figure in figures for file, svg in figure.panels]
