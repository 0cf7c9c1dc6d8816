"""Names in a sentence: all while they are few."""

from __future__ import annotations

MOST_NAMES = 6
"""Names that a sentence lists one by one."""


def named(what: str, names: list[str]) -> str:
    """`Hinge a`, or `Hinges a, b, c`, or the first of many and how many more there are."""
    return f"{what} {names[0]}" if len(names) == 1 else f"{what}s {shown(names)}"


def shown(names: list[str]) -> str:
    """Names with commas, the rest of many counted."""
    few = len(names) <= MOST_NAMES
    return ", ".join(names if few else [*names[: MOST_NAMES - 1], f"{len(names) - MOST_NAMES + 1} more"])
