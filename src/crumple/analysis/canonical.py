"""Canonical form of an analysis, for hashing, storing and comparing inputs."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from typing import Any

from crumple.analysis.analysis import Analysis

DIGITS = 12
"""Significant digits by which inputs differ: 50 mm and 1.968503937007874 in are the same length."""


def canonical(analysis: Analysis) -> dict[str, Any]:
    """Plain data of an analysis in SI, independent of how it was written.

    Parameters
    ----------
    analysis
        From a file or from Python.

    Returns
    -------
    dict
        Keys sorted, defaults included, numbers to 12 significant digits; empty entries are left out.
    """
    plain = _plain(analysis.model_dump(mode="json"))
    assert isinstance(plain, dict)
    return plain


def input_hash(analysis: Analysis) -> str:
    """SHA-256 of the canonical form, 64 hexadecimal digits."""
    return hash_of(canonical(analysis))


def hash_of(plain: dict[str, Any]) -> str:
    """SHA-256 of what `canonical` gave, 64 hexadecimal digits."""
    text = json.dumps(plain, sort_keys=True, separators=(",", ":"), allow_nan=False, ensure_ascii=True)
    return hashlib.sha256(text.encode()).hexdigest()


def _plain(value: Any) -> Any:
    if isinstance(value, Mapping):
        pairs = ((key, _plain(value[key])) for key in sorted(value))
        return {key: plain for key, plain in pairs if plain is not None and plain not in ({}, [])}
    if isinstance(value, list | tuple):
        return [_plain(item) for item in value]
    if isinstance(value, float | int) and not isinstance(value, bool):
        # -0.0 and 0 are the same input
        return float(f"{float(value):.{DIGITS}g}") + 0.0
    return value
