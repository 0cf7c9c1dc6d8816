"""Rigid hinges beside an elastic-plastic one need no more Newton steps than rigid hinges alone."""

from crumple import loads, solve

CHAIN = """crumple: 1
materials:
  steel: {youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: 400 MPa}
sections:
  tube: {type: rectangular_tube, width: 50 mm, depth: 30 mm, thickness: 2 mm}
nodes:
  a: [0 m, 0 m, 0 m]
  b: [0.5 m, 0 m, 0 m]
  c: [1 m, 0 m, 0.1 m]
members:
  one: {nodes: [a, b], section: tube, material: steel, bars: {number: 20, axes: [y, z], law: constant}}
  two: {nodes: [b, c], section: tube, material: steel, hinges: [{name: h, at: 100 mm, axis: y, law: FORM}]}
hinge_laws:
  rigid: {type: constant}
  elastic: {type: constant, form: elastic-plastic}
supports:
  clamp: {node: a, fix: all}
masses:
  m: {node: c, mass: 5 kg}
impulses: [{node: c, impulse: [10 N*s, 5 N*s, 20 N*s]}]
analysis: {duration: 1 ms, multibody: {mechanism_check: off}}
"""


def newton_steps(law):
    result = solve(loads(CHAIN.replace("FORM", law)))
    assert result.status.ok
    return result.provenance.settings["newton_steps"]


def test_one_elastic_hinge_does_not_slow_the_rigid_ones_down():
    assert newton_steps("elastic") < newton_steps("rigid")
