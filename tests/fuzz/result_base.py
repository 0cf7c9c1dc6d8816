"""The result file of a small run, and changes of it."""

from __future__ import annotations

import tempfile
from collections.abc import Sequence
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from crumple.analysis import loads, solve
from crumple.result.store import FILE_NAME, write

BASE = Path(__file__).parent / "bases" / "shell.yaml"


@cache
def base() -> bytes:
    """Content of the file."""
    with tempfile.TemporaryDirectory() as folder:
        write(solve(loads(BASE.read_text(encoding="utf-8"))), folder)
        return (Path(folder) / FILE_NAME).read_bytes()


def changed(content: bytes, edits: Sequence[tuple[int, Any]]) -> bytes:
    """Bytes replaced, or entries dropped or given other values."""
    if edits and isinstance(edits[0][1], str):
        return _with_entries(content, edits)
    buffer = bytearray(content)
    for place, value in edits:
        buffer[place % len(buffer)] = value
    return bytes(buffer)


def _with_entries(content: bytes, edits: Sequence[tuple[int, str]]) -> bytes:
    import h5py

    path = Path("edited.vtkhdf")
    path.write_bytes(content)
    with h5py.File(path, "r+") as file:
        for number, what in edits:
            names: list[str] = []
            file.visit(names.append)
            # the last group is the project's own
            names = [name for name in names if name.startswith("crumple")] or names
            if not names:
                break
            name = names[number % len(names)]
            if what == "attribute":
                owner = file[name].attrs or file["crumple"].attrs if "crumple" in file else file.attrs
                keys = list(owner)
                if keys:
                    owner[keys[number // 7 % len(keys)]] = [99, "x", b"\xff", [1.5, 2.5]][number % 4]
            elif what != "drop" and isinstance(file[name], h5py.Dataset):
                values = file[name][()]
                del file[name]
                file[name] = values[: len(values) // 2] if what == "short" and np.ndim(values) else "x"
            else:
                del file[name]
    return path.read_bytes()
