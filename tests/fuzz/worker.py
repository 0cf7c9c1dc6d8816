"""A process that runs cases: a crash, a hang or a lack of memory ends it and is reported.

    with Worker() as worker:
        outcome = worker.run(Case("input", "crumple: 1"))

The child is `python -m tests.fuzz.child`.  It may use `MEMORY` of address space and `SECONDS` a case; the
parent starts another one when it ended, and reports the case that ended it.
"""

from __future__ import annotations

import contextlib
import os
import pickle
import re
import signal
import subprocess
import sys
import tempfile
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, BinaryIO

ROOT = Path(__file__).parents[2]
MEMORY = 2_000_000_000
"""Address space of the worker [byte]; not limited on systems without `resource`."""
SECONDS = 20.0
"""Longest processor time of a case [s]; the process ends itself after it, whatever it is doing."""
WAITING = 5.0 * SECONDS
"""Longest wall time of a case [s]: nothing should wait, but other processes may need the cores."""
_SOURCE = re.compile(
    r'File "[^"]*?((?:src|site-packages)/crumple/[^"]*|tests/fuzz/[^"]*)", line \d+,? in (\S+)'
)


@dataclass(frozen=True)
class Case:
    """What is tried: its kind, one of `tests.fuzz.attacks.ATTACKS`, and what that takes."""

    kind: str
    payload: Any


@dataclass
class Outcome:
    """What came of a case.

    Attributes
    ----------
    accepted
        Whether it was taken; a refusal otherwise, or a finding.
    message
        Of a refusal.
    finding
        What must not happen, in a form that is the same for the same defect; empty for none.
    detail
        Traceback of a finding.
    sites
        Source places (file in the package, line) of a refusal that had not been reported before.
    """

    accepted: bool = False
    message: str = ""
    finding: str = ""
    detail: str = ""
    sites: set[tuple[str, int]] = field(default_factory=set)


class Worker:
    """Parent's side."""

    def __init__(self) -> None:
        self._child: subprocess.Popen[bytes] | None = None
        self._words = tempfile.TemporaryFile()  # noqa: SIM115  (closed by __exit__)

    def __enter__(self) -> Worker:
        return self

    def __exit__(self, *_: object) -> None:
        self._stop()
        self._words.close()

    def run(self, case: Case) -> Outcome:
        """Try a case."""
        child = self._child or self._start()
        assert child.stdin is not None
        assert child.stdout is not None
        with contextlib.suppress(BrokenPipeError):
            send(child.stdin, case)
        try:
            outcome = receive(child.stdout)
        except EOFError:
            return self._ended(case)
        assert isinstance(outcome, Outcome)
        return outcome

    def _start(self) -> subprocess.Popen[bytes]:
        alone = os.environ | dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"), "1")
        self._words.truncate(0)
        self._words.seek(0)
        command = [sys.executable, "-m", "tests.fuzz.child"]
        pipe = subprocess.PIPE
        self._child = subprocess.Popen(
            command, cwd=ROOT, env=alone, stdin=pipe, stdout=pipe, stderr=self._words
        )
        return self._child

    def _stop(self) -> int:
        child, self._child = self._child, None
        if child is None:
            return 0
        for pipe in (child.stdin, child.stdout):
            with contextlib.suppress(BrokenPipeError):
                if pipe is not None:
                    pipe.close()
        return child.wait()

    def _ended(self, case: Case) -> Outcome:
        code = self._stop()
        self._words.seek(0)
        words = self._words.read().decode(errors="replace")
        hangs = "Timeout (" in words or code == -getattr(signal, "SIGPROF", 0)
        kind = f"hang above {SECONDS:g} s" if hangs and code else f"crash with exit code {code}"
        # the most recent call is the first
        return Outcome(finding=f"{kind} of {case.kind} {place_in(words, -1)}".strip(), detail=words[-6000:])


def place_in(words: str, step: int) -> str:
    """The innermost function of the package in a traceback, listed from outside (1) or from inside (-1)."""
    found = _SOURCE.findall(words)[::step]
    own = [one for one in found if "/crumple/" in one[0]] or found
    return f"in {own[-1][0].split('crumple/')[-1]} {own[-1][1]}" if own else ""


def send(pipe: BinaryIO | Any, thing: object) -> None:
    content = pickle.dumps(thing)
    pipe.write(len(content).to_bytes(8, "little") + content)
    pipe.flush()


def receive(pipe: BinaryIO | Any) -> Any:
    length = pipe.read(8)
    if len(length) < 8:
        raise EOFError
    return pickle.loads(pipe.read(int.from_bytes(length, "little")))
