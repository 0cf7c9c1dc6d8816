"""Exceptions, and the status of a run; every message names the cause and what to do."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum


class CrumpleError(Exception):
    """Base of every error that Crumple raises on purpose."""


@dataclass(frozen=True)
class Problem:
    """One mistake in the input.

    Attributes
    ----------
    what
        The mistake in one sentence.
    came
        Value in the input, shortened; empty if there is none.
    allowed
        Values that are accepted.
    todo
        What the engineer can do about it.
    where
        Path inside the input, for example ``members.tube.section``.
    file, line
        File and 1-based line; ``line`` 0 when unknown (a model built in Python).
    """

    what: str
    came: str = ""
    allowed: str = ""
    todo: str = ""
    where: str = ""
    file: str = ""
    line: int = 0

    def __str__(self) -> str:
        place = ":".join(part for part in (self.file, str(self.line) if self.line else "") if part)
        head = ": ".join(part for part in (place, self.where, self.what) if part)
        details = (("given", self.came), ("allowed", self.allowed), ("do", self.todo))
        return "\n".join([head, *(f"    {name + ':':<9}{text}" for name, text in details if text)])


class InputError(CrumpleError):
    """The description of the structure or analysis cannot be accepted; holds every problem found.

    Parameters
    ----------
    problems
        One or more problems; a plain string is a problem without a location.
    """

    def __init__(self, problems: str | Problem | Sequence[Problem]) -> None:
        if isinstance(problems, str):
            problems = Problem(problems)
        self.problems: list[Problem] = [problems] if isinstance(problems, Problem) else list(problems)
        super().__init__("\n".join(str(problem) for problem in self.problems))

    def __reduce__(self) -> tuple[type[InputError], tuple[list[Problem]]]:
        return (type(self), (self.problems,))


class CancelledError(CrumpleError):
    """The caller cancelled before the first step, or before all runs that a figure needs: it is not known."""


class Status(Enum):
    """How a run ended; the value is the message for the user."""

    COMPLETE = "complete"
    RESIDUAL_EXCEEDED = "ended, but the energy residual exceeds its limit: do not trust this result"
    IMPOSSIBLE = "ended, but the result violates a law of mechanics: do not trust it"
    STEP_COLLAPSED = "stopped: the time step fell below its minimum"
    NOT_CONVERGED = "stopped: the step's equations did not converge"
    NOT_FINITE = "stopped: a state became infinite or not a number"
    OVERLAPPING = "stopped: an obstacle appeared inside the structure"
    INVERTED = "stopped: an element is inverted"
    UNHELD = "stopped: the structure is not supported in a quasi-static stage"
    STALLED = "stopped: the run hardly advanced any more"
    LIMIT_LOAD = "stopped: the loads of a quasi-static stage exceed the limit load of the structure"
    CANCELLED = "cancelled by the caller"
    REFUSED = "refused: the input cannot be solved"

    @property
    def ok(self) -> bool:
        """Whether the run reached its end within its limits."""
        return self is Status.COMPLETE
