"""Restart files: full state and record of a run, so that it continues bitwise identically."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from zipfile import is_zipfile

import numpy as np

from crumple.errors import InputError, Problem
from crumple.numeric.arrays import Floats
from crumple.portable import replacing
from crumple.result import StageSummary
from crumple.shell.answer.record import Record
from crumple.structure import Outputs, ShellSettings, Stage, Structure

FORMAT = 5
"""Version of the file; another one is refused."""


def fingerprint(
    structure: Structure, settings: ShellSettings, outputs: Outputs, stages: Sequence[Stage], every: float
) -> str:
    """SHA-256 of everything that determines the results of a run bit for bit, except the machine."""
    parts = [part.model_dump(mode="json") for part in (structure, settings, outputs, *stages)]
    text = json.dumps([parts, every], sort_keys=True, default=str)
    return hashlib.sha256(text.encode()).hexdigest()


@dataclass(frozen=True)
class Saved:
    """What a restart file holds.

    Attributes
    ----------
    record
        Record of the run so far.
    seconds
        Wall time of the run so far [s].
    ended
        Stages that have ended.
    state, watch
        Arrays of the stepper and of the conditions of the current stage.
    isa
        Instruction set that wrote it.
    """

    record: Record
    seconds: float
    ended: tuple[StageSummary, ...]
    state: dict[str, Floats]
    watch: dict[str, Floats]
    isa: str


def write_restart(path: Path, saved: Saved, mark: str) -> None:
    """Write a restart file, whole or not at all.

    Parameters
    ----------
    path
        File.
    saved
        Of the run, between two steps.
    mark
        Fingerprint of the run.
    """
    arrays = {
        f"{kind}/{name}": values
        for kind in ("state", "watch")
        for name, values in getattr(saved, kind).items()
    }
    arrays |= saved.record.to_arrays()
    head = {"format": FORMAT, "mark": mark, "isa": saved.isa, "seconds": saved.seconds, "sum": _sum(arrays)}
    text = json.dumps({**head, "ended": [asdict(stage) for stage in saved.ended]})
    with replacing(path) as temporary, temporary.open("wb") as file:
        np.savez(file, head=np.frombuffer(text.encode(), dtype=np.uint8), **arrays)


def _sum(arrays: Mapping[str, Floats]) -> str:
    """SHA-256 of the names, types, shapes and bytes of arrays."""
    digest = hashlib.sha256()
    for name in sorted(arrays):
        values = np.asarray(arrays[name])
        digest.update(f"{name} {values.dtype.str} {values.shape} ".encode())
        digest.update(values.tobytes())
    return digest.hexdigest()


def unreadable(path: Path, error: Exception) -> InputError:
    """Error for a file that is not a restart file, or is damaged."""
    allowed, todo = "the file that an interrupted run wrote", "give that file, or start from the beginning"
    if not path.exists():
        what = "there is no such restart file"
    elif path.is_dir():
        what = "this is a folder and not a restart file"
    elif isinstance(error, OSError):
        what = f"the restart file cannot be read: {error.strerror or 'the disk gives no answer'}"
    elif path.stat().st_size == 0:
        what = "the restart file is empty"
    elif is_zipfile(path):
        what = "the restart file is damaged, or another program's"
    else:
        what = "this is no restart file, or it was cut off"
    return InputError(Problem(what, path.name, allowed, todo, file=str(path)))


def read_restart(path: Path, mark: str, isa: str) -> Saved:
    """Read a restart file.

    Raises
    ------
    InputError
        If the file cannot be read, or belongs to another input or instruction set.
    """
    try:
        with path.open("rb") as opened, np.load(opened, allow_pickle=False) as file:
            arrays = {name: file[name] for name in file.files}
        head = json.loads(arrays.pop("head").tobytes())
        found = {key: head[key] for key in ("format", "mark", "isa", "seconds")}
        whole = found["format"] != FORMAT or head["sum"] == _sum(arrays)
        ended = tuple(StageSummary(**stage) for stage in head.get("ended", ()))
    except Exception as error:  # a damaged file can hold anything, and each reader raises its own error
        raise unreadable(path, error) from error
    if not whole or any(values.dtype.kind not in "fiub" for values in arrays.values()):
        raise unreadable(path, ValueError("checksum"))
    if found["format"] != FORMAT or found["mark"] != mark:
        what, todo = (
            "the restart file belongs to another input",
            "restart with the input file that was interrupted",
        )
        raise InputError(Problem(what, todo=todo, file=str(path)))
    if found["isa"] != isa:
        what, todo = "the restart file was written with another instruction set", "set CRUMPLE_ISA to it"
        raise InputError(Problem(what, found["isa"], isa, todo, file=str(path)))
    of = {
        kind: {name.removeprefix(f"{kind}/"): v for name, v in arrays.items() if name.startswith(f"{kind}/")}
        for kind in ("state", "watch")
    }
    record = Record.from_arrays(arrays)
    return Saved(record, float(found["seconds"]), ended, of["state"], of["watch"], isa)
