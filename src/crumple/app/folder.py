"""Files of the opened folder: no path leads out of it, and nothing is overwritten that changed meanwhile."""

from __future__ import annotations

import hashlib
import shutil
from dataclasses import dataclass
from pathlib import Path

from crumple.errors import InputError, Problem
from crumple.portable import replacing

ENDINGS = (".yaml", ".yml")
LARGEST = 900_000
"""Largest file [byte]: it must fit into one message."""
MOST_FILES = 500
"""Files that are listed."""
LONGEST_NAME = 200


@dataclass(frozen=True)
class Opened:
    """A file as it was read.

    Attributes
    ----------
    name
        Relative to the folder.
    text
        With Unix line ends.
    seen
        SHA-256 of its bytes.
    draft
        Text that was not saved; None if there is none.
    """

    name: str
    text: str
    seen: str
    draft: str | None


class Folder:
    """One folder; names are relative to it, and may lead into folders below.

    Parameters
    ----------
    path
        Of the folder.
    """

    def __init__(self, path: Path) -> None:
        self.path = path.resolve()

    def files(self) -> list[str]:
        """Names of the input files in the folder, without those in folders below."""
        entries = sorted(one.name for one in self.path.iterdir() if one.suffix in ENDINGS)
        return [name for name in entries if not name.startswith(".") and self._is_inside(name)][:MOST_FILES]

    def place(self, name: object) -> Path:
        """Path of a name, with links resolved.

        Raises
        ------
        InputError
            If it is no name of an input file, or leads out of the folder.
        """
        if not isinstance(name, str) or not name or len(name) > LONGEST_NAME or not name.isprintable():
            raise _refusal("this is not a file name", "")
        if Path(name).suffix not in ENDINGS or Path(name).name.startswith("."):
            raise _refusal("this is not the name of an input file", name, "a name that ends with .yaml")
        try:
            found = (self.path / name).resolve()
        except (OSError, RuntimeError, ValueError):
            raise _refusal("this file cannot be reached", name) from None
        if not found.is_relative_to(self.path) or found == self.path:
            raise _refusal("this file is outside the opened folder", name, "a file in the opened folder")
        if not found.parent.is_dir():
            raise _refusal("there is no such folder", name)
        return found

    def open(self, name: object) -> Opened:
        """Content of a file, and its draft.

        Raises
        ------
        InputError
            If it cannot be read.
        """
        place = self.place(name)
        content = _bytes(place, str(name))
        return Opened(str(name), _text(content, str(name)), _hash(content), self._draft(place))

    def save(self, name: object, text: str, seen: str) -> str:
        """Write a file as a whole and remove its draft; gives the hash of what is there now.

        Parameters
        ----------
        name, text
            Of the file; line ends are kept as they are in the file that is there.
        seen
            Hash of the content that the text was made from, empty for a new file.

        Raises
        ------
        InputError
            If the file has changed meanwhile, or cannot be written.
        """
        place = self.place(name)
        before = _bytes(place, str(name)) if place.exists() else b""
        if (_hash(before) if place.exists() else "") != seen:
            what = "the file was changed by another program" if seen else "there is such a file already"
            raise _refusal(what, str(name), "", "save under another name, or open the file again")
        content = _encoded(text, before)
        try:
            with replacing(place) as temporary:
                temporary.write_bytes(content)
                if place.exists():
                    shutil.copymode(place, temporary)
        except OSError as error:
            raise _refusal(f"the file cannot be written: {error.strerror}", str(name)) from None
        self.discard(name)
        return _hash(content)

    def keep_draft(self, name: object, text: str) -> None:
        """Write a draft beside its file.

        Raises
        ------
        InputError
            If it cannot be written.
        """
        try:
            with replacing(_draft_of(self.place(name))) as temporary:
                temporary.write_bytes(text.encode())
        except OSError as error:
            raise _refusal(f"the draft cannot be written: {error.strerror}", str(name)) from None

    def discard(self, name: object) -> None:
        """Remove the draft of a file."""
        _draft_of(self.place(name)).unlink(missing_ok=True)

    def _draft(self, place: Path) -> str | None:
        draft = _draft_of(place)
        # a link could show a file of another folder
        if draft.is_symlink() or not draft.is_file():
            return None
        return _text(_bytes(draft, draft.name), draft.name)

    def _is_inside(self, name: str) -> bool:
        try:
            return self.place(name).is_file()
        except InputError:
            return False


def _draft_of(place: Path) -> Path:
    return place.with_name(f".{place.name}.draft")


def _bytes(place: Path, name: str) -> bytes:
    try:
        if not place.is_file():
            raise _refusal("there is no such file", name)
        with place.open("rb") as file:
            content = file.read(LARGEST + 1)
    except OSError as error:
        raise _refusal(f"the file cannot be read: {error.strerror}", name) from None
    if len(content) > LARGEST:
        raise _refusal("the file is too large for the app", name, f"at most {LARGEST / 1e6:g} MB")
    return content


def _text(content: bytes, name: str) -> str:
    try:
        return content.decode("utf-8-sig").replace("\r\n", "\n")
    except UnicodeDecodeError:
        raise _refusal("the file is not a text in UTF-8", name) from None


def _encoded(text: str, before: bytes) -> bytes:
    """A text with the line ends and the byte order mark of the file that it replaces."""
    if b"\r\n" in before:
        text = text.replace("\n", "\r\n")
    mark = b"\xef\xbb\xbf" if before.startswith(b"\xef\xbb\xbf") else b""
    return mark + text.encode()


def _hash(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()


def _refusal(what: str, name: str, allowed: str = "", todo: str = "") -> InputError:
    return InputError(Problem(what, allowed=allowed, todo=todo, file=name))
