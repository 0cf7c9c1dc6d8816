"""Changes of nested data (mappings, lists, arrays): each is a place, what is done there, and a value."""

from __future__ import annotations

import copy
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

_QUANTITY = re.compile(r"([-+]?[0-9.]+(?:e[-+]?[0-9]+)?)( ?)(.*)")
Edit = tuple[int, str, Any]
"""Number of the place, what is done, and the value for it."""


class _Tuple(list[Any]):
    """What was a tuple, and will be one again."""


def place(data: Any, number: int) -> tuple[Any, Any] | None:
    """A part of the data as its holder and its key or index there; None where there is none.

    The number chooses a way down from the top, so that parts of small groups are met as often as those of
    large ones; one in five ways ends on each level.
    """
    found = None
    while isinstance(data, dict | list) and data:
        keys = list(data) if isinstance(data, dict) else range(len(data))
        number, at = divmod(number, len(keys))
        number, stop = divmod(number, 5)
        found = data, keys[at]
        data = data[keys[at]]
        if stop == 4:
            break
    return found


def listed(data: Any) -> Any:
    """A copy with lists in place of tuples, so that all of it can be changed."""
    if isinstance(data, Mapping):
        return {key: listed(part) for key, part in data.items()}
    if isinstance(data, list | tuple):
        kind = _Tuple if isinstance(data, tuple | _Tuple) else list
        return kind(listed(part) for part in data)
    return copy.deepcopy(data)


def _restored(data: Any) -> Any:
    if isinstance(data, dict):
        return {key: _restored(part) for key, part in data.items()}
    if isinstance(data, list):
        return (tuple if isinstance(data, _Tuple) else list)(_restored(part) for part in data)
    return data


@dataclass(frozen=True)
class Pool:
    """What fits somewhere: values by key, and the keys that stand together in a group."""

    values: Mapping[str, Sequence[Any]] = field(default_factory=dict)
    groups: Sequence[frozenset[str]] = ()

    def value(self, key: Any, number: int, now: Any = None) -> Any:
        """One of the values of a key, as new lists and mappings; `now` if there is none."""
        values = self.values.get(key, ()) if isinstance(key, str) else ()
        return listed(values[number % len(values)]) if values else now

    def missing(self, group: Mapping[Any, Any], number: int) -> str:
        """A key that the group could have too: of the kind of group that it is most like."""
        alike = max(self.groups, key=lambda known: len(known & set(group)) - 0.01 * len(known))
        names = sorted(alike - set(group)) or sorted(self.values)
        return names[number % len(names)]


NOTHING = Pool()


def edited(data: Any, edits: Sequence[Edit], pool: Pool = NOTHING) -> Any:
    """Copy of the data after the edits; the pool serves "splice" and "add"."""
    data = listed(data)
    for number, what, value in edits:
        found = place(data, number)
        if found is not None:
            _apply(*found, what, value, pool)
    return _restored(data)


def _apply(holder: Any, key: Any, what: str, value: Any, pool: Pool) -> None:
    now = holder[key]
    if what == "drop":
        del holder[key]
    elif what == "rename" and isinstance(holder, dict):
        items = [(value if one == key else one, part) for one, part in holder.items()]
        holder.clear()
        holder.update(items)
    elif what == "repeat" and isinstance(holder, list):
        holder[key:key] = [listed(now) for _ in range(value)]
    elif what == "repeat" and isinstance(holder, dict):
        holder.update({f"{key}{i}": listed(now) for i in range(value)})
    elif what == "nest":
        for i in range(value):
            now = {key: now} if i % 2 and isinstance(key, str) else [now]
        holder[key] = now
    elif what == "splice":
        holder[key] = pool.value(key, value, now)
    elif what == "add" and isinstance(now, dict) and pool.groups:
        name = pool.missing(now, value)
        now[name] = pool.value(name, value // 7)
    elif what == "scale":
        holder[key] = (
            type(now)(scaled(part, value) for part in now) if isinstance(now, list) else scaled(now, value)
        )
    elif what == "copy":
        others = list(holder.values()) if isinstance(holder, dict) else holder
        holder[key] = listed(others[value % len(others)])
    elif what == "array" and isinstance(now, np.ndarray):
        holder[key] = reshaped(now, value)
    elif what == "set":
        holder[key] = value


def scaled(now: Any, factor: float) -> Any:
    """A number or quantity times a factor; anything else as it is."""
    if isinstance(now, bool):
        return not now
    if isinstance(now, np.ndarray) and now.dtype.kind == "f":
        return now * factor
    if isinstance(now, int) and abs(now * factor) < 1e15:
        return int(now * factor)
    if isinstance(now, float):
        return now * factor
    match = _QUANTITY.fullmatch(now) if isinstance(now, str) else None
    if match is None or not re.fullmatch(r"[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?", match[1]):
        return now
    return f"{float(match[1]) * factor!r}{match[2]}{match[3]}"


def reshaped(array: Any, number: int) -> Any:
    """An array cut, grown, turned, of another type, or with a number in it that cannot be."""
    flat = array.ravel()
    at = (number // 16) % max(flat.size, 1)
    return [
        lambda: array[:0],
        lambda: array[:-1],
        lambda: flat[: flat.size // 2],
        lambda: np.concatenate([flat, flat]),
        lambda: array.T,
        lambda: array[None],
        lambda: flat,
        lambda: array.astype(np.float32),
        lambda: array.astype(complex),
        lambda: array.astype(object),
        lambda: _with(array, at, -1),
        lambda: _with(array, at, 2**31 - 1),
        lambda: _with(array, at, np.nan),
        lambda: _with(array, at, np.inf),
        lambda: _with(array, at, 1e300),
        lambda: array[..., ::-1],
    ][number % 16]()


def _with(array: Any, at: int, value: float) -> Any:
    whole = array.copy().ravel()
    if whole.size:
        whole = whole.astype(float) if whole.dtype.kind not in "iu" else whole
        finite = value if np.isfinite(value) and abs(value) < 2**40 else 2**31 - 1
        with np.errstate(all="ignore"):
            whole[at] = np.array(value if whole.dtype.kind == "f" else finite).astype(whole.dtype)
    return whole.reshape(array.shape)
