"""Restart files: the full state of a run and what it had noted, so that it goes on with the same bits."""

from __future__ import annotations

import hashlib
import json
from pathlib import Path
from zipfile import BadZipFile

import numpy as np

from crumple._core.shell import ShellState
from crumple.errors import InputError, Problem
from crumple.result.files import replacing
from crumple.shell.record import Record
from crumple.structure import Outputs, ShellSettings, Structure

FORMAT = 1
"""Version of the file; another one is refused."""


def fingerprint(
    structure: Structure, settings: ShellSettings, outputs: Outputs, duration: float, every: float
) -> str:
    """SHA-256 of everything that the bits of a run depend on, but for the machine."""
    parts = [part.model_dump(mode="json") for part in (structure, settings, outputs)]
    text = json.dumps([parts, duration, every], sort_keys=True, default=str)
    return hashlib.sha256(text.encode()).hexdigest()


def write_restart(path: Path, state: ShellState, record: Record, mark: str, seconds: float) -> None:
    """Write a restart file, whole or not at all.

    Parameters
    ----------
    path
        File.
    state, record
        Of the run, between two steps.
    mark
        Fingerprint of the run.
    seconds
        Wall time spent so far [s].
    """
    arrays = {f"state/{name}": values for name, values in state.checkpoint().items()} | record.to_arrays()
    text = json.dumps({"format": FORMAT, "mark": mark, "isa": state.isa, "seconds": seconds})
    with replacing(path) as temporary, temporary.open("wb") as file:
        np.savez(file, allow_pickle=False, head=np.frombuffer(text.encode(), dtype=np.uint8), **arrays)


def read_restart(path: Path, state: ShellState, mark: str) -> tuple[Record, float]:
    """Put a state back where a restart file left it.

    Returns
    -------
    record, seconds
        What the run had noted, and the wall time it had spent [s].

    Raises
    ------
    InputError
        If the file cannot be read, or belongs to another input or instruction set.
    """
    try:
        with path.open("rb") as opened, np.load(opened, allow_pickle=False) as file:
            arrays = {name: file[name] for name in file.files}
        head = json.loads(arrays["head"].tobytes())
        found = {key: head[key] for key in ("format", "mark", "isa", "seconds")}
    except (OSError, KeyError, ValueError, EOFError, BadZipFile) as error:
        what, todo = "the restart file cannot be read", "give the file that an interrupted run wrote"
        raise InputError(
            Problem(what, f"{type(error).__name__}: {str(error)[:200]}", "", todo, file=str(path))
        ) from error
    if found["format"] != FORMAT or found["mark"] != mark:
        what, todo = (
            "the restart file belongs to another input",
            "restart with the input file that was interrupted",
        )
        raise InputError(Problem(what, todo=todo, file=str(path)))
    if found["isa"] != state.isa:
        what, todo = "the restart file was written with another instruction set", "set CRUMPLE_ISA to it"
        raise InputError(Problem(what, found["isa"], state.isa, todo, file=str(path)))
    state.restore(
        {name[len("state/") :]: values for name, values in arrays.items() if name.startswith("state/")}
    )
    return Record.from_arrays(arrays), float(found["seconds"])
