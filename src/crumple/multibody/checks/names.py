"""The subject of a sentence about one or several things."""

from __future__ import annotations

from crumple.text.names import listed


def named(what: str, names: list[str]) -> str:
    """``Hinge a``, ``Hinges a, b, c``, or the first of many names and the number of further ones."""
    return f"{what} {names[0]}" if len(names) == 1 else f"{what}s {listed(names)}"
