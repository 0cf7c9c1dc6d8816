"""Closed-form collapse law of a square tube, after Wierzbicki et al. (1994, part II).

Unknown: the capacity M(theta) of a square tube with mid-line side b, wall t and flow stress s_0:

    M = min(Mmax, C (0.576 + 1/(2 sqrt(theta)))),        C = 4.65 s_0 b^(4/3) t^(5/3)

Mmax is the largest moment of crumple.hinge.bending.largest_moment.  Limits: theta -> 0 is singular, so the
curve is capped up to theta_T = (2 (Mmax/C - 0.576))^-2; for large theta M tends to 0.576 C, but the walls
touch before that.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from crumple.errors import InputError, Problem
from crumple.hinge.bending.folding import FoldingLaw
from crumple.hinge.bending.jamming import AfterJamming
from crumple.hinge.bending.largest_moment import peak_moment
from crumple.hinge.law import Source, Trust, Validity
from crumple.hinge.options import choice
from crumple.hinge.rate import hinge_rate, rate_warnings
from crumple.hinge.stop import Stop
from crumple.material import Material
from crumple.numeric.arrays import Floats
from crumple.registry.quantity import PositiveLength
from crumple.section import Axis, RectangularTube, Section, half_fold_length

SOURCE = Source(
    "after Wierzbicki, Recke, Abramowicz, Gholami & Huang, part II (bending), "
    "Computers & Structures 51 (1994) 625-641",
    Trust.QUOTED,
    "the bracket is widely quoted; its coefficient 4.65 was not found in any available text",
)
COEFFICIENT = 4.65
"""[-]; quoted without a text that confirms it, see `SOURCE`; the whole curve scales with it."""
STEADY = 0.576
"""[-]; limit of the bracket at large rotation."""
SAME_SIDE = 1e-3
"""Relative difference of the sides up to which a tube counts as square."""


@dataclass(frozen=True)
class WierzbickiLaw(FoldingLaw):
    """Closed form of a square tube after Wierzbicki and others (1994).

    The same in both senses.

    Attributes
    ----------
    peak
        Mmax [N m].
    scale
        C [N m].
    touching
        Rotation at which the flange halves touch [rad], from half the fold length H_b and the depth.
    validity, after_jamming, rate, stop
        See `FoldingLaw`.

    References
    ----------
    docs/theory/wierzbicki.md.  Verified in tests/verification/hinge/test_wierzbicki.py.
    """

    name: ClassVar[str] = "wierzbicki"
    source: ClassVar[Source] = SOURCE

    peak: float
    scale: float
    touching: float

    @classmethod
    def of(
        cls,
        section: Section,
        material: Material,
        axis: Axis = "y",
        *,
        equivalent_side: PositiveLength | None = None,
        after_jamming: AfterJamming | str = AfterJamming.SECOND_FOLD,
    ) -> WierzbickiLaw:
        """Law of a square tube.

        Parameters
        ----------
        section
            Square tube, or a rectangular one together with ``equivalent_side``.
        material
            Yield stress for the largest moment, flow stress for the fold, flow rate for the rate factor.
        axis
            Axis of bending.
        equivalent_side
            Mid-line side [m] of the square tube equivalent to a rectangular one.
        after_jamming
            What follows when the walls touch: a further fold in series, an elastic stop, or the moment held.

        Returns
        -------
        WierzbickiLaw
            Frozen law.

        Raises
        ------
        InputError
            If the section is not a rectangular tube, or is not square and has no ``equivalent_side``.
        """
        if not isinstance(section, RectangularTube):
            allowed, todo = (
                "rectangular_tube with equal sides",
                "use a table or a constant law for this section",
            )
            raise InputError(Problem("this law is for square tubes", section.kind, allowed, todo))
        after = choice("after_jamming", after_jamming, AfterJamming)
        side = _side(section, equivalent_side)
        t, depth = section.thickness, section.bending_depth(axis)
        half_fold = half_fold_length(section, axis)
        jamming = 2.0 * math.asin(min((half_fold - t / 2.0) / depth, 1.0))
        stiffness = material.youngs_modulus * section.second_moment(axis) / (2.0 * half_fold)
        return cls(
            peak_moment(section, material, axis).moment,
            COEFFICIENT * material.flow_stress * side ** (4.0 / 3.0) * t ** (5.0 / 3.0),
            jamming,
            validity=_validity(jamming, material, equivalent_side),
            after_jamming=after,
            rate=hinge_rate(material.flow_rate),
            stop=Stop(jamming, stiffness) if after is AfterJamming.STOP else None,
        )

    @property
    def title(self) -> str:
        """One line for people."""
        return "closed form of a square tube after Wierzbicki et al. (1994)"

    @property
    def jamming_angle(self) -> float:
        """Rotation at which the flange halves touch [rad]."""
        return self.touching

    @property
    def folding_from(self) -> float:
        """theta_T: rotation from which the fold governs [rad]; infinite if it never does."""
        excess = self.peak / self.scale - STEADY
        return math.inf if excess <= 0.0 else 1.0 / (2.0 * excess) ** 2

    @property
    def fold_kinks(self) -> tuple[float, ...]:
        """Rotations up to jamming where the slope jumps [rad]."""
        return (self.folding_from,) if self.folding_from < self.jamming_angle else ()

    def single_fold(self, rotation: Floats) -> Floats:
        """Capacity of one fold up to jamming [N m]."""
        # the fold's moment meets the cap at theta_T: clipping there keeps it finite at zero
        folded = np.maximum(rotation, min(self.folding_from, self.jamming_angle))
        return np.minimum(self.peak, self.scale * (STEADY + 0.5 / np.sqrt(folded)))


def _side(section: RectangularTube, equivalent_side: PositiveLength | None) -> float:
    """Mid-line side [m] of the square tube."""
    if equivalent_side is not None:
        if not (math.isfinite(equivalent_side) and equivalent_side > section.thickness):
            what, came = "the equivalent side is not larger than the wall", f"{1e3 * equivalent_side:g} mm"
            todo = "give the mid-line side of a square tube"
            raise InputError(
                Problem(what, came, f"> {1e3 * section.thickness:g} mm", todo, "equivalent_side")
            )
        return equivalent_side
    if abs(section.width - section.depth) > SAME_SIDE * section.width:
        what = "this law is for square tubes, and no source gives the equivalent side of a rectangular one"
        todo = "use the law kecman, or give equivalent_side"
        raise InputError(Problem(what, section.title, "equal sides", todo, "equivalent_side"))
    return section.width - section.thickness


def _validity(jamming_angle: float, material: Material, equivalent_side: PositiveLength | None) -> Validity:
    warnings = ["the coefficient of the curve is quoted without a text that confirms it"]
    if equivalent_side is not None:
        warnings.append("the side of the equivalent square tube is given by the user")
    warnings += rate_warnings(material)
    basis = (
        "validated neither by tests nor by finite elements; the walls touch at "
        f"{math.degrees(jamming_angle):.1f} deg, and the behaviour beyond is a model without a source"
    )
    return Validity(jamming_angle, basis, tuple(warnings))
