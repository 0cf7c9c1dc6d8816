"""Axial crushing of a member by a stored law: force over shortening of a sub-model of a stated length.

The peak is the largest force of the curve, the mean its work over its end, at which the folds are closed.
The effective stroke is that end over the length of the sub-model, so that a member of another length folds
as often as its length allows.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from crumple.errors import InputError, Problem
from crumple.hinge.axial.axial_law import CrushRate, CrushValidity
from crumple.hinge.law import Source
from crumple.hinge.measured.stored import StoredLaw
from crumple.units import parse_quantity

GAUGE = "gauge"
"""Key of the length of the sub-model in the origin of a law file."""


@dataclass(frozen=True)
class StoredCrushing:
    """Law of a law file with slip.

    Attributes
    ----------
    peak_force, mean_crushing_force, effective_stroke, rate, half_fold_length, peak_strain
        See `AxialLaw`; without a rate, and the strain at the peak is not known.

    References
    ----------
    docs/theory/characterisation.md.  Verified in tests/unit/hinge/measured/test_stored_crushing.py.
    """

    name: ClassVar[str] = "stored"

    title: str
    source: Source
    validity: CrushValidity
    peak_force: float
    mean_crushing_force: float
    effective_stroke: float
    half_fold_length: float | None = None
    peak_strain: float = 0.0
    rate: CrushRate | None = None

    @classmethod
    def of(cls, law: StoredLaw) -> StoredCrushing:
        """Crushing by a stored law.

        Raises
        ------
        InputError
            If it is no law along the member, or its length is not stated.
        """
        length = dict(law.origin).get(GAUGE)
        if not law.slip or length is None:
            what, todo = (
                "this is no law of axial crushing",
                "create it with crumple characterise --load crush",
            )
            raise InputError(Problem(what, law.title, f"slip, and {GAUGE} in its origin", todo))
        slip, force = (np.array(one) for one in law.points(-1))
        work = float((0.5 * (force[1:] + force[:-1]) * np.diff(slip)).sum())
        return cls(
            law.title,
            law.source,
            CrushValidity(law.validity.basis, law.validity.warnings, law.validity.uncertainty),
            float(force.max()),
            work / float(slip[-1]),
            float(slip[-1]) / parse_quantity(length, "m"),
        )
