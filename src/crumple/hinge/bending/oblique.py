"""Rectangular tube bent about any axis of its section: two Kecman-type folds at once.

Unknown: the moment M(theta) about an axis at an angle alpha from a side of the tube, the rotation kept about
that axis.  With c = cos alpha, s = sin alpha the tube folds about both sides, by theta c and theta s.  If the
two folds do not interact, their work adds, W = W_a(theta c) + W_b(theta s), and

    M = min( M_alpha,  c M_a(theta c) + s M_b(theta s) )

M_a and M_b are the laws of the sides.  M_alpha, the largest moment, has every fibre at yield:
s_y integral |u| dA with u the distance from the axis; of a rectangle w x d, p = d c/2 and q = w s/2:

    integral |u| dA = w d (p/2 + q^2/(6 p)),  p >= q        (otherwise with p and q exchanged)

of the outer rectangle less the inner one.  Where flanges buckle, M_alpha is reduced like the two sides, in
the mean with weights c^2 and s^2.  Limits: alpha = 0 and 90 deg are the laws of the sides; the sum is an
upper bound of its kinematics, and the walls jam as soon as one of the folds does: min(theta_Ja/c,
theta_Jb/s).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

import numpy as np

from crumple.errors import InputError, Problem
from crumple.hinge.bending.folding import FoldingLaw
from crumple.hinge.bending.jamming import AfterJamming
from crumple.hinge.bending.kecman import KecmanLaw
from crumple.hinge.law import Source, Trust, Validity
from crumple.hinge.options import choice, number_between
from crumple.hinge.stop import Stop
from crumple.material import Material
from crumple.numeric.arrays import Floats
from crumple.numeric.sign_change import sign_change
from crumple.registry.quantity import Angle, RollingWeight
from crumple.section import Axis, RectangularTube, Section

SOURCE = Source(
    "two Kecman-type mechanisms at once, after D. Kecman, Int. J. Mech. Sci. 25 (1983) 623-636",
    Trust.DERIVED,
    "sum of the works of both folds, derived here; tests of biaxial collapse exist (Brown & Tidbury 1983) "
    "but were not available",
)
SAME_KINK = 1e-9
"""Kinks closer than this share of the jamming angle are one: a slope between them is only rounding."""


@dataclass(frozen=True)
class ObliqueLaw(FoldingLaw):
    """Rectangular tube bent about an axis between its sides: two Kecman-type folds at once.

    The same in both senses.

    Attributes
    ----------
    angle
        Of the bending axis from the side that the law was asked for [rad], 0 to pi/2.
    first, second
        Laws about that side and about the other one.
    peak
        M_alpha [N m].
    validity, after_jamming, rate, stop
        See `FoldingLaw`.

    References
    ----------
    docs/theory/oblique.md.  Verified in tests/verification/hinge/test_oblique_bending.py.
    """

    name: ClassVar[str] = "oblique"
    source: ClassVar[Source] = SOURCE

    angle: float
    first: KecmanLaw
    second: KecmanLaw
    peak: float

    @classmethod
    def of(
        cls,
        section: Section,
        material: Material,
        axis: Axis = "y",
        *,
        angle: Angle = math.pi / 4.0,
        rolling_weight: RollingWeight = 1.0,
        after_jamming: AfterJamming | str = AfterJamming.SECOND_FOLD,
    ) -> ObliqueLaw:
        """Law of a rectangular tube.

        Parameters
        ----------
        section
            Rectangular tube.
        material
            As in the Kecman-type law.
        axis
            Side from which the angle is measured.
        angle
            Of the bending axis from the hinge's own axis [rad], 0 deg to 90 deg (the tube is symmetric).
        rolling_weight
            Weight of the second rolling line of each web.
        after_jamming
            What follows when the walls touch: a further fold in series, an elastic stop, or the moment held.

        Raises
        ------
        InputError
            If the section is not a rectangular tube or a value is out of range.
        """
        if not isinstance(section, RectangularTube):
            what, todo = "this law is for rectangular tubes", "use the law circular or folded_profile"
            raise InputError(Problem(what, section.title, "rectangular_tube", todo, "section"))
        angle = number_between("angle", angle, 0.0, math.pi / 2.0)
        after = choice("after_jamming", after_jamming, AfterJamming)
        other: Axis = "z" if axis == "y" else "y"
        first, second = (
            KecmanLaw.of(section, material, each, rolling_weight=rolling_weight, after_jamming="hold")
            for each in (axis, other)
        )
        c2 = math.cos(angle) ** 2
        share = c2 * _reduction(first) + (1.0 - c2) * _reduction(second)
        peak = share * material.yield_stress * oblique_plastic_modulus(section, axis, angle)
        jamming = _jamming(first, second, angle)
        stiffness = c2 * section.second_moment(axis) + (1.0 - c2) * section.second_moment(other)
        length = 2.0 * min(first.mechanism.half_length, second.mechanism.half_length)
        stop = Stop(jamming, material.youngs_modulus * stiffness / length)
        return cls(
            angle,
            first,
            second,
            peak,
            validity=_validity(first, second, jamming),
            after_jamming=after,
            rate=first.rate,
            stop=stop if after is AfterJamming.STOP else None,
        )

    @property
    def title(self) -> str:
        """One line for people."""
        return f"two folds about an axis {math.degrees(self.angle):.3g} deg from a side"

    @property
    def jamming_angle(self) -> float:
        """Rotation at which one of the folds jams [rad]."""
        return _jamming(self.first, self.second, self.angle)

    @property
    def fold_kinks(self) -> tuple[float, ...]:
        """Rotations up to jamming where the slope jumps [rad]."""
        c, s = math.cos(self.angle), math.sin(self.angle)
        ends = [(self.first.mechanism_from, c), (self.second.mechanism_from, s), (self._peak_to, 1.0)]
        within: list[float] = []
        for kink in sorted(end / share for end, share in ends if share * self.jamming_angle > end):
            # both folds of a square tube at 45 deg begin at the same rotation except for rounding
            if not within or kink - within[-1] > SAME_KINK * self.jamming_angle:
                within.append(kink)
        return tuple(within)

    @cached_property
    def _peak_to(self) -> float:
        """Rotation up to which the largest moment governs [rad]; infinite if it always does."""
        crossing = sign_change(
            lambda at: self.peak - self._folds(at), 1e-4 * self.jamming_angle, self.jamming_angle
        )
        return math.inf if crossing is None else crossing

    def _folds(self, rotation: Floats) -> Floats:
        c, s = math.cos(self.angle), math.sin(self.angle)
        first = self.first.moment_capacity(c * rotation)
        return np.asarray(c * first + s * self.second.moment_capacity(s * rotation), np.float64)

    def single_fold(self, rotation: Floats) -> Floats:
        """Capacity of one fold up to jamming [N m]."""
        return np.minimum(self.peak, self._folds(rotation))


def oblique_plastic_modulus(section: RectangularTube, axis: Axis, angle: float) -> float:
    """Plastic section modulus about an axis at an angle [rad] from a side [m^3]; exact for sharp corners.

    Rounded corners enter by the ratio of exact to sharp moduli about both sides, weights c^2 and s^2.
    """
    t, a, b = section.thickness, section.flange_width(axis), section.bending_depth(axis)
    sharp = _first_moment(a, b, angle) - _first_moment(a - 2.0 * t, b - 2.0 * t, angle)
    if section.corner_radius == 0.0:
        return sharp
    square = RectangularTube(section.width, section.depth, t)
    other: Axis = "z" if axis == "y" else "y"
    weights = ((axis, math.cos(angle) ** 2), (other, math.sin(angle) ** 2))
    return sharp * sum(
        w * section.plastic_section_modulus(each) / square.plastic_section_modulus(each)
        for each, w in weights
    )


def _first_moment(width: float, depth: float, angle: float) -> float:
    """Integral of |u| over a rectangle [m^3]."""
    p, q = depth * math.cos(angle) / 2.0, width * math.sin(angle) / 2.0
    p, q = max(p, q), min(p, q)
    return width * depth * (p / 2.0 + q**2 / (6.0 * p))


def _reduction(law: KecmanLaw) -> float:
    return law.peak.moment / law.peak.plastic_moment


def _jamming(first: KecmanLaw, second: KecmanLaw, angle: float) -> float:
    c, s = math.cos(angle), math.sin(angle)
    # below the rounding of a right angle the other fold does not rotate
    ends = [law.jamming_angle / share for law, share in ((first, c), (second, s)) if share > 1e-12]
    return min(*ends, math.pi)


def _validity(first: KecmanLaw, second: KecmanLaw, jamming: float) -> Validity:
    warnings = dict.fromkeys((*first.validity.warnings, *second.validity.warnings))
    basis = (
        "the laws of both sides are Kecman-type; their sum about an oblique axis is not validated; "
        f"the walls touch at {math.degrees(jamming):.1f} deg; behaviour beyond is a model without a source"
    )
    return Validity(jamming, basis, tuple(warnings))
