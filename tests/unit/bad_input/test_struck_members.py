"""Mistakes in members that obstacles strike: where they strike is sought before all is sound."""

import pytest

from crumple.analysis import loads
from crumple.errors import InputError

GOOD = """crumple: 1
materials:
  steel: {youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: 260 MPa}
sections:
  column: {type: square_tube, side: 90 mm, thickness: 1.6 mm}
  beam: {type: square_tube, side: 60 mm, thickness: 1.5 mm}
nodes: {near: [0 m, 0 m, 0 m], far: [1.6 m, 0 m, 0 m], left: [0 m, 0 m, 1.5 m], right: [1.6 m, 0 m, 1.5 m]}
members:
  first: {nodes: [near, left], section: column, material: steel}
  second: {nodes: [left, right], section: beam, material: steel}
  third: {nodes: [right, far], section: column, material: steel}
hinges: auto
supports: {one: {node: left, fix: all}, other: {node: far, fix: all}}
obstacles:
  car: OBSTACLE
analysis: {duration: 70 ms}
"""
OBSTACLES = {
    "ball": "{type: sphere, point: [-300 mm, 0 m, 0.5 m], radius: 250 mm, velocity: [5 m/s, 0 m/s, 0 m/s]}",
    "pole": "{type: cylinder, point: [-300 mm, -0.2 m, 0.5 m], axis: [0, 1, 0], radius: 250 mm, length: 0.4 m"
    ", velocity: [5 m/s, 0 m/s, 0 m/s]}",
    "ball that comes nowhere": "{type: sphere, point: [-300 mm, 0 m, 0.5 m], radius: 250 mm}",
}
# what is replaced by what; where the message points; words that it contains
CASES = {
    "misspelt section": ("section: beam, mat", "section: beem, mat", "members.second.section", "'beam'?"),
    "refused section": ("side: 60 mm", "side: 60", "sections.beam.side", "the unit is missing"),
    "misspelt material": (
        "column, material: steel",
        "column, material: stele",
        "members.first.material",
        "steel",
    ),
    "misspelt first node": ("nodes: [near, left]", "nodes: [naer, left]", "members.first.nodes", "'near'?"),
    "refused first node": ("near: [0 m", "near: [5", "nodes.near[0]", "the unit is missing"),
}


@pytest.mark.parametrize("obstacle", list(OBSTACLES))
@pytest.mark.parametrize("case", list(CASES))
def test_a_mistake_beside_an_obstacle_is_named(case, obstacle):
    old, new, where, words = CASES[case]
    good = GOOD.replace("OBSTACLE", OBSTACLES[obstacle])
    loads(good)
    assert old in good
    with pytest.raises(InputError) as caught:
        loads(good.replace(old, new, 1))
    told = [problem for problem in caught.value.problems if problem.where.startswith(where)]
    assert told, caught.value
    assert words in f"{told[0]} {told[0].todo}"
