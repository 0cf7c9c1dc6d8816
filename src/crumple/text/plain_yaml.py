"""Plain YAML with the line of every entry: mappings, lists and texts, nothing else.

For files that programs write and people read.  Anchors, aliases, tags, directives, further documents,
repeated keys and control characters are refused; every scalar stays a text, without type conversion.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from crumple.errors import InputError, Problem

LARGEST_TEXT = 2_000_000
"""Largest number of characters of a file; a curve of 20 000 points is shorter."""
DEEPEST = 8
"""Nested groups."""
_CONTROL = re.compile(r"[^\t\n\r\x20-\x7e\x85\xa0-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")


@dataclass(frozen=True)
class Entry:
    """One value with its line.

    Attributes
    ----------
    value
        Text, list of entries, or mapping from text to entry.
    line
        1-based.
    """

    value: str | list[Entry] | dict[str, Entry]
    line: int


def read_plain_yaml(text: str, file: str = "") -> dict[str, Entry]:
    """Mapping of a text.

    Parameters
    ----------
    text
        The content.
    file
        Name for messages.

    Raises
    ------
    InputError
        With the line, if it is not YAML or contains something that is refused.
    """
    if len(text) > LARGEST_TEXT:
        raise _refusal("the file is too large", file, 0, f"at most {LARGEST_TEXT / 1e6:g} MB")
    control = _CONTROL.search(text)
    if control is not None:
        raise _refusal("the file is binary", file, text.count("\n", 0, control.start()) + 1, "a YAML text")
    entry = _Reader(text, file).document()
    if entry is None or not isinstance(entry.value, dict):
        raise _refusal("the file has no keys", file, 1, "lines such as 'title: ...'")
    return entry.value


class _Reader:
    """Builds entries from the parser's events, so that aliases and tags have no effect."""

    def __init__(self, text: str, file: str) -> None:
        from ruamel.yaml import YAML  # noqa: PLC0415  (laws built from formulas need none)

        self._file = file
        self._events: Iterator[Any] = iter(YAML(typ="safe", pure=True).parse(text))

    def document(self) -> Entry | None:
        found: Entry | None = None
        starts = 0
        while (kind := type(event := self._next()).__name__) != "StreamEndEvent":
            if kind == "DocumentStartEvent":
                starts += 1
                if starts > 1 or event.version or event.tags:
                    raise self._refused(event, "directives and further documents are not allowed")
            elif kind not in {"StreamStartEvent", "DocumentEndEvent"}:
                found = self._entry(event, 0)
        return found

    def _next(self) -> Any:
        from ruamel.yaml.error import MarkedYAMLError, YAMLError  # noqa: PLC0415

        try:
            return next(self._events)
        except MarkedYAMLError as error:
            mark = error.problem_mark or error.context_mark
            line = mark.line + 1 if mark is not None else 0
            raise _refusal(f"this is not YAML: {error.problem}", self._file, line) from None
        except (YAMLError, ValueError, TypeError, AttributeError, IndexError, RecursionError) as error:
            raise _refusal(f"this is not YAML: {type(error).__name__}", self._file, 1) from None

    def _entry(self, event: Any, depth: int) -> Entry:
        kind, line = type(event).__name__, event.start_mark.line + 1
        if kind == "AliasEvent" or event.anchor:
            raise self._refused(event, "anchors and aliases are refused")
        if event.tag is not None and str(event.tag) not in {"None", "!"}:
            raise self._refused(event, "tags are refused")
        if depth > DEEPEST:
            raise self._refused(event, "the groups are nested too deeply")
        if kind == "ScalarEvent":
            return Entry(str(event.value), line)
        if kind == "SequenceStartEvent":
            items: list[Entry] = []
            while type(inner := self._next()).__name__ != "SequenceEndEvent":
                items.append(self._entry(inner, depth + 1))
            return Entry(items, line)
        mapping: dict[str, Entry] = {}
        while type(inner := self._next()).__name__ != "MappingEndEvent":
            key = self._entry(inner, depth + 1)
            if not isinstance(key.value, str):
                raise self._refused(inner, "a group or a list cannot be a key")
            value = self._entry(self._next(), depth + 1)
            if key.value in mapping:
                raise self._refused(inner, f"the key '{key.value[:40]}' is given twice")
            # a value may begin a line below its key: report the line of the key
            mapping[key.value] = Entry(value.value, key.line)
        return Entry(mapping, line)

    def _refused(self, event: Any, what: str) -> InputError:
        return _refusal(what, self._file, event.start_mark.line + 1)


def _refusal(what: str, file: str, line: int, allowed: str = "") -> InputError:
    todo = "look at this line and the one before" if line else ""
    return InputError(Problem(what, "", allowed, todo, "", file, line))
