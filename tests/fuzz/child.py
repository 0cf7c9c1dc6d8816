"""The worker's own process: limits itself, tries what it is sent, and answers what came of it."""

from __future__ import annotations

import contextlib
import faulthandler
import os
import signal
import sys
import tempfile
import traceback
import warnings
from collections.abc import Callable
from typing import Any

from tests.fuzz.attacks import ATTACKS
from tests.fuzz.sites import Watch
from tests.fuzz.worker import MEMORY, SECONDS, WAITING, Outcome, place_in, receive, send


def attempt(attack: Callable[[Any], str], payload: Any) -> Outcome:
    """Outcome of an attack, which returns "" for what it accepted or the message of a refusal."""
    try:
        message = attack(payload)
    except BaseException as error:
        if isinstance(error, KeyboardInterrupt):
            raise
        detail = traceback.format_exc()
        return Outcome(finding=f"{type(error).__name__} {place_in(detail, 1)}".strip(), detail=detail[-6000:])
    return Outcome(accepted=not message, message=message)


def limit(seconds: float, waiting: float) -> None:
    """End this process with a traceback after so much processor time from now or wall time [s]; 0: never."""
    faulthandler.cancel_dump_traceback_later()
    if waiting:
        faulthandler.dump_traceback_later(waiting, exit=True)
    if hasattr(signal, "setitimer"):
        signal.setitimer(signal.ITIMER_PROF, seconds)


def main() -> None:
    """Take cases until the parent goes."""
    with contextlib.suppress(ImportError):
        import resource

        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    faulthandler.enable()
    if hasattr(signal, "setitimer"):
        faulthandler.register(signal.SIGPROF, chain=True)
    warnings.simplefilter("error")
    requests, answers = sys.stdin.buffer, os.fdopen(os.dup(1), "wb")
    # whatever prints does not disturb the answers
    os.dup2(2, 1)
    watch = Watch()
    with tempfile.TemporaryDirectory() as folder, contextlib.suppress(EOFError):
        os.chdir(folder)
        while True:
            case = receive(requests)
            limit(SECONDS, WAITING)
            outcome = attempt(ATTACKS[case.kind], case.payload)
            limit(0.0, 0.0)
            outcome.sites = watch.new()
            send(answers, outcome)


if __name__ == "__main__":
    main()
