"""Measured curves or curves of other codes from CSV: a column of time, other columns, units in the header.

A column title is ``name [unit]`` or ``name (unit)``; the short form ``name_unit`` is read for the units of
`SUFFIXES`, because other programs write it.  A column without a unit is left out and reported; errors are
reported with file and line.
"""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from crumple.comparison.rating.signal import Signal
from crumple.errors import InputError, Problem
from crumple.result.format import present_name
from crumple.units import QuantityError, unit_factor

LARGEST_FILE = 50_000_000
"""Bytes; a history of some hundred thousand times and a dozen columns."""
LARGEST = 1e100
"""Largest magnitude of a number; squares of larger ones could overflow."""
MOST_LINES = 1_000_000
"""Lines; every one takes some microseconds to read."""
LONGEST_LINE = 100_000
"""Characters of a line; a row of a thousand numbers has a fifth of it."""
SHOWN = 10
"""Number of wrong lines that are reported."""
SUFFIXES = {
    "s": "s", "ms": "ms", "rad": "rad", "deg": "deg", "rad_s": "rad/s", "deg_s": "deg/s", "m": "m",
    "mm": "mm", "m_s": "m/s", "N": "N", "kN": "kN", "Nm": "N*m", "kNm": "kN*m", "J": "J", "kJ": "kJ",
}  # fmt: skip
SI_UNITS = ("s", "m", "rad", "rad/s", "m/s", "m/s^2", "rad/s^2", "N", "J", "Pa", "kg", "1")
"""SI units of columns; moment and energy have one dimension and are distinguished by how they are written."""

_BRACKETS = re.compile(r"(?P<name>.+?)\s*[\[(](?P<unit>[^\])]*)[\])]")


@dataclass(frozen=True, eq=False)
class CurveFile:
    """Curves of one file.

    Attributes
    ----------
    name
        Their name in the comparison.
    file
        Path of the file.
    signals
        By the name of the column, or of the channel that it was paired with.
    left_out
        Columns without a unit.
    columns
        Every column with a unit except that of time, by its name in the file.
    """

    name: str
    file: str
    signals: dict[str, Signal]
    left_out: tuple[str, ...] = ()
    columns: tuple[str, ...] = ()


def read_curves(path: Path | str, name: str = "", pairs: Mapping[str, str] | None = None) -> CurveFile:
    """Read a CSV file of histories.

    Parameters
    ----------
    path
        File: one header, then numbers; separated by comma, semicolon or tab; lines that start with # are
        ignored.
    name
        Of the source; by default the file's.
    pairs
        Names of channels for columns with other names; with a minus in front if the column has the opposite
        sign.

    Raises
    ------
    InputError
        With file and line: no such file, no column of time, no unit, an unknown unit, a number
        missing, times that do not increase, two columns of one name.
    """
    place = Path(path)
    lines = _lines(place)
    if not lines:
        raise _refused(
            "the file is empty", place, todo="write a header such as 'time [ms], hinge.root.rotation [deg]'"
        )
    head_line, head = lines[0]
    separator = max(",;\t", key=head.count)
    titles = next(csv.reader([head], delimiter=separator))
    columns = _columns(titles, place, head_line)
    times = [i for i, (title, _, unit) in columns.items() if unit == "s" and title.lower() in ("time", "t")]
    if not times:
        raise _refused(
            "no column of time", place, head_line, head[:80], "a column such as 'time [s]' or 'time [ms]'"
        )
    if len(columns) < 2:
        raise _refused(
            "no column except time has a unit", place, head_line, head[:80], "titles such as 'tip [rad]'"
        )
    table = _numbers(lines[1:], separator, sorted(columns), place)
    scaled = {i: table[:, k] * columns[i][1] for k, i in enumerate(sorted(columns))}
    time = scaled[times[0]]
    if time.size < 2 or not (np.diff(time) > 0.0).all():
        where = int(np.flatnonzero(np.diff(time) <= 0.0)[0]) + 2 if time.size > 1 else 0
        line = lines[where][0] if time.size > 1 else head_line
        raise _refused(
            "the times do not increase", place, line, "", "at least two rows with increasing times"
        )
    renamed = dict(pairs or {})
    signals: dict[str, Signal] = {}
    for i, (title, _, unit) in columns.items():
        if i == times[0]:
            continue
        called = renamed.get(title, title)
        side, called = (-1.0 if called.startswith("-") else 1.0), present_name(called.removeprefix("-"))
        if called in signals:
            todo = "leave one of them out, or give it another name"
            raise _refused("two columns have the same name", place, head_line, called, "", todo=todo)
        signals[called] = Signal(called, unit, time, side * scaled[i])
    left = tuple(title.strip() for i, title in enumerate(titles) if i not in columns)
    named = tuple(title for i, (title, _, _) in columns.items() if i != times[0])
    return CurveFile(name or place.stem, str(place), signals, left, named)


def _lines(place: Path) -> list[tuple[int, str]]:
    """Lines with something in them, by number, few and short enough to be read."""
    every = _text(place).splitlines()
    if len(every) > MOST_LINES:
        came, allowed = str(len(every)), f"at most {MOST_LINES}"
        raise _refused("the file has too many lines", place, 0, came, allowed, todo="leave some times out")
    lines = [(n, t) for n, t in enumerate(every, 1) if t.strip() and not t.lstrip().startswith("#")]
    for number, line in lines:
        if len(line) > LONGEST_LINE:
            came, allowed = f"{len(line)} characters", f"at most {LONGEST_LINE}"
            todo = "write one row of numbers per line, separated by comma, semicolon or tab"
            raise _refused("the line is too long", place, number, came, allowed, todo=todo)
    return lines


def _text(place: Path) -> str:
    try:
        if not place.is_file():
            raise _refused("there is no such file", place, todo="correct the name")
        if place.stat().st_size > LARGEST_FILE:
            raise _refused("the file is too large", place, 0, "", f"at most {LARGEST_FILE / 1e6:g} MB")
        return place.read_text(encoding="utf-8-sig")
    except UnicodeDecodeError:
        todo = "save it as CSV in UTF-8, which spreadsheet programs offer"
        raise _refused("the file is not text in UTF-8", place, 0, "", "a CSV file", todo=todo) from None
    except OSError as error:
        raise _refused(f"the file cannot be read: {error.strerror}", place) from None


def _columns(heads: list[str], place: Path, line: int) -> dict[int, tuple[str, float, str]]:
    """Index to name, factor to SI and SI unit of every column that has a unit."""
    found = {}
    for index, cell in enumerate(heads):
        parts = _head(cell.strip())
        if parts is None:
            continue
        title, unit = parts
        try:
            si, factor = _si(unit)
        except QuantityError as error:
            problem = error.problems[0]
            raise _refused(
                problem.what, place, line, cell.strip()[:60], "a unit such as rad, deg/s, kN*m"
            ) from None
        found[index] = (title, factor, si)
    return found


def _head(cell: str) -> tuple[str, str] | None:
    """Name and unit of a column title, or None if it has no unit."""
    match = _BRACKETS.fullmatch(cell)
    if match is not None:
        return match["name"], match["unit"].strip() or "1"
    for suffix in sorted(SUFFIXES, key=len, reverse=True):
        if cell.endswith("_" + suffix):
            return cell[: -len(suffix) - 1], SUFFIXES[suffix]
    return None


def _si(unit: str) -> tuple[str, float]:
    """SI unit of the same kind and the factor to it."""
    for si in SI_UNITS:
        try:
            factor = unit_factor(unit, si)
        except QuantityError:
            continue
        # a moment and an energy have one dimension
        return ("N*m" if si == "J" and "J" not in unit else si), factor
    unit_factor(unit, "N*m")
    raise AssertionError("an unknown unit was accepted")


def _numbers(rows: list[tuple[int, str]], separator: str, wanted: list[int], place: Path) -> np.ndarray:
    """Numbers of the wanted columns, (rows, columns)."""
    table, problems = [], []
    for line, text in rows:
        cells = next(csv.reader([text], delimiter=separator))
        values = [_number(cells[i]) if i < len(cells) else math.nan for i in wanted]
        table.append(values)
        if not all(abs(value) <= LARGEST for value in values):
            todo = "write numbers with a decimal point in every column that has a unit"
            what = "this row contains something other than finite numbers"
            problems.append(Problem(what, text[:60], "", todo, "", str(place), line))
    if problems:
        more = [Problem(f"{len(problems) - SHOWN} more lines are wrong", file=str(place))]
        raise InputError(problems[:SHOWN] + (more if len(problems) > SHOWN else []))
    if not table:
        raise _refused("the file contains a header but no numbers", place)
    return np.array(table)


def _number(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        return math.nan


def _refused(
    what: str, place: Path, line: int = 0, came: str = "", allowed: str = "", *, todo: str = ""
) -> InputError:
    return InputError(Problem(what, came, allowed, todo, "", str(place), line))
