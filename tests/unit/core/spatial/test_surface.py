"""Points of an interaction surface: found to round-off, with the right derivative, whatever the metric."""

import itertools

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from scipy.optimize import minimize
from tests.support.multibody.hinge_rig import BALL, ELLIPSOID, NO_ARM, SECTION

from crumple._core import _kernels

space = _kernels.spatial
RNG = np.random.default_rng(3)
ROWS = np.column_stack([RNG.normal(size=(12, 3)), np.zeros(12)])
IN_PLANE = np.array([[0.9, 0.8], [0.9, -0.8], [0.3, 1.0], [0.3, -1.0], [1.0, 0.0]])


def surface(coupling, rows=None, power=2.0, torque_power=2.0, torsion=-1, axisymmetric=False):
    flat = [] if rows is None else rows.ravel().tolist()
    return {"coupling": coupling, "rows": flat, "power": power, "torque_power": torque_power} | {
        "torsion": torsion,
        "axisymmetric": axisymmetric,
        **NO_ARM,
    }


SURFACES = {
    "ellipsoid": (surface(ELLIPSOID), 4),
    "ball": (surface(BALL), 3),
    "rows": (surface(SECTION, ROWS[:, :3], 6.0), 3),
    "rows with torque": (surface(SECTION, ROWS, 10.0, 2.5, 3), 4),
    "sharp rows": (surface(SECTION, ROWS, 16.0, 2.0, 3), 4),
    "round": (surface(SECTION, IN_PLANE, 16.0, axisymmetric=True), 3),
    "round with torque": (surface(SECTION, IN_PLANE, 16.0, 2.0, 1, axisymmetric=True), 4),
}
number = st.floats(-1.0, 1.0).map(lambda v: 0.0 if abs(v) < 1e-3 else v)
load = st.lists(number, min_size=4, max_size=4).filter(any)
metric = st.one_of(
    st.just([0.0] * 4),
    st.floats(-8.0, 1.0).map(lambda e: [10.0**e] * 4),
    st.lists(st.floats(-2.0, 1.0).map(lambda e: 10.0**e), min_size=4, max_size=4),
)


def gauge(constants, x):
    value, gradient = space.surface_gauge(constants, list(x))
    return value, np.array(gradient)


@pytest.mark.parametrize("name", SURFACES)
@given(y=load, m=metric)
def test_the_point_is_the_maximum(name, y, m):
    constants, n = SURFACES[name]
    y, m = np.array(y[:n]), np.array(m[:n])
    assume(y.any())
    x, value, multiplier, derivative = space.surface_point(constants, y.tolist(), m.tolist())
    x, g = np.array(x), gauge(constants, x)
    assert g[0] <= 1.0 + 4e-16 * 8
    assert value == pytest.approx(y @ x - x @ (m * x) / 2, rel=1e-14)
    # y - m x = multiplier times the normal, to rounding of the load
    np.testing.assert_allclose(y - m * x, multiplier * g[1], atol=2e-14 * np.abs(y).max())
    assert multiplier == 0.0 or g[0] == pytest.approx(1.0, abs=1e-14)
    block = np.reshape(derivative, (n, n))
    np.testing.assert_array_equal(block, block.T)
    assert np.linalg.eigvalsh(block).min() >= -1e-10 * np.abs(block).max()


@pytest.mark.parametrize("name", SURFACES)
def test_no_other_point_gives_more(name):
    constants, n = SURFACES[name]
    generator = np.random.default_rng(5)
    others = generator.normal(size=(2000, n))
    others = np.array([x / gauge(constants, x)[0] for x in others])
    for _ in range(20):
        y = generator.normal(size=n)
        value = space.surface_point(constants, y.tolist(), [0.0] * n)[1]
        assert (others @ y).max() <= value


@pytest.mark.parametrize("name", SURFACES)
def test_derivative_is_that_of_the_point(name):
    constants, n = SURFACES[name]
    generator = np.random.default_rng(7)
    for scale in (0.1, 1.0):
        y, m = generator.normal(size=n) * 5.0, np.full(n, scale) + generator.random(n)
        block = np.reshape(space.surface_point(constants, y.tolist(), m.tolist())[3], (n, n))
        for k in range(n):
            step = np.eye(n)[k] * 1e-6
            ends = [
                np.array(space.surface_point(constants, list(y + s * step), m.tolist())[0]) for s in (1, -1)
            ]
            np.testing.assert_allclose(
                block[:, k], (ends[0] - ends[1]) / 2e-6, atol=1e-6 * np.abs(block).max()
            )


def test_gauge_is_a_norm_and_its_gradient_is_true():
    generator = np.random.default_rng(11)
    for constants, n in SURFACES.values():
        for _ in range(20):
            a, b = generator.normal(size=(2, n))
            g, gradient = gauge(constants, a)
            assert gauge(constants, -2.0 * a)[0] == pytest.approx(2.0 * g, rel=1e-13)
            assert gauge(constants, a + b)[0] <= g + gauge(constants, b)[0] + 1e-13
            slope = [
                (gauge(constants, a + d)[0] - gauge(constants, a - d)[0]) / 2e-6 for d in np.eye(n) * 1e-6
            ]
            np.testing.assert_allclose(gradient, slope, atol=1e-8)


def test_round_surface_is_that_of_the_resultant():
    """A moment about any axis has the g of the same moment about y, down to none."""
    (turned, n), plane = SURFACES["round"], surface(SECTION, IN_PLANE, 16.0)
    for force, moment in ((0.4, 0.7), (1.0, 1e-3), (1.0, 1e-12), (1.0, 0.0), (0.0, 1.0)):
        for angle in (0.0, 0.3, 2.0, 4.0):
            about = moment * np.array([np.cos(angle), np.sin(angle)])
            g, gradient = gauge(turned, [force, *about])
            flat, slope = gauge(plane, [force, moment])
            assert g == pytest.approx(flat, rel=1e-14)
            wanted = [slope[0], slope[1] * np.cos(angle), slope[1] * np.sin(angle)]
            np.testing.assert_allclose(gradient, wanted, atol=1e-13)
            # the point nearest to a load outside, where a moment is as small as it likes
            y = (2.0 * np.array([force, *about])).tolist()
            x = np.array(space.surface_point(turned, y, [1.0] * n)[0])
            in_plane = space.surface_point(plane, [2.0 * force, 2.0 * moment], [1.0, 1.0])[0]
            np.testing.assert_allclose([x[0], np.hypot(*x[1:])], in_plane, atol=1e-12)


GAINING = {"arm_gains": [0.3, 0.8], "arm_gain_shares": [0.1, 0.3]}
GROWN = {"growth_rotation": [0.0, 1e-9, 1.0], "growth_share": [0.0, 0.8, 0.8]}


@pytest.mark.parametrize(
    ("more", "arms", "bounds"),
    [
        ({}, [0.5], [60.0]),
        # sides meet at compressions of 0.1 and 0.3 of the yield force of 150
        (GAINING, [0.5, 0.8, 1.3], [60.0, 60.0 + 0.3 * 15.0, 60.0 + 0.3 * 15.0 + 0.5 * 45.0]),
        (GAINING | GROWN, [0.4, 0.7, 1.2], [60.0, 60.0 + 0.3 * 15.0, 60.0 + 0.3 * 15.0 + 0.5 * 45.0]),
    ],
)
def test_tension_flange_against_a_general_optimiser(more, arms, bounds):
    """|M| <= 100, |M| - arm N <= bound, -80 <= N <= 150 at softened moment: by SciPy's SLSQP."""
    from tests.support.multibody.hinge_rig import (
        ABOUT_Y,
        AXIAL,
        ELASTIC_PLASTIC,
        TENSION_FLANGE,
        component,
        hinge,
        rig,
    )

    constants = hinge(
        component(AXIAL, 150.0, 80.0, elastic_stiffness=900.0),
        component(ABOUT_Y, ([0.0, 1e-9, 1.0], [100.0, 60.0, 60.0]), elastic_stiffness=400.0),
        form=ELASTIC_PLASTIC,
        coupling=TENSION_FLANGE,
        arm=0.5,
        **more,
    )
    stiffness = np.array([900.0, 400.0])
    for force, moment in itertools.product((-2.0, -0.4, -0.05, 0.05, 0.3, 2.0), (-1.0, -0.3, 0.1, 0.3, 1.0)):
        made = rig(constants)
        made.led(1.0, [0.0, 0.5])
        start = np.array(made.state["moment"])
        w = np.array([force, moment])
        made.element.freeze(1.0, [0.0, 0.0], w.tolist())
        end = 2.0 * np.array(made.element.law(w.tolist())[0]) - start
        trial = start + stiffness * w / 2.0
        sides = [
            {"type": "ineq", "fun": lambda t: 100.0 - t[1]},
            {"type": "ineq", "fun": lambda t: 100.0 + t[1]},
            {"type": "ineq", "fun": lambda t: np.array(bounds) - t[1] + np.array(arms) * t[0]},
            {"type": "ineq", "fun": lambda t: np.array(bounds) + t[1] + np.array(arms) * t[0]},
            {"type": "ineq", "fun": lambda t: t[0] + 80.0},
            {"type": "ineq", "fun": lambda t: 150.0 - t[0]},
        ]

        def distance(t, trial=trial):
            return float(((t - trial) ** 2 / stiffness).sum())

        found = minimize(distance, np.zeros(2), constraints=sides, method="SLSQP", options={"ftol": 1e-14})
        np.testing.assert_allclose(end, found.x, atol=2e-3)
        assert all(np.all(side["fun"](end) >= -1e-12 * 150.0) for side in sides)
        assert distance(end) <= found.fun + 1e-9
