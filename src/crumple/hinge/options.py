"""Options of laws, checked on input."""

from __future__ import annotations

from enum import Enum
from typing import TypeVar

from crumple.errors import InputError, Problem

Choice = TypeVar("Choice", bound=Enum)


def choice(name: str, value: Choice | str, kind: type[Choice]) -> Choice:
    """Member of an enum by itself or by its text.

    Raises
    ------
    InputError
        If the text names no member.
    """
    try:
        return kind(value)
    except ValueError:
        allowed = ", ".join(str(member.value) for member in kind)
        raise InputError(
            Problem("unknown choice", repr(value), allowed, "choose one of these", name)
        ) from None


def number_between(name: str, value: float, low: float, high: float) -> float:
    """Return a number inside a closed interval.

    Raises
    ------
    InputError
        If it is outside or not a number.
    """
    if not low <= value <= high:
        what = f"{name.replace('_', ' ')} is out of range"
        raise InputError(
            Problem(what, f"{value:g}", f"{low:g} to {high:g}", "choose a value in the range", name)
        )
    return float(value)
