"""Cancelling: long work asks now and then whether to go on, wherever it is.

The caller states whom to ask (`asking`); loops that may be long call `go_on`.  Nothing is passed down:
a solve goes through many rooms, and each thread has its own wish.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar

from crumple.errors import CancelledError

EVERY = 0.05
"""Wall time between two questions [s]: nobody feels it, and asking costs nothing beside it."""


class _Asking:
    def __init__(self, cancel: Callable[[], bool]) -> None:
        self.cancel, self.next = cancel, time.perf_counter() + EVERY


_asking: ContextVar[_Asking | None] = ContextVar("asking", default=None)


@contextmanager
def asking(cancel: Callable[[], bool] | None) -> Iterator[None]:
    """Let `go_on` ask whether to cancel, inside the block."""
    token = _asking.set(None if cancel is None else _Asking(cancel))
    try:
        yield
    finally:
        _asking.reset(token)


def go_on() -> None:
    """Ask now and then whether the work is still wanted.

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
