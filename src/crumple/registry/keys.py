"""Keys of a description that follow from a class or a function: its parameters.

What a parameter is called, its unit and range (in the annotation), its default and its meaning (in the
docstring) are defined once, with the class or function.
"""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum
from functools import cache
from types import UnionType
from typing import Annotated, Any, Literal, Union, get_args, get_origin, get_type_hints

from crumple.registry.quantity import Dimension, Whole

MISSING: Any = inspect.Parameter.empty
"""Default of a key that must be given."""
_SECTION = re.compile(r"^(Attributes|Parameters)\n-+\n(.*?)(?=^\w[^\n]*\n-+\n|\Z)", re.MULTILINE | re.DOTALL)
_UNIT = re.compile(r" ?\[[^\]]*\]")


@dataclass(frozen=True)
class Word:
    """Words for a key on the command line, after the sizes of a section; the first is the usual one."""

    texts: tuple[str, ...]


@dataclass(frozen=True)
class As:
    """Type of a parameter in an input, if Python code may give further types."""

    annotation: Any


@dataclass(frozen=True)
class Key:
    """One key.

    Attributes
    ----------
    name
        As in the input file.
    annotation
        Type, with unit and range.
    default
        `MISSING` where it must be given.
    text
        Its meaning in one sentence.
    """

    name: str
    annotation: Any
    default: Any
    text: str

    @property
    def words(self) -> tuple[str, ...]:
        """Words for it on the command line; none for a size, which is known by its position."""
        found = [text for item in self._metadata if isinstance(item, Word) for text in item.texts]
        if found or self.default is MISSING:
            return tuple(found)
        return (self.name.replace("_", " "),)

    @property
    def measure(self) -> Dimension | Whole | None:
        """Unit and range of a number; None for other values."""
        return next((item for item in self._metadata if isinstance(item, Dimension | Whole)), None)

    @property
    def _metadata(self) -> tuple[Any, ...]:
        return get_args(self.annotation)[1:] if get_origin(self.annotation) is Annotated else ()


def keys_of(make: Callable[..., Any], *, options: bool = False) -> tuple[Key, ...]:
    """Parameters of a class or function as keys.

    Parameters
    ----------
    make
        Class or function with annotations, and a docstring with the meaning of each parameter.
    options
        Whether only keyword-only parameters are keys.
    """
    return _keys_of(make, options)


@cache
def _keys_of(make: Callable[..., Any], options: bool) -> tuple[Key, ...]:
    hints = get_type_hints(make, include_extras=True)
    texts = _texts(inspect.getdoc(make) or "")
    return tuple(
        Key(
            name,
            _described(hints[name]),
            parameter.default.value if isinstance(parameter.default, Enum) else parameter.default,
            texts.get(name, ""),
        )
        for name, parameter in inspect.signature(make).parameters.items()
        if not options or parameter.kind is parameter.KEYWORD_ONLY
    )


def _texts(docstring: str) -> dict[str, str]:
    """Description of each parameter, on one line and without units."""
    texts: dict[str, list[str]] = {}
    current: list[list[str]] = []
    for line in (line for section in _SECTION.findall(docstring) for line in section[1].splitlines()):
        if line and not line.startswith(" "):
            current = [texts.setdefault(name, []) for name in line.split(", ")]
        for text in current if line.startswith(" ") else ():
            text.append(line.strip())
    return {name: _UNIT.sub("", " ".join(lines)) for name, lines in texts.items()}


def sentence_on(make: object) -> str:
    """What a class or function is: the first paragraph of its docstring on one line."""
    return " ".join((inspect.getdoc(make) or "").split("\n\n")[0].split())


def _described(annotation: Any) -> Any:
    """Type that a description gives: of an enum that is accepted by its texts, those texts."""
    if get_origin(annotation) is Annotated:
        given = [item.annotation for item in get_args(annotation)[1:] if isinstance(item, As)]
        return given[0] if given else annotation
    if get_origin(annotation) in {Union, UnionType}:
        enums = [kind for kind in get_args(annotation) if isinstance(kind, type) and issubclass(kind, Enum)]
        if enums:
            return Literal[tuple(member.value for member in enums[0])]
    return annotation
