"""A fold about its tension flange whose shortening counts as a rotation: in its moment, and in its arm."""

import pytest
from tests.support.multibody.hinge_rig import ABOUT_Y, AXIAL, TENSION_FLANGE, component, hinge, rig

FALLING = ([0.0, 0.4, 2.0], [100.0, 60.0, 20.0])
GROWTH = {"growth_rotation": [0.0, 0.4, 1.0], "growth_share": [0.0, 0.999, 0.999]}
H = 1e-3


def moved(slip, **more):
    """A fold that has slipped by 200 steps of a rate; the arm is half a metre."""
    keys = {"arm": 0.5, "coupling": TENSION_FLANGE}
    element = rig(hinge(component(AXIAL, 1e4), component(ABOUT_Y, FALLING), **keys, **more))
    for _ in range(200):
        element.led(H, [slip, 0.0])
    return element


@pytest.mark.parametrize(("turn", "left"), [(0.0, 100.0), (2.0, 60.0)])
def test_what_shortens_loses_moment(turn, left):
    """Shortened by 0.2 m, which counts as 0.4 rad: the moment is that after such a rotation."""
    element = moved(-1.0, shortened_turn=turn)
    element.led(H, [0.0, 1e-3])
    assert element.state["capacity"][1] == pytest.approx(left, rel=5e-3)


def test_the_arm_grows_with_it():
    """On the side M - arm N = 60 N m: a turn faster than it lengthens pulls, until M is that of the start."""
    grown = moved(-1.0, shortened_turn=2.0, **GROWTH)
    force, moment = grown.led(H, [-0.25e-3, 1e-3])
    assert force == pytest.approx((100.0 - 60.0) / (0.999 * 0.5), rel=1e-3)
    assert moment == pytest.approx(100.0, rel=1e-6)
    # without it the arm has not grown, and only the walls' force is left
    small = moved(-1.0, shortened_turn=0.0, **GROWTH)
    assert small.led(H, [-0.25e-3, 1e-3])[0] == pytest.approx(-1e4, rel=1e-6)


def test_lengthening_costs_no_moment():
    element = moved(1.0, shortened_turn=2.0)
    element.led(H, [0.0, 1e-3])
    assert element.state["capacity"][1] == pytest.approx(100.0)


def test_a_negative_weight_is_refused():
    with pytest.raises(ValueError, match="no negative rotation"):
        moved(1.0, shortened_turn=-1.0)
