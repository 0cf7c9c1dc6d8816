"""Obstacles: which way they move, where they are, and what is refused."""

import numpy as np
import pytest

from crumple.errors import InputError
from crumple.structure import CylinderObstacle, PlaneObstacle, SphereObstacle, Structure, gap

RAMP = {"step": {"x0": 0, "h0": 0, "x1": 1, "h1": 0.1}}
FLOOR = {"type": "plane", "point": (0, 0, -0.1), "normal": (0, 0, 2)}
BALL = {"type": "sphere", "point": (0.5, 0, 0.3), "radius": 0.1}


def test_plane_is_solid_behind_it():
    floor = PlaneObstacle(point=(0, 0, 1), normal=(0, 0, 5))
    assert gap(floor, np.array([7.0, -3.0, 1.25])) == pytest.approx(0.25)
    assert gap(floor, np.array([7.0, -3.0, 0.0])) == pytest.approx(-1.0)


@pytest.mark.parametrize(
    ("point", "distance"),
    [((-1, 0, 0.5), 0.5), ((2, 0, -1), 2.0), ((3, 0, 4), 5.0), ((-0.2, 0, -1), -0.2), ((-2, 0, -0.1), -0.1)],
)
def test_plane_with_edge_ends_there(point, distance):
    ground = PlaneObstacle(point=(0, 0, 0), normal=(0, 0, 1), edge=(2, 0, 0))
    assert gap(ground, np.array(point, float)) == pytest.approx(distance)


def test_pole_with_a_length_has_round_ends():
    pole = CylinderObstacle(point=(0, 0, 0), axis=(0, 0, 3), radius=0.5, length=2.0)
    assert gap(pole, np.array([1.0, 0.0, 1.0])) == pytest.approx(0.5)
    assert gap(pole, np.array([0.0, 0.0, 3.0])) == pytest.approx(0.5)
    endless = CylinderObstacle(point=(0, 0, 0), axis=(0, 0, 3), radius=0.5)
    assert gap(endless, np.array([0.0, 2.0, 30.0])) == pytest.approx(1.5)
    ball = SphereObstacle(point=(0, 0, 1), radius=0.25)
    assert gap(ball, np.array([0.0, 0.0, 0.0])) == pytest.approx(0.75)


def test_a_key_of_another_type_is_refused_with_the_type_that_has_it():
    with pytest.raises(InputError) as refused:
        Structure(obstacles={"ball": {**BALL, "axis": (0, 1, 0)}})
    (problem,) = [one for one in refused.value.problems if one.where == "obstacles.ball.axis"]
    assert problem.what == "unknown key 'axis'"
    assert problem.todo == "remove it, or choose type cylinder, which has it"
    with pytest.raises(InputError, match="did you mean 'radius'"):
        Structure(obstacles={"ball": {**BALL, "radios": 1.0}})


def test_mass_moves_along_its_guide_else_its_velocity_else_across_the_plane():
    def guide(**keys):
        return PlaneObstacle(point=(0, 0, 0), normal=(0, 0, 2), mass=5.0, **keys).guide_direction

    assert guide(guide=(0, 3, 4), velocity=(0, 0.6, 0.8)) == pytest.approx([0, 0.6, 0.8])
    assert guide(velocity=(2, 0, 0)) == pytest.approx([1, 0, 0])
    assert guide() == pytest.approx([0, 0, 1])
    assert PlaneObstacle(point=(0, 0, 0), normal=(0, 0, 1)).guide_direction is None


def test_driven_is_true_for_prescribed_motion():
    assert not SphereObstacle(point=(0, 0, 0), radius=1).driven
    assert SphereObstacle(point=(0, 0, 0), radius=1, velocity=(1, 0, 0)).driven
    assert not SphereObstacle(point=(0, 0, 0), radius=1, velocity=(1, 0, 0), mass=1).driven
    assert SphereObstacle(point=(0, 0, 0), radius=1, motion={"z": RAMP}).driven
    turning = {"about": (0, 0, 0), "axis": (0, 1, 0), "angle": RAMP}
    assert SphereObstacle(point=(0, 0, 0), radius=1, turning=turning).driven


# what is given, the key with the mistake, the message
WRONG = {
    "zero normal": ({**FLOOR, "normal": (0, 0, 0)}, "normal", "direction is zero"),
    "zero axis": ({**BALL, "type": "cylinder", "axis": (0, 0, 0)}, "axis", "direction is zero"),
    "leaning edge": ({**FLOOR, "edge": (1, 0, 0.1)}, "edge", "not perpendicular"),
    "no radius": ({**BALL, "radius": 0}, "radius", "more than 0"),
    "unknown type": ({**BALL, "type": "cube"}, "", "cube"),
    "guide without mass": ({**BALL, "guide": (1, 0, 0)}, "guide", "guide without a mass"),
    "driven twice": ({**BALL, "velocity": (1, 0, 0), "motion": {"x": RAMP}}, "velocity", "driven twice"),
    "driven mass": (
        {**BALL, "mass": 1, "velocity": (1, 0, 0), "motion": {"x": RAMP}},
        "motion",
        "not driven",
    ),
    "no guide": ({**BALL, "mass": 1}, "mass", "direction in which the mass"),
    "slanted": (
        {**FLOOR, "mass": 1, "guide": (0, 0, 1), "velocity": (1, 0, 0)},
        "velocity",
        "at an angle to the guide",
    ),
    "elastic beyond one": ({**BALL, "restitution": 1.5}, "restitution", "out of range"),
    "nothing to touch": ({**BALL, "members": ()}, "members", "no member can touch it"),
    "unknown member": ({**BALL, "members": ("arn",)}, "members[0]", "no member 'arn'"),
    "node inside": ({**BALL, "point": (1.05, 0, 0)}, "", "'tip' starts inside"),
    "jump": ({**BALL, "motion": {"z": {"constant": 0.1}}}, "motion.z", "starts with a jump"),
}


def test_directions_that_were_rounded_are_taken_as_meant(keys):
    turn = np.array([0.0, np.sin(0.35), np.cos(0.35)])
    ram = {**BALL, "mass": 1, "guide": tuple(turn.round(4)), "velocity": tuple((7.123 * turn).round(3))}
    ditch = {**FLOOR, "normal": tuple(turn.round(4)), "edge": (0, *np.array([turn[2], -turn[1]]).round(3))}
    ram, ditch = Structure(**keys, obstacles={"ram": ram, "ditch": ditch}).obstacles.values()
    np.testing.assert_allclose(np.cross(ram.velocity, ram.guide), 0.0, atol=1e-15)
    np.testing.assert_allclose(np.linalg.norm(ram.velocity), 7.123, rtol=1e-4)
    np.testing.assert_allclose(np.dot(ditch.normal, ditch.edge), 0.0, atol=1e-15)


@pytest.mark.parametrize("name", WRONG)
def test_wrong_obstacle_is_refused(name, keys):
    obstacle, key, expected = WRONG[name]
    with pytest.raises(InputError) as refused:
        Structure(**keys, obstacles={"thing": obstacle})
    found = [problem for problem in refused.value.problems if expected in str(problem)]
    assert found, refused.value
    assert found[0].where.startswith("obstacles.thing")
    assert found[0].where.endswith(key)


def test_member_that_starts_inside_is_refused_although_its_nodes_do_not(keys):
    with pytest.raises(InputError, match="the member 'arm' starts inside"):
        Structure(**keys, obstacles={"ball": {**BALL, "point": (0.5, 0, 0.05)}})


def test_obstacle_and_support_of_one_name_are_refused(keys):
    with pytest.raises(InputError, match="both called 'clamp'"):
        Structure(**keys, obstacles={"clamp": BALL})


def test_members_that_cannot_touch_may_start_inside(keys):
    keys["nodes"] |= {"far": (5, 0, 0)}
    keys["members"] |= {"other": {"nodes": ("tip", "far"), "section": "tube", "material": "steel"}}
    ball = {**BALL, "point": (0, 0, 0)}
    assert Structure(**keys, obstacles={"ball": {**ball, "members": ("other",)}}).obstacles
    with pytest.raises(InputError, match="'root' starts inside"):
        Structure(**keys, obstacles={"ball": ball})
