"""Given motion that is lost at the start: members that keep their length are named where it changes it."""

import pytest

from crumple.analysis import loads, solve
from crumple.multibody.bodies.initial_motion import stretched

TEXT = """crumple: 1
materials: {s: {youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: 355 MPa}}
sections: {c: {type: square_tube, side: 40 mm, thickness: 2 mm}}
nodes: {a: [0 m, 0 m, 0 m], b: [0.3 m, 0 m, 0.4 m]}
members: {leg: {nodes: [a, b], section: c, material: s}}
hinges: HINGES
supports: {clamp: {node: a, fix: all}}
masses: {m: {node: b, mass: 10 kg}}
initial_velocity: [{nodes: [b], translation: [5 m/s, 0 m/s, 0 m/s]}]
analysis: {duration: 1 ms, multibody: {members: KIND}}
"""


def lost(hinges, kind):
    """Kinetic energy at the start [J], and the warnings of motion that is lost."""
    result = solve(loads(TEXT.replace("HINGES", hinges).replace("KIND", kind)))
    assert result.status.ok, result.reason
    return float(result["energy.kinetic"][0]), [text for text in result.warnings if "is lost" in text]


@pytest.mark.parametrize("kind", ["elastic", "rigid"])
def test_a_mass_thrown_along_a_member_that_keeps_its_length_names_it(kind):
    """Of 5 m/s along x 3 m/s are along the leg: 0.36 of 125 J, and the mass of the leg, are lost."""
    energy, (text,) = lost("{axial: false}", kind)
    assert energy == pytest.approx(0.64 * 125.0, rel=0.08)
    said = (
        "Member leg keeps the length, elastic or not, and the motion moves its ends relative to each other by"
    )
    assert said in text
    assert "3 m/s along the axis: give the hinges 'axial: true'" in text


def test_nothing_is_lost_if_its_hinges_yield_along_it():
    energy, texts = lost("{axial: true}", "elastic")
    assert texts == []
    assert energy == pytest.approx(125.0, rel=0.05)


@pytest.mark.parametrize(
    ("motion", "fix", "rates"),
    [
        ("[5 m/s, 0 m/s, 0 m/s]", "all", {"leg": 3.0}),
        ("[-5 m/s, 0 m/s, 0 m/s]", "[x, y, z]", {"leg": -3.0}),
        # across the leg, and where the other end is free to follow
        ("[4 m/s, 0 m/s, -3 m/s]", "all", {}),
        ("[5 m/s, 0 m/s, 0 m/s]", "[y, z, rx, ry, rz]", {}),
    ],
)
def test_the_rate_is_that_between_masses_and_supports_that_hold(motion, fix, rates):
    text = TEXT.replace("[5 m/s, 0 m/s, 0 m/s]", motion).replace("fix: all", f"fix: {fix}")
    whole = loads(text.replace("HINGES", "{axial: false}").replace("KIND", "rigid")).structure
    assert stretched(whole, whole.initial_velocity) == pytest.approx(rates)
