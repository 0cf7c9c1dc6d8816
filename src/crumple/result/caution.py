"""A check that a result did not pass: what was checked, the value found, the limit, and where."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass


@dataclass(frozen=True)
class Caution:
    """One check that failed at one place.

    Attributes
    ----------
    code
        Short name of the check; formulas and limits are in docs/theory/result_checks.md.
    value, limit
        Value found and limit, in SI units.
    unit
        Of both.
    place
        Hinge, member, node or obstacle; empty: the whole model.
    text
        Sentence for people; the same text for all places of one sentence.
    violation
        Whether a law of mechanics is broken: then the result is not called complete.
    """

    code: str
    value: float
    limit: float
    unit: str
    place: str
    text: str
    violation: bool = False


def sentences(cautions: Iterable[Caution]) -> tuple[str, ...]:
    """Sentences of cautions, each once."""
    return tuple(dict.fromkeys(caution.text for caution in cautions))
