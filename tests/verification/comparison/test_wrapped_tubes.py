"""Round tubes that bend around a pole, or fold under it, against shells.

Tubes between two pivots a half span from the middle each, pushed there at 3 m/s by a pole without friction
(4.5 elements along half a fold, solved once by this program): moment [N m] at 10, 20 and 28 degrees of
rotation, force times half the distance of the pivots from the ends of the arc that touches the pole.  The
criterion was found on the first four that are named in docs/theory/dents.md; its threshold lies in the gap
between those of the nine that wrap and those that do not.

Kind: independent calculation.  Source: run here.
"""

import math

import numpy as np
import pytest

from crumple.hinge import build_law
from crumple.hinge.bending.dented import WrappedLaw, wraps
from crumple.material import Material
from crumple.material.hardening.voce import Voce
from crumple.section import CircularTube, half_fold_length

DEGREES = (10.0, 20.0, 28.0)
# diameter, wall [mm]; yield stress [MPa]; Voce's saturation [MPa] and strain; radius of the pole [mm]; shells
WRAPPED = [
    (35, 2.8, 600, None, 127, (1673, 1634, 1571)),
    (35, 2.8, 600, (300, 0.03), 127, (2050, 2163, 2190)),
    (38, 2.5, 450, (150, 0.04), 150, (1548, 1569, 1574)),
    (42.4, 3.2, 350, None, 127, (1683, 1584, 1511)),
    (30, 2.5, 900, None, 127, (1637, 1593, 1568)),
]
FOLDED = [
    (35, 2.8, 600, None, 25, (1557, 1420, 1283)),
    (50, 3.0, 350, None, 127, (2230, 1669, 1427)),
    (60, 2.0, 350, None, 127, (1515, 1069, 902)),
    (48.3, 2.6, 355, None, 150, (1840, 1297, 1153)),
]


def law_and_most(diameter, wall, stress, voce, radius):
    """Law of one fold, and the rotation at which it has the curvature of the pole."""
    tube = CircularTube(diameter / 1e3, wall / 1e3)
    curve = Voce(1e6 * stress, 1e6 * voce[0], voce[1]) if voce else None
    metal = Material("metal", 210e9, 0.3, 7850.0, 1e6 * stress, hardening=curve)
    most = 2.0 * half_fold_length(tube, "y") / (radius / 1e3 + diameter / 2e3)
    return build_law("auto", tube, metal, "y"), most


@pytest.mark.parametrize("case", WRAPPED)
def test_a_thick_tube_bends_around_a_wide_pole(case, record_figure):
    *tube, shells = case
    diameter, wall, _, voce, radius = tube
    law, most = law_and_most(*tube)
    assert wraps(law, most, 1)
    wrapped = WrappedLaw(law, most)
    for degrees, expected in zip(DEGREES, shells, strict=True):
        found = float(wrapped.moment_capacity(math.radians(degrees)))
        hardens = ", hardens" if voce else ""
        what = f"round {diameter}x{wall} mm{hardens}, pole {radius} mm, moment at {degrees:g} deg"
        record_figure(what, found, expected, 0.15, "N m", relative=True)
    # and one fold alone would carry much less at the end
    alone = float(law.moment_capacity(math.radians(45.0)))
    assert alone < 0.85 * float(wrapped.moment_capacity(math.radians(45.0)))


@pytest.mark.parametrize("case", FOLDED)
def test_a_tube_that_softens_before_folds_in_one_place(case):
    *tube, shells = case
    law, most = law_and_most(*tube)
    assert not wraps(law, most, 1)
    assert shells[2] < 0.83 * shells[0]
    found = law.moment_capacity(np.radians(DEGREES))
    np.testing.assert_allclose(found, shells, rtol=0.25)
