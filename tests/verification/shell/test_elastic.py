"""Elastic shells in motion: frequencies, large rotations, twisted beam, pinched cylinder, waves.

- Cantilever strip, first bending frequency: (1.8751/L)^2 sqrt(EI/rho A), Euler-Bernoulli; L/t = 100, nu =
  0.
- Square plate, simply supported, first frequency: 2 (pi/a)^2 sqrt(D/rho t), Kirchhoff; a/t = 100.
- Cantilever under an end moment 2 pi EI/L: it closes to a circle of radius L/2 pi.
- Cantilever under a dead end load P L^2/EI = 2, the elastica: tip displaced by 0.4935 L across and 0.1606 L
  along (Mattiasson, Int. J. Num. Meth. Eng. 17, 1981, 145-153).
- Twisted beam, 90 degrees over 12 x 1.1 x 0.32, unit end loads: 5.424e-3 in the plane of the end, 1.754e-3
  across (MacNeal and Harder, Finite Elements in Analysis and Design 1, 1985, 3-20).
- Pinched cylinder with diaphragms, quasi-static by damping: the deflection that the same mesh has without
  inertia (tests/verification/shell/test_linear.py, where its mesh is refined).
- Longitudinal wave in a bar: speed sqrt(E/rho), stress rho c v.

Tolerances are those of the mesh (stated beside each), not of the time integration.

Kind: closed form; published.  Source: textbook; quoted.
"""

from dataclasses import replace

import numpy as np
import pytest
from tests.support.shell.sheets import grid, model
from tests.support.shell.statics import solve

from crumple._core.shell.simulation import (
    Element,
    NodalLoad,
    PrescribedVelocity,
    RigidSet,
    ShellMaterial,
    ShellModel,
    ShellSettings,
    ShellState,
)

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


@pytest.mark.parametrize("element", Element)
def test_frequency_of_a_cantilever(element, record_figure):
    length, t = 0.2, 2e-3
    x, quads = grid(40, 2, length, 0.02)
    velocity = np.zeros_like(x)
    velocity[:, 2] = 0.01 * (x[:, 0] / length) ** 2 * (6 - 4 * x[:, 0] / length + (x[:, 0] / length) ** 2) / 3
    settings = {"element": element}
    state = ShellState(model(x, quads, t, PLAIN, settings=settings, fixed=clamped(x), velocity=velocity))
    exact = (1.8751 / length) ** 2 * np.sqrt(E * t**2 / 12 / RHO) / (2 * np.pi)
    # 40 elements: 0.1 %; the rotary inertia of the nodes lowers it less than that
    found = 1 / period(state, len(x) - 2, 2.2 / exact, 120)
    record_figure(f"cantilever, {element.value}", found, exact, 0.005, "Hz", relative=True)


@pytest.mark.parametrize("element", Element)
def test_frequency_of_a_plate(element, record_figure):
    a, t, nu = 0.2, 2e-3, 0.3
    x, quads = grid(20, 20, a, a)
    rim = (x[:, 0] % a < 1e-9) | (x[:, 1] % a < 1e-9) | (a - x[:, 0] < 1e-9) | (a - x[:, 1] < 1e-9)
    fixed = np.zeros((len(x), 6), dtype=bool)
    fixed[rim, :3] = True
    velocity = np.zeros_like(x)
    velocity[:, 2] = 1e-3 * np.sin(np.pi * x[:, 0] / a) * np.sin(np.pi * x[:, 1] / a)
    settings = {"element": element}
    state = ShellState(
        model(x, quads, t, ShellMaterial(RHO, E, nu), settings=settings, fixed=fixed, velocity=velocity)
    )
    exact = np.pi / a**2 * np.sqrt(E * t**2 / 12 / (1 - nu**2) / RHO)
    found = 1 / period(state, 10 * 21 + 10, 2.2 / exact, 120)
    record_figure(f"simply supported plate, {element.value}", found, exact, 0.01, "Hz", relative=True)


@pytest.mark.parametrize("element", Element)
def test_cantilever_rolls_into_a_circle(element, record_figure):
    """Moment on the free end, raised to 2 pi EI/L and held: the end comes back to the clamp."""
    length, width, t = 0.1, 0.01, 5e-4
    x, quads = grid(20, 2, length, width)
    moment = 2 * np.pi * E * width * t**3 / 12 / length
    share = np.array([0.25, 0.5, 0.25])
    loads = [NodalLoad(60 + i, "ry", [0, 0.06], [0, -moment * share[i]]) for i in range(3)]
    settings = {"damping": 600.0, "thickness_update": False, "element": element}
    state = ShellState(model(x, quads, t, PLAIN, settings=settings, fixed=clamped(x), loads=loads))
    state.advance(0.12)
    end, middle = state.position[61], state.position[31]
    gap = float(np.hypot(end[0], end[2]) / length)
    record_figure(f"gap of the ring over its length, {element.value}", gap, 0.0, 1e-5)
    # a polygon of 20 sides is 0.4 % higher than the circle
    name = f"height of the ring over the circle's, {element.value}"
    record_figure(name, middle[2] / (length / np.pi), 1.0, 0.005)
    # work of a moment that turns its end by 2 pi
    record_figure(
        f"energy over pi M, {element.value}", state.energies["elastic"] / (np.pi * moment), 1.0, 1e-4
    )


def test_large_deflection_of_a_cantilever(record_figure):
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
    record_figure("elastica, aside over length", tip[2] / length, 0.4935, 0.01, relative=True)
    record_figure("elastica, back over length", 1 - tip[0] / length, 0.1606, 0.02, relative=True)
    assert abs(state.energies["residual"]) < 1e-3 * state.energies["external_work"]


@pytest.mark.parametrize("element", Element)
@pytest.mark.parametrize(("direction", "exact"), [("z", 5.424e-3), ("y", 1.754e-3)])
def test_twisted_beam_comes_to_rest(element, direction, exact, record_figure):
    """Load raised slowly with damping; warping terms and drill stiffness on; 24 x 4 elements."""
    nx, ny = 24, 4
    x, quads = grid(nx, ny, 12.0, 1.1)
    y, angle = x[:, 1] - 0.55, 0.5 * np.pi * x[:, 0] / 12
    x = np.stack([x[:, 0], y * np.cos(angle), y * np.sin(angle)], axis=1)
    end = np.arange(nx * (ny + 1), (nx + 1) * (ny + 1))
    share = np.full(ny + 1, 1.0 / ny)
    share[[0, -1]] /= 2
    loads = [NodalLoad(int(n), direction, [0, 0.02], [0, s]) for n, s in zip(end, share, strict=True)]
    settings = {"damping": 900.0, "thickness_update": False, "element": element}
    settings |= {"warping_correction": True, "drill_stiffness": 0.01}
    material = ShellMaterial(7.3e-4, 29e6, 0.22)
    state = ShellState(model(x, quads, 0.32, material, settings=settings, fixed=clamped(x), loads=loads))
    state.advance(0.06)
    found = (state.position - x)[end].mean(axis=0)["xyz".index(direction)]
    name = f"twisted beam, {element.value}, load along {direction}"
    record_figure(name, found, exact, 0.02, "in", relative=True)


@pytest.mark.parametrize("element", Element)
def test_pinched_cylinder_comes_to_rest(element, record_figure):
    """An eighth of the cylinder, 8 x 8 elements, load raised slowly with damping."""
    x, quads = grid(8, 8, 300.0, np.pi / 2)
    along, angle = x[:, 0].copy(), x[:, 1].copy()
    x = np.stack([along, 300 * np.sin(angle), 300 * np.cos(angle)], axis=1)
    held = np.zeros((len(x), 6), dtype=bool)
    held[along < 1e-9] |= np.array([1, 0, 0, 0, 1, 1], dtype=bool)
    held[along > 300 - 1e-9] |= np.array([0, 1, 1, 1, 0, 0], dtype=bool)
    held[angle < 1e-9] |= np.array([0, 1, 0, 1, 0, 1], dtype=bool)
    held[angle > np.pi / 2 - 1e-9] |= np.array([0, 0, 1, 1, 1, 0], dtype=bool)
    settings = ShellSettings(
        element=element, warping_correction=True, drill_stiffness=0.01, thickness_update=False, damping=10.0
    )
    load = NodalLoad(0, "z", [0, 2.0], [0, -0.25])
    at_rest = ShellModel(
        x, quads, 3.0, [ShellMaterial(1e-2, 3e6, 0.3)], fixed=held, loads=[load], settings=settings
    )
    force = np.zeros((len(x), 6))
    force[0, 2] = -0.25
    exact = solve(at_rest, force, held)[0, 2]
    state = ShellState(at_rest)
    state.advance(6.0)
    name = f"pinched cylinder at rest, {element.value}, 8 x 8"
    record_figure(name, state.position[0, 2] - x[0, 2], exact, 1e-4, "in", relative=True)


def test_wave_in_a_bar(record_figure):
    """Velocity step at one end: the front arrives at x = c t, and behind it the stress is rho c v."""
    x, quads = grid(200, 1, 1.0, 0.005)
    c, v = np.sqrt(E / RHO), 1.0
    motions = [PrescribedVelocity(n, "x", [0, 4e-5], [0, v]) for n in (0, 1)]
    state = ShellState(model(x, quads, 2e-3, PLAIN, motions=motions))
    state.advance(1.2e-4)
    velocity = state.velocity[0][::2, 0]
    front = np.interp(-0.5, -velocity[:150], x[::2, 0][:150])
    # half of the ramp is past after 2e-5 s
    record_figure("place of the front", front, c * (state.time - 2e-5), 0.01, "m", relative=True)
    stress = float(state.point_field("stress_x")[40].mean())
    record_figure("stress behind it", stress, -RHO * c * v, 0.02, "Pa", relative=True)


def test_rigid_end_turns_like_the_beam_it_closes(record_figure):
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
    record_figure("turn of the end", float(np.arctan2(turn[2, 0], turn[0, 0])), 0.3, 0.003, "rad")
