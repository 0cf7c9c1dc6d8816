"""The YAML that nearly every input file is written in, read a line at a time: some twenty times as fast.

Simple lines are ``key: value`` and ``- value``, indented, where a value is a text on one line, a collection
in brackets on one line, or the deeper lines that follow.  Comments and quoted texts without escapes may stand
there too.  Whatever else a text holds, mistakes included, is left to the full parser: `read_simple` then
gives None, and what it gives is what the full parser would have given.  A test compares the two.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any

from crumple.structure.schema.problems import Place

Scalar = Callable[[str], Any]
"""Value of a text that is not in quotes."""

_PLAIN = r"~|[-+]?\.?[^\W_][\w .+\-*/^()=<>°]*"
"""A text without quotes: no character in it means anything to YAML."""
_OTHER_LINES = re.compile("[\t\r\x85\u2028\u2029\ufeff]")
"""Tabs, and unusual line breaks."""
_QUOTED = r"\"[^\"\\]*\"|'[^']*'"
_KEY = re.compile(rf"({_QUOTED}|[^\W_][\w.\-]*|_[\w.\-]*):(?: +(.*))?")
_PLAIN_TEXT = re.compile(_PLAIN)
_WHOLE = re.compile(rf"{_QUOTED}|~|[-+]?\.?[^\W_][\w .+\-*/^()=<>°,;'\[\]{{}}]*")
_TOKEN = re.compile(rf" *([\[\]{{}},]|(?:{_QUOTED}|{_PLAIN})(?::(?= ))?)")
_LONGEST_KEY = 200
"""Characters; the full parser takes no key above 1024."""


class _NotSimpleError(Exception):
    """The line is none of the simple ones."""


class _NotPlainError(Exception):
    """The text is more than a plain one."""


class _PlainTexts(dict[str, Any]):
    """Values of plain texts by what stands between two commas: in a large file most are repeated."""

    def __init__(self, scalar: Scalar) -> None:
        super().__init__()
        self._scalar = scalar

    def __missing__(self, part: str) -> Any:
        text = part.strip(" ")
        if _PLAIN_TEXT.fullmatch(text) is None:
            raise _NotPlainError
        value = self[part] = self._scalar(text)
        return value


class SimpleText:
    """A text in simple lines.

    Parameters
    ----------
    text
        Without control characters.
    scalar
        Gives the value of a text that is not in quotes.
    deepest
        Levels that may be nested.
    """

    def __init__(self, text: str, scalar: Scalar, deepest: int) -> None:
        self._scalar, self._deepest = scalar, deepest
        self._next = 0
        self._lines: list[tuple[int, int, str]] = []
        self._values: dict[str, Any] = {}
        self._plain, self._keys = _PlainTexts(scalar), _PlainTexts(str)
        self._text = text.replace("\r\n", "\n")
        self.lines: dict[Place, int] = {}
        """Of every key and every entry that begins a line; what follows in brackets is in the same line."""
        self.stopped = 0

    def read(self) -> dict[str, Any] | None:
        """The mapping that the text is; None where a line, noted in `stopped`, is not simple."""
        try:
            other = _OTHER_LINES.search(self._text)
            if other is not None:
                self.stopped = self._text.count("\n", 0, other.start()) + 1
                return None
            for number, line in enumerate(self._text.split("\n"), 1):
                self.stopped = number
                indented = line.lstrip(" ")
                content = _without_comment(indented)
                if content:
                    self._lines.append((number, len(line) - len(indented), content))
            if not self._lines or self._lines[0][1] != 0:
                return None
            data = self._block(0, ())
            if self._next != len(self._lines) or not isinstance(data, dict):
                self.stopped = self._lines[min(self._next, len(self._lines) - 1)][0]
                return None
        except _NotSimpleError:
            return None
        return data

    def _block(self, indent: int, place: Place) -> Any:
        """Mapping or list whose lines begin here, at one indent."""
        if len(place) > self._deepest:
            raise _NotSimpleError
        is_list = self._lines[self._next][2].startswith("- ")
        return self._list(indent, place) if is_list else self._mapping(indent, place)

    def _mapping(self, indent: int, place: Place) -> dict[str, Any]:
        mapping: dict[str, Any] = {}
        while self._next < len(self._lines):
            number, at, content = self._lines[self._next]
            if at < indent:
                break
            self.stopped = number
            match = _KEY.fullmatch(content)
            if at > indent or match is None:
                raise _NotSimpleError
            key = _bare(match[1])
            here = (*place, key)
            if key in mapping or len(key) > _LONGEST_KEY:
                raise _NotSimpleError
            self.lines[here] = number
            mapping[key] = self._value(match[2] or "", indent, here)
        return mapping

    def _list(self, indent: int, place: Place) -> list[Any]:
        values: list[Any] = []
        while self._next < len(self._lines):
            number, at, content = self._lines[self._next]
            if at < indent or (at == indent and not content.startswith("- ")):
                break
            self.stopped = number
            if at > indent:
                raise _NotSimpleError
            rest = content[1:].lstrip(" ")
            inner = at + len(content) - len(rest)
            here = (*place, len(values))
            self.lines[here] = number
            if _KEY.fullmatch(rest) or rest.startswith("- "):
                # a group or a list that begins in the line of its dash
                self._lines[self._next] = (number, inner, rest)
                values.append(self._block(inner, here))
            else:
                values.append(self._inline(rest, here))
                self._next += 1
        return values

    def _value(self, text: str, indent: int, place: Place) -> Any:
        """Value of a key: the rest of its line, or the deeper lines that follow."""
        self._next += 1
        if text:
            return self._inline(text, place)
        if self._next == len(self._lines):
            return None
        _, at, content = self._lines[self._next]
        # the entries of a list may stand as far out as their key
        if at > indent or (at == indent and content.startswith("- ")):
            return self._block(at, place)
        return None

    def _inline(self, text: str, place: Place) -> Any:
        """Value of a text on one line."""
        if text[0] not in "[{":
            if text not in self._values and _WHOLE.fullmatch(text) is None:
                raise _NotSimpleError
            return self._text_value(text)
        if len(place) + 2 <= self._deepest:
            try:
                return self._flat(text)
            except _NotPlainError:
                pass
        tokens, end = [], 0
        for match in _TOKEN.finditer(text):
            if match.start() != end:
                raise _NotSimpleError
            tokens.append(match[1])
            end = match.end()
        if end < len(text):
            raise _NotSimpleError
        value, used = self._collection(tokens, 0, place)
        if used != len(tokens):
            raise _NotSimpleError
        return value

    def _flat(self, text: str) -> Any:
        """A list or a group of plain texts, or a list of one such group: nearly all that is in brackets."""
        ends, inner = text[0] + text[-1], text[1:-1]
        if ends == "[]" and inner[:1] == "{":
            return [self._flat(inner)]
        if ends == "[]":
            return [self._plain[part] for part in inner.split(",")]
        if ends != "{}":
            raise _NotPlainError
        group: dict[str, Any] = {}
        entries = inner.split(",")
        for entry in entries:
            key, _, value = entry.partition(": ")
            group[self._keys[key]] = self._plain[value]
        if len(group) < len(entries) or max(map(len, group)) > _LONGEST_KEY:
            raise _NotPlainError
        return group

    def _collection(self, tokens: list[str], at: int, place: Place) -> tuple[Any, int]:
        """Value that begins at a token, and the token after it."""
        if at >= len(tokens) or len(place) > self._deepest:
            raise _NotSimpleError
        head = tokens[at]
        if head not in ("[", "{"):
            if head in ("]", "}", ",") or head.endswith(":"):
                raise _NotSimpleError
            return self._text_value(head), at + 1
        values: Any = [] if head == "[" else {}
        close, at = ("]" if head == "[" else "}"), at + 1
        if tokens[at : at + 1] == [close]:
            return values, at + 1
        while True:
            at = self._entry(tokens, at, place, values)
            if at >= len(tokens) or tokens[at] not in (",", close):
                raise _NotSimpleError
            at += 1
            if tokens[at - 1] == close:
                return values, at

    def _entry(self, tokens: list[str], at: int, place: Place, values: Any) -> int:
        """Add one entry to a list or a group in brackets; gives the token after it."""
        key: str | int = len(values)
        if isinstance(values, dict):
            if at >= len(tokens) or not tokens[at].endswith(":"):
                raise _NotSimpleError
            key, at = _bare(tokens[at][:-1].rstrip(" ")), at + 1
            if key in values or len(key) > _LONGEST_KEY:
                raise _NotSimpleError
        value, at = self._collection(tokens, at, (*place, key))
        if isinstance(values, dict):
            values[key] = value
        else:
            values.append(value)
        return at

    def _text_value(self, text: str) -> Any:
        # most texts of a large file are repeated: names, units and zeros
        if text not in self._values:
            quoted = text[0] in "\"'"
            self._values[text] = text[1:-1] if quoted else self._scalar(text.rstrip(" "))
        return self._values[text]


def _bare(key: str) -> str:
    """Key without its quotes."""
    return key[1:-1] if key[0] in "\"'" else key


def _without_comment(content: str) -> str:
    """A line's content without indent, comment and spaces at its end."""
    if "#" in content:
        if content[0] == "#":
            return ""
        cut = content.find(" #")
        if cut < 0 or '"' in content or "'" in content or "#" in content[:cut]:
            raise _NotSimpleError
        content = content[:cut]
    return content.rstrip(" ")
