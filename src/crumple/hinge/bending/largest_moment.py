"""Largest bending moment of a rectangular tube whose compression flange may buckle first.

Unknown: Mmax.  The compression flange (width a, held by the webs of depth b) buckles at

    sigma_cr = k pi^2 E/(12 (1 - nu^2)) (t/a)^2,        k = 5.23 + 0.16 a/b

    sigma_cr < sigma_y:                effective flange a_e = a (0.7 sigma_cr/sigma_y + 0.3), edge at yield:
                                       Mmax = sigma_y t b^2 [2a + b + a_e (3a/b + 2)]/(3 (a + b))
    sigma_y <= sigma_cr < 2 sigma_y:   Mmax = Mel + (Mp - Mel)(sigma_cr - sigma_y)/sigma_y
    otherwise:                         Mmax = Mp = sigma_y Z_pl

with Mel = sigma_y t b (a + b/3).  The bracket is exact for linear stress in thin walls; a_e = a makes it Mel,
so the regimes join.  One convention: a and b are outer dimensions in all of it, Z_pl is the exact one, and
Mel and the first regime are limited to Mp (thick walls would exceed it, since their corners count twice).
Limit: a_e never exceeds a, so first yield is always on the compression side.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum

from crumple.material import Material
from crumple.section import Axis, RectangularTube


class Regime(Enum):
    """Regime in which the compression flange reaches its largest moment."""

    BUCKLES_ELASTICALLY = "the flange buckles before it yields: effective width"
    BUCKLES_PLASTICALLY = "the flange buckles near yield: between first yield and full plasticity"
    FULLY_PLASTIC = "the flange does not buckle before the section is fully plastic"


@dataclass(frozen=True)
class PeakMoment:
    """Largest moment of a tube, with its regime.

    Attributes
    ----------
    moment
        Mmax [N m].
    plastic_moment
        Mp [N m].
    elastic_moment
        Mel, first yield of the unbuckled mid-line section, at most Mp [N m].
    buckling_ratio
        Flange buckling stress over yield stress [-].
    web_buckling_ratio
        The same for the webs in bending [-]; does not enter the moment.
    effective_width
        a_e [m]; the whole width where the flange does not buckle elastically.
    regime
        Which of the three formulas holds.
    """

    moment: float
    plastic_moment: float
    elastic_moment: float
    buckling_ratio: float
    web_buckling_ratio: float
    effective_width: float
    regime: Regime


def peak_moment(section: RectangularTube, material: Material, axis: Axis = "y") -> PeakMoment:
    """Largest bending moment of a rectangular tube.

    Parameters
    ----------
    section
        Tube.
    material
        Yield stress, Young's modulus and Poisson's ratio are used.
    axis
        Axis of bending.

    Returns
    -------
    PeakMoment
        Moment with its intermediate values.

    Notes
    -----
    Considers the flange only: it is too high if deep slender webs buckle.

    References
    ----------
    Regimes and buckling coefficient as quoted from D. Kecman, Int. J. Mech. Sci. 25 (1983) 623-636 (original
    not seen); bracket, Mel and Mp derived.  docs/theory/kecman.md.
    Verified in tests/verification/hinge/test_kecman_peak_moment.py.
    """
    a, b, t = section.flange_width(axis), section.bending_depth(axis), section.thickness
    plastic = material.yield_stress * section.plastic_section_modulus(axis)
    elastic = min(material.yield_stress * t * b * (a + b / 3.0), plastic)
    ratio = _plate_buckling_stress(5.23 + 0.16 * a / b, t / a, material) / material.yield_stress
    # 23.9: plate held at both edges under pure bending
    web_ratio = _plate_buckling_stress(23.9, t / b, material) / material.yield_stress
    effective = a
    if ratio < 1.0:
        effective = a * (0.7 * ratio + 0.3)
        bracket = 2.0 * a + b + effective * (3.0 * a / b + 2.0)
        moment = min(material.yield_stress * t * b**2 * bracket / (3.0 * (a + b)), plastic)
        regime = Regime.BUCKLES_ELASTICALLY
    elif ratio < 2.0:
        moment = elastic + (plastic - elastic) * (ratio - 1.0)
        regime = Regime.BUCKLES_PLASTICALLY
    else:
        moment = plastic
        regime = Regime.FULLY_PLASTIC
    return PeakMoment(moment, plastic, elastic, ratio, web_ratio, effective, regime)


def _plate_buckling_stress(coefficient: float, slenderness: float, material: Material) -> float:
    """Elastic buckling stress [Pa] of a plate; slenderness is thickness over width."""
    bending = math.pi**2 * material.youngs_modulus / (12.0 * (1.0 - material.poissons_ratio**2))
    return coefficient * bending * slenderness**2
