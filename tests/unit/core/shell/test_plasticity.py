"""Plane-stress return: yield surface to round-off, fine integration, resultants, hardening, rate, failure."""

from dataclasses import replace

import numpy as np
import pytest
from tests.support.shell.sheets import ELASTIC, STEEL, grid, model

from crumple._core.shell.simulation import Sheet, ShellMaterial, ShellState, thickness_rule

E, NU, G = 210e9, 0.3, 210e9 / 2.6
X, QUAD = grid(1, 1, 0.01, 0.01)
# rotations [rad] that bend by 1/m
BEND = (X[:, :1] - 0.005) * np.array([0.0, 1.0, 0.0])


def stress_of(state):
    return np.array([state.point_field(n)[0, 0] for n in ("stress_x", "stress_y", "stress_xy")])


def mises(s):
    return np.sqrt(s[0] ** 2 - s[0] * s[1] + s[1] ** 2 + 3 * s[2] ** 2)


def one(material, strain, steps=1):
    """Stress after a strain path in `steps` equal parts at a fixed shape (small strains)."""
    state = ShellState(model(X, QUAD, 2e-3, material))
    e = np.asarray(strain, dtype=float) / steps
    u = X @ np.array([[e[0], e[2] / 2, 0], [e[2] / 2, e[1], 0], [0, 0, 0]])
    for _ in range(steps):
        state.deform(X, u, 0 * X, 1.0)
    return stress_of(state), state


@pytest.mark.parametrize("size", [1e-3, 1e-2, 0.3])
@pytest.mark.parametrize("strain", [(1, 0, 0), (1, 1, 0), (1, -1, 0.5), (0, 0, 1), (0.7, -0.2, 3)])
def test_stress_ends_on_the_yield_surface(size, strain):
    """One step, however large, ends at the yield stress to round-off."""
    x, y, xy = size * np.array(strain)
    elastic = mises(np.array([x + NU * y, y + NU * x, (1 - NU) / 2 * xy]) * E / (1 - NU**2))
    stress, state = one(STEEL, size * np.array(strain))
    if elastic > 488e6:
        assert state.point_field("plastic_strain")[0, 0] > 0
        assert mises(stress) == pytest.approx(488e6, rel=5e-14)
    else:
        # small and finite strains differ by terms of their own order
        assert state.point_field("plastic_strain")[0, 0] == 0
        assert mises(stress) == pytest.approx(elastic, rel=2 * size)


@pytest.mark.parametrize("lobatto", [False, True])
@pytest.mark.parametrize("points", [2, 4, 5, 7])
@pytest.mark.parametrize("table", [False, True])
def test_forces_are_the_integrals_of_the_points(points, lobatto, table):
    """Force and moment on a side, bent beyond yield at one face first: sums of the stresses in the state."""
    curve = ShellMaterial(7850.0, E, NU, hardening=([0.0, 0.1], [488e6, 600e6]))
    m = model(X, QUAD, 2e-3, curve if table else STEEL, settings={"thickness_update": False})
    m = replace(m, sheets=[Sheet(points=points, lobatto=lobatto)])
    state, z, weight = ShellState(m), *thickness_rule(points, lobatto)
    yielded = []
    for stretch, curvature in ((1.8e-3, 2.0), (1.5e-3, -0.5), (-5e-3, 1.0)):
        u = stretch * X @ np.array([[1.0, 0.3, 0.0], [0.3, -0.2, 0.0], [0.0, 0.0, 0.0]])
        force = state.deform(X, u, curvature * BEND, 1.0)
        for along, names in ((0, ("stress_x", 4)), (1, ("stress_xy", 3))):
            stress = state.point_field(names[0])[0]
            on_side = force[X[:, 0] > 0]
            assert on_side[:, along].sum() == pytest.approx(
                0.01 * 2e-3 * weight @ stress, rel=1e-12, abs=1e-6
            )
            moment = 0.01 * 2e-3**2 * (weight * z) @ stress * (1 if along == 0 else -1)
            assert on_side[:, names[1]].sum() == pytest.approx(moment, rel=1e-12, abs=1e-9)
        yielded.append((state.point_field("plastic_strain")[0] > 0).sum())
    assert 0 < yielded[0] < points
    assert yielded[-1] == points


def test_hourglass_force_is_returned_with_the_points():
    """One point of three has yielded: the force falls by the mean share of the deviator that is left."""
    pattern = np.array([[1.0], [-1.0], [1.0], [-1.0]])[np.argsort(QUAD[0])] * [1e-5, 0.0, 0.0]
    forces, kept = [], 1.0
    for metal in (ELASTIC, STEEL):
        m = model(X, QUAD, 2e-3, metal, points=3, settings={"thickness_update": False})
        state = ShellState(m)
        force = state.deform(X, 1e-3 * X + pattern, 2.5 * BEND, 1.0)
        forces.append((force[:, :3] * np.sign(pattern)).sum())
        if metal is STEEL:
            plastic = state.point_field("plastic_strain")[0]
            assert (plastic > 0).sum() == 1
            kept = thickness_rule(3)[1] @ (1 / (1 + 3 * G * plastic / 488e6))
    assert forces[0] != 0
    assert forces[1] == pytest.approx(kept * forces[0], rel=1e-12)
    assert kept < 0.98


def fine_path(strain, steps, table=((0.0,), (488e6,))):
    """Independent reference: forward integration of the rate equations with the consistent multiplier."""
    C = E / (1 - NU**2) * np.array([[1, NU, 0], [NU, 1, 0], [0, 0, (1 - NU) / 2]])
    s, ep = np.zeros(3), 0.0
    d = np.asarray(strain, dtype=float) / steps
    for _ in range(steps):
        trial = s + C @ d
        y = np.interp(ep, *table)
        if mises(trial) > y:
            n = np.array([s[0] - s[1] / 2, s[1] - s[0] / 2, 3 * s[2]]) / max(mises(s), 1.0)
            h = (np.interp(ep + 1e-6, *table) - y) / 1e-6
            rate = max(n @ C @ d, 0.0) / (n @ C @ n + h) if mises(s) > 0.9999 * y else 0.0
            trial = s + C @ (d - rate * n)
            ep += rate
            trial *= min(1.0, np.interp(ep, *table) / mises(trial)) if rate else 1.0
        s = trial
    return s, ep


@pytest.mark.parametrize("strain", [(0.02, -0.004, 0.01), (0.01, 0.008, 0.0), (0.0, 0.002, 0.03)])
def test_return_agrees_with_fine_integration(strain):
    stress, state = one(STEEL, strain, steps=400)
    reference, ep = fine_path(strain, 40_000)
    assert stress == pytest.approx(reference, abs=2e-3 * 488e6)
    assert state.point_field("plastic_strain")[0, 0] == pytest.approx(ep, rel=5e-3)


def test_linear_hardening_and_table_agree():
    line = ShellMaterial(7850.0, E, NU, yield_stress=300e6, hardening_modulus=2e9)
    table = ShellMaterial(7850.0, E, NU, hardening=([0.0, 0.01, 0.5], [300e6, 320e6, 1300e6]))
    for steps in (1, 7):
        a, state = one(line, (0.05, -0.01, 0.02), steps)
        b, other = one(table, (0.05, -0.01, 0.02), steps)
        assert a == pytest.approx(b, rel=1e-12)
        ep = state.point_field("plastic_strain")[0, 0]
        assert other.point_field("plastic_strain")[0, 0] == pytest.approx(ep, rel=1e-12)
        assert mises(a) == pytest.approx(300e6 + 2e9 * ep, rel=1e-13)


def test_table_with_kinks_is_followed():
    strain, stress = [0.0, 0.01, 0.03, 0.1], [300e6, 400e6, 420e6, 600e6]
    material = ShellMaterial(7850.0, E, NU, hardening=(strain, stress))
    for size in (0.005, 0.02, 0.08, 0.3):
        s, state = one(material, (size, -size / 2, 0), 3)
        assert mises(s) == pytest.approx(
            np.interp(state.point_field("plastic_strain")[0, 0], strain, stress), rel=1e-12
        )


def test_cowper_symonds_raises_the_yield_stress():
    material = ShellMaterial(
        7850.0, E, NU, yield_stress=488e6, rate_reference=40.4, rate_exponent=5.0, rate_time=0.0
    )
    state = ShellState(model(X, QUAD, 2e-3, material))
    rate, dt = 100.0, 1e-6
    velocity = X @ np.diag([rate, -0.5 * rate, 0.0])
    for _ in range(200):
        state.deform(X, velocity, 0 * X, dt)
    # uniaxial incompressible flow: the equivalent rate is the axial one
    assert mises(stress_of(state)) == pytest.approx(
        488e6 * (1 + (rate / 40.4) ** 0.2), rel=1e-5
    )  # the elastic share is still settling


@pytest.mark.parametrize(("rate", "factor"), [(200.0, 1 + 0.03 * np.log(100.0)), (1.0, 1.0)])
def test_johnson_cook_raises_the_yield_stress(rate, factor):
    """1 + C ln(rate / reference) above the reference rate of 2 /s, nothing below it."""
    material = ShellMaterial(
        7850.0, E, NU, yield_stress=488e6, rate_reference=2.0, rate_logarithm=0.03, rate_time=0.0
    )
    state = ShellState(model(X, QUAD, 2e-3, material))
    dt = 1e-4 / rate
    velocity = X @ np.diag([rate, -0.5 * rate, 0.0])
    for _ in range(200):
        state.deform(X, velocity, 0 * X, dt)
    # uniaxial incompressible flow: the equivalent rate is the axial one
    assert mises(stress_of(state)) == pytest.approx(488e6 * factor, rel=1e-5)


def test_rate_and_hardening_table_multiply():
    material = ShellMaterial(
        7850.0, E, NU, hardening=([0.0, 0.1], [300e6, 400e6]), rate_reference=1.0, rate_logarithm=0.05,
        rate_time=0.0,
    )  # fmt: skip
    state = ShellState(model(X, QUAD, 2e-3, material))
    velocity = X @ np.diag([50.0, -25.0, 0.0])
    for _ in range(400):
        state.deform(X, velocity, 0 * X, 2e-6)
    ep = state.point_field("plastic_strain")[0, 0]
    assert mises(stress_of(state)) == pytest.approx((300e6 + 1e9 * ep) * (1 + 0.05 * np.log(50.0)), rel=1e-5)


def test_answer_of_an_element_does_not_depend_on_its_neighbours():
    """Elements that yield and that do not, in one block and alone: same bits."""
    position, quads = grid(9, 1, 0.09, 0.01)
    together = ShellState(model(position, quads, 2e-3, STEEL))
    stretch = np.where(position[:, 0] > 0.045, 0.02, 1e-4)[:, None] * position * [1, -0.3, 0]
    together.deform(position + stretch, stretch, 0 * position, 1.0)
    for e in (2, 4, 7):
        nodes = quads[e]
        alone = ShellState(model(position[nodes], np.array([[0, 1, 2, 3]]), 2e-3, STEEL))
        alone.deform((position + stretch)[nodes], stretch[nodes], 0 * position[nodes], 1.0)
        for name in ("stress_x", "stress_y", "stress_xy", "plastic_strain"):
            assert np.array_equal(together.point_field(name)[e], alone.point_field(name)[0])


@pytest.mark.parametrize("any_point", [True, False])
def test_failed_element_carries_nothing_and_keeps_its_energy(any_point):
    material = ShellMaterial(
        7850.0, E, NU, yield_stress=300e6, failure_strain=0.02, fails_at_any_point=any_point
    )
    state = ShellState(model(X, QUAD, 2e-3, material))
    u = X @ np.diag([2e-3, -1e-3, 0])
    for _ in range(20):
        force = state.deform(X, u, 0 * X, 1.0)
    assert state.element_field("alive")[0] == 0
    assert not force.any()
    e = state.energies
    assert e["eroded"] == pytest.approx(e["elastic"])
    assert e["plastic"] == pytest.approx(300e6 * 0.02 * 2e-3 * 1e-4, rel=0.1)


def test_elastic_material_never_yields():
    stress, state = one(ELASTIC, (0.01, 0, 0))
    assert stress[0] == pytest.approx(E / (1 - NU**2) * (0.01 - 0.5e-4), rel=1e-9)
    assert not state.point_field("plastic_strain").any()
