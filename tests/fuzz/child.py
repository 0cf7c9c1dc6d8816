"""The worker's own process: limits itself, tries what it is sent, and answers what came of it."""

from __future__ import annotations

import contextlib
import faulthandler
import os
import signal
import tempfile
import traceback
import warnings
from collections.abc import Callable
from multiprocessing.connection import Connection
from typing import Any

from tests.fuzz import kernel_base, restart_base
from tests.fuzz.attacks import ATTACKS
from tests.fuzz.sites import Watch, sites
from tests.fuzz.worker import MEMORY, SECONDS, WAITING, Outcome, place_in

import crumple.multibody
import crumple.shell

FORKED = (kernel_base, restart_base, crumple.multibody, crumple.shell)
"""Modules that attacks import late: children are forked with them."""
SITES = sites()
"""Found once, before children are forked: it takes seconds."""


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
        faulthandler.dump_traceback_later(waiting, exit=True, file=2)
    if hasattr(signal, "setitimer"):
        signal.setitimer(signal.ITIMER_PROF, seconds)


def serve(pipe: Connection, words: str) -> None:
    """Take cases until the parent ends; output and tracebacks of crashes go into the file `words`."""
    with contextlib.suppress(ImportError):
        import resource

        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    said = os.open(words, os.O_WRONLY | os.O_APPEND)
    os.dup2(said, 1)
    os.dup2(said, 2)
    # by number: the object of the parent may not be the file that is number 2 here
    faulthandler.enable(file=2)
    if hasattr(signal, "setitimer"):
        faulthandler.register(signal.SIGPROF, file=2, chain=True)
    warnings.simplefilter("error")
    # what old versions of dependencies say of each other is no error of Crumple
    warnings.filterwarnings("default", category=DeprecationWarning, module=r"matplotlib|pyparsing")
    watch = Watch()
    with tempfile.TemporaryDirectory() as folder, contextlib.suppress(EOFError):
        os.chdir(folder)
        while True:
            case = pipe.recv()
            limit(SECONDS, WAITING)
            outcome = attempt(ATTACKS[case.kind], case.payload)
            limit(0.0, 0.0)
            outcome.sites = watch.new()
            pipe.send(outcome)
