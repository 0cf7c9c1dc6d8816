"""Moments of a tube soften by rotation about their own axis, and by half as much about the other one."""

import math

import numpy as np
import pytest
from tests.support.multibody.hinge_rig import (
    ABOUT_Y,
    ABOUT_Z,
    ACCUMULATED,
    ELASTIC_PLASTIC,
    ELLIPSOID,
    PEAK,
    ROTATION,
    SECTION,
    SET_VALUED,
    TORSION,
    component,
    hinge,
    rig,
)

from crumple._core import _kernels

FALLING = ([0.0, 0.4, 2.0], [100.0, 60.0, 20.0])
LOWER = ([0.0, 0.4, 2.0], [50.0, 20.0, 10.0])
VARIABLES = {"peak": PEAK, "rotation": ROTATION, "accumulated": ACCUMULATED}
H = 1e-3


def made(weight, softening=PEAK, form=SET_VALUED, coupling=ELLIPSOID, weaker=FALLING, relief=0.0):
    stiff = 4e5 if form == ELASTIC_PLASTIC else np.inf
    parts = [
        component(TORSION, FALLING, elastic_stiffness=stiff),
        component(ABOUT_Y, FALLING, elastic_stiffness=stiff),
        component(ABOUT_Z, weaker, elastic_stiffness=stiff),
    ]
    extra = {"cross_softening": weight, "edge_relief": relief}
    if coupling == SECTION:
        extra |= {"rows": [0.0, 1.0, 0.0, 0.0, 0.0, 1.0], "torsion": 0}
    return rig(hinge(*parts, form=form, softening=softening, coupling=coupling, **extra))


def led(element, rate, time):
    """Lead a hinge at a constant rate; moments at the end."""
    for _ in range(round(time / H)):
        element.led(H, np.array(rate, float))
    return np.array(element.state["moment"])


def at(curve, rotation):
    return np.interp(rotation, *curve)


@pytest.mark.parametrize("coupling", [ELLIPSOID, SECTION])
@pytest.mark.parametrize("form", [SET_VALUED, ELASTIC_PLASTIC])
@pytest.mark.parametrize("variable", VARIABLES)
def test_rotation_about_one_axis_counts_half_about_the_other(variable, form, coupling):
    element = made(0.5, VARIABLES[variable], form, coupling, weaker=LOWER)
    assert led(element, [0.0, 1.0, 0.0], 0.4)[1] == pytest.approx(60.0, rel=5e-3)
    first = led(element, [0.0, 0.0, 1.0], 2e-3)[2]
    # half of the rotation about y, whatever the capacities
    assert first == pytest.approx(at(LOWER, 0.2), rel=1e-2)


def test_a_moment_starts_as_soft_as_the_rotation_about_the_other_axis_has_made_it():
    for weight, left in ((1.0, 60.0), (0.5, 80.0), (0.25, 90.0)):
        element = made(weight)
        led(element, [0.0, 1.0, 0.0], 0.4)
        assert led(element, [0.0, 0.0, 1.0], 2e-3)[2] == pytest.approx(left, rel=5e-3)


@pytest.mark.parametrize("variable", VARIABLES)
def test_oblique_rotation_softens_less(variable):
    element = made(0.5, VARIABLES[variable])
    moments = led(element, [0.0, 1.0, 1.0], 0.3)
    own = math.hypot(0.3, 0.5 * 0.3)
    assert np.hypot(*moments[1:]) == pytest.approx(at(FALLING, own), rel=2e-3)
    whole = led(made(1.0, VARIABLES[variable]), [0.0, 1.0, 1.0], 0.3)
    assert np.hypot(*whole[1:]) == pytest.approx(at(FALLING, math.hypot(0.3, 0.3)), rel=2e-3)


def test_twist_softens_and_is_softened_as_before():
    element = made(0.5)
    led(element, [0.0, 1.0, 1.0], 0.3)
    # the torque falls by all of the measure
    torque = led(element, [1.0, 0.0, 0.0], 2e-3)[0]
    assert torque == pytest.approx(at(FALLING, math.hypot(0.3, 0.3)), rel=5e-3)
    element = made(0.5)
    led(element, [1.0, 0.0, 0.0], 0.4)
    assert led(element, [0.0, 1.0, 0.0], 2e-3)[1] == pytest.approx(60.0, rel=5e-3)


def test_a_fold_that_is_bent_back_regains_nothing():
    element = made(0.5)
    led(element, [0.0, 1.0, 0.0], 0.4)
    led(element, [0.0, -1.0, 0.0], 0.4)
    assert led(element, [0.0, 0.0, 1.0], 2e-3)[2] == pytest.approx(80.0, rel=5e-3)
    # and the energy is accounted for
    assert element.energy == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("coupling", [ELLIPSOID, SECTION])
@pytest.mark.parametrize("form", [SET_VALUED, ELASTIC_PLASTIC])
@pytest.mark.parametrize("variable", VARIABLES)
def test_a_fold_about_both_axes_is_relieved(variable, form, coupling):
    """By the fourth power of 2 W_y W_z/(W_y^2 + W_z^2), with the works of the first capacities."""
    for share, even in ((1.0, 1.0), (0.5, 0.8), (0.25, 8.0 / 17.0)):
        for sense in (1.0, -1.0):
            element = made(0.5, VARIABLES[variable], form, coupling, LOWER, relief=0.5)
            # LOWER starts at half of FALLING: the works are as 1 to `share`
            led(element, [0.0, 1.0, sense * 2.0 * share], 0.2)
            rotation = math.hypot(0.2, 0.5 * 2.0 * share * 0.2) * (1.0 - 0.5 * even**4)
            assert element.state["capacity"][1] == pytest.approx(at(FALLING, rotation), rel=5e-3)


def test_a_fold_about_one_axis_and_twist_are_not_relieved():
    for turn in ([0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 1.0, 0.0]):
        moments = [led(made(0.5, relief=relief), turn, 0.3) for relief in (0.0, 0.6)]
        assert moments[1] == pytest.approx(moments[0], rel=1e-12)
    element = made(0.5, relief=0.6)
    led(element, [0.0, 1.0, 1.0], 0.3)
    torque = led(element, [1.0, 0.0, 0.0], 2e-3)[0]
    assert torque == pytest.approx(at(FALLING, math.hypot(0.3, 0.3)), rel=5e-3)


@pytest.mark.parametrize("relief", [-0.1, 1.0, math.nan])
def test_reliefs_that_are_refused(relief):
    parts = [component(ABOUT_Y, FALLING), component(ABOUT_Z, FALLING)]
    with pytest.raises(ValueError, match="relieved of a part"):
        _kernels.spatial.HingeElement(hinge(*parts, coupling=ELLIPSOID, edge_relief=relief))


@pytest.mark.parametrize("weight", [0.0, -0.5, 1.5, math.nan])
def test_weights_that_are_refused(weight):
    parts = [component(ABOUT_Y, FALLING), component(ABOUT_Z, FALLING)]
    with pytest.raises(ValueError, match="softens by a positive part"):
        _kernels.spatial.HingeElement(hinge(*parts, coupling=ELLIPSOID, cross_softening=weight))
