"""A mapping that cannot change: named parts of a frozen structure."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NoReturn, TypeVar

Value = TypeVar("Value")


class FrozenMapping(dict[str, Value]):
    """A `dict` that refuses every change; picklable and hashable by its content."""

    def _refuse(self, *_: Any, **__: Any) -> NoReturn:
        raise TypeError(
            "the parts of a structure are frozen: build a new one with model_copy or the constructor"
        )

    __setitem__ = __delitem__ = _refuse
    __ior__ = _refuse
    clear = pop = popitem = setdefault = update = _refuse

    def __hash__(self) -> int:  # type: ignore[override]
        return hash(frozenset(self.items()))

    def __reduce__(self) -> tuple[type[FrozenMapping[Value]], tuple[dict[str, Value]]]:
        return (type(self), (dict(self),))


def frozen(mapping: Mapping[str, Value]) -> FrozenMapping[Value]:
    """Copy of a mapping that cannot change."""
    return FrozenMapping(mapping)
