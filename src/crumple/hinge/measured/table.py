"""Measured curves: reading, and removal of the elastic part."""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from crumple.errors import InputError, Problem
from crumple.numeric.arrays import Floats
from crumple.units import QuantityError, plain_number, unit_factor

Curve = Sequence[float] | Floats


class Column(NamedTuple):
    """Column of a table: words that name it in the header, and its SI unit."""

    words: tuple[str, ...]
    unit: str


BENDING = (
    Column(("rotation", "angle", "theta", "twist"), "rad"),
    Column(("moment", "capacity", "torque"), "N*m"),
)
"""Columns of a bending or torsion test."""
CRUSHING = (Column(("shortening", "displacement", "stroke"), "m"), Column(("force", "load"), "N"))
"""Columns of a crush test."""
_HEAD = re.compile(r"(?P<name>[^\[\(]+?)\s*[\[\(](?P<unit>[^\]\)]+)[\]\)]")
# The elastic line is fitted between these fractions of the peak: above the play of a test, below first yield.
ELASTIC_SHARES = (0.2, 0.6)
# Points within this share of the peak's elastic rotation count as lying on the elastic line.
ON_THE_LINE = 1e-3


def read_table(text: str, file: str = "", columns: tuple[Column, Column] = BENDING) -> tuple[Floats, Floats]:
    """Read a measured curve from CSV text.

    Parameters
    ----------
    text
        Lines of numbers under one header that names both columns with their units, for example
        ``rotation [deg], moment [kN*m]``; separated by comma, semicolon or tab; lines that start with # are
        left out; further columns are ignored.
    file
        Name for messages.
    columns
        `BENDING` (rotation and moment) or `CRUSHING` (shortening and force).

    Returns
    -------
    tuple
        Rotation [rad] and moment [N m], or shortening [m] and force [N], each of shape (n,).

    Raises
    ------
    InputError
        With the line, if a column, a unit or a number is missing or wrong.
    """
    lines = [
        (number, line)
        for number, line in enumerate(text.splitlines(), 1)
        if line.strip() and not line.lstrip().startswith("#")
    ]
    if not lines:
        todo = "write a header such as 'rotation [deg], moment [kN*m]' and the points under it"
        raise InputError(Problem("the table is empty", todo=todo, file=file, line=1))
    head_line, head = lines[0]
    separator = max(",;\t", key=head.count)
    places = [_column(head.split(separator), column, file, head_line) for column in columns]
    numbers, problems = [], []
    for line, content in lines[1:]:
        row = _cells(content, separator, file, line)
        values = [_number(row[index]) if index < len(row) else math.nan for index, _ in places]
        numbers.append(values)
        if not np.all(np.isfinite(values)):
            came, todo = separator.join(row)[:60], "write plain numbers with a decimal point"
            problems.append(Problem("this is not a number in every column", came, "", todo, "", file, line))
    if problems or not numbers:
        raise InputError(
            problems or Problem("the table has a header but no points", file=file, line=head_line)
        )
    table = np.array(numbers) * np.array([factor for _, factor in places])
    return table[:, 0], table[:, 1]


def _cells(content: str, separator: str, file: str, line: int) -> list[str]:
    """Cells of one line; a quote that is not closed ends with it."""
    try:
        return next(csv.reader([content], delimiter=separator))
    except csv.Error as error:
        allowed, todo = f"cells of at most {csv.field_size_limit()} characters", "write plain numbers"
        raise InputError(
            Problem(f"this is no row of a table: {error}", "", allowed, todo, "", file, line)
        ) from None


def plastic_part(
    rotation: Curve,
    moment: Curve,
    elastic_stiffness: float | None = None,
) -> tuple[Floats, Floats, float]:
    """Capacity against plastic rotation, from a curve against total rotation.

    Parameters
    ----------
    rotation, moment
        Measured curve [rad], [N m] with its elastic rise.
    elastic_stiffness
        [N m/rad]; None: slope of a straight line fitted between 20 and 60 % of the peak, whose crossing with
        zero moment also becomes the zero of rotation.

    Returns
    -------
    tuple
        Plastic rotation [rad] from 0, capacity [N m] and the stiffness [N m/rad].

    Raises
    ------
    InputError
        If the rise has fewer than two points between 20 and 60 % of the peak and no stiffness is given, or
        the given one is not positive or steeper than every line from zero to a point of the rise.

    Notes
    -----
    Plastic rotation is rotation - moment/stiffness.  The curve begins with the last point on the elastic
    line; points at which the plastic rotation does not grow (unloading, scatter) are left out.
    """
    total, moment = np.asarray(rotation, np.float64), np.asarray(moment, np.float64)
    peak = int(np.argmax(moment))
    zero = 0.0
    if elastic_stiffness is None:
        elastic_stiffness, zero = _elastic_line(total[: peak + 1], moment[: peak + 1])
    elif not 0.0 < elastic_stiffness < math.inf:
        what, todo = (
            "the elastic stiffness must be positive",
            "give the slope of the elastic rise, or omit it",
        )
        came = f"{elastic_stiffness:g} N m/rad"
        raise InputError(Problem(what, came, "above 0 N m/rad, finite", todo, "elastic_stiffness"))
    plastic = total - zero - moment / elastic_stiffness
    on_line = np.flatnonzero(plastic[: peak + 1] <= ON_THE_LINE * moment[peak] / elastic_stiffness)
    first = int(on_line[-1]) if on_line.size else 0
    if not moment[first] > 0.0:
        raise InputError(_too_steep(total[: peak + 1], moment[: peak + 1], elastic_stiffness))
    kept = [first]
    start = plastic[first]
    for index in range(first + 1, len(plastic)):
        if plastic[index] > plastic[kept[-1]]:
            kept.append(index)
    return plastic[kept] - start, moment[kept], float(elastic_stiffness)


def _elastic_line(rotation: Floats, moment: Floats) -> tuple[float, float]:
    """Slope [N m/rad] of the elastic rise and its crossing with zero moment [rad]."""
    low, high = (share * moment[-1] for share in ELASTIC_SHARES)
    rise = (moment >= low) & (moment <= high)
    if np.count_nonzero(rise) < 2 or np.ptp(rotation[rise]) <= 0.0:
        raise InputError(_no_rise(rotation, moment, int(np.count_nonzero(rise))))
    slope, intercept = np.polyfit(rotation[rise], moment[rise], 1)
    if not slope > 0.0:
        raise InputError(_no_rise(rotation, moment, int(np.count_nonzero(rise))))
    return float(slope), float(-intercept / slope)


def _steepest(rotation: Floats, moment: Floats) -> float:
    """Slope of the steepest line from zero to a point of the rise [N m/rad], rounded down to four digits.

    A steeper elastic line meets no point of the curve but zero; infinite if the curve begins with a moment.
    """
    risen = moment > 0.0
    if not risen.any() or rotation[risen][0] <= 0.0:
        return math.inf
    slope = float(np.max(moment[risen] / rotation[risen]))
    unit = 10.0 ** (math.floor(math.log10(slope)) - 3)
    return math.floor(slope / unit) * unit


def _no_rise(rotation: Floats, moment: Floats, count: int) -> Problem:
    """Of a curve whose elastic slope cannot be found; what is asked for is accepted."""
    what = "the elastic rise cannot be found: two points must rise between 20 and 60 % of the peak moment"
    came, slope = f"{count} point{'' if count == 1 else 's'}", _steepest(rotation, moment)
    if math.isinf(slope):
        todo = (
            "add points of the rise; or, if rotations are plastic since the curve begins with a moment, "
            "write 'type: table' without 'remove_elastic'; or give elastic_stiffness, the slope of the rise"
        )
    else:
        written = f"elastic_stiffness: {plain_number(slope / 1e3)} kN*m/rad"
        todo = f"add points of the rise, or write '{written}', the steepest line from zero to a point of it"
    return Problem(what, came, "at least two", todo, "elastic_stiffness")


def _too_steep(rotation: Floats, moment: Floats, given: float) -> Problem:
    """Of a given stiffness whose elastic line meets no point; what is asked for is accepted."""
    what = "the elastic stiffness is steeper than the rise of the curve: no point lies on the elastic line"
    most = f"{plain_number(_steepest(rotation, moment) / 1e3)} kN*m/rad"
    todo = f"write at most 'elastic_stiffness: {most}'"
    try:
        _elastic_line(rotation, moment)
        todo += ", or leave it out: then the slope is found from the curve"
    except InputError:
        todo += ", or add points of the rise and leave it out"
    came = f"{plain_number(given / 1e3)} kN*m/rad"
    return Problem(what, came, f"more than 0, at most {most}", todo, "elastic_stiffness")


def _column(head: Sequence[str], column: Column, file: str, line: int) -> tuple[int, float]:
    """Index and factor to SI of the column that one of the words names."""
    words, unit = column
    for index, cell in enumerate(head):
        match = _HEAD.fullmatch(cell.strip())
        if match is None:
            continue
        words_given = match["name"].lower().replace("_", " ").split()
        if "rate" not in words_given and any(word in words_given for word in words):
            try:
                return index, unit_factor(match["unit"], unit)
            except QuantityError as error:
                problem = error.problems[0]
                raise InputError(
                    Problem(problem.what, cell.strip(), problem.allowed, problem.todo, "", file, line)
                ) from None
    what = f"no column is named {words[0]} with a unit in brackets"
    written = {"rad": "deg", "N*m": "kN*m", "m": "mm", "N": "kN"}[unit]
    todo = f"write a header that names it, for example '{words[0]} [{written}]'"
    raise InputError(Problem(what, ", ".join(head)[:80], " or ".join(words), todo, "", file, line))


def _number(text: str) -> float:
    """Plain number, NaN for other text."""
    try:
        return float(text)
    except ValueError:
        return math.nan
