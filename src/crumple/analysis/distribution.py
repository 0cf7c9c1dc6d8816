"""How a quantity scatters: distributions, and their values at probabilities."""

from __future__ import annotations

import difflib
import math
import re
from collections.abc import Mapping
from typing import Any, Literal

import numpy as np

from crumple.errors import InputError, Problem
from crumple.numeric.arrays import Floats
from crumple.structure.schema.spec import Spec
from crumple.units import QuantityError, parse_quantity

Value = float | str
"""A number, or a text: a quantity with its unit, or a name."""
EDGE = 2.0**-53
"""Probabilities are kept this far from 0 and 1, where unbounded distributions are infinite."""
_UNIT = re.compile(r"\s*[-+]?[0-9.]+(?:[eE][-+]?[0-9]+)?\s*(\D.*?)\s*")


class Distribution(Spec):
    """How a variable scatters."""

    type: Literal["normal", "lognormal", "uniform", "table"]
    """Kind of distribution."""
    mean: Value | None = None
    """Mean (normal, lognormal)."""
    deviation: Value | None = None
    """Standard deviation (normal, lognormal)."""
    low: Value | None = None
    """Smallest value (uniform)."""
    high: Value | None = None
    """Largest value (uniform)."""
    values: tuple[Value, ...] = ()
    """Values of a table, increasing; between them the probability is interpolated."""
    cumulative: tuple[float, ...] = ()
    """Probability of being below each value of the table, from 0 to 1."""


def number(value: Value, unit: str, where: str) -> float:
    """SI value of a quantity as written.

    Raises
    ------
    InputError
        If the unit is missing or of another dimension.
    """
    if isinstance(value, str):
        try:
            return parse_quantity(value, unit)
        except QuantityError as error:
            found = error.problems[0]
            raise InputError(Problem(found.what, found.came, found.allowed, found.todo, where)) from None
    if unit != "1" and value != 0.0:
        what, todo = "the unit is missing", "write the number with its unit"
        raise InputError(Problem(what, f"{value:g}", f"a quantity such as '{value:g} {unit}'", todo, where))
    return float(value)


def numbers_of(given: Distribution | None, unit: str, where: str) -> dict[str, Any]:
    """Values of a distribution in SI by name; without one none.

    Raises
    ------
    InputError
        If a quantity has another dimension than `unit`, or the values are not those of a distribution.
    """
    if given is None:
        return {}
    needed = ("mean", "deviation") if given.type in {"normal", "lognormal"} else ("low", "high")
    found: dict[str, Any] = {}
    if given.type == "table":
        found["values"] = [number(value, unit, f"{where}.values") for value in given.values]
        found["cumulative"] = list(given.cumulative)
        rising = all(np.all(np.diff(column) > 0.0) for column in found.values())
        ends = (found["cumulative"][:1], found["cumulative"][-1:]) == ([0.0], [1.0])
        if len(given.values) != len(given.cumulative) or not (ends and rising):
            allowed = "as many increasing values as probabilities, which increase from 0 to 1"
            raise InputError(Problem("this is not a distribution", "", allowed, "correct the table", where))
        return found
    for key in needed:
        value = getattr(given, key)
        if value is None:
            what = f"a {given.type} distribution needs '{key}'"
            raise InputError(Problem(what, "", "", f"add '{key}'", where))
        found[key] = number(value, unit, f"{where}.{key}")
    positive = [found.get("deviation", 1.0)] + ([found["mean"]] if given.type == "lognormal" else [])
    if min(positive) <= 0.0 or ("low" in found and not found["low"] < found["high"]):
        allowed = "deviation above 0; lognormal: mean above 0; uniform: low below high"
        raise InputError(Problem("this is not a distribution", "", allowed, "correct it", where))
    return found


def quantile(kind: str, given: Mapping[str, Any], share: Floats) -> Floats:
    """Values of a distribution at probabilities between 0 and 1, of the same shape.

    Parameters
    ----------
    kind
        Type of the distribution.
    given
        As `numbers_of` gives them.
    share
        Probabilities of being below.
    """
    from scipy import special  # noqa: PLC0415  (slow to import)

    share = np.clip(share, EDGE, 1.0 - EDGE)
    if kind == "normal":
        return np.asarray(given["mean"] + given["deviation"] * special.ndtri(share))
    if kind == "lognormal":
        spread = math.log1p((given["deviation"] / given["mean"]) ** 2)
        centre = math.log(given["mean"]) - 0.5 * spread
        return np.asarray(np.exp(centre + math.sqrt(spread) * special.ndtri(share)))
    if kind == "table":
        return np.asarray(np.interp(share, given["cumulative"], given["values"]), float)
    return np.asarray(given["low"] + (given["high"] - given["low"]) * share)


def unit_at(document: object | None, place: str, where: str) -> str | None:
    """Unit of the quantity at a path of an input as written; None if a text without number is there.

    Parameters
    ----------
    document
        Data of the input file.
    place
        The path, or a factor, whose unit is "1".
    where
        That a refusal names.

    Raises
    ------
    InputError
        If nothing is written at the path.
    """
    part: object = document
    if "." not in place or place.startswith("hinges."):
        return "1"
    for key in place.split("."):
        if isinstance(part, dict):
            part = part.get(key, part.get(int(key)) if key.isdigit() else None)
        elif isinstance(part, list) and key.isdigit() and int(key) < len(part):
            part = part[int(key)]
        else:
            part = None
    if part is None:
        what, near = "the base input has nothing at this path", _nearest_path(document, place.split("."))
        todo = f"did you mean '{near}'?" if near else "correct the path, or write the value there"
        raise InputError(Problem(what, place, "a path that is written in the base input", todo, where))
    if isinstance(part, int | float):
        return "1"
    match = _UNIT.fullmatch(part) if isinstance(part, str) else None
    return match[1] if match else None


def _nearest_path(document: object, keys: list[str]) -> str:
    """The path in an input whose keys are nearly those of another path; empty if there is none."""
    part, found = document, []
    if isinstance(part, dict) and keys[0] not in part and keys[0] == "structure":
        keys = keys[1:]
    for key in keys:
        if isinstance(part, dict):
            known = {str(name): value for name, value in part.items()}
        elif isinstance(part, list):
            known = {str(i): value for i, value in enumerate(part)}
        else:
            return ""
        close = [key] if key in known else difflib.get_close_matches(key[:64], known, n=1)
        if not close:
            return ""
        part = known[close[0]]
        found.append(close[0])
    return ".".join(found) if isinstance(part, int | float | str) else ""
