"""From the input file's mapping to a function of time; nothing is ever evaluated as code.

A function is written as a quantity (``5 kN``) or as a mapping with exactly one key:

    {step: {x0: 0 ms, h0: 0 N, x1: 10 ms, h1: 5 kN}}            also step5, havsin
    {table: {time: [0 ms, 5 ms], value: [0 N, 5 kN]}}           or numbers with units: {time: ms, value: kN}
    {sum: [<function>, <function>]}
    {impact: {x: <motion>, x1: 0 mm, k: 1 kN/mm, e: 1, cmax: 0 N*s/m, d: 1 mm}}      also bistop, with x2

`impact` and `bistop` give a force of a motion x(t) [m], or a moment of a rotation x(t) [rad].
"""

from __future__ import annotations

import difflib
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import replace
from numbers import Real
from typing import Any, ClassVar

from crumple.errors import InputError, Problem
from crumple.function.time_function import Constant, Stop, Sum, Table, TimeFunction, Transition
from crumple.text.names import listed
from crumple.units import parse_quantity, unit_factor

MAX_DEPTH = 8
"""Largest nesting depth of sums and motions; deeper input is a mistake."""
MAX_ROWS = 100_000
"""Rows of a table in an input file, and terms of a sum."""
EXAMPLE = "{havsin: {x0: 0 ms, h0: 0, x1: 10 ms, h1: ...}} or {table: {time: [...], value: [...]}}"
"""Functions as one writes them."""

_MOTION_UNIT = {"N": "m", "N*m": "rad"}


def parse_time_function(spec: object, unit: str, *, plain_numbers: bool = False) -> TimeFunction:
    """Function of time from its description.

    Parameters
    ----------
    spec
        Quantity text, mapping as in the module's docstring, or a `TimeFunction`, which is returned.
    unit
        SI unit of the values, for example ``"N"``.
    plain_numbers
        Whether numbers without a unit are taken as SI (a model built in Python).

    Returns
    -------
    TimeFunction
        Values in SI against time [s].

    Raises
    ------
    InputError
        With every problem found; `Problem.where` is the path inside `spec`.
    """
    reader = _Reader(plain_numbers)
    function = reader.function(spec, unit, "", 0)
    if reader.problems or function is None:
        raise InputError(reader.problems)
    return function


class _Reader:
    """Collects problems while it reads, so that all are reported at once."""

    def __init__(self, plain_numbers: bool) -> None:
        self.plain_numbers = plain_numbers
        self.problems: list[Problem] = []

    def function(self, spec: object, unit: str, where: str, depth: int) -> TimeFunction | None:
        """The function, or None where a problem was noted."""
        if isinstance(spec, TimeFunction):
            return spec
        before = len(self.problems)
        function: TimeFunction | None = None
        with self._placed(where):
            if not isinstance(spec, Mapping):
                function = Constant(self.number(spec, unit, where))
            elif depth > MAX_DEPTH:
                what, todo = (
                    f"functions are nested more than {MAX_DEPTH} deep",
                    "write one sum of all its terms",
                )
                raise InputError(Problem(what, todo=todo))
            elif len(spec) != 1 or next(iter(spec)) not in self._READERS:
                came = ", ".join(str(key)[:40] for key in list(spec)[:5])
                allowed = f"one key of {', '.join(self._READERS)}"
                near = difflib.get_close_matches(came, self._READERS, n=1) if len(spec) == 1 else []
                todo = f"did you mean '{near[0]}'?" if near else f"write it as {EXAMPLE}"
                raise InputError(Problem("this is not a function of time", came, allowed, todo))
            else:
                kind, body = next(iter(spec.items()))
                where = f"{where}.{kind}" if where else kind
                with self._placed(where):
                    function = self._READERS[kind](self, body, unit, where, depth)
        return function if len(self.problems) == before else None

    def constant(self, body: object, unit: str, where: str, depth: int) -> TimeFunction:
        return Constant(self.number(body, unit, where))

    def transition(self, body: object, unit: str, where: str, depth: int) -> TimeFunction | None:
        units = {"x0": "s", "h0": unit, "x1": "s", "h1": unit}
        fields = _fields(body, tuple(units))
        values = {name: self.number(fields[name], si, f"{where}.{name}") for name, si in units.items()}
        return None if _unknown(values) else Transition(where.rpartition(".")[2], **values)

    def table(self, body: object, unit: str, where: str, depth: int) -> TimeFunction | None:
        fields = _fields(body, ("time", "value"), ("units",))
        heads = _fields(fields["units"], ("time", "value")) if "units" in fields else {}
        before = len(self.problems)
        time, value = (
            self.column(fields[name], si, heads.get(name), f"{where}.{name}")
            for name, si in (("time", "s"), ("value", unit))
        )
        return Table(time, value) if len(self.problems) == before else None

    def sum(self, body: object, unit: str, where: str, depth: int) -> TimeFunction | None:
        rows = _rows(body)
        terms = [self.function(term, unit, f"{where}[{i}]", depth + 1) for i, term in enumerate(rows)]
        found = tuple(term for term in terms if term is not None)
        return Sum(found) if len(found) == len(terms) else None

    def stop(self, body: object, unit: str, where: str, depth: int) -> TimeFunction | None:
        motion_unit = _MOTION_UNIT.get(unit)
        if motion_unit is None:
            what = f"impact and bistop give a force or a moment, but a value in {unit} is needed"
            raise InputError(Problem(what, todo="use a table, or a step, step5 or havsin"))
        travel = ("x1", "x2") if where.endswith("bistop") else ("x1",)
        fields = _fields(body, ("x", *travel, "k", "e", "cmax", "d"))
        motion = self.function(fields["x"], motion_unit, f"{where}.x", depth + 1)
        exponent = self.number(fields["e"], "1", f"{where}.e")
        units = dict.fromkeys((*travel, "d"), motion_unit) | {"cmax": f"{unit}*s/{motion_unit}"}
        values = {name: self.number(fields[name], si, f"{where}.{name}") for name, si in units.items()}
        values["k"] = self.stiffness(fields["k"], exponent, f"{unit}/{motion_unit}", f"{where}.k")
        if motion is None or _unknown(values | {"e": exponent}):
            return None
        return Stop(motion=motion, e=exponent, x2=values.pop("x2", None), **values)

    _READERS: ClassVar[dict[str, Callable[[_Reader, Any, str, str, int], TimeFunction | None]]] = {
        "constant": constant,
        **dict.fromkeys(Transition.KINDS, transition),
        "table": table,
        "sum": sum,
        "impact": stop,
        "bistop": stop,
    }

    def stiffness(self, value: object, e: float, unit: str, where: str) -> float:
        """Stiffness of a stop; for a fractional exponent, which the grammar lacks, a plain SI number."""
        if math.isnan(e) or e == 1.0:
            return self.number(value, unit, where)
        if e.is_integer():
            return self.number(value, f"{unit}^{int(e)}", where)
        return self.number(value, "1", where)

    def number(self, value: object, unit: str, where: str) -> float:
        """SI value; NaN where a problem was noted."""
        with self._placed(where):
            if isinstance(value, Real) and not isinstance(value, bool):
                if (self.plain_numbers or unit == "1" or value == 0) and math.isfinite(value):
                    return float(value)
                return parse_quantity(str(value), unit)
            return parse_quantity(value, unit)  # type: ignore[arg-type]
        return math.nan

    def column(self, values: object, unit: str, head: object, where: str) -> tuple[float, ...]:
        """SI values of a column of a table; with a head its numbers are plain and the head is their unit."""
        with self._placed(where):
            factor = 1.0 if head is None else unit_factor(str(head), unit)
            written = unit if head is None else "1"
            rows = enumerate(_rows(values))
            return tuple(factor * self.number(value, written, f"{where}[{i}]") for i, value in rows)
        return ()

    @contextmanager
    def _placed(self, where: str) -> Iterator[None]:
        """Notes the problems of a refusal under the place where it happened."""
        try:
            yield
        except InputError as error:
            self.problems += [replace(problem, where=problem.where or where) for problem in error.problems]


def _fields(body: object, needed: tuple[str, ...], optional: tuple[str, ...] = ()) -> Mapping[str, Any]:
    """The mapping itself, refused unless it has every needed key and no unknown one."""
    allowed = ", ".join((*needed, *optional))
    if not isinstance(body, Mapping):
        todo = f"write its keys with values: {{{needed[0]}: ...}}"
        raise InputError(Problem("a group of keys is needed here", _kind(body), allowed, todo))
    missing = [name for name in needed if name not in body]
    unknown = [str(name)[:40] for name in body if name not in (*needed, *optional)]
    problems = [
        Problem(f"{what}: {listed(names, 8)}", allowed=allowed, todo=todo)
        for what, names, todo in (
            ("missing", missing, "add it" if len(missing) == 1 else "add them"),
            ("unknown key", unknown, "remove it or correct its spelling"),
        )
        if names
    ]
    if problems:
        raise InputError(problems)
    return body


def _rows(values: object) -> Sequence[Any]:
    if isinstance(values, Sequence) and not isinstance(values, (str, bytes)) and len(values) <= MAX_ROWS:
        return values
    what, came = f"a list of at most {MAX_ROWS} entries is needed", _kind(values)
    raise InputError(Problem(what, came, todo="write a list in brackets, of fewer entries if it is longer"))


def _kind(value: object) -> str:
    """What a value is, in words of the input file."""
    if isinstance(value, str | Real):
        return str(value)[:40]
    if isinstance(value, Mapping):
        return "keys with values"
    return f"a list of {len(value)}" if isinstance(value, Sequence) else "nothing"


def _unknown(values: Mapping[str, float]) -> bool:
    return any(math.isnan(value) for value in values.values())
