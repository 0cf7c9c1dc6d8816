"""From the text of an input file to plain data, with the line of every key.

YAML 1.2 without features that an input file does not need: anchors, aliases, tags, directives and several
documents are refused, the size and the depth are bounded, and a repeated key is a mistake.  Numbers are those
of the JSON schema of YAML; every other plain text stays a text.
"""

from __future__ import annotations

import codecs
import math
import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from crumple.analysis.simple_yaml import SimpleText
from crumple.errors import InputError, Problem
from crumple.structure.schema.problems import Place, shown, spelled

LARGEST_FILE = 4_000_000
"""Bytes of an input file; a chain of ten thousand members, each with a hinge, has 1.5 MB."""
LARGEST_TEXT = 1_000_000
"""Characters of a text that is not in simple lines: the full parser takes ten seconds for it."""
MOST_REPEATED = 20
"""Repeated keys that are listed; after that reading stops."""
DEEPEST = 16
"""Largest depth of nested groups; the format itself needs eight."""

_NEAR = "look at this line and the one before; indent with spaces, quote texts that contain ': ' or '#'"
_CONTROL = re.compile(r"[^\t\n\r\x20-\x7e\x85\xa0-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
_CONTROL_BYTE = re.compile(rb"[\0-\x08\x0e-\x1f\x7f]")
_NUMBER = re.compile(r"[-+]?([0-9]+(\.[0-9]*)?|\.[0-9]+)([eE][-+]?[0-9]+)?")
_NOT_FINITE = re.compile(r"[-+]?\.(inf|Inf|INF)|\.(nan|NaN|NAN)")
_CONSTANTS: dict[str, bool | None] = {"": None, "~": None, "null": None, "Null": None, "NULL": None}
_CONSTANTS |= {"true": True, "True": True, "TRUE": True, "false": False, "False": False, "FALSE": False}


@dataclass
class Document:
    """Content of an input file.

    Attributes
    ----------
    data
        Mappings, lists, texts, numbers, booleans, None.
    lines
        1-based line of each place (path of keys and indices).
    problems
        Mistakes that did not stop the reading.
    text
        As its author wrote it.
    """

    data: Any
    lines: dict[Place, int] = field(default_factory=dict)
    problems: list[Problem] = field(default_factory=list)
    text: str = ""

    def line_of(self, place: Place) -> int:
        """Line of a path, or of the nearest enclosing path that is in the file."""
        while place and place not in self.lines:
            place = place[:-1]
        return self.lines.get(place, 1)


def read_file(path: Path) -> Document:
    """Content of a file.

    Raises
    ------
    InputError
        If it is missing, too large, binary, not UTF-8, empty or not YAML.
    """
    name = str(path)
    try:
        if not path.is_file():
            what = "this is a folder" if path.is_dir() else "there is no such file"
            if path.exists() and not path.is_dir():
                what = "this is not a regular file"
            raise _refusal(what, name, allowed="an input file", todo="check the name")
        with path.open("rb") as file:
            content = file.read(LARGEST_FILE + 1)
            size = path.stat().st_size
    except OSError as error:
        raise _refusal(f"the file cannot be read: {error.strerror}", name) from None
    if len(content) > LARGEST_FILE:
        came, allowed = f"{max(size, len(content)) / 1e6:.1f} MB", f"at most {LARGEST_FILE / 1e6:g} MB"
        raise _refusal(
            "the file is too large for an input file", name, came, allowed, "put curves into CSV files"
        )
    try:
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        wide = content.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE))
        text_of_another_kind = wide or not _CONTROL_BYTE.search(content)
        what = "the text is not UTF-8" if text_of_another_kind else "the file is binary"
        came = "UTF-16" if wide else f"the byte {content[error.start]:#04x}" if text_of_another_kind else ""
        todo = "save it again as UTF-8" if text_of_another_kind else "write it with a text editor, in UTF-8"
        raise _refusal(what, name, came, "a YAML text in UTF-8", todo, line) from None
    return read_text(text, name)


def read_text(text: str, file: str = "") -> Document:
    """Content of a text.

    Raises
    ------
    InputError
        If it is binary, empty or not YAML.
    """
    control = _CONTROL.search(text)
    if control is not None:
        line, came = text.count("\n", 0, control.start()) + 1, f"the control character {ord(control[0])}"
        raise _refusal("the file is binary", file, came, "a YAML text", "write it with a text editor", line)
    simple = SimpleText(text, _plain_scalar, DEEPEST)
    data = simple.read()
    if data is not None:
        return Document(data, simple.lines, text=text)
    if len(text) > LARGEST_TEXT:
        came, allowed = f"{len(text) / 1e6:.1f} MB", f"at most {LARGEST_TEXT / 1e6:g} MB"
        allowed += (
            f", or {LARGEST_FILE / 1e6:g} MB in lines such as 'key: value' and 'key: {{a: 1, b: [2, 3]}}'"
        )
        todo = "write this line so, or put curves into CSV files"
        raise _refusal(
            "so large a file can have simple lines only", file, came, allowed, todo, simple.stopped
        )
    document = _Reader(text, file).read()
    if document.data is None:
        raise _refusal("the file is empty", file, "", "a description", "start with the line 'crumple: 1'", 1)
    return document


class _Reader:
    """Builds data from the parser's events, so that aliases and tags have no effect."""

    def __init__(self, text: str, file: str) -> None:
        from ruamel.yaml import YAML  # noqa: PLC0415  (an analysis built in Python needs none)

        self._file = file
        self._document = Document(None, text=text)
        self._events: Iterator[Any] = iter(YAML(typ="safe", pure=True).parse(text))

    def read(self) -> Document:
        """Read the only document."""
        documents = 0
        while True:
            event = self._next()
            kind = type(event).__name__
            if kind == "StreamEndEvent":
                return self._document
            if kind == "DocumentStartEvent":
                documents += 1
                if documents > 1:
                    raise self._refusal(
                        event, "a second document starts here", allowed="one description per file"
                    )
                if event.version or event.tags:
                    raise self._refusal(
                        event, "directives are not allowed", todo="remove the line that starts with %"
                    )
            elif kind not in {"StreamStartEvent", "DocumentEndEvent"}:
                self._document.data = self._value(event, ())

    def _next(self) -> Any:
        from ruamel.yaml.error import MarkedYAMLError, YAMLError  # noqa: PLC0415

        try:
            return next(self._events)
        except MarkedYAMLError as error:
            mark = error.problem_mark or error.context_mark
            line = mark.line + 1 if mark is not None else 0
            what = f"this is not YAML: {_sentence(error)}"
            raise _refusal(what, self._file, todo=_NEAR, line=line) from None
        except RecursionError:
            allowed = f"at most {DEEPEST} levels"
            raise _refusal("the groups are nested too deeply", self._file, "", allowed, line=1) from None
        except (YAMLError, ValueError, TypeError, AttributeError, IndexError) as error:
            # the parser fails with other exceptions on some malformed texts
            raise _refusal(f"this is not YAML: {_sentence(error)}", self._file, todo=_NEAR, line=1) from None

    def _value(self, event: Any, place: Place) -> Any:
        kind = type(event).__name__
        if kind == "AliasEvent":
            raise self._refusal(event, "aliases are refused", f"*{event.anchor}", "", "write out the content")
        if event.anchor:
            raise self._refusal(event, "anchors are refused", f"&{event.anchor}", "", "write out the content")
        if event.tag is not None and str(event.tag) not in {"None", "!"}:
            tag = shown(str(event.tag).replace("tag:yaml.org,2002:", "!!"))
            raise self._refusal(event, "tags are refused", tag, "", "remove the tag")
        if len(place) > DEEPEST:
            raise self._refusal(event, "the groups are nested too deeply", "", f"at most {DEEPEST} levels")
        if kind == "ScalarEvent":
            return self._scalar(event)
        return self._mapping(place) if kind == "MappingStartEvent" else self._sequence(place)

    def _mapping(self, place: Place) -> dict[str, Any]:
        mapping: dict[str, Any] = {}
        while type(event := self._next()).__name__ != "MappingEndEvent":
            if type(event).__name__ != "ScalarEvent" or event.anchor or event.tag:
                self._value(event, place)
                raise self._refusal(event, "a group or a list cannot be a key", allowed="a name")
            key, line = event.value, event.start_mark.line + 1
            value = self._value(self._next(), (*place, key))
            if key in mapping:
                first = self._document.lines[(*place, key)]
                what, todo = (
                    f"the key '{shown(key)}' is given twice",
                    f"remove one; the first is in line {first}",
                )
                self._document.problems.append(
                    Problem(what, todo=todo, where=spelled((*place, key)), file=self._file, line=line)
                )
                if len(self._document.problems) == MOST_REPEATED:
                    raise InputError(self._document.problems)
                continue
            mapping[key] = value
            self._document.lines[(*place, key)] = line
        return mapping

    def _sequence(self, place: Place) -> list[Any]:
        values: list[Any] = []
        while type(event := self._next()).__name__ != "SequenceEndEvent":
            here = (*place, len(values))
            self._document.lines[here] = event.start_mark.line + 1
            values.append(self._value(event, here))
        return values

    def _scalar(self, event: Any) -> Any:
        return event.value if event.style in {"'", '"', "|", ">"} else _plain_scalar(event.value)

    def _refusal(
        self, event: Any, what: str, came: str = "", allowed: str = "", todo: str = ""
    ) -> InputError:
        return _refusal(what, self._file, came, allowed, todo, event.start_mark.line + 1)


def _plain_scalar(text: str) -> Any:
    """Value of a text that is not in quotes."""
    if text in _CONSTANTS:
        return _CONSTANTS[text]
    if _NOT_FINITE.fullmatch(text):
        return math.nan if "n" in text.lower()[:2] else math.inf
    # a number longer than any of use stays a text: it is refused where a number is needed
    if len(text) <= 40 and _NUMBER.fullmatch(text):
        return int(text) if text.lstrip("+-").isdigit() else float(text)
    return text


def _refusal(
    what: str, file: str, came: str = "", allowed: str = "", todo: str = "", line: int = 0
) -> InputError:
    return InputError(Problem(what, came, allowed, todo, file=file, line=line))


def _sentence(error: Exception) -> str:
    text = getattr(error, "problem", None) or str(error).split("\n")[0] or type(error).__name__
    return shown(text)
