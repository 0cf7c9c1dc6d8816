"""Explicit tables of named entries; an entry is imported when it is first used."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from importlib import import_module
from typing import Generic, TypeVar, cast

from crumple.errors import InputError, Problem

Entry = TypeVar("Entry")


class Registry(Generic[Entry]):
    """Entries by name, one line each; a mapping that imports an entry when it is first looked up.

    Parameters
    ----------
    noun
        Noun for an entry in messages.
    lines
        Where the entry of each name is defined, as ``package.module:NAME``.
    """

    def __init__(self, noun: str, lines: Mapping[str, str]) -> None:
        self._noun = noun
        self._lines = dict(lines)
        self._found: dict[str, Entry] = {}

    def __iter__(self) -> Iterator[str]:
        return iter(self._lines)

    def __len__(self) -> int:
        return len(self._lines)

    def __contains__(self, name: object) -> bool:
        return name in self._lines

    def __getitem__(self, name: str) -> Entry:
        """Entry of a name; refuses an unknown one with `InputError`."""
        if name not in self._lines:
            what, todo = f"unknown {self._noun}", "choose one of these"
            raise InputError(Problem(what, repr(name), ", ".join(self), todo, "type"))
        if name not in self._found:
            module, _, attribute = self._lines[name].partition(":")
            self._found[name] = cast(Entry, getattr(import_module(module), attribute))
        return self._found[name]

    def items(self) -> Iterator[tuple[str, Entry]]:
        """Every name and its entry; imports them all."""
        return ((name, self[name]) for name in self)
