"""Files of a run appear together: written to a folder beside their places, moved when all are whole."""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from crumple.portable import PART, replace

SUMMARY = "summary.json"
SOMETIMES = ("bands.csv",)
"""Files that only some runs have: those of an earlier run are taken away with its summary."""


@contextmanager
def published(folder: Path, last: str = SUMMARY) -> Iterator[Path]:
    """Give an empty folder; when the block ends without an error, move every file in it to `folder`.

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
            for name in SOMETIMES:
                (folder / name).unlink(missing_ok=True)
        for path in sorted(files, key=lambda path: path.name == last):
            place = folder / path.relative_to(staging)
            place.parent.mkdir(exist_ok=True)
            replace(path, place)
    finally:
        shutil.rmtree(staging, ignore_errors=True)


def remove_left_over(folder: Path) -> None:
    """Remove what an interrupted run left unfinished in a folder; no other run may be writing into it."""
    for path in folder.glob(f"{PART}*"):
        if path.is_dir() and not path.is_symlink():
            shutil.rmtree(path, ignore_errors=True)
        else:
            path.unlink(missing_ok=True)
