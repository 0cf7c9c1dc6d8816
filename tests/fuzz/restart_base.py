"""A small shell run that was stopped, and changes of its restart file."""

from __future__ import annotations

import io
import json
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from tests.fuzz.mutation import edited

from crumple.analysis import Analysis, loads, solve
from crumple.shell import LongRun, restart

BASE = Path(__file__).parent / "bases" / "shell.yaml"


@cache
def base() -> tuple[Analysis, bytes]:
    """The run, and the restart file that it left when it was cancelled."""
    analysis = loads(BASE.read_text(encoding="utf-8"))
    asked, path = iter(range(10**9)), Path("base.npz")
    solve(analysis, "shell", cancel=lambda: next(asked) > 3, long_run=LongRun(restart_to=path))
    return analysis, path.read_bytes()


def changed(content: bytes, edits: Mapping[str, Any]) -> bytes:
    """Bytes replaced, the end cut off, or arrays changed (if wanted with a checksum that fits)."""
    if edits["arrays"]:
        content = _with_arrays(content, edits["arrays"], edits["fitting"])
    buffer = bytearray(content[: len(content) - edits["cut"]])
    for place, value in edits["bytes"]:
        if buffer:
            buffer[place % len(buffer)] = value
    return bytes(buffer)


def _with_arrays(content: bytes, edits: Any, fitting: bool) -> bytes:
    with np.load(io.BytesIO(content)) as file:
        arrays: dict[str, Any] = {name: file[name] for name in file.files}
    head = json.loads(arrays.pop("head").tobytes())
    arrays = {
        name: np.asarray(values)
        for name, values in edited(arrays, edits).items()
        if isinstance(name, str) and not isinstance(values, dict)
    }
    arrays = {name: values for name, values in arrays.items() if values.dtype != object}
    checksum = getattr(restart, "_sum", None)
    if fitting and checksum is not None:
        head["sum"] = checksum(arrays)
    buffer = io.BytesIO()
    np.savez(buffer, head=np.frombuffer(json.dumps(head).encode(), np.uint8), **arrays)
    return buffer.getvalue()
