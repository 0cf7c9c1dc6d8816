"""Parkes (1955): rigid-plastic cantilever struck at its tip.

A cantilever of length L, mass m per length and moment M_p carries a mass G = gamma m L at its tip, which
starts with V0.  For small deflections the final deflection of the tip is

    G^2 V0^2/(3 m M_p) [2 ln(1 + 1/(2 gamma)) + 1/(1 + 2 gamma)]   after   G V0 L/M_p.

A chain of N rigid bars converges to it from above.  Figures of a separate code run to 1e-3: gamma = 1, +3.6
% at N = 10 and +1.7 % at N = 40; gamma = 10, +0.32 % and +0.13 %; they are reproduced within 1e-3 and their
rounding.  The deflection is a thousandth of the length (finite rotations contribute 1e-6), the section is
so small that its rotary inertia is 2e-3 of that of a bar, and the motion lasts 10 ms, so that locked hinges
do not creep.

Kind: published; independent calculation.  Source: quoted; derived here.
"""

import math
from itertools import pairwise

import pytest
from tests.support.structures import STEEL, constant_law

from crumple.multibody import Run, solve_multibody
from crumple.structure import MultibodySettings, Outputs, Structure

LENGTH, DURATION, DEFLECTION = 10.0, 0.010, 0.010
SECTION = {"type": "circular_tube", "diameter": 0.010, "thickness": 0.001}
MASS_PER_LENGTH = 7850.0 * math.pi / 4 * (0.010**2 - 0.008**2)


def struck(gamma, bars):
    """Cantilever whose closed form gives the deflection and duration above, and its initial speed."""
    bracket = 2 * math.log(1 + 1 / (2 * gamma)) + 1 / (1 + 2 * gamma)
    moment = 3 * MASS_PER_LENGTH * LENGTH**2 * DEFLECTION / (DURATION**2 * bracket)
    tip = gamma * MASS_PER_LENGTH * LENGTH
    speed = DURATION * moment / (tip * LENGTH)
    law = constant_law(moment)
    structure = Structure(
        materials={"steel": STEEL},
        sections={"rod": SECTION},
        nodes={"root": (0.0, 0.0, 0.0), "tip": (LENGTH, 0.0, 0.0)},
        members={
            "beam": {
                "nodes": ("root", "tip"),
                "section": "rod",
                "material": "steel",
                "bars": {"number": bars, "law": law},
                "hinges": [{"name": "root", "at": "root", "offset": 0.0, "law": law}],
            }
        },
        supports={"clamp": {"node": "root", "fix": "all"}},
        masses={"tip": {"node": "tip", "mass": tip}},
        initial_velocity=[{"translation": (0.0, 0.0, speed), "nodes": ("tip",)}],
    )
    return structure, tip * speed**2 / 2


def excess(gamma, bars):
    """How far tip deflection and duration of the chain lie above the closed forms, as fractions."""
    structure, energy = struck(gamma, bars)
    run = Run(1.5 * DURATION, DURATION / 20, MultibodySettings(accuracy=1e-4), Outputs(nodes=("tip",)))
    result = solve_multibody(structure, run)
    assert result.status.ok
    assert result.energy_residual < 1e-8
    # the last bar takes part at once, so the chain starts with somewhat less than the mass was given
    assert 0.9 * energy < result["energy.kinetic"][0] < energy
    rest = max(hinge.time_of_rest for hinge in result.hinges.values())
    return result["node.tip.displacement.z"][-1] / DEFLECTION - 1, rest / DURATION - 1


@pytest.mark.parametrize(
    ("gamma", "bars", "figure"), [(1, 10, 3.6), (1, 40, 1.7), (10, 10, 0.32), (10, 40, 0.13)]
)
def test_tip_deflection(gamma, bars, figure, record_figure):
    deflection, duration = excess(gamma, bars)
    name = f"gamma {gamma}, {bars} bars"
    record_figure(f"excess of the deflection, {name}", 100 * deflection, figure, 0.1 + 0.05 / gamma, "%")
    # the duration follows the impulse: half of the deflection's excess or less
    record_figure(f"excess of the duration, {name}", 100 * duration, 0.0, 60 * deflection, "%")


def test_converges_from_above():
    found = [excess(1, bars)[0] for bars in (10, 20, 40, 80)]
    assert found == sorted(found, reverse=True)
    assert found[-1] > 0
    # the order grows towards one as the bars become short against the length that moves at first
    ratios = [a / b for a, b in pairwise(found)]
    assert ratios == sorted(ratios)
    assert ratios[-1] > 1.5
