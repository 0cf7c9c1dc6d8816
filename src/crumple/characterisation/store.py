"""A folder of laws: one readable file a law, named by what it was made from.

The name holds the hash of the sub-model's input, so that a change of section, material, mesh or duration
gives another file.  A file appears whole or not at all; a folder may be copied, shared and kept under version
control.
"""

from __future__ import annotations

import re
import shutil
import tempfile
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from crumple.analysis import input_hash
from crumple.characterisation.law import CORNER_METHOD
from crumple.characterisation.sub_model import SubModel
from crumple.errors import InputError, Problem
from crumple.hinge.measured.law_file import read_law, write_law
from crumple.hinge.measured.library import content_of
from crumple.hinge.measured.place_hash import CORNER
from crumple.hinge.measured.stored import StoredLaw
from crumple.portable import refusal_of, replacing

METHOD = 3
"""Number of the way in which sub-models are built and measured: laws of another method are computed again.
That of corners is in their law files too, as `CORNER_METHOD`."""


@dataclass(frozen=True)
class LawStore:
    """Laws in a folder.

    Attributes
    ----------
    folder
        Made when the first law is written.
    """

    folder: Path

    def path(self, model: SubModel) -> Path:
        """File of a sub-model's law."""
        words = re.sub(r"[^a-z0-9]+", "-", model.title.lower()).strip("-")
        method = CORNER_METHOD if CORNER in model.origin else METHOD
        return self.folder / f"{words[:80]}-{method}-{input_hash(model.analysis())[:16]}.law.yaml"

    def law(self, model: SubModel) -> StoredLaw | None:
        """Law of a sub-model, or None where it is not there.

        Raises
        ------
        InputError
            With file and line, if the file is no law file.
        """
        path = self.path(model)
        return read_law(content_of(path), str(path)) if path.is_file() else None

    def prepare(self, models: Iterable[SubModel]) -> None:
        """Make the folder and see that laws can be written there, before they are solved.

        Raises
        ------
        InputError
            If they cannot, or a folder has the name of a law's file.
        """
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
            with tempfile.TemporaryFile(dir=self.folder):
                pass
        except OSError as error:
            raise InputError(_not_written(self.folder, refusal_of(error))) from None
        for path in map(self.path, models):
            if path.is_dir():
                raise InputError(_not_written(path, "a folder has this name"))

    def keep(self, model: SubModel, law: StoredLaw) -> Path:
        """Write a law; the file appears whole or not at all.

        Raises
        ------
        InputError
            If it cannot be written; it is then in a folder for temporary files, if that has room.
        """
        path, text = self.path(model), write_law(law)
        try:
            _write(path, text)
        except OSError as error:
            kept = _kept_elsewhere(path.name, text)
            raise InputError(_not_written(path, refusal_of(error), *kept)) from None
        return path


def _kept_elsewhere(name: str, text: str) -> tuple[str, ...]:
    """Write a law to a folder for temporary files; what to do with it, nothing if that fails too."""
    spare = None
    try:
        spare = Path(tempfile.mkdtemp(prefix="crumple-laws-"))
        _write(spare / name, text)
    except OSError:
        if spare is not None:
            shutil.rmtree(spare, ignore_errors=True)
        return ()
    return (f"the law is in {spare / name}: move it to a store",)


def _write(path: Path, text: str) -> None:
    with replacing(path) as part:
        part.write_text(text, encoding="utf-8")


def _not_written(path: Path, reason: str, todo: str = "choose another folder with --store") -> Problem:
    return Problem(f"laws cannot be written to {path}: {reason}", todo=todo)
