"""One group of a law file: its keys as texts, numbers with units, choices and points, errors by line."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import NoReturn, TypeVar

from crumple.errors import InputError, Problem
from crumple.text.plain_yaml import Entry
from crumple.units import QuantityError, parse_quantity

Value = TypeVar("Value")
MOST_POINTS = 20_000
"""Largest number of points of one curve."""


class Group:
    """A mapping with its line in the file.

    Parameters
    ----------
    entries
        Keys and values.
    file
        Name for messages.
    line
        Line at which the group begins.
    path
        Its keys from the top, for example ``range``.
    """

    def __init__(self, entries: Mapping[str, Entry], file: str, line: int, path: str) -> None:
        self.entries = entries
        self._file = file
        self._line = line
        self._path = path

    def refuse(self, entry: Entry, what: str, allowed: str = "", todo: str = "", key: str = "") -> NoReturn:
        """Raise the refusal of an entry."""
        came = entry.value[:60] if isinstance(entry.value, str) else ""
        raise InputError(Problem(what, came, allowed, todo, self._where(key), self._file, entry.line))

    def only(self, known: Sequence[str]) -> None:
        """Refuse every key that is not known, all at once."""
        problems = [
            Problem("unknown key", key[:60], ", ".join(known), "", self._where(key), self._file, entry.line)
            for key, entry in self.entries.items()
            if key not in known
        ]
        if problems:
            raise InputError(problems)

    def take(self, key: str) -> Entry:
        """Entry of a key that must be there."""
        if key not in self.entries:
            what = f"the key {key} is missing"
            raise InputError(Problem(what, where=self._path, file=self._file, line=self._line))
        return self.entries[key]

    def text(self, key: str) -> str:
        """Text of a key."""
        entry = self.take(key)
        if not isinstance(entry.value, str):
            self.refuse(entry, "a text is needed here", key=key)
        return entry.value

    def texts(self, key: str) -> tuple[str, ...]:
        """List of texts of a key."""
        entry = self.take(key)
        if not isinstance(entry.value, list) or any(not isinstance(one.value, str) for one in entry.value):
            self.refuse(entry, "a list of texts is needed here", key=key)
        return tuple(str(one.value) for one in entry.value)

    def group(self, key: str) -> Group:
        """Group of a key."""
        entry = self.take(key)
        if not isinstance(entry.value, dict):
            self.refuse(entry, "a group of keys is needed here", key=key)
        return Group(entry.value, self._file, entry.line, self._where(key))

    def says_none(self, key: str) -> bool:
        """Whether the value of a key is none."""
        return self.take(key).value == "none"

    def number(self, key: str, unit: str, *, none: bool = False) -> float | None:
        """SI value of a number with a unit; None for "none" if permitted; infinite for "unlimited"."""
        text, entry = self.text(key), self.take(key)
        if none and text == "none":
            return None
        if text == "unlimited":
            return math.inf
        try:
            return parse_quantity(text, unit)
        except QuantityError as error:
            problem = error.problems[0]
            self.refuse(entry, problem.what, problem.allowed, problem.todo, key)

    def choice(self, key: str, choices: Mapping[str, Value]) -> Value:
        """Member that a key names."""
        text = self.text(key)
        if text not in choices:
            self.refuse(self.take(key), "unknown choice", ", ".join(choices), "choose one of these", key)
        return choices[text]

    def points(self, key: str) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """Pairs of plain numbers of a key."""
        entry = self.take(key)
        if not isinstance(entry.value, list) or not 0 < len(entry.value) <= MOST_POINTS:
            self.refuse(entry, "a list of pairs is needed here", f"1 to {MOST_POINTS} pairs", "", key)
        pairs = [self._pair(one, key) for one in entry.value]
        return tuple(pair[0] for pair in pairs), tuple(pair[1] for pair in pairs)

    def built(self, build: Callable[[], Value]) -> Value:
        """Object made by a constructor; its errors get the location of this group."""
        try:
            return build()
        except InputError as error:
            raise InputError(
                [
                    replace(one, file=self._file, line=self._line_of(one.where), where=self._where(one.where))
                    for one in error.problems
                ]
            ) from None

    def _pair(self, entry: Entry, key: str) -> tuple[float, float]:
        values = entry.value if isinstance(entry.value, list) else []
        try:
            rotation, moment = (float(str(one.value)) for one in values)
        except ValueError:
            self.refuse(entry, "two plain numbers are needed here", "[rotation, moment]", "", key)
        return rotation, moment

    def _line_of(self, key: str) -> int:
        return self.entries[key].line if key in self.entries else self._line

    def _where(self, key: str) -> str:
        return ".".join(part for part in (self._path, key) if part)
