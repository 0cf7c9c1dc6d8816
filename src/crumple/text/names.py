"""Lists of names in a sentence, shortened to the first few."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TypeVar

MOST_NAMED = 6
"""Names in a list of a sentence, unless its author chooses another number."""

Item = TypeVar("Item")


def listed(
    items: Iterable[Item],
    most: int = MOST_NAMED,
    separator: str = ", ",
    spell: Callable[[Item], str] = str,
) -> str:
    """``a, b and 6 more``: the first names, and the number of the others.

    Parameters
    ----------
    items
        What is named, in this order.
    most
        Largest number of names.
    separator
        Between names; a semicolon for names that contain commas or "and".
    spell
        Name of an item; called only for those that are named.
    """
    every = list(items)
    text = separator.join(map(spell, every[:most]))
    if len(every) <= most:
        return text
    return f"{text}{'' if separator == ', ' else separator.rstrip()} and {len(every) - most} more"
