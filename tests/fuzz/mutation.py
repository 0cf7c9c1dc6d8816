"""Changes of nested data (mappings, lists, arrays): each is a place, what is done there, and a value."""

from __future__ import annotations

import copy
import re
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

_QUANTITY = re.compile(r"([-+]?[0-9.]+(?:e[-+]?[0-9]+)?)( ?)(.*)")
Edit = tuple[int, str, Any]
"""Number of the place (modulo their count), what is done, and the value for it."""


class _Tuple(list[Any]):
    """What was a tuple, and will be one again."""


def places(data: Any) -> Iterator[tuple[Any, Any]]:
    """Every part of the data as its holder and its key or index there."""
    if isinstance(data, dict):
        for key in data:
            yield data, key
            yield from places(data[key])
    elif isinstance(data, list):
        for i, part in enumerate(data):
            yield data, i
            yield from places(part)


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


def edited(data: Any, edits: Sequence[Edit], pool: Mapping[str, Sequence[Any]] | None = None) -> Any:
    """Copy of the data after the edits; `pool` has values by key for "splice" and "add"."""
    data = [listed(data)]
    for number, what, value in edits:
        found = list(places(data[0]))
        if found:
            holder, key = found[number % len(found)]
            _apply(holder, key, what, value, pool or {})
    return _restored(data[0])


def _apply(holder: Any, key: Any, what: str, value: Any, pool: Mapping[str, Sequence[Any]]) -> None:
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
        holder[key] = listed(_other(pool.get(key, ()) if isinstance(key, str) else (), value, now))
    elif what == "add" and isinstance(now, dict) and pool:
        name = sorted(pool)[value % len(pool)]
        now[name] = listed(_other(pool[name], value // len(pool), None))
    elif what == "scale":
        holder[key] = scaled(now, value)
    elif what == "array" and isinstance(now, np.ndarray):
        holder[key] = reshaped(now, value)
    elif what == "set":
        holder[key] = value


def _other(values: Sequence[Any], number: int, now: Any) -> Any:
    return values[number % len(values)] if values else now


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
