"""Store of hinge laws that a structure uses: a folder or a file in the input, read with it.

A dataclass, since its keys are not keys of the input: there it is the name of the store.
"""

from __future__ import annotations

from dataclasses import dataclass
from dataclasses import field as dataclass_field
from pathlib import Path
from typing import Annotated, Any

from pydantic import BeforeValidator, Field, ValidationInfo

from crumple.errors import InputError
from crumple.hinge.measured.library import read_store
from crumple.registry.refusal import refuse


@dataclass(frozen=True)
class StoredLaws:
    """Laws of a store, read when the structure is.

    Attributes
    ----------
    name
        Folder or file, for people; two copies of a store give the same structure.
    texts
        Law files with a place.
    """

    name: Annotated[str, Field(exclude=True)] = dataclass_field(compare=False)
    texts: tuple[str, ...] = ()

    @classmethod
    def read(cls, path: Path) -> StoredLaws:
        """Laws of a folder or a file.

        Raises
        ------
        InputError
            If there is none, or one of its laws cannot be read.
        """
        return cls(name=str(path), texts=read_store(path))


def _read(given: Any, info: ValidationInfo) -> Any:
    if not isinstance(given, str):
        return given
    folder = (info.context or {}).get("directory")
    path = Path(folder or ".") / given
    if folder is not None and _leaves(path, Path(folder)):
        what, todo = "this store lies outside the folder of the input file", "copy it there, or use --laws"
        refuse(what, allowed="a folder or file in the folder of the input file, or below it", todo=todo)
    try:
        # may be empty: the laws that this input needs are what `crumple characterise` adds
        return StoredLaws(name=given, texts=read_store(path, filling=True))
    except InputError as error:
        refuse("the store of laws cannot be read", problems=error.problems[:10])


def _leaves(store: Path, folder: Path) -> bool:
    """Whether a store, or a law in it, is elsewhere; links are followed."""
    laws = [store, *(store.glob("*") if store.is_dir() else [])]
    return any(not law.resolve().is_relative_to(folder.resolve()) for law in laws)


LawsOrFolder = Annotated[StoredLaws, BeforeValidator(_read, json_schema_input_type=str)]
"""A folder or a file of laws."""
