"""Files that are either complete or absent: written under another name, then renamed."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path


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
        Where to write.  The name starts with a dot, so that viewers which watch the folder do not open it.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    handle, name = tempfile.mkstemp(prefix=f".{path.name}.", dir=path.parent)
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


def write_text(path: Path, text: str) -> None:
    """Write UTF-8 text with Unix line ends, whole or not at all."""
    with replacing(path) as temporary:
        temporary.write_text(text, encoding="utf-8", newline="\n")


def _umask() -> int:
    """Permissions mask of the process; the operating system only tells it while setting it."""
    mask = os.umask(0o022)
    os.umask(mask)
    return mask
