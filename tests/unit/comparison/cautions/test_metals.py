"""A comparison says where its shells yield at a higher stress from the start than the laws of its hinges."""

from dataclasses import replace

import pytest

from crumple.analysis import loads, solve
from crumple.comparison import compare, with_frames

TUBE = """crumple: 1
materials: {steel: METAL}
sections: {tube: {type: square_tube, side: 50 mm, thickness: 2 mm}}
nodes: {root: [0 m, 0 m, 0 m], tip: [1 m, 0 m, 0 m]}
members: {arm: {nodes: [root, tip], section: tube, material: steel}}
hinges: auto
supports: {clamp: {node: root, fix: all}}
masses: {m: {node: tip, mass: 5 kg}}
initial_velocity: [{rotation: 1 rad/s, axis: [0, -1, 0]}]
analysis: {duration: 2 ms}
outputs: {every: 1 ms}
"""
PLAIN = "youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: 350 MPa"
METALS = {
    "grade": ("{grade: S355}", False),
    "grade with a constant stress": ("{grade: S355, flow_stress: 412 MPa}", True),
    "flow stress": (f"{{{PLAIN}, flow_stress: 400 MPa}}", True),
    "perfectly plastic": (f"{{{PLAIN}}}", False),
    "hardening": (f"{{{PLAIN}, hardening: {{type: swift, prestrain: 0.01, exponent: 0.1}}}}", False),
}


@pytest.mark.parametrize("metal", list(METALS))
@pytest.mark.parametrize("fidelity", ["shell", "multibody"])
def test_a_flow_stress_without_a_curve_is_a_caution(metal, fidelity):
    keys, differs = METALS[metal]
    analysis = loads(TUBE.replace("METAL", keys))
    result = solve(with_frames(analysis), "multibody", checks=False)
    trust = compare(result, replace(result, fidelity=fidelity), analysis.structure).trust
    said = [text for text in trust.cautions if "perfectly plastic at its flow stress" in text]
    assert bool(said) == (differs and fidelity == "shell")
    if said and metal == "flow stress":
        assert "400 MPa" in said[0]
        assert "350 MPa" in said[0]
        assert "up to 14 %" in said[0]
