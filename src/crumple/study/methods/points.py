"""Points of a study: the samplers of SciPy, a grid, or a file."""

from __future__ import annotations

import csv
import itertools
import math
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np

from crumple.errors import InputError, Problem
from crumple.numeric.arrays import Floats
from crumple.study.space import Axis, Point, points_of
from crumple.study.study_file import MOST_ROWS, Method

Block = tuple[list[Point], list[Point], list[list[Point]]]
"""Points A, B, and of each variable A with that variable from B."""


def _latin(axes: Sequence[Axis], method: Method) -> Floats:
    from scipy.stats import qmc  # noqa: PLC0415  (takes a second to import)

    return qmc.LatinHypercube(len(axes), seed=method.seed).random(method.rows)


def _sobol(axes: Sequence[Axis], method: Method) -> Floats:
    return _sequence(len(axes), method.rows, method.seed)


def _random(axes: Sequence[Axis], method: Method) -> Floats:
    return np.random.default_rng(method.seed).random((method.rows, len(axes)))


_SAMPLERS: dict[str, Callable[[Sequence[Axis], Method], Floats]] = {
    "latin_hypercube": _latin,
    "sobol": _sobol,
    "monte_carlo": _random,
}


def sampled(axes: Sequence[Axis], method: Method, folder: Path) -> list[Point]:
    """Points of a method that knows them all beforehand.

    Parameters
    ----------
    axes
        Variables.
    method
        Kind, number, and seed of the points.
    folder
        That the name of a file of points is relative to.

    Raises
    ------
    InputError
        If a grid is too large, or the file of points is not one.
    """
    if method.type == "grid":
        levels = [axis.grid() for axis in axes]
        count = math.prod(map(len, levels))
        if count > MOST_ROWS:
            what, todo = "the grid has too many points", "reduce 'steps'"
            raise InputError(Problem(what, str(count), f"at most {MOST_ROWS}", todo, "method"))
        return list(itertools.product(*levels))
    if method.type == "points":
        return _read(axes, folder / method.file)
    return points_of(axes, _SAMPLERS[method.type](axes, method))


def blocks(axes: Sequence[Axis], first: int, count: int, seed: int) -> Block:
    """Points of Saltelli's scheme for Sobol' indices from a Sobol' sequence of twice as many dimensions.

    Parameters
    ----------
    axes
        Variables.
    first, count
        Number of the first block, and how many.
    seed
        Of the scrambling.

    References
    ----------
    A. Saltelli et al., Variance based sensitivity analysis of model output, Comput. Phys. Commun. 181 (2010).
    """
    size = len(axes)
    shares = _sequence(2 * size, first + count, seed)[first:]
    a, b = shares[:, :size], shares[:, size:]
    mixed = [np.where(np.arange(size) == k, b, a) for k in range(size)]
    return points_of(axes, a), points_of(axes, b), [points_of(axes, one) for one in mixed]


def _sequence(size: int, count: int, seed: int) -> Floats:
    """First points of a scrambled Sobol' sequence; made in a power of two, else SciPy warns."""
    from scipy.stats import qmc  # noqa: PLC0415  (takes a second to import)

    return qmc.Sobol(size, seed=seed).random_base2(max(count - 1, 0).bit_length())[:count]


def _read(axes: Sequence[Axis], path: Path) -> list[Point]:
    """Points of a CSV file: a line of names, then numbers in SI units, or names."""
    todo = "write a line of the variables' names, then a line per point, in SI units"
    try:
        with path.open(encoding="utf-8-sig", newline="") as file:
            lines = list(csv.reader(file))
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise InputError(
            Problem(f"the points cannot be read: {error}", "", "", todo, "method.file")
        ) from None
    head = [name.strip() for name in lines[0]] if lines else []
    if sorted(head) != sorted(axis.name for axis in axes):
        allowed = ", ".join(axis.name for axis in axes)
        raise InputError(
            Problem(
                "the columns are not the variables",
                ", ".join(head)[:60],
                allowed,
                todo,
                file=str(path),
                line=1,
            )
        )
    places = [head.index(axis.name) for axis in axes]
    points = []
    for line, cells in enumerate(lines[1:], 2):
        try:
            given = [cells[place].strip() for place in places]
            point = tuple(_cell(text, axis) for text, axis in zip(given, axes, strict=True))
        except (IndexError, ValueError):
            allowed = "a finite number per variable"
            what, came = "this is not a point", ",".join(cells)[:60]
            raise InputError(Problem(what, came, allowed, todo, file=str(path), line=line)) from None
        points.append(point)
    if not points:
        raise InputError(Problem("the file has no points", "", "", todo, file=str(path), line=1))
    return points


def _cell(text: str, axis: Axis) -> float | str:
    if not axis.numeric:
        return text
    number = float(text)
    if not math.isfinite(number):
        raise ValueError(text)
    return number
