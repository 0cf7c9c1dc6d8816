"""One input solved on a grid of one or two of its numbers, for a page that a reader can vary."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import product
from typing import Any

import numpy as np

from crumple.analysis.analysis import Analysis
from crumple.analysis.frames import solve_with_frames
from crumple.analysis.law_changes import as_solved, law_changes, law_types_at
from crumple.errors import InputError, Problem
from crumple.result import Result
from crumple.structure import Structure, changed, value_at
from crumple.units import parse_quantity

COUNT = {1: 9, 2: 5}
"""Values of each number, by how many numbers there are."""
AROUND = 0.3
"""Range about the value of the input if none is given, over it."""
WHERE = "--explore"
_UNIT = re.compile(r"\s*[-+]?[0-9.]+(?:[eE][-+]?[0-9]+)?\s*(\D.*?)?\s*")


@dataclass(frozen=True)
class Slider:
    """A number of the input that is varied: its path, its unit as written there, and its values in SI."""

    path: str
    unit: str
    values: tuple[float, ...]

    @property
    def factor(self) -> float:
        """Value of its unit in SI."""
        return 1.0 if self.unit == "1" else parse_quantity(f"1 {self.unit}", self.unit)


@dataclass(frozen=True, eq=False)
class Explored:
    """One point of the grid.

    Attributes
    ----------
    values
        Of the numbers, in SI.
    result, frames, structure
        As for a run; None if it was refused.
    reason
        Why there is no reliable result; empty if there is one.
    """

    values: tuple[float, ...]
    result: Result | None
    frames: Result | None
    structure: Structure | None
    reason: str


def sliders_of(wanted: str, analysis: Analysis, data: Any) -> tuple[Slider, ...]:
    """The numbers that a text such as ``thickness,mass=200 kg..400 kg`` names.

    Parameters
    ----------
    wanted
        One or two numbers apart by a comma: a path of the input, or its end if there is only one such; then,
        if wanted, the range.  Without a range it is the value of the input +- 30 %.
    analysis
        Of the input.
    data
        The input as it was written.

    Raises
    ------
    InputError
        If a number is not there, or is not the only one of its name, or the range is none.
    """
    parts = [part.strip() for part in wanted.split(",") if part.strip()]
    if len(parts) not in COUNT:
        raise _refused("one or two numbers can be explored", wanted, "mass,thickness", "name one or two")
    found = tuple(_slider(part, analysis.structure, data, COUNT[len(parts)]) for part in parts)
    if len({slider.path for slider in found}) < len(found):
        raise _refused("this number is named twice", wanted, "two different numbers", "name another one")
    return found


def explore(
    analysis: Analysis,
    sliders: Sequence[Slider],
    progress: Callable[[float], None] | None = None,
    cancel: Callable[[], bool] | None = None,
) -> list[Explored]:
    """Solve the multibody model at every point of the grid, the last number changing fastest.

    Parameters
    ----------
    analysis
        Gives what the numbers leave alone.
    sliders
        The numbers.
    progress, cancel
        As for `solve`; what is not solved when cancelled has a reason.
    """
    points = list(product(*(slider.values for slider in sliders)))
    found = []
    for i, values in enumerate(points):
        found.append(_solved(analysis, sliders, values, cancel))
        if progress is not None:
            progress((i + 1) / len(points))
    return found


def law_cautions(analysis: Analysis, sliders: Sequence[Slider], points: Sequence[Explored]) -> list[str]:
    """Sentences about hinges that have laws of other types at other points of the grid."""
    base, types, places = as_solved(analysis), {}, {}
    for i, point in enumerate(points):
        laws = law_types_at(base, {one.path: value for one, value in zip(sliders, point.values, strict=True)})
        if laws is not None:
            types[i] = laws
            places[i] = [one.values.index(value) for one, value in zip(sliders, point.values, strict=True)]
    told = [
        ", ".join(
            f"{one.path} {value / one.factor:.6g}{'' if one.unit == '1' else f' {one.unit}'}"
            for one, value in zip(sliders, point.values, strict=True)
        )
        for point in points
    ]
    changes = law_changes(types, places, dict.fromkeys(types, 1))
    return [
        change.sentence("variant", (told[change.variants[0]], told[change.variants[1]])) for change in changes
    ]


def _solved(
    analysis: Analysis,
    sliders: Sequence[Slider],
    values: tuple[float, ...],
    cancel: Callable[[], bool] | None,
) -> Explored:
    try:
        paths = (slider.path for slider in sliders)
        structure = changed(analysis.structure, dict(zip(paths, values, strict=True)))
        new = analysis.model_copy(update={"structure": structure})
        result, frames = solve_with_frames(new, cancel=cancel)
    except InputError as error:
        return Explored(values, None, None, None, error.problems[0].what)
    reason = "" if result.status.ok else result.reason or result.status.value
    return Explored(values, result, frames, structure, reason)


def _slider(part: str, structure: Structure, data: Any, count: int) -> Slider:
    name, _, given = (text.strip() for text in part.partition("="))
    numbers = {path: text for path, text in _numbers(data) if path.split(".")[0] in Structure.model_fields}
    paths = [path for path in numbers if path == name or path.endswith(f".{name}")]
    if len(paths) != 1:
        what = "the input has several such numbers" if paths else "the input has no such number"
        shown = paths or [path for path in numbers if not path.startswith("nodes.")] or list(numbers)
        more = f" and {len(shown) - 8} more" if len(shown) > 8 else ""
        raise _refused(what, name, ", ".join(shown[:8]) + more, "write the path of one of them")
    path, base = paths[0], value_at(structure, paths[0])
    match = _UNIT.fullmatch(str(numbers[path]))
    unit = (match[1] if match else "") or "1"
    low, high = base * (1.0 - AROUND), base * (1.0 + AROUND)
    if given:
        ends = given.split("..")
        if len(ends) != 2:
            raise _refused("this is not a range", part, f"{name}=LOW..HIGH", "write both ends with units")
        low, high = (_quantity(end.strip(), unit, part) for end in ends)
    low, high = min(low, high), max(low, high)
    if not low < high:
        what, todo = "the range has no width", f"write one, as {name}=LOW..HIGH"
        raise _refused(what, part, "two different values", todo)
    return Slider(path, unit, tuple(np.linspace(low, high, count).tolist()))


def _quantity(text: str, unit: str, part: str) -> float:
    try:
        return parse_quantity(text, unit) if unit != "1" else float(text)
    except ValueError:
        allowed = "a number" if unit == "1" else f"a quantity such as 2 {unit}"
        raise _refused("this is not a value of the number", part, allowed, "correct it") from None


def _numbers(part: Any, where: str = "") -> Iterator[tuple[str, Any]]:
    """Paths and texts of all numbers of the input as written."""
    if isinstance(part, dict):
        for key, value in part.items():
            yield from _numbers(value, f"{where}.{key}" if where else str(key))
    elif isinstance(part, list):
        for i, value in enumerate(part):
            yield from _numbers(value, f"{where}.{i}")
    elif not isinstance(part, bool) and (isinstance(part, int | float) or _is_quantity(part)):
        yield where, part


def _is_quantity(part: Any) -> bool:
    return isinstance(part, str) and _UNIT.fullmatch(part) is not None


def _refused(what: str, came: str, allowed: str, todo: str) -> InputError:
    return InputError(Problem(what, came, allowed, todo, WHERE))
