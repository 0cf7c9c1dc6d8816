"""A folder of laws: one readable file a law, named by what it was made from.

The name holds the hash of the sub-model's input, so that a change of section, material, mesh or duration
gives another file.  A file appears whole or not at all; a folder may be copied, shared and kept under version
control.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

from crumple.analysis import input_hash
from crumple.characterisation.law import CORNER_METHOD
from crumple.characterisation.sub_model import SubModel
from crumple.hinge.measured.law_file import read_law, write_law
from crumple.hinge.measured.place_hash import CORNER
from crumple.hinge.measured.stored import StoredLaw
from crumple.portable import replacing

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
        return read_law(path.read_text(encoding="utf-8"), str(path)) if path.is_file() else None

    def keep(self, model: SubModel, law: StoredLaw) -> Path:
        """Write a law; the file appears whole or not at all."""
        self.folder.mkdir(parents=True, exist_ok=True)
        path = self.path(model)
        with replacing(path) as part:
            part.write_text(write_law(law), encoding="utf-8")
        return path
