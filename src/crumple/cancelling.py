"""Cancellation: long computations check at intervals whether to continue, at any depth of calls.

The caller sets the function that decides (`asking`); loops that may be long call `go_on`.  It is not passed
as an argument: a solve calls many packages, and each thread has a function of its own.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar

from crumple.errors import CancelledError

EVERY = 0.05
"""Wall time between two checks [s]: not noticeable, and long compared with the cost of a check."""


class _Asking:
    def __init__(self, cancel: Callable[[], bool]) -> None:
        self.cancel, self.next = cancel, time.perf_counter() + EVERY


_asking: ContextVar[_Asking | None] = ContextVar("asking", default=None)


@contextmanager
def asking(cancel: Callable[[], bool] | None) -> Iterator[None]:
    """Let `go_on` check inside the block whether to cancel."""
    token = _asking.set(None if cancel is None else _Asking(cancel))
    try:
        yield
    finally:
        _asking.reset(token)


def go_on() -> None:
    """Check at intervals whether the work is to continue.

    Raises
    ------
    CancelledError
        If it is not.
    """
    asked = _asking.get()
    if asked is None:
        return
    now = time.perf_counter()
    if now < asked.next:
        return
    asked.next = now + EVERY
    if asked.cancel():
        raise CancelledError("cancelled before the first step: nothing was computed")
