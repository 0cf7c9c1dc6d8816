"""Numbers and words of an input text and where they stand: sliders and forms change them and nothing else."""

from __future__ import annotations

import re
from dataclasses import asdict, dataclass
from typing import Any

MOST = 2000
"""Numbers that are given; those that follow have no sliders."""
LONGEST = 100_000
"""Characters of a text whose numbers are looked for; longer ones take seconds."""
IN_FORMS = ("sections.", "hinge_laws.")
"""Paths whose words are in forms."""
_WORD = re.compile(r"[A-Za-z][\w.-]{0,40}")
_QUANTITY = re.compile(
    r"([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)(?:[ ]*((?!x\d)[A-Za-z%°µ][^,\[\]{}#]*))?"
)


@dataclass(frozen=True)
class Number:
    """One number.

    Attributes
    ----------
    path
        Keys and indices, as ``sections.tube.thickness``.
    start, end
        Of its digits in the text, in units of UTF-16, as browsers count.
    value
        As written.
    unit
        That follows it, empty if none does.
    """

    path: str
    start: int
    end: int
    value: float
    unit: str


@dataclass(frozen=True)
class Word:
    """One plain word of a section or a law.

    Attributes
    ----------
    path
        Keys and indices, as ``sections.tube.type``.
    start, end
        Of it in the text, in units of UTF-16.
    text
        As written.
    """

    path: str
    start: int
    end: int
    text: str


def scalars_of(text: str) -> dict[str, list[dict[str, Any]]]:
    """``numbers`` and ``words`` of a text that is YAML as far as they stand, as plain data.

    See `Number` and `Word`.
    """
    from ruamel.yaml import YAML  # noqa: PLC0415
    from ruamel.yaml.error import YAMLError  # noqa: PLC0415

    if len(text) > LONGEST:
        return {"numbers": [], "words": []}
    found: list[Number] = []
    words: list[Word] = []
    # for every open group: its path, whether it is a list, and its key or how many entries came
    groups: list[list[Any]] = []
    units = _Units(text)
    try:
        for event in YAML(typ="safe", pure=True).parse(text):
            kind = type(event).__name__
            if kind in ("MappingEndEvent", "SequenceEndEvent"):
                groups.pop()
            elif kind in ("MappingStartEvent", "SequenceStartEvent", "ScalarEvent", "AliasEvent"):
                path = _next_path(groups, event)
                if kind.endswith("StartEvent"):
                    groups.append([path or "", kind[0] == "S", None if kind[0] == "M" else 0])
                elif kind == "ScalarEvent" and path is not None and len(found) < MOST:
                    numbers = _number(event, path, units)
                    found += numbers
                    words += [] if numbers else _word(event, path, units)
    except (YAMLError, ValueError, TypeError, AttributeError, IndexError, RecursionError):
        # what was read before the mistake has sliders
        pass
    return {
        "numbers": [asdict(one) for one in found if one.path != "crumple"],
        "words": [asdict(one) for one in words],
    }


def _next_path(groups: list[list[Any]], event: Any) -> str | None:
    """Path of the value that an event begins; None for a key."""
    if not groups:
        return ""
    group = groups[-1]
    path, is_list, at = group
    if is_list:
        group[2] += 1
        return f"{path}[{at}]"
    if at is None:
        group[2] = str(getattr(event, "value", ""))
        return None
    group[2] = None
    return f"{path}.{at}" if path else str(at)


def _number(event: Any, path: str, units: _Units) -> list[Number]:
    if event.style in {"'", '"', "|", ">"}:
        return []
    match = _QUANTITY.fullmatch(event.value)
    if match is None or len(match[1]) > 20:
        return []
    begin = event.start_mark.index
    start, end = units.place(begin), units.place(begin + len(match[1]))
    return [Number(path, start, end, float(match[1]), (match[2] or "").strip())]


def _word(event: Any, path: str, units: _Units) -> list[Word]:
    if event.style in {"'", '"', "|", ">"} or not path.startswith(IN_FORMS):
        return []
    if not _WORD.fullmatch(event.value):
        return []
    begin = event.start_mark.index
    return [Word(path, units.place(begin), units.place(begin + len(event.value)), event.value)]


class _Units:
    """Places in units of UTF-16."""

    def __init__(self, text: str) -> None:
        self._wide = [i for i, letter in enumerate(text) if ord(letter) > 0xFFFF]

    def place(self, index: int) -> int:
        return index + sum(1 for i in self._wide if i < index)
