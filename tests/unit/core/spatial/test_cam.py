"""A held translation that follows a rotation: a slider driven by a wheel.

With the displacement s(a) of the slider over the angle a of the wheel, its mass m and the wheel's inertia I,
(I + m s'(a)^2) a'^2 = I w^2 at any time; where the cam does not move it, the wheel turns as without it.
"""

import numpy as np
import pytest
from tests.support.multibody.space_models import RZ, started

from crumple._core.spatial.model import (
    GROUND,
    SpatialBody,
    SpatialCam,
    SpatialJoint,
    SpatialModel,
    prismatic,
    revolute,
)

INERTIA, MASS, SPIN = 0.02, 3.0, 2.0
HELD = (True, False, False, False, False, False)
ANGLE, SLOPE = np.array([0.0, 0.5, 1.0, 1.5]), np.array([0.0, 0.08, 0.08, 0.0])


def wheel_and_slider(sense):
    """The cam joins the slider, along x, and the wheel, about z."""
    wheel = SpatialBody(1.0, INERTIA * np.eye(3), np.zeros(3))
    slider = SpatialBody(MASS, np.eye(3), np.zeros(3))
    joints = (
        revolute(GROUND, 0, np.zeros(3), [0.0, 0.0, 1.0]),
        prismatic(GROUND, 1, np.zeros(3), [1.0, 0.0, 0.0]),
        SpatialJoint(1, 0, np.zeros(3), np.eye(3), HELD),
    )
    cam = SpatialCam(2, 0, RZ, ANGLE, SLOPE)
    model = SpatialModel((wheel, slider), joints, cams=(cam,))
    return started(model, [[0.0, 0.0, sense * SPIN, 0.0, 0.0, 0.0], np.zeros(6)], 1e-5)


def test_a_cam_moves_a_slider_and_keeps_the_energy():
    record = wheel_and_slider(1.0).run(np.linspace(0.01, 1.0, 100))
    turned = 2.0 * np.arctan2(record.rotation[:, 0, 3], record.rotation[:, 0, 0])
    fine = np.linspace(0.0, 2.0, 20001)
    slope = np.interp(fine, ANGLE, SLOPE)
    moved = np.append(0.0, np.cumsum((slope[1:] + slope[:-1]) / 2.0 * np.diff(fine)))
    assert turned[-1] > ANGLE[-1]
    # the wheel's point of the joint stays; the slider moves against the cam's displacement
    np.testing.assert_allclose(-record.centre[:, 1, 0], np.interp(turned, fine, moved), atol=1e-6)
    slopes = np.interp(turned, ANGLE, SLOPE)
    expected = SPIN / np.sqrt(1.0 + MASS * slopes**2 / INERTIA)
    np.testing.assert_allclose(record.velocity[:, 0, 2], expected, rtol=2e-3)
    assert slopes.max() > 0.07
    np.testing.assert_allclose(record.velocity[:, 1, 3], -slopes * record.velocity[:, 0, 2], atol=1e-6)
    assert record.energy.kinetic[-1] == pytest.approx(INERTIA * SPIN**2 / 2.0, rel=1e-3)


def test_a_cam_keeps_its_first_slope_before_its_first_angle():
    record = wheel_and_slider(-1.0).run(np.array([0.5]))
    assert record.centre[-1, 1, 0] == pytest.approx(0.0, abs=1e-9)
    assert record.velocity[-1, 0, 2] == pytest.approx(-SPIN, rel=1e-9)
