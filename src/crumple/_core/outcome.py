"""Outcome of a run of a multibody kernel."""

from __future__ import annotations

from enum import IntEnum


class Outcome(IntEnum):
    """How a run ended; the values of native/common/records.hpp."""

    COMPLETE = 0
    STEP_COLLAPSED = 1
    NOT_FINITE = 2
    CANCELLED = 3
    REFUSED = 4
    UNHELD = 5
    LIMIT_LOAD = 6
    STALLED = 7
