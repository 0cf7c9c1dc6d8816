"""Shell engine against closed forms of elasticity.

- Cantilever strip, first bending frequency: (1.8751/L)^2 sqrt(EI/rho A), Euler-Bernoulli; L/t = 100, nu = 0.
- Square plate, simply supported, first frequency: 2 (pi/a)^2 sqrt(D/rho t), Kirchhoff; a/t = 100.
- Cantilever under a dead end load P L^2/EI = 2, the elastica: tip 0.4935 L aside, 0.1606 L back
  (Mattiasson, Int. J. Num. Meth. Eng. 17, 1981, 145-153).
- Twisted beam, 90 degrees over 12 x 1.1 x 0.32, unit end loads: 5.424e-3 in the plane of the end, 1.754e-3
  across (MacNeal and Harder, Finite Elements in Analysis and Design 1, 1985, 3-20).
- Longitudinal wave in a bar: speed sqrt(E/rho), stress rho c v.
Tolerances are those of the mesh (stated beside each), not of the integration.
"""

from dataclasses import replace

import numpy as np
import pytest
from sheets import grid, model

from crumple._core.shell import NodalLoad, PrescribedVelocity, RigidSet, ShellMaterial, ShellState

E, RHO = 210e9, 7850.0
PLAIN = ShellMaterial(RHO, E, 0.0)


def clamped(x, at=0.0):
    fixed = np.zeros((len(x), 6), dtype=bool)
    fixed[np.abs(x[:, 0] - at) < 1e-9] = True
    return fixed


def period(state, node, end, outputs):
    """Mean period [s] of the z displacement from its zero crossings."""
    z, t = [], []
    for time in np.linspace(0, end, outputs)[1:]:
        state.advance(time)
        z.append(state.position[node, 2])
        t.append(state.time)
    z, t = np.array(z), np.array(t)
    k = np.flatnonzero(z[:-1] * z[1:] < 0)
    crossings = t[k] - z[k] * (t[k + 1] - t[k]) / (z[k + 1] - z[k])
    return 2 * np.diff(crossings).mean()


def test_frequency_of_a_cantilever():
    length, t = 0.2, 2e-3
    x, quads = grid(40, 2, length, 0.02)
    velocity = np.zeros_like(x)
    velocity[:, 2] = 0.01 * (x[:, 0] / length) ** 2 * (6 - 4 * x[:, 0] / length + (x[:, 0] / length) ** 2) / 3
    state = ShellState(model(x, quads, t, PLAIN, fixed=clamped(x), velocity=velocity))
    exact = (1.8751 / length) ** 2 * np.sqrt(E * t**2 / 12 / RHO) / (2 * np.pi)
    # 40 elements: 0.1 %; the rotary inertia of the nodes lowers it less than that
    assert 1 / period(state, len(x) - 2, 2.2 / exact, 120) == pytest.approx(exact, rel=0.005)


def test_frequency_of_a_plate():
    a, t, nu = 0.2, 2e-3, 0.3
    x, quads = grid(20, 20, a, a)
    rim = (x[:, 0] % a < 1e-9) | (x[:, 1] % a < 1e-9) | (a - x[:, 0] < 1e-9) | (a - x[:, 1] < 1e-9)
    fixed = np.zeros((len(x), 6), dtype=bool)
    fixed[rim, :3] = True
    velocity = np.zeros_like(x)
    velocity[:, 2] = 1e-3 * np.sin(np.pi * x[:, 0] / a) * np.sin(np.pi * x[:, 1] / a)
    state = ShellState(model(x, quads, t, ShellMaterial(RHO, E, nu), fixed=fixed, velocity=velocity))
    exact = np.pi / a**2 * np.sqrt(E * t**2 / 12 / (1 - nu**2) / RHO)
    assert 1 / period(state, 10 * 21 + 10, 2.2 / exact, 120) == pytest.approx(exact, rel=0.01)


def test_large_deflection_of_a_cantilever():
    length, width, t = 0.1, 0.01, 2e-3
    x, quads = grid(20, 2, length, width)
    load = 2 * E * width * t**3 / 12 / length**2
    share = np.array([0.25, 0.5, 0.25])
    loads = [NodalLoad(60 + i, "z", [0, 0.01], [0, load * share[i]]) for i in range(3)]
    settings = {"damping": 2000.0, "thickness_update": False}
    state = ShellState(model(x, quads, t, PLAIN, fixed=clamped(x), loads=loads, settings=settings))
    state.advance(0.03)
    tip = state.position[61]
    # 20 elements: 1 %
    assert tip[2] / length == pytest.approx(0.4935, rel=0.01)
    assert 1 - tip[0] / length == pytest.approx(0.1606, rel=0.02)
    assert abs(state.energies["residual"]) < 1e-3 * state.energies["external_work"]


def twisted(direction, correction, nx=24, ny=4):
    """Deflection of the twisted beam under a unit end load along y or z (inch, pound, second)."""
    x, quads = grid(nx, ny, 12.0, 1.1)
    y, angle = x[:, 1] - 0.55, 0.5 * np.pi * x[:, 0] / 12
    x = np.stack([x[:, 0], y * np.cos(angle), y * np.sin(angle)], axis=1)
    material = ShellMaterial(7.3e-4, 29e6, 0.22)
    end = np.arange(nx * (ny + 1), (nx + 1) * (ny + 1))
    share = np.full(ny + 1, 1.0 / ny)
    share[[0, -1]] /= 2
    loads = [NodalLoad(int(n), direction, [0, 0.02], [0, s]) for n, s in zip(end, share, strict=True)]
    settings = {"damping": 900.0, "warping_correction": correction, "thickness_update": False}
    state = ShellState(model(x, quads, 0.32, material, fixed=clamped(x), loads=loads, settings=settings))
    state.advance(0.06)
    return (state.position - x)[end].mean(axis=0)["xyz".index(direction)]


@pytest.mark.parametrize(("direction", "exact"), [("z", 5.424e-3), ("y", 1.754e-3)])
def test_twisted_beam(direction, exact):
    """With the warping correction within 2 %; without it the nodes' drill is a mechanism."""
    assert twisted(direction, True) == pytest.approx(exact, rel=0.02)
    assert twisted(direction, False) > 5 * exact


def test_wave_in_a_bar():
    """Velocity step at one end: the front arrives at x = c t, and behind it the stress is rho c v."""
    x, quads = grid(200, 1, 1.0, 0.005)
    c, v = np.sqrt(E / RHO), 1.0
    motions = [PrescribedVelocity(n, "x", [0, 4e-5], [0, v]) for n in (0, 1)]
    state = ShellState(model(x, quads, 2e-3, PLAIN, motions=motions))
    state.advance(1.2e-4)
    velocity = state.velocity[0][::2, 0]
    front = np.interp(-0.5, -velocity[:150], x[::2, 0][:150])
    # half of the ramp is past after 2e-5 s
    assert front == pytest.approx(c * (state.time - 2e-5), rel=0.01)
    assert state.point_field("stress_x")[40].mean() == pytest.approx(-RHO * c * v, rel=0.02)


def test_rigid_end_turns_like_the_beam_it_closes():
    """Moment on a rigid end: M L / EI, through rotations of a rigid set's members."""
    length, width, t = 0.1, 0.01, 2e-3
    x, quads = grid(20, 2, length, width)
    moment = 0.3 * E * width * t**3 / 12 / length
    m = model(x, quads, t, PLAIN, fixed=clamped(x), settings={"damping": 2000.0})
    m = replace(
        m,
        rigid_sets=[RigidSet([60, 61, 62], mass=1e-4)],
        loads=[NodalLoad(61, "ry", [0, 0.01], [0, -moment])],
    )
    state = ShellState(m)
    state.advance(0.03)
    turn = state.rigid_sets[0, 9:].reshape(3, 3)
    assert np.arctan2(turn[2, 0], turn[0, 0]) == pytest.approx(0.3, rel=0.01)
