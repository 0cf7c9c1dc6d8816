"""A progress bar for long runs.

The bar is drawn on standard error and only after `PATIENCE`; most runs end before.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rich.progress import Progress

PATIENCE = 0.4
"""Time before the bar appears [s]: for shorter runs it would only flicker."""


class Bar:
    """Call it with the fraction done, 0 to 1."""

    def __init__(self, title: str) -> None:
        self._title, self._started = title, time.monotonic()
        self._bar: Progress | None = None

    def __call__(self, fraction: float) -> None:
        if self._bar is None:
            if time.monotonic() - self._started < PATIENCE or not sys.stderr.isatty():
                return
            from rich.console import Console
            from rich.progress import Progress

            self._bar = Progress(console=Console(stderr=True), transient=True)
            self._bar.add_task(self._title, total=1.0)
            self._bar.start()
        self._bar.update(self._bar.task_ids[0], completed=fraction)

    @property
    def drawn(self) -> bool:
        """Whether the bar is shown on the terminal."""
        return self._bar is not None

    def describe(self, text: str) -> None:
        """Show a status text beside the bar, if the bar is shown."""
        if self._bar is not None:
            self._bar.update(self._bar.task_ids[0], description=text)

    def stop(self) -> None:
        """Remove the bar."""
        if self._bar is not None:
            self._bar.stop()


@contextmanager
def progress_bar(title: str) -> Iterator[Bar]:
    """Give a bar to call with the fraction done, 0 to 1."""
    bar = Bar(title)
    try:
        yield bar
    finally:
        bar.stop()
