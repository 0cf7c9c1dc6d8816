"""Mass added at the small elements of a mitre: the law of the corner stays, in far fewer steps.

Corner of 90 deg of two tubes 50x50x3 mm (350 MPa), coarse mesh (3 elements along half a fold), closed,
opened and turned about its tangent: plastic work with the added mass against that without it, 1 %.

Kind: independent calculation.  Source: derived here.
"""

import math

import pytest

from crumple.analysis import solve
from crumple.characterisation import Bending, OutOfPlane
from crumple.characterisation.resolution import Resolution
from crumple.characterisation.solving import kinetic_share
from crumple.material import Material
from crumple.section import RectangularTube

pytestmark = pytest.mark.slow

TUBE = RectangularTube(0.050, 0.050, 0.003)
STEEL = Material("steel", 210e9, 0.3, 7850.0, 350e6)
COARSE = {"largest": math.radians(20.0), "resolution": Resolution(3.0, 7.0)}
AT = [math.radians(angle) for angle in (2.0, 5.0, 10.0, 19.0)]
RIGHT_ANGLE = math.pi / 2
CORNERS = {
    "closing": Bending(TUBE, STEEL, "y", 1, RIGHT_ANGLE, **COARSE),
    "opening": Bending(TUBE, STEEL, "y", -1, RIGHT_ANGLE, **COARSE),
    "tangent": OutOfPlane(TUBE, STEEL, "y", RIGHT_ANGLE, "tangent", **COARSE),
}


@pytest.mark.parametrize("how", CORNERS)
def test_work_of_a_corner_with_added_mass(how, record_figure):
    model = CORNERS[how]
    scaled = model.analysis()
    alone = scaled.model_copy(update={"shell": scaled.shell.model_copy(update={"mass_scaling": None})})
    runs = [solve(one, "shell", threads=1) for one in (alone, scaled)]
    usual, found = (model.curve(run) for run in runs)
    steps = [run.provenance.settings["steps"] for run in runs]
    assert runs[1].provenance.settings["added_mass"] > 0.0
    assert steps[1] < 0.7 * steps[0]
    assert kinetic_share(runs[1], found.energy_at(model.watched_from)) < 0.02
    for at in AT:
        expected = usual.energy_at(at)
        record_figure(
            f"work of a corner ({how}) to {math.degrees(at):.0f} deg",
            found.energy_at(at),
            expected,
            0.01,
            "J",
            relative=True,
        )
