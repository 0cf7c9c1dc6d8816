"""An obstacle with a mass meets the part of a member between its clamp and its first hinge.

The piece is held, so that an impact leaves -e v and the distance travelled is the gap at the start: the walls
are 25 mm from the axis of the post, the obstacles 15 mm before them.  The leaning plane reaches the corner of
the foot first.  What overlaps at the start counts from there.  A piece that folds along the member is passed.

Kind: independent calculation.  Source: derived here.
"""

import pytest

from crumple.analysis import loads, solve
from crumple.errors import Status

TEXT = """
crumple: 1
materials:
  steel: {{youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: 300 MPa}}
sections: {{tube: {{type: rectangular_tube, width: 50 mm, depth: 50 mm, thickness: 2 mm}}}}
nodes: {{root: [0 m, 0 m, 0 m], tip: [0 m, 0 m, 1 m]}}
members:
  post:
    nodes: [root, tip]
    section: tube
    material: steel
    hinges: [{{name: h, at: root, offset: 200 mm, law: {{type: constant}}{more}}}]
supports: {{clamp: {{node: root, fix: all}}}}
obstacles:
  ram: {{{shape}, {motion}}}
analysis: {{duration: 10 ms}}
outputs: {{every: 0.1 ms}}
"""
SPEED = 5.0
SHAPES = [
    "type: plane, point: [-40 mm, 0 m, 0 m], normal: [1, 0, 0.1]",
    "type: cylinder, point: [-55 mm, 0 m, 100 mm], axis: [0, 1, 0], radius: 15 mm",
    "type: sphere, point: [-55 mm, 0 m, 100 mm], radius: 15 mm",
]


def ram(shape, motion, more=""):
    result = solve(loads(TEXT.format(shape=shape, motion=motion, more=more)))
    assert result.status is Status.COMPLETE
    assert not [text for text in result.warnings if "held part" in text]
    return result["obstacle.ram.velocity.x"], result["obstacle.ram.displacement.x"]


@pytest.mark.parametrize("restitution", [0.0, 0.5])
@pytest.mark.parametrize("shape", SHAPES)
def test_a_mass_rebounds_from_a_held_piece(shape, restitution):
    velocity, travel = ram(
        shape, f"mass: 50 kg, velocity: [{SPEED} m/s, 0 m/s, 0 m/s], restitution: {restitution}"
    )
    assert velocity[-1] == pytest.approx(-restitution * SPEED, abs=1e-4)
    if restitution == 0.0:
        assert travel.max() == pytest.approx(15e-3, abs=1e-5)


def test_what_overlaps_at_the_start_may_leave_but_not_go_deeper():
    inside = SHAPES[1].replace("-55 mm", "-35 mm")
    _, travel = ram(inside, "mass: 50 kg, velocity: [5 m/s, 0 m/s, 0 m/s]")
    assert travel.max() < 1e-5
    velocity, _ = ram(inside, "mass: 50 kg, velocity: [-5 m/s, 0 m/s, 0 m/s]")
    assert velocity[-1] == pytest.approx(-SPEED, rel=1e-9)


def test_a_piece_that_folds_along_the_member_is_passed():
    velocity, _ = ram(SHAPES[1], "mass: 50 kg, velocity: [5 m/s, 0 m/s, 0 m/s]", ", axial: true")
    assert velocity[-1] == pytest.approx(SPEED, rel=1e-9)
