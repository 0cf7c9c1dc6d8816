"""A process that runs cases: a crash, a hang or a lack of memory ends it and is reported.

    with Worker() as worker:
        outcome = worker.run(Case("input", "crumple: 1"))

The child runs `tests.fuzz.child.serve`.  It may use `MEMORY` of address space and `SECONDS` a case; the
parent starts another one when it ended, and reports the case that ended it.  Where the system can, children
are forked from a process that has imported everything once, so a new one costs hardly any time.
"""

from __future__ import annotations

import contextlib
import multiprocessing
import os
import re
import signal
import tempfile
from dataclasses import dataclass, field
from functools import cache
from multiprocessing.connection import Connection
from multiprocessing.process import BaseProcess
from typing import Any

from tests.fuzz.sites import REACHED

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
        Refusals of the code that it reached and that had not been reported before.
    """

    accepted: bool = False
    message: str = ""
    finding: str = ""
    detail: str = ""
    sites: set[str] = field(default_factory=set)


@cache
def _starting() -> Any:
    """How children are started."""
    able = "forkserver" in multiprocessing.get_all_start_methods()
    started = multiprocessing.get_context("forkserver" if able else "spawn")
    if able:
        started.set_forkserver_preload(["tests.fuzz.child"])
    return started


class Worker:
    """Parent's side."""

    def __init__(self) -> None:
        self._child: BaseProcess | None = None
        self._pipe: Connection | None = None
        self._words = tempfile.NamedTemporaryFile()  # noqa: SIM115  (closed by __exit__)

    def __enter__(self) -> Worker:
        return self

    def __exit__(self, *_: object) -> None:
        self._stop()
        self._words.close()

    def run(self, case: Case) -> Outcome:
        """Try a case."""
        pipe = self._pipe or self._start()
        with contextlib.suppress(BrokenPipeError, ConnectionResetError):
            pipe.send(case)
        try:
            outcome = pipe.recv()
        except (EOFError, ConnectionResetError):
            return self._ended(case)
        assert isinstance(outcome, Outcome)
        REACHED.update(outcome.sites)
        return outcome

    def _start(self) -> Connection:
        from tests.fuzz.child import serve

        self._words.truncate(0)
        self._words.seek(0)
        names = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS")
        before = {name: os.environ.get(name) for name in names}
        # the server and its children inherit them
        os.environ.update(dict.fromkeys(names, "1"))
        try:
            self._pipe, theirs = _starting().Pipe()
            self._child = _starting().Process(target=serve, args=(theirs, self._words.name), daemon=True)
            self._child.start()
        finally:
            for name, value in before.items():
                if value is None:
                    del os.environ[name]
                else:
                    os.environ[name] = value
        theirs.close()
        assert self._pipe is not None
        return self._pipe

    def _stop(self) -> int:
        child, self._child = self._child, None
        pipe, self._pipe = self._pipe, None
        if child is None or pipe is None:
            return 0
        pipe.close()
        child.join()
        return child.exitcode or 0

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
