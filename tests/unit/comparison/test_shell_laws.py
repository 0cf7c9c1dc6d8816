"""The model with the laws of the shells differs from elastic members in its laws alone."""

import numpy as np

from crumple.analysis import loads
from crumple.comparison.measure.motion import HingeMotion
from crumple.comparison.variant import SHELL_LAWS, variants_of
from crumple.structure import plastic_hinges, with_elastic_members

TIME = np.linspace(0.0, 1.0, 50)
FRAME = """crumple: 1
materials:
  steel: {youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: 300 MPa}
sections: {tube: {type: circular_tube, diameter: 40 mm, thickness: 2 mm}}
nodes: {root: [0 m, 0 m, 0 m], knee: [0 m, 0 m, 0.5 m], tip: [0 m, 0.5 m, 0.5 m]}
members:
  post: {nodes: [root, knee], section: tube, material: steel}
  arm: {nodes: [knee, tip], section: tube, material: steel}
hinges: {axes: [y, z]}
supports: {clamp: {node: root, fix: all}}
masses: {load: {node: tip, mass: 20 kg}, bracket: {node: knee, mass: 1 kg}}
initial_velocity: [{nodes: [tip], translation: [5 m/s, 0 m/s, -3 m/s]}]
analysis: {duration: 20 ms}
"""


def test_hinges_also_twist_as_those_of_elastic_members():
    analysis = loads(FRAME)
    turned = 0.3 * TIME
    folds = [
        HingeMotion(name, "post", 0.03, TIME, turned, turned, turned, 1e3 + 0.0 * TIME, 1e3 * turned, "")
        for name in ("post-root", "arm-knee")
    ]
    structure = variants_of(analysis, folds)[SHELL_LAWS].structure
    plain = with_elastic_members(analysis.structure, analysis.multibody, analysis.time_in_motion)
    own, wanted = ({hinge.name: hinge for hinge in plastic_hinges(one)} for one in (structure, plain))
    assert own.keys() == wanted.keys()
    assert {len(hinge.spatial.freedoms) for hinge in wanted.values()} == {3}
    assert all(own[name].spatial.freedoms == hinge.spatial.freedoms for name, hinge in wanted.items())
