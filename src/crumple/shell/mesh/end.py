"""One end of a member, as joints and their kinds name it."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class End:
    """One end of a member: the second if ``second``, else the first."""

    member: str
    second: bool
