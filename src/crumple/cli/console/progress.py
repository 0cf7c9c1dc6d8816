"""A progress bar that appears where work is long, and Ctrl-C as a wish to stop.

The bar is drawn on standard error and only after `PATIENCE`; most runs end before.  Where standard error is
no terminal, a line is written every `NEWS_EVERY`.
"""

from __future__ import annotations

import signal
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rich.progress import Progress

PATIENCE = 0.4
"""Seconds of silence before the bar: shorter work would only flicker."""
NEWS_EVERY = 10.0
"""Wall time between two lines of news where there is no terminal to draw a bar on [s]."""


class Bar:
    """Call it with the fraction done, 0 to 1; without a terminal it writes a line now and then."""

    def __init__(self, title: str) -> None:
        self._title, self._started = title, time.monotonic()
        self._told, self._news = self._started, ""
        self._bar: Progress | None = None

    def __call__(self, fraction: float) -> None:
        if not sys.stderr.isatty():
            self._tell(fraction)
            return
        if self._bar is None:
            if time.monotonic() - self._started < PATIENCE:
                return
            from rich.console import Console
            from rich.progress import Progress

            self._bar = Progress(console=Console(stderr=True), transient=True)
            self._bar.add_task(self._title, total=1.0)
            self._bar.start()
        self._bar.update(self._bar.task_ids[0], completed=fraction)

    def say(self, text: str) -> None:
        """Say what is going on: beside the bar, or in the next line."""
        self._news = text
        if self._bar is not None:
            self._bar.update(self._bar.task_ids[0], description=text)

    def stop(self) -> None:
        """Take the bar away."""
        if self._bar is not None:
            self._bar.stop()

    def _tell(self, fraction: float) -> None:
        now = time.monotonic()
        if now - self._told < NEWS_EVERY:
            return
        self._told = now
        spent = now - self._started
        left = f", about {duration(spent * (1.0 - fraction) / fraction)} left" if fraction > 0.0 else ""
        print(self._news or f"{self._title}: {100.0 * fraction:.3g} %{left}", file=sys.stderr, flush=True)


def duration(seconds: float) -> str:
    """Wall time for people."""
    if seconds < 100.0:
        return f"{seconds:.0f} s"
    return f"{seconds / 60.0:.0f} min" if seconds < 6000.0 else f"{seconds / 3600.0:.1f} h"


@contextmanager
def progress_bar(title: str) -> Iterator[Bar]:
    """Give a bar to call with the fraction done, 0 to 1."""
    bar = Bar(title)
    try:
        yield bar
    finally:
        bar.stop()


@contextmanager
def stop_on_interrupt() -> Iterator[Callable[[], bool]]:
    """Give a function that says whether Ctrl-C or SIGTERM came; a second one ends the program."""
    pressed = threading.Event()
    previous = {number: signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)}

    def restore() -> None:
        for number, handler in previous.items():
            signal.signal(number, handler)

    def note(number: int, frame: FrameType | None) -> None:
        pressed.set()
        restore()

    for number in previous:
        signal.signal(number, note)
    try:
        yield pressed.is_set
    finally:
        restore()
