"""The rate law of a fold, found at one speed, gives the work of its sub-model at another.

Tubes of 488 MPa with a Cowper-Symonds law (40.4 1/s, 5) on coarse meshes (4 elements along half a fold), bent
and twisted: the law comes from the work up to 30 degrees at the usual speed of the sub-model (20 to 50
rad/s), and predicts the work at three times this speed within 5 %.

Kind: invariant.  Source: derived here.
"""

import pytest

from crumple.characterisation import Bending, Torsion, characterise
from crumple.characterisation.resolution import Resolution
from crumple.material import CowperSymonds, Material
from crumple.section import RectangularTube

STEEL = Material("steel", 210e9, 0.3, 7850.0, 488e6, flow_rate=CowperSymonds(40.4, 5.0))
TUBE = RectangularTube(width=0.050, depth=0.025, thickness=0.00265)
THIN = RectangularTube(width=0.050, depth=0.050, thickness=0.0015)
COARSE = Resolution(4.0, 7.0)
MODELS = {
    "bent": Bending(TUBE, STEEL, resolution=COARSE),
    "thin, bent": Bending(THIN, STEEL, resolution=COARSE),
    "thin, twisted": Torsion(THIN, STEEL, resolution=COARSE),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", MODELS)
def test_work_at_three_times_the_speed(name, record_figure):
    law = characterise(MODELS[name]).law
    assert law.rate is not None
    off = float(dict(law.origin)["rate"].split("differs by ")[1].split(" %")[0])
    record_figure(f"difference of the work, {name}", off, 0.0, 5.0, "%")
