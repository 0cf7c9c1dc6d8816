"""What differs between operating systems, in one place: cores, signals, files that replace others, consoles.

No other module asks which system it runs on or calls what only some of them have; `ruff` refuses it.
"""

from __future__ import annotations

import codecs
import errno
import os
import shlex
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from types import FrameType

WINDOWS: bool = sys.platform == "win32"
SYSTEM: str = sys.platform
"""Name of the operating system, for reports of defects."""
PART = ".crumple-part-"
"""How names of files begin that are not whole yet; viewers that watch a folder do not open hidden files."""
PATIENCE = 1.0
"""How long Windows may refuse to replace a file [s]; virus scanners hold a new one for a moment."""
READABLE = {
    "−": "-",
    "–": "-",
    "—": "-",
    "±": "+-",
    "×": "x",
    "·": "*",
    "°": " deg",
    "µ": "u",
    "²": "^2",
    "³": "^3",
}
"""What stands for characters that a console lacks; "?" for others."""


def available_cores() -> int:
    """Cores that this process may use: fewer than the machine has where it is bound to some of them."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


_stopped_by: list[int] = []


def exit_code_of_stop() -> int:
    """Exit code of a command that was asked to stop: 143 if SIGTERM did, else 130 as after Ctrl-C."""
    return 143 if _stopped_by[-1:] == [signal.SIGTERM] else 130


@contextmanager
def stop_on_interrupt() -> Iterator[Callable[[], bool]]:
    """Give a function that returns whether Ctrl-C or SIGTERM was received; a second one ends the program."""
    pressed = threading.Event()
    _stopped_by.clear()
    # the last is Ctrl-Break, which Windows alone has
    numbers = [getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGBREAK") if hasattr(signal, name)]
    previous = {number: signal.getsignal(number) for number in numbers}

    def restore() -> None:
        for number, handler in previous.items():
            signal.signal(number, handler)

    def note(number: int, frame: FrameType | None) -> None:
        pressed.set()
        _stopped_by.append(number)
        restore()

    for number in previous:
        signal.signal(number, note)
    try:
        yield pressed.is_set
    finally:
        restore()


@contextmanager
def interrupt_on_termination() -> Iterator[None]:
    """Raise `KeyboardInterrupt` in the main thread at SIGTERM; a second one ends the program."""
    previous = signal.getsignal(signal.SIGTERM)
    _stopped_by.clear()

    def interrupt(number: int, frame: FrameType | None) -> None:
        signal.signal(signal.SIGTERM, previous)
        _stopped_by.append(number)
        raise KeyboardInterrupt

    signal.signal(signal.SIGTERM, interrupt)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, previous)


def command_line(*words: object) -> str:
    """A command to be copied into a shell: words with blanks are quoted."""
    texts = [str(word) for word in words]
    return subprocess.list2cmdline(texts) if WINDOWS else shlex.join(texts)


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
        Where to write; a name that begins with `PART`.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    temporary = path.with_name(f"{PART}{path.name}.{os.urandom(4).hex()}")
    # exclusively, and with the permissions that any new file gets
    temporary.open("xb").close()
    try:
        yield temporary
        # the content must be on the disk before the name is, or a power cut leaves an empty file
        with temporary.open("rb+") as file:
            os.fsync(file.fileno())
        replace(temporary, path)
    finally:
        temporary.unlink(missing_ok=True)


def replace(source: Path, target: Path) -> None:
    """Move a file over another; Windows refuses it as long as some program has one of them open."""
    start = time.monotonic()
    while True:
        try:
            source.replace(target)
            return
        except PermissionError:
            if not WINDOWS or time.monotonic() - start > PATIENCE:
                raise
            time.sleep(0.02)


def write_text(path: Path, text: str) -> None:
    """Write UTF-8 text with Unix line ends, whole or not at all."""
    with replacing(path) as temporary:
        temporary.write_text(text, encoding="utf-8", newline="\n")


def reader_left(error: OSError) -> bool:
    """Whether the reader of a pipe went away, as `| head` does; Windows calls it an invalid argument."""
    return isinstance(error, BrokenPipeError) or (
        WINDOWS and error.errno == errno.EINVAL and error.filename is None
    )


def refusal_of(error: OSError) -> str:
    """Why the system refused something, for people; libraries give their own text in place of its reason."""
    if isinstance(error, FileExistsError | NotADirectoryError):
        return "a file has this name, or the name of a folder above it"
    return os.strerror(error.errno) if error.errno else "the operating system refused"


def prepare_consoles() -> None:
    """Let the standard streams take any character: what an encoding lacks is written in those that it has."""
    codecs.register_error("crumple", _readable)
    for stream in (sys.stdout, sys.stderr):
        # a test or a host may have put something else in place
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="crumple")


def console_takes_all() -> bool:
    """Whether the standard output has an encoding of all characters."""
    return (getattr(sys.stdout, "encoding", None) or "").lower().startswith("utf")


def _readable(error: UnicodeError) -> tuple[str, int]:
    if not isinstance(error, UnicodeEncodeError):
        raise error
    lacking = error.object[error.start : error.end]
    return "".join(READABLE.get(character, "?") for character in lacking), error.end
