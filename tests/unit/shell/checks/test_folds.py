"""Meshes whose elements are too long for the folds are named."""

from __future__ import annotations

import re

import pytest

from crumple.analysis import loads
from crumple.shell.checks.folds import coarse_folds, coarse_settings
from crumple.shell.mesh.mesh import mesh_of

TUBE = """crumple: 1
materials:
  steel: {{youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: 350 MPa}}
sections: {{tube: {{type: square_tube, side: 50 mm, thickness: 2 mm}}}}
nodes: {{root: [0 m, 0 m, 0 m], tip: [0.5 m, 0 m, 0 m]}}
members: {{tube: {{nodes: [root, tip], section: tube, material: steel, hinges: [{{name: a, at: {at}}}]}}}}
supports: {{clamp: {{node: root, fix: all}}}}
analysis: {{duration: 1 ms, shell: {{element_size: 12 mm, fine_size: {size} mm}}}}
"""


@pytest.mark.parametrize(("size", "warned"), [(8.0, True), (4.0, False)])
@pytest.mark.parametrize("at", ["root", "0.25 m"])
def test_elements_longer_than_a_quarter_of_half_a_fold_are_warned_of(size, warned, at):
    analysis = loads(TUBE.format(size=size, at=at))
    structure = analysis.structure
    found = list(coarse_folds(structure, mesh_of(structure, analysis.shell)))
    assert bool(found) == warned
    assert bool(list(coarse_settings(structure, analysis.shell))) == warned
    if warned:
        assert "of member tube." in found[0]


@pytest.mark.parametrize("length", [0.4, 0.45, 0.5, 0.55])
@pytest.mark.parametrize("thickness", [1.2, 2.0, 3.0])
def test_the_advised_size_is_small_enough(length, thickness):
    """Elements may be longer than asked, as their number is rounded."""
    text = TUBE.replace("0.5 m, 0 m", f"{length} m, 0 m").replace("thickness: 2", f"thickness: {thickness}")
    text = text.format(size=9.0, at="root")

    def warned(text):
        analysis = loads(text)
        return list(coarse_folds(analysis.structure, mesh_of(analysis.structure, analysis.shell)))

    advised = re.search(r"fine_size (\S+) mm\.", warned(text)[0]).group(1)
    assert not warned(text.replace("fine_size: 9.0", f"fine_size: {advised}"))
