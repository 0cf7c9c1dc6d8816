"""Range of validity of the Kecman-type law of a tube.

One comparison exists: solid finite elements of the 50x25x2.65 mm tube bent about its weak axis (flange 50
mm, yield 488 MPa, perfectly plastic, sharp corners), to 42 deg.  With full rolling weight the law's moment
lay 2 to 20 % above them, its energy 6 to 11 % above; with weight 0 the energy lay 3 % above to 9 % below.
One mesh, no convergence study.
"""

from __future__ import annotations

import numpy as np

from crumple.hinge.bending.kecman_mechanism import FoldMechanism
from crumple.hinge.bending.largest_moment import PeakMoment, Regime
from crumple.hinge.law import Validity
from crumple.hinge.rate import rate_warnings
from crumple.material import Material
from crumple.section import Axis, RectangularTube

CHECKED_TO = float(np.radians(42.0))
CHECKED_WIDTH_TO_THICKNESS = 50.0 / 2.65
CHECKED_WIDTH_TO_DEPTH = 2.0
# Largest moment difference seen on the checked tube, at 42 deg.
CHECKED_DIFFERENCE = 0.20
# Proportions within 10 % of the checked tube count as those of the checked tube.
SAME_PROPORTIONS = 0.10
# In finite elements, flanges thicker than this stayed on their plateau longer than in the law.
STOCKY_WIDTH_TO_THICKNESS = 12.0
# Share of a ratio of two decimal lengths that is rounding: 36 mm over 3 mm is 11.999999999999998.
ROUNDING = 1e-9
# Range of the tests with which the mechanism was first compared.
TESTED_WIDTH_TO_THICKNESS = (9.14, 128.0)
TESTED_WIDTH_TO_DEPTH = (0.33, 3.0)


def kecman_validity(
    section: RectangularTube, material: Material, axis: Axis, peak: PeakMoment, mechanism: FoldMechanism
) -> Validity:
    """Range of the law of a tube, with one warning for each condition that is not met."""
    a, b, t = section.flange_width(axis), section.bending_depth(axis), section.thickness
    same = (
        abs(a / t / CHECKED_WIDTH_TO_THICKNESS - 1.0) <= SAME_PROPORTIONS
        and abs(a / b / CHECKED_WIDTH_TO_DEPTH - 1.0) <= SAME_PROPORTIONS
        and peak.regime is Regime.FULLY_PLASTIC
    )
    subject = "a tube of these proportions" if same else "one tube of other proportions (a/t 18.9, a/b 2)"
    basis = (
        f"validated by finite elements of {subject} up to 42 deg"
        f"; its walls touch at {np.degrees(mechanism.jamming_angle):.1f} deg, "
        "and the behaviour beyond is a model without a source"
    )
    warnings = (*_proportion_warnings(a, b, t), *_other_warnings(section, material, peak))
    return Validity(
        min(CHECKED_TO, mechanism.jamming_angle), basis, warnings, CHECKED_DIFFERENCE if same else None
    )


def _proportion_warnings(a: float, b: float, t: float) -> list[str]:
    warnings = []
    if a / t < STOCKY_WIDTH_TO_THICKNESS * (1.0 - ROUNDING):
        warnings.append(
            f"thick flange (a/t = {a / t:.1f} < 12): finite elements of such tubes stayed near their "
            "largest moment longer than the law"
        )
    low, high = TESTED_WIDTH_TO_THICKNESS
    if not low <= a / t <= high:
        warnings.append(f"a/t = {a / t:.1f} is outside the range of Kecman's tests, {low:g} to {high:g}")
    low, high = TESTED_WIDTH_TO_DEPTH
    if not low <= a / b <= high:
        warnings.append(f"a/b = {a / b:.2f} is outside the range of Kecman's tests, {low:g} to {high:g}")
    return warnings


def _other_warnings(section: RectangularTube, material: Material, peak: PeakMoment) -> list[str]:
    warnings = []
    if peak.regime is not Regime.FULLY_PLASTIC:
        warnings.append(
            f"the compressed wall is slender (it buckles elastically at {peak.buckling_ratio:.2f} times the "
            "yield stress; below 2 times it the law lowers the largest moment, here to "
            f"{peak.moment / peak.plastic_moment:.0%} of the plastic one), and that was not compared with "
            "finite elements"
        )
    if peak.web_buckling_ratio < 2.0:
        warnings.append(
            f"slender webs (buckling at {peak.web_buckling_ratio:.2f} times yield): the largest moment "
            "considers the flange only and is too high"
        )
    if section.corner_radius > 0.0:
        warnings.append(
            "rounded corners are included in the plastic moment only: the mechanism has sharp corners"
        )
    return [*warnings, *rate_warnings(material)]
