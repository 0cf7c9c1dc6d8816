"""The law type ``file``: any law, from the text of a law file."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any, ClassVar

from crumple.errors import InputError, Problem
from crumple.hinge.measured.embedding import FileName, with_law_read
from crumple.hinge.measured.law_file import read_law
from crumple.hinge.measured.stored import StoredLaw
from crumple.material import Material
from crumple.registry.keys import Key
from crumple.registry.quantity import Longest
from crumple.section import Axis, Section
from crumple.text.plain_yaml import LARGEST_TEXT

FILE_KEYS = (
    Key("file", FileName | None, None, "Law file (YAML), in the folder of the input file or below."),
)


class FileLaw:
    """Law of a law file, as `crumple hinge --save` writes it."""

    file_keys: ClassVar[tuple[Key, ...]] = FILE_KEYS

    @classmethod
    def of(
        cls,
        section: Section,
        material: Material,
        axis: Axis = "y",
        *,
        text: Annotated[str, Longest(LARGEST_TEXT)],
    ) -> StoredLaw:
        """Law of a file's text.

        Parameters
        ----------
        section, material, axis
            Not used: the curve is already for a section.
        text
            Content of a law file instead of its name.

        Raises
        ------
        InputError
            With lines, if the text is not a law file; if it is a law of axial crushing.
        """
        law = read_law(text)
        if law.slip:
            what, todo = "this law acts along the member", "use it from a store of laws (--laws FOLDER)"
            raise InputError(Problem(what, law.title, "a law of bending or torsion", todo, "file"))
        return law

    @staticmethod
    def embedded(given: dict[str, Any], folder: Path | None) -> dict[str, Any]:
        """Keys of a description with the content of the law file in place of its name, checked.

        Parameters
        ----------
        given
            Keys of the law, `FILE_KEYS` among them.
        folder
            Folder of the input file, in which the file must lie; None: built in Python, any file.
        """
        return with_law_read(given, folder)
