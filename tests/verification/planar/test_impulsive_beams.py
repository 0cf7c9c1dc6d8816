"""Rigid-plastic beams of span 2L under a uniform impulse, simply supported and clamped.

For small deflections a beam with mass m per length, moment M_p and uniform initial velocity V0 has the
final mid deflection m V0^2 L^2/(3 M_p) after m V0 L^2/(2 M_p) if simply supported, and m V0^2 L^2/(6 M_p)
after m V0 L^2/(4 M_p) if clamped.  Hinges travel from the supports to the middle at first, which a chain of
bars follows from bar to bar: it converges from above, the faster the shorter the bars (the order tends to
one, as in Parkes' problem).  One end may slide along the beam, so that the deflection needs no stretching.
The deflection is a five-hundredth of half the span, and the section so small that its rotary inertia is
negligible.

Kind: closed form.  Source: textbook.
"""

import math
from itertools import pairwise

import pytest
from tests.support.structures import STEEL, constant_law

from crumple.multibody import Run, solve_multibody
from crumple.structure import MultibodySettings, Outputs, Structure

HALF, DURATION, DEFLECTION = 5.0, 0.010, 0.010
SECTION = {"type": "circular_tube", "diameter": 0.010, "thickness": 0.001}
MASS_PER_LENGTH = 7850.0 * math.pi / 4 * (0.010**2 - 0.008**2)
SHARES = {"simple": (1 / 3, 1 / 2), "clamped": (1 / 6, 1 / 4)}
"""Deflection over m V0^2 L^2/M_p and duration over m V0 L^2/M_p."""


def beam(kind, bars):
    """Beam of an even number of bars whose closed form gives the deflection and duration above."""
    deflection, duration = SHARES[kind]
    speed = DEFLECTION / DURATION * duration / deflection
    moment = duration * MASS_PER_LENGTH * speed * HALF**2 / DURATION
    law = constant_law(moment)
    ends = (
        [] if kind == "simple" else [{"name": side, "at": side, "offset": 0.0, "law": law} for side in "ab"]
    )
    half = {"section": "rod", "material": "steel", "bars": {"number": bars // 2, "law": law}}
    structure = Structure(
        materials={"steel": STEEL},
        sections={"rod": SECTION},
        nodes={"a": (-HALF, 0.0, 0.0), "m": (0.0, 0.0, 0.0), "b": (HALF, 0.0, 0.0)},
        members={
            "left": {**half, "nodes": ("a", "m"), "hinges": ends[:1]},
            "right": {
                **half,
                "nodes": ("m", "b"),
                "hinges": [{"name": "middle", "at": "m", "offset": 0.0, "law": law}, *ends[1:]],
            },
        },
        supports={
            "left": {"node": "a", "fix": "pin" if kind == "simple" else "all"},
            "right": {"node": "b", "fix": ("y", "z") if kind == "simple" else ("y", "z", "rx", "ry", "rz")},
        },
        # the clamp that slides needs some inertia along the beam
        masses={}
        if kind == "simple"
        else {"shoe": {"node": "b", "mass": 1e-3, "rotary_inertia": (1e-6,) * 3}},
        initial_velocity=[{"translation": (0.0, 0.0, speed), "members": ("left", "right")}],
    )
    return structure


def found(kind, bars):
    """Mid deflection and duration over their closed forms, less 1."""
    run = Run(1.5 * DURATION, DURATION / 20, MultibodySettings(accuracy=1e-4), Outputs(nodes=("m",)))
    result = solve_multibody(beam(kind, bars), run)
    assert result.status.ok, result.reason
    rest = max(hinge.time_of_rest for hinge in result.hinges.values())
    return result["node.m.displacement.z"][-1] / DEFLECTION - 1, rest / DURATION - 1


@pytest.mark.parametrize("kind", SHARES)
def test_converges_to_the_beam(kind, record_figure):
    excess = [found(kind, bars) for bars in (8, 16, 32, 64)]
    ratios = [coarse[0] / fine[0] for coarse, fine in pairwise(excess)]
    assert ratios == sorted(ratios)
    assert ratios[0] > 1.2
    assert ratios[-1] > 1.5
    deflection, duration = (100 * value for value in excess[-1])
    # at the last ratio but one half of what is left goes with each doubling: 3.0 % and 2.7 % found
    record_figure(f"{kind}, excess of the mid deflection, 64 bars", deflection, 0.0, 3.5, "%")
    record_figure(f"{kind}, excess of the duration, 64 bars", duration, 0.0, 1.5, "%")
