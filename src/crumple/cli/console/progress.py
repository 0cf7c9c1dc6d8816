"""A progress bar for long runs.

The bar is drawn on standard error and only after `PATIENCE`; most runs end before.  Where standard error is
no terminal, a line is written every `STATUS_INTERVAL`.
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
STATUS_INTERVAL = 10.0
"""Wall time between two status lines if there is no terminal for a progress bar [s]."""

LOWERING = "lowering"
"""What is shown before the first fraction: the model is being built from the input."""


class Bar:
    """Call it with the fraction done, 0 to 1; without a terminal it writes a line at intervals."""

    def __init__(self, title: str) -> None:
        self._title, self._started = title, time.monotonic()
        self._reported, self._text = self._started, ""
        self._bar: Progress | None = None
        self._begun = False

    def __call__(self, fraction: float) -> None:
        if not self._begun:
            self._begun = True
            self.describe(self._text)
        self._show(fraction)

    def preparing(self) -> None:
        """Say that the model is being lowered, until the first fraction is given; call it at intervals."""
        if not self._begun:
            self._show(0.0)

    def _show(self, fraction: float) -> None:
        if not sys.stderr.isatty():
            self._report(fraction)
            return
        if self._bar is None:
            if time.monotonic() - self._started < PATIENCE:
                return
            from rich.console import Console
            from rich.progress import Progress

            self._bar = Progress(console=Console(stderr=True), transient=True)
            self._bar.add_task(self._now, total=1.0)
            self._bar.start()
        self._bar.update(self._bar.task_ids[0], completed=fraction)

    @property
    def _now(self) -> str:
        """What is being done."""
        return self._text or (self._title if self._begun else LOWERING)

    def describe(self, text: str) -> None:
        """Show a status text: beside the bar, or in the next status line."""
        self._text = text
        if self._bar is not None:
            self._bar.update(self._bar.task_ids[0], description=self._now)

    def stop(self) -> None:
        """Remove the bar."""
        if self._bar is not None:
            self._bar.stop()

    def _report(self, fraction: float) -> None:
        now = time.monotonic()
        if now - self._reported < STATUS_INTERVAL:
            return
        self._reported = now
        spent = now - self._started
        left = f", about {duration(spent * (1.0 - fraction) / fraction)} left" if fraction > 0.0 else ""
        share = f": {100.0 * fraction:.3g} %{left}" if self._begun and not self._text else ""
        print(f"{self._now}{share}", file=sys.stderr, flush=True)


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
