"""Error of the coupling of a corner's hinge: bent in and out of its plane at once.

The moment is along a direction between the normal of the corner's plane and its bisector. The hinge has the
laws of both on an ellipsoid, with the flow along its normal,

    M^-2 = (cos/C_u)^2 + (sin/C_n)^2        du : dn = cos/C_u^2 : sin/C_n^2,

and both capacities soften with the common measure of docs/theory/spatial_hinge.md.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np

from crumple.analysis import Analysis
from crumple.characterisation.bending import Bending
from crumple.characterisation.coupling.errors_of_work import errors_of_work
from crumple.characterisation.curve import LawCurve
from crumple.characterisation.out_of_plane import OutOfPlane
from crumple.characterisation.sub_model import Solvable, StrongCornerError
from crumple.numeric.arrays import Floats
from crumple.result import Result

HALFWAY = math.pi / 4.0
"""Angle of the moment to the bisector [rad]."""

COUPLED = ("closing_45_deg", "opening_45_deg")
"""Keys of the errors in a law file."""


@dataclass(frozen=True)
class ObliqueCorner(OutOfPlane):
    """A mitred corner under a moment between its bisector and the normal of its plane.

    Attributes
    ----------
    tilt
        Angle of the moment to the bisector towards the normal [rad]: positive closes the corner, negative
        opens it.
    """

    tilt: float = HALFWAY

    @property
    def title(self) -> str:
        """One line for people."""
        return f"{super().title}, tilted by {math.degrees(self.tilt):.3g} deg"

    @property
    def _flexibility(self) -> float:
        """As out of the plane, and that of bending in it."""
        rigidity = self.material.youngs_modulus * self.section.second_moment(self.axis)
        aside = super()._flexibility
        return math.cos(self.tilt) ** 2 * aside + math.sin(self.tilt) ** 2 * self.length / rigidity

    def analysis(self) -> Analysis:
        """Input of the shell solver: the moment is along a global axis."""
        bisector, normal = (np.eye(3)["xyz".index(one)] for one in (self._across, self.axis))
        moment = math.cos(self.tilt) * bisector + math.sin(self.tilt) * normal
        x = np.array([1.0, 0.0, 0.0])
        if self._across == "z":
            return self.seen_in(np.array([x, np.cross(moment, x), moment]))
        return self.seen_in(np.array([x, moment, np.cross(x, moment)]))

    def curve(self, result: Result) -> LawCurve:
        """Moment about its direction against the plastic rotation about it."""
        return self.curve_of(*self._histories(result))


def coupling_errors(
    model: OutOfPlane, alone: LawCurve, solved: Callable[[Solvable], LawCurve]
) -> dict[str, str]:
    """Errors of the coupling of a corner's hinge as entries of its law file.

    Parameters
    ----------
    model
        The corner about its bisector.
    alone
        Its law.
    solved
        Solves a sub-model and gives its curve.

    Returns
    -------
    dict
        Sentences by key, ``closing_45_deg`` and ``opening_45_deg``; a sense in which the corner is as strong
        as its members in the plane is left out.

    References
    ----------
    docs/theory/characterisation.md.  Verified in tests/unit/characterisation/test_oblique_corner.py.
    """
    found = {}
    place = (model.section, model.material, model.axis)
    for key, sense in zip(COUPLED, (1, -1), strict=True):
        bent = Bending(*place, sense, model.angle, model.largest, resolution=model.resolution)
        try:
            normal = solved(bent)
        except StrongCornerError:
            continue
        both = ObliqueCorner(
            *place, model.angle, largest=model.largest, resolution=model.resolution, tilt=sense * HALFWAY
        )
        errors = errors_of_work(solved(both), partial(on_ellipsoid, HALFWAY, alone, normal))
        found[key] = f"coupling ellipsoid {errors}"
    return found


def on_ellipsoid(tilt: float, bisector: LawCurve, normal: LawCurve, at: Floats) -> Floats:
    """Moment of the hinge at rotations about the direction of the moment [N m], (n,).

    Parameters
    ----------
    tilt
        Angle of the moment to the bisector [rad].
    bisector, normal
        Laws about both.
    at
        Plastic rotations, increasing from 0 [rad], (n,).
    """
    parts, laws = np.array([math.cos(tilt), math.sin(tilt)]), (bisector, normal)
    first = np.array([law.moment_at(0.0) for law in laws])
    turned, moments = np.zeros(2), np.zeros(len(at))
    for i in range(len(at)):
        measure = float(np.linalg.norm(first * turned))
        capacity = np.array([law.moment_at(measure / c) for law, c in zip(laws, first, strict=True)])
        moments[i] = 1.0 / float(np.linalg.norm(parts / capacity))
        flow = parts / capacity**2
        turned = turned + flow / float(flow @ parts) * (at[min(i + 1, len(at) - 1)] - at[i])
    return moments
