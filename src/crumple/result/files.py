"""Files that are either complete or absent: written under another name, then renamed."""

from __future__ import annotations

import os
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

PART = ".crumple-part-"
"""How names of files begin that are not whole yet; viewers that watch a folder do not open hidden files."""
SUMMARY = "summary.json"


@contextmanager
def replacing(path: Path) -> Iterator[Path]:
    """Give a temporary path in the same folder; move it to `path` when the block ends well, else delete it.

    Parameters
    ----------
    path
        Final place.  Its folder is made when absent; a file already there stays until the new one is whole.

    Yields
    ------
    Path
        Where to write.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    handle, name = tempfile.mkstemp(prefix=f"{PART}{path.name}.", dir=path.parent)
    os.close(handle)
    temporary = Path(name)
    try:
        yield temporary
        # the content must be on the disk before the name is, or a power cut leaves an empty file
        with temporary.open("rb+") as file:
            os.fsync(file.fileno())
        temporary.chmod(0o666 & ~_umask())
        temporary.replace(path)
    finally:
        temporary.unlink(missing_ok=True)


@contextmanager
def published(folder: Path, last: str = SUMMARY) -> Iterator[Path]:
    """Give an empty folder; when the block ends well, move every file in it to `folder`.

    Nothing in `folder` changes until all files are whole on its disk.  Then the file named `last` is taken
    away, the others are replaced, and `last` comes at the end: where it stands, all files are of one run.

    Parameters
    ----------
    folder
        Made when absent.
    last
        Name of the file that says that the others are there.

    Yields
    ------
    Path
        Where to write; files in folders keep them.
    """
    folder.mkdir(parents=True, exist_ok=True)
    staging = Path(tempfile.mkdtemp(prefix=PART, dir=folder))
    try:
        yield staging
        files = [path for path in staging.rglob("*") if path.is_file()]
        if any(path.name == last for path in files):
            (folder / last).unlink(missing_ok=True)
        for path in sorted(files, key=lambda path: path.name == last):
            place = folder / path.relative_to(staging)
            place.parent.mkdir(exist_ok=True)
            path.replace(place)
    finally:
        shutil.rmtree(staging, ignore_errors=True)


def remove_left_over(folder: Path) -> None:
    """Remove what an interrupted run left unfinished in a folder; no other run may be writing into it."""
    for path in folder.glob(f"{PART}*"):
        if path.is_dir() and not path.is_symlink():
            shutil.rmtree(path, ignore_errors=True)
        else:
            path.unlink(missing_ok=True)


def write_text(path: Path, text: str) -> None:
    """Write UTF-8 text with Unix line ends, whole or not at all."""
    with replacing(path) as temporary:
        temporary.write_text(text, encoding="utf-8", newline="\n")


def _umask() -> int:
    """Permissions mask of the process; the operating system only tells it while setting it."""
    mask = os.umask(0o022)
    os.umask(mask)
    return mask
