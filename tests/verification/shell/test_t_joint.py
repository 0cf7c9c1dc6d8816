"""Welded T-joint in the plane: a thin face yields below its yield-line bound, a stiff one leaves a beam.

The brace of a T-joint of square tubes is turned at its far end, which is free to move, so the moment is the
same everywhere; the chord's ends are clamped.  With 2 degrees of plastic rotation the moment is at most the
upper bound of limit analysis of the face (docs/theory/t_joint.md), and not more than a fifth below; a rigid
joint would carry three times as much.  With a chord of a metal that is a hundred times stiffer the
flexibility is that of the brace as a beam, within 5 %.

Kind: closed form; closed form.  Source: derived here; textbook.
"""

import math

import numpy as np
import pytest

from crumple.analysis import Analysis, solve
from crumple.errors import Status
from crumple.material import Material
from crumple.section.shapes.rectangular_tube import RectangularTube
from crumple.structure import Structure

STEEL = Material("steel", 210e9, 0.3, 7850.0, 350e6)
SIDE, LENGTH = 0.060, 0.3
BRACE = RectangularTube(width=0.036, depth=0.036, thickness=0.003)


def turned(thickness, turn, duration, size, metal=STEEL):
    """Rotation of the brace's end [rad] and moment [N m]; thickness [m] and metal are the chord's."""
    chord = {"section": "chord", "material": "metal", "up": (0.0, 0.0, 1.0)}
    brace = {"section": "brace", "material": "steel", "up": (0.0, 1.0, 0.0)}
    motion = {"ry": {"havsin": {"x0": 0.0, "h0": 0.0, "x1": duration, "h1": turn}}}
    structure = Structure(
        materials={"steel": STEEL, "metal": metal},
        sections={"chord": RectangularTube(SIDE, SIDE, thickness), "brace": BRACE},
        nodes={
            "left": (-LENGTH, 0.0, 0.0),
            "node": (0.0, 0.0, 0.0),
            "right": (LENGTH, 0.0, 0.0),
            "far": (0.0, 0.0, LENGTH),
        },
        members={
            "first": {"nodes": ("left", "node"), **chord},
            "second": {"nodes": ("node", "right"), **chord},
            "brace": {"nodes": ("node", "far"), **brace},
        },
        supports={
            "left": {"node": "left", "fix": "all"},
            "right": {"node": "right", "fix": "all"},
            "far": {"node": "far", "fix": ["rx", "rz"], "motion": motion},
        },
    )
    shell = {"element_size": size, "t_joints": "welded"}
    outputs = {"every": duration / 200, "nodes": ["far"]}
    given = Analysis(title="T", structure=structure, duration=duration, shell=shell, outputs=outputs)
    result = solve(given, "shell")
    assert result.status is Status.COMPLETE
    return result["node.far.rotation.y"], -result["support.far.moment.y"]


def bound(thickness):
    """Upper bound of limit analysis of the face [N m], with the distances of mid-planes."""
    wide, depth = SIDE - thickness, BRACE.width - BRACE.thickness
    beta = eta = depth / wide
    terms = (2.0 - beta) / (2.0 * eta) + 2.0 / math.sqrt(1.0 - beta) + eta / (1.0 - beta)
    return STEEL.yield_stress * thickness**2 * depth * terms


@pytest.mark.slow
@pytest.mark.parametrize("thickness", [0.003, 0.002])
def test_face_yields_a_little_below_its_bound(thickness):
    rotation, moment = turned(thickness, 0.09, 0.030, 6e-3)
    share = moment / moment.max()
    rise = (share > 0.05) & (share < 0.3) & (np.arange(len(share)) <= share.argmax())
    plastic = rotation - np.polyfit(moment[rise], rotation[rise], 1)[0] * moment
    at = float(np.interp(math.radians(2.0), np.maximum.accumulate(plastic), moment))
    assert 0.8 * bound(thickness) < at < bound(thickness)


def test_stiff_face_leaves_the_flexibility_of_the_brace():
    thickness = 0.006
    # as heavy as stiff, so that waves are as fast
    stiff = Material("stiff", 100 * 210e9, 0.3, 100 * 7850.0, 350e9)
    rotation, moment = turned(thickness, 0.008, 0.030, 9e-3, stiff)
    length = LENGTH - (SIDE - thickness) / 2
    beam = length / (STEEL.youngs_modulus * BRACE.second_moment("y"))
    assert rotation @ moment / (moment @ moment) == pytest.approx(beam, rel=0.05)
