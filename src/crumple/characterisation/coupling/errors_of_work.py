"""Error of the work of a hinge under combined loads: what it would carry over the rotation of the shells."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from crumple.characterisation.curve import LawCurve
from crumple.numeric.arrays import Floats

COMPARED = (math.radians(10.0), math.radians(30.0))
"""Plastic rotations up to which the work is compared [rad]."""
POINTS = 400


def errors_of_work(shells: LawCurve, hinge: Callable[[Floats], Floats]) -> str:
    """Error of the work of a hinge's moments, up to each rotation that the shells reached."""
    words = []
    for end in COMPARED:
        if end > shells.rotation[-1] * (1.0 + 1e-6):
            continue
        at = np.linspace(0.0, end, POINTS)
        moment = hinge(at)
        work = float((0.5 * (moment[1:] + moment[:-1]) * np.diff(at)).sum())
        # adding zero turns -0 into 0
        error = round(work / shells.energy_at(end) - 1.0, 2) + 0.0
        words.append(f"{error:+.0%} to {math.degrees(end):.0f} deg")
    return "work " + ", ".join(words)
