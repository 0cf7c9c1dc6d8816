"""Cache of objects derived from an input: sections, materials, laws and their records."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from typing import ParamSpec, TypeVar, cast

P = ParamSpec("P")
T = TypeVar("T")

_forgetting: list[Callable[[], None]] = []


def remembered(size: int) -> Callable[[Callable[P, T]], Callable[P, T]]:
    """Decorator that keeps the last answers of a function of hashable arguments, until `forget`."""

    def keep(function: Callable[P, T]) -> Callable[P, T]:
        kept = lru_cache(maxsize=size)(function)
        _forgetting.append(kept.cache_clear)
        # the return type of lru_cache does not contain the arguments
        return cast(Callable[P, T], kept)

    return keep


def forget() -> None:
    """Clear all caches, so that a timed solution starts without cached objects."""
    for clear in _forgetting:
        clear()
