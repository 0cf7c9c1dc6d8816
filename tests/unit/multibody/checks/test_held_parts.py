"""Obstacles that pass through held parts are reported with the time at which the surfaces meet."""

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
  ram: {{{shape}, motion: {{x: {{table: {{time: [0 s, 1 s], value: [0 m, 100 mm]}}}}}}}}
analysis: {{stages: [{{name: push, kind: quasi-static, duration: 0.5 s}}]}}
outputs: {{every: 10 ms}}
"""
PLANE = "type: plane, point: [-40 mm, 0 m, 0 m], normal: [1, 0, 0]"
POLE = "type: cylinder, point: [-55 mm, 0 m, {height}], axis: [0, 1, 0], radius: 15 mm"
BALL = "type: sphere, point: [-55 mm, 0 m, {height}], radius: 15 mm"


def reported(shape, more=", axial: true"):
    result = solve(loads(TEXT.format(shape=shape, more=more)))
    return [text for text in result.warnings if "held part" in text]


@pytest.mark.parametrize("shape", [PLANE, POLE.format(height="230 mm"), BALL.format(height="230 mm")])
def test_an_obstacle_that_reaches_the_held_part_is_reported(shape):
    # the plane has 15 mm to go at 100 mm/s; pole and ball stand 30 mm above the end, round with 25 mm
    (text,) = reported(shape)
    assert "Obstacle ram" in text
    assert "member post" in text
    if shape is PLANE:
        # judged at outputs, every 10 ms
        assert "passes through held parts of member post from 160 ms on" in text


@pytest.mark.parametrize(
    "shape",
    [
        POLE.format(height="700 mm"),
        BALL.format(height="700 mm"),
        PLANE.replace("-40 mm", "-80 mm"),
        PLANE + ", edge: [0, 0, 1]",
    ],
)
def test_what_stays_clear_of_it_is_not(shape):
    assert reported(shape) == []


def test_a_ball_that_wedges_what_cannot_slip_crushes_it():
    """Pressed ever nearer to its hinge the post cannot give way: a caution says that its wall is crushed."""
    result = solve(loads(TEXT.format(shape=BALL.format(height="230 mm"), more="")))
    assert result.status is Status.COMPLETE
    (caution,) = (caution for caution in result.cautions if caution.code == "crushed_contact")
    assert caution.place == "member post"
    # its surface meets the round end at the hinge after 55 mm - sqrt(40^2 - 30^2) mm, at 100 mm/s; the rest
    # of its way, less a little that the ball passes beside the end, is crushed
    rest = 0.1 * result.time[-1] - (0.055 - 700.0**0.5 / 1e3)
    assert 0.5 * rest < caution.value < rest
