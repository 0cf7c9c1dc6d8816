"""A model's marks: numbers by which a checkpoint knows the model that it was made with."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from dataclasses import fields, is_dataclass
from enum import Enum
from typing import Any

import numpy as np

from crumple._core.shell.model import ShellModel
from crumple.numeric.arrays import Floats

OF_STRUCTURE = (
    "position",
    "elements",
    "thickness",
    "materials",
    "sheets",
    "sheet",
    "mass",
    "inertia",
    "spot_welds",
)
"""Fields that all stages of a run have in common."""
PARTS, BITS = 4, 48
"""Numbers of one mark, and bits of each: a number in double precision holds 53 exactly."""


def marks(model: ShellModel) -> Floats:
    """Marks of the structure, which all stages of a run share, and of the whole model, (2, 4)."""
    structure, whole = hashlib.sha256(), hashlib.sha256()
    for one in fields(model):
        value = getattr(model, one.name)
        _add(whole, value)
        if one.name in OF_STRUCTURE:
            _add(structure, value)
    return np.array([_numbers(structure.digest()), _numbers(whole.digest())])


def _numbers(digest: bytes) -> list[float]:
    size = BITS // 8
    return [float(int.from_bytes(digest[i * size : (i + 1) * size])) for i in range(PARTS)]


def _add(digest: Any, value: Any) -> None:
    """Add a value with its kind and length, so that no two different values are the same bytes."""
    if is_dataclass(value):
        for one in fields(value):
            _add(digest, getattr(value, one.name))
    elif isinstance(value, np.ndarray) and value.dtype != object:
        _add(digest, value.shape)
        digest.update(value.dtype.str.encode() + np.ascontiguousarray(value).tobytes())
    elif isinstance(value, Sequence) and not isinstance(value, str):
        digest.update(f"[{len(value)}]".encode())
        for part in value:
            _add(digest, part)
    elif isinstance(value, Enum):
        digest.update(f"{value.name};".encode())
    elif isinstance(value, np.generic):
        _add(digest, value.item())
    elif value is None or isinstance(value, str | bool | int | float):
        digest.update(f"{value!r};".encode())
    else:
        raise TypeError(f"a model cannot contain {type(value).__name__}")
