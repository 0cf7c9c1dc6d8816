"""Error of the coupling of a corner's hinge: bent in and out of its plane at once.

The moment is along a direction between the normal of the corner's plane and its bisector. The hinge has the
laws of both on an ellipsoid, with the flow along its normal,

    M^-2 = (cos/C_u)^2 + (sin/C_n)^2        du : dn = cos/C_u^2 : sin/C_n^2,

and both capacities soften with the common measure of docs/theory/spatial_hinge.md; of tubes the centre of
the ellipsoid moves as in docs/theory/mitred_corner.md.
"""

from __future__ import annotations

import contextlib
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
from crumple.hinge.corner.shift import corner_shift
from crumple.numeric.arrays import Floats
from crumple.result import Result

HALFWAY = math.pi / 4.0
"""Angle of the moment to the bisector [rad]."""

NARROWEST = 0.1
"""Least half axis of a shifted set in opening over the capacity there, as in the solver [-]."""

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
    place = (model.section, model.material, model.axis)
    laws: dict[int, LawCurve] = {}
    for sense in (1, -1):
        with contextlib.suppress(StrongCornerError):
            laws[sense] = solved(
                Bending(*place, sense, model.angle, model.largest, resolution=model.resolution)
            )
    share = corner_shift(model.section, model.angle) if 1 in laws else None
    found = {}
    for key, sense in zip(COUPLED, (1, -1), strict=True):
        if sense not in laws:
            continue
        both = ObliqueCorner(
            *place, model.angle, largest=model.largest, resolution=model.resolution, tilt=sense * HALFWAY
        )
        # the opening half of the set is not reached when the corner closes
        normal = laws[1], laws.get(-1, laws[1])
        if share is None:
            kind, hinge = "ellipsoid", partial(on_ellipsoid, HALFWAY, alone, laws[sense])
        else:
            kind, hinge = "shifted ellipsoid", partial(_on_shifted, both.tilt, alone, normal, share)
        found[key] = f"coupling {kind} {errors_of_work(solved(both), hinge)}"
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


def on_shifted_ellipsoid(
    tilt: float,
    bisector: LawCurve,
    normal: tuple[LawCurve, LawCurve],
    share: Callable[[Floats], Floats],
    at: Floats,
) -> tuple[Floats, Floats]:
    """The same of a corner whose set moves along the normal, and its rotations.

    Parameters
    ----------
    tilt
        Angle of the moment to the bisector towards the normal [rad], positive if the corner closes.
    bisector, normal
        Laws about both, about the normal in closing and in opening.
    share
        Of the half axis in closing by which the centre has moved, at rotations about the bisector.
    at
        Plastic rotations, increasing from 0 [rad], (n,).

    Returns
    -------
    moments, rotations
        Moment [N m], (n,), and rotations about bisector and normal [rad], (n, 2).
    """
    parts = np.array([math.cos(tilt), math.sin(tilt)])
    turned, moments = np.zeros((len(at), 2)), np.zeros(len(at))
    for i in range(len(at)):
        softened = float(np.linalg.norm(turned[i]))
        aside, closing, opening = (law.moment_at(softened) for law in (bisector, *normal))
        moved = float(share(np.abs(turned[i, 0])))
        way = moved / (1.0 - moved) * closing
        centre, wide = np.array([0.0, -way]), aside / math.sqrt(1.0 - moved**2)
        for half, sense in ((closing + way, 1.0), (max(opening - way, NARROWEST * opening), -1.0)):
            # |M parts - centre| = 1 in units of the half axes
            units = np.array([wide, half])
            a, b = parts / units, centre / units
            moments[i] = (a @ b + math.sqrt((a @ b) ** 2 - (a @ a) * (b @ b - 1.0))) / (a @ a)
            flow = (moments[i] * a - b) / units
            if sense * flow[1] >= 0.0:
                break
        if i + 1 < len(at):
            turned[i + 1] = turned[i] + flow / float(flow @ parts) * (at[i + 1] - at[i])
    return moments, turned


def _on_shifted(
    tilt: float,
    bisector: LawCurve,
    normal: tuple[LawCurve, LawCurve],
    share: Callable[[Floats], Floats],
    at: Floats,
) -> Floats:
    return on_shifted_ellipsoid(tilt, bisector, normal, share, at)[0]
