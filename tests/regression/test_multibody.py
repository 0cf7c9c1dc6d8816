"""Our own past figures of the multibody answer: example 01's tube in every form, and a struck chain.

No external source confirms these values; tests/verification does that. A change of the method may move
them by its accuracy, which is the tolerance; more than that wants a reason.
"""

import pytest
from tests.support.structures import cantilever

from crumple.multibody import Run, solve_multibody

THROWN = [{"rotation": 15.0, "axis": (0.0, -1.0, 0.0)}]
# form: rotation [rad], time of rest [s], absorbed energy [J]
TUBE = {
    "set-valued": (-0.544891, 0.0801595, 783.749),
    "elastic-plastic": (-0.567953, 0.0803590, 759.190),
    "regularised": (-0.544896, 0.079875, 783.749),
}
# rotations [rad] of a chain of four bars with 2 kg at its tip, struck there by 40 N s
CHAIN = {"root": 0.14073, "tube-1": 0.01733, "tube-2": 0.02058, "tube-3": 0.03290}


@pytest.mark.parametrize("form", TUBE)
def test_tube(form):
    structure = cantilever({"type": "kecman", "form": form}, initial_velocity=THROWN)
    hinge = solve_multibody(structure, Run(0.1, 0.0005)).hinges["root"]
    rotation, rest, energy = TUBE[form]
    assert hinge.rotation_max == pytest.approx(-rotation, rel=1e-3)
    assert hinge.time_of_rest == pytest.approx(rest, abs=3e-4)
    assert hinge.energy == pytest.approx(energy, rel=1e-3)


def test_chain():
    blow = [{"node": "tip", "impulse": (0.0, 0.0, 40.0)}]
    structure = cantilever({"type": "kecman"}, payload=2.0, bars=4, impulses=blow)
    hinges = solve_multibody(structure, Run(0.1, 0.0005)).hinges
    for name, rotation in CHAIN.items():
        assert hinges[name].rotation_max == pytest.approx(rotation, abs=3e-4), name
