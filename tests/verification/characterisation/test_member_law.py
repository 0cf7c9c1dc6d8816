"""The law of a fold does not depend on how the sub-model is cut or how slowly it is turned.

The tube of example 01 on a coarse mesh (4 elements along half a fold): the plastic work between the
planes of measurement at 5, 10, 20 and 30 degrees of plastic rotation, from a sub-model of the usual
length, from one 1.5 times as long, and from one that is turned twice as slowly; likewise for a right-
angled corner that closes, with stubs 1.9 times as long beyond the planes. Tolerance: 3 %. The moment at
the start of the law is the plastic moment of the section, whose walls have not buckled by then: flow
stress times the plastic section modulus, within 3 %, since Poisson's contraction is restrained across the
flanges.

Kind: invariant; closed form.  Source: derived here; textbook.
"""

import math

import pytest

from crumple.characterisation import Bending, LawCurve, characterise
from crumple.characterisation.resolution import Resolution
from crumple.material import Material
from crumple.section.shapes.rectangular_tube import RectangularTube

STEEL = Material("steel", 210e9, 0.3, 7850.0, 488e6)
TUBE = RectangularTube(width=0.050, depth=0.025, thickness=0.00265)


def curve_of(length_factor: float = 1.0, slowness: float = 7.0) -> LawCurve:
    model = Bending(TUBE, STEEL, length_factor=length_factor, resolution=Resolution(4.0, slowness))
    return characterise(model).curve


@pytest.fixture(scope="module")
def usual() -> LawCurve:
    return curve_of()


@pytest.mark.slow
@pytest.mark.parametrize(
    ("what", "other"),
    [("1.5 times as long", {"length_factor": 1.9}), ("twice as slow", {"slowness": 14.0})],
)
def test_work_is_that_of_another_sub_model(what, other, usual, record_figure):
    curve = curve_of(**other)
    for degrees in (5, 10, 20, 30):
        at = math.radians(degrees)
        record_figure(
            f"work at {degrees} deg, {what}",
            curve.energy_at(at),
            usual.energy_at(at),
            0.03,
            "J",
            relative=True,
        )


@pytest.mark.slow
def test_work_of_a_corner_is_that_of_longer_stubs(record_figure):
    one, other = (
        characterise(
            Bending(
                TUBE, STEEL, angle=math.radians(90.0), length_factor=factor, resolution=Resolution(4.0, 7.0)
            )
        ).curve
        for factor in (1.0, 1.9)
    )
    for degrees in (5, 10, 20, 30):
        at = math.radians(degrees)
        record_figure(
            f"corner, work at {degrees} deg", other.energy_at(at), one.energy_at(at), 0.03, "J", relative=True
        )
    # the walls of a mitre give way far below the plastic moment of the section
    assert one.moment.max() < 0.6 * STEEL.yield_stress * TUBE.plastic_section_modulus("y")


def test_law_starts_with_the_plastic_moment(usual, record_figure):
    plastic = STEEL.yield_stress * TUBE.plastic_section_modulus("y")
    record_figure("moment at 1 deg", usual.moment_at(math.radians(1.0)), plastic, 0.03, "N m", relative=True)
    assert usual.moment_at(math.radians(30.0)) < 0.65 * plastic
