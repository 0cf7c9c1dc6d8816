"""Cache of objects derived from an input: sections, materials, laws and their records."""

from __future__ import annotations

from collections.abc import Callable, Collection, Hashable
from functools import lru_cache
from typing import Any, ParamSpec, TypeVar, cast
from weakref import WeakValueDictionary

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


FOUND = frozenset({"lengthening members"})
"""Kinds of data that a solution has shown."""


class Kept(dict[tuple[str, Hashable], Any]):
    """Data derived from a structure, by kind and name, until `forget`; not part of its description."""

    def __init__(self) -> None:
        super().__init__()
        self.frames: dict[str, Any] = {}
        """Frames of members by name: asked for so often that they have a place of their own."""
        _structures[id(self)] = self

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Kept)

    __hash__ = None

    def __reduce__(self) -> tuple[Any, ...]:
        # another process works all out again, but for what only a solution shows
        return (Kept, (), None, None, iter([item for item in self.items() if item[0][0] in FOUND]))

    def clear(self) -> None:
        """Forget all."""
        super().clear()
        self.frames.clear()

    def shared(self, kinds: Collection[str]) -> Kept:
        """Data of some kinds, and the frames, for a structure in which they are the same."""
        other = Kept()
        other.update({key: value for key, value in self.items() if key[0] in kinds})
        other.frames.update(self.frames)
        return other

    def once(self, kind: str, name: Hashable, compute: Callable[[], T]) -> T:
        """Data of a kind and name; computed when first needed."""
        found = self.get((kind, name))
        if found is None:
            self[kind, name] = found = compute()
        return cast(T, found)


_structures: WeakValueDictionary[int, Kept] = WeakValueDictionary()


def forget() -> None:
    """Clear all caches, so that a timed solution starts without cached objects."""
    for clear in _forgetting:
        clear()
    for kept in list(_structures.values()):
        kept.clear()
