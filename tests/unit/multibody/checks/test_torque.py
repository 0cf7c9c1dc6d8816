"""Hinges that cannot twist and carry more torque than the section of their member."""

import math

import pytest

from crumple.multibody import Run, solve_multibody
from crumple.structure import MultibodySettings, Structure

ARM, YIELD = 0.5, 300e6
TUBE = {"type": "square_tube", "side": 0.045, "thickness": 0.003}
TORQUE = 2.0 * 0.042**2 * 0.003 * YIELD / math.sqrt(3.0)
"""Plastic torque by Bredt: 2 A t s_y/sqrt(3) [N m]."""


def crank(torque, section=TUBE, more=(), **hinge):
    """A clamped shaft along x with a hinge near the clamp, and an arm across its end with a force along z."""
    hinge = {
        "name": "root",
        "at": 0.1,
        "law": {"type": "constant", "moment": 1e5},
        "coupling": "none",
    } | hinge
    shaft = {"nodes": ("clamp", "end"), "section": "tube", "material": "steel"}
    return Structure(
        materials={
            "steel": {
                "youngs_modulus": 210e9,
                "poissons_ratio": 0.3,
                "density": 7850.0,
                "yield_stress": YIELD,
            }
        },
        sections={"tube": section},
        nodes={"clamp": (0.0, 0.0, 0.0), "end": (0.6, 0.0, 0.0), "tip": (0.6, ARM, 0.0)},
        members={
            "shaft": shaft | {"hinges": [hinge, *(hinge | one for one in more)]},
            "arm": shaft | {"nodes": ("end", "tip"), "rigid": True},
        },
        supports={"clamp": {"node": "clamp", "fix": "all"}},
        loads=[
            {"node": "tip", "force": {"z": {"step": {"x0": -1e-3, "h0": 0.0, "x1": 0.0, "h1": torque / ARM}}}}
        ],
    )


def found(structure, **settings):
    result = solve_multibody(structure, Run(0.01, 0.001, MultibodySettings(kernel="spatial", **settings)))
    assert result.status.ok
    return [c for c in result.cautions if c.code == "torque_without_twist"], result


def test_a_torque_beyond_the_plastic_one_is_a_caution():
    (caution,), result = found(crank(1.5 * TORQUE, axes=("y", "z")))
    assert caution.place == "member shaft"
    assert caution.limit == pytest.approx(TORQUE, rel=1e-9)
    assert caution.value == pytest.approx(1.5 * TORQUE, rel=1e-6)
    (sentence,) = (text for text in result.warnings if "cannot twist" in text)
    assert sentence.startswith("Member shaft carries up to 1.5 times the plastic torque of its section")
    assert not caution.violation


def test_a_torque_below_it_gives_none():
    assert not found(crank(0.99 * TORQUE, axes=("y", "z")))[0]


def test_members_that_twist_at_a_hinge_and_elastic_ones_give_none():
    assert not found(crank(1.1 * TORQUE, axes=("y", "z", "x")))[0]
    # the shaft between both hinges adds its inertia to the torque at the root
    other = {"name": "other", "at": 0.5, "axes": ("y", "z", "x")}
    assert not found(crank(3.0 * TORQUE, axes=("y", "z"), more=[other]))[0]
    assert not found(crank(1.1 * TORQUE, axes=("y", "z")), members="elastic")[0]


def test_an_open_section_carries_the_torque_of_its_walls_and_of_the_warping_that_its_ends_hold():
    """Mid-lines b = 38.5, h = 77 mm: B_p = s_y t h (b^2/2 - x^2), x = b/2 - h/8."""
    channel = {"type": "channel", "width": 0.04, "depth": 0.08, "thickness": 0.003}
    t, b, h = 0.003, 0.0385, 0.077
    bimoment = YIELD * t * h * (b**2 / 2.0 - (b / 2.0 - h / 8.0) ** 2)
    limit = (2.0 * b + h) * t**2 / 2.0 * YIELD / math.sqrt(3.0) + 2.0 * bimoment / 0.6
    (caution,), _ = found(crank(1.2 * limit, channel, axes=("y", "z")))
    assert caution.limit == pytest.approx(limit, rel=0.02)
    assert not found(crank(0.9 * limit, channel, axes=("y", "z")))[0]
