"""Curves of an input from a CSV file; read on loading, so that a loaded structure needs no files."""

from __future__ import annotations

import csv
from collections.abc import Mapping
from numbers import Integral, Real
from pathlib import Path
from typing import Annotated, Any

from crumple.errors import InputError, Problem
from crumple.hinge.measured.law_file import read_law
from crumple.hinge.measured.table import read_table
from crumple.registry.quantity import Converted, Longest
from crumple.registry.refusal import refuse
from crumple.units import QuantityError, unit_factor

LARGEST_FILE = 2_000_000
"""Largest size of a curve file [bytes]; more than any test needs, small enough to read at once."""
MOST_POINTS = 20_000
"""Largest number of points of one curve."""
SHOWN_PROBLEMS = 10
"""Number of invalid rows of one file that are reported."""
FileName = Annotated[str, Longest(400)]
SI_UNIT = {"rotation": "rad", "moment": "N*m"}


def with_curve_read(given: dict[str, Any], directory: Path | None, prefix: str = "") -> dict[str, Any]:
    """Replace the file of a table by its points; without a file the table stays as it is.

    Parameters
    ----------
    given
        Table as given in the input; ``<prefix>file`` names the file.
    directory
        Folder of the input file, in which the file must lie; None: built in Python, any file.
    prefix
        ``"negative_"`` for the curve of the other sense.
    """
    key = f"{prefix}file"
    columns = (f"{prefix}rotation", f"{prefix}moment")
    name = given.get(key)
    if name is None:
        return given
    if not isinstance(name, str):
        refuse("the name of a file is needed here", key=key, allowed="a text such as test.csv")
    if any(given.get(column) for column in columns):
        refuse("the curve is given twice", key=key, todo="give the file or the lists")
    rotation, moment = _read(name, directory, key)
    rest = {name: value for name, value in given.items() if name != key}
    return {**rest, columns[0]: rotation, columns[1]: moment}


def with_units(given: dict[str, Any]) -> dict[str, Any]:
    """Apply the units of the key ``units`` to the plain numbers of a table's lists."""
    units = given.get("units")
    if not isinstance(units, Mapping):
        return given
    unknown = [str(name) for name in units if name not in SI_UNIT]
    if unknown:
        refuse(f"unknown column '{unknown[0]}'", key="units", allowed=", ".join(SI_UNIT))
    changed = {name: value for name, value in given.items() if name != "units"}
    for name, unit in units.items():
        try:
            unit_factor(str(unit), SI_UNIT[name])
        except QuantityError as error:
            refuse(error.problems[0].what, key="units", allowed=error.problems[0].allowed)
        for column in (name, f"negative_{name}"):
            values = given.get(column)
            if isinstance(values, list | tuple):
                changed[column] = [f"{_digits(v)} {unit}" if _is_number(v) else v for v in values]
    return changed


def _is_number(value: object) -> bool:
    return isinstance(value, Real) and not isinstance(value, bool)


def _digits(value: Any) -> str:
    """All digits of a number; scalars of NumPy would include their type."""
    return str(value) if isinstance(value, Integral) else repr(float(value))


def with_law_read(given: dict[str, Any], directory: Path | None) -> dict[str, Any]:
    """Replace the name of a law file by its content, checked; without a name the content itself is checked.

    Parameters
    ----------
    given
        Law as given in the input; ``file`` names the file, ``text`` is its content.
    directory
        Folder of the input file, in which the file must lie; None: built in Python, any file.
    """
    name, text = given.get("file"), given.get("text")
    if name is None and not isinstance(text, str):
        refuse("a law file is needed", key="file", todo="give the file that `crumple hinge --save` wrote")
    if name is not None:
        if not isinstance(name, str):
            refuse("the name of a file is needed here", key="file", allowed="a text such as hinge.yaml")
        if text:
            refuse("the law is given twice", key="file", todo="give the file or the text")
        text = _content(name, directory, "file", "a law file")
    try:
        read_law(str(text), str(name or ""))
    except InputError as error:
        refuse("the law file cannot be read", problems=error.problems[:SHOWN_PROBLEMS])
    return {**{key: value for key, value in given.items() if key != "file"}, "text": text}


def _content(name: str, directory: Path | None, key: str, kind: str) -> str:
    """Text of a file, or an error with the reason."""
    if "\0" in name:
        refuse("this is not a file name", key=key)
    path = (directory or Path()) / name
    _check_inside(path, directory, key)
    try:
        found, size = path.is_file(), path.stat().st_size if path.is_file() else 0
        text = path.read_text(encoding="utf-8-sig") if found and size <= LARGEST_FILE else ""
    except UnicodeDecodeError:
        refuse("the file is not a text in UTF-8", key=key, allowed=kind)
    except OSError as error:
        refuse(f"the file cannot be read: {error.strerror}", key=key, allowed=kind)
    if not found and path.exists() and not path.is_dir():
        refuse("this is not a regular file", key=key, allowed=kind)
    if not found:
        todo = "correct the name or put the file there"
        refuse("there is no such file", key=key, allowed="a file name, relative to the input file", todo=todo)
    if size > LARGEST_FILE:
        refuse("the file is too large", key=key, allowed=f"at most {LARGEST_FILE / 1e6:g} MB")
    return text


def _check_inside(path: Path, directory: Path | None, key: str) -> None:
    """Refuse a file outside the folder of the input file: an input from another source must not read it."""
    if directory is None:
        return
    try:
        inside = path.resolve().is_relative_to(directory.resolve())
    except (OSError, RuntimeError, ValueError):  # a loop of symbolic links, or a name that is too long
        inside = True
    if not inside:
        refuse(
            "this file lies outside the folder of the input file",
            key=key,
            allowed="a file in the folder of the input file, or below it",
            todo="copy it there",
        )


def _read(name: str, directory: Path | None, key: str) -> tuple[list[float], list[float]]:
    text = _content(name, directory, key, "a CSV file")
    try:
        rotation, moment = read_table(text, name)
    except InputError as error:
        shown, rest = error.problems[:SHOWN_PROBLEMS], error.problems[SHOWN_PROBLEMS:]
        more = [Problem(f"{len(rest)} more lines are wrong", file=name)] if rest else []
        refuse("the curve cannot be read", problems=[*shown, *more])
    except (ValueError, csv.Error) as error:
        refuse(f"the file is not a table: {error}", key=key, allowed="a CSV file")
    if len(rotation) > MOST_POINTS:
        refuse("the curve has too many points", key=key, allowed=f"at most {MOST_POINTS}")
    return [Converted(value) for value in rotation], [Converted(value) for value in moment]
