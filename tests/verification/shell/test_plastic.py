"""Plastic shells: limit loads, a closed form of combined loading, and another explicit code.

- Strip of an elastic-perfectly plastic metal: plastic moment M_p = yield b t^2/4 as the integration points
  represent it (five Gauss points have 94.5 % of it, ten 100.8 %); limit load of a cantilever between M_p/L
  and 1.155 M_p/L.
- Circular plate under pressure, simply supported: between 6 M_p/R^2, exact for Tresca's yield condition,
  and 2/sqrt(3) times that: the ellipse of von Mises lies between Tresca's hexagon and the hexagon larger by
  this factor.
- Bar of an incompressible metal pulled to yield and then sheared at constant length: tau = Y/sqrt(3)
  tanh(sqrt(3) G gamma/Y), sigma = Y/cosh(sqrt(3) G gamma/Y) (derived below).
- A tube on the same mesh in OpenRadioss (Belytschko-Tsay); skipped unless the environment variable
  CRUMPLE_REFERENCE names the folder of its input and histories.

Kind: closed form; other code.  Source: derived here; run here.
"""

import os
from pathlib import Path

import numpy as np
import pytest
from tests.support.shell.sheets import grid, model
from tests.support.shell.tube_reference import compared, run, tube

from crumple._core.shell.simulation import (
    Cut,
    Element,
    NodalLoad,
    PrescribedVelocity,
    RigidSet,
    ShellMaterial,
    ShellState,
    thickness_rule,
)

LENGTH, WIDTH, WALL, YIELD = 0.1, 0.01, 4e-3, 300e6
REFERENCE = Path(os.environ.get("CRUMPLE_REFERENCE", "reference"))


def strip(points, motions, damping=2000.0, **more):
    """Strip 100 x 10 x 4 mm, clamped at x = 0 but free to contract in width there; cut 0 is the clamp."""
    x, quads = grid(40, 4, LENGTH, WIDTH)
    fixed = np.zeros((len(x), 6), dtype=bool)
    fixed[x[:, 0] == 0] = [True, False, True, False, True, True]
    fixed[2, 1] = True
    cut = Cut(np.arange(4), np.arange(5))
    material = ShellMaterial(7850.0, 210e9, 0.3, yield_stress=YIELD)
    settings = {"damping": damping}
    return ShellState(
        model(x, quads, WALL, material, points, settings, fixed=fixed, motions=motions, cuts=[cut], **more)
    )


def plastic_moment(points):
    """Moment with every thickness point at yield [N m]."""
    z, weight = thickness_rule(points)
    return YIELD * WIDTH * WALL**2 * (weight @ abs(z))


def late(state, kind, axis, times):
    """Mean of a component of the clamp's force (0) or moment (1)."""
    values = []
    for time in times:
        state.advance(time)
        values.append(state.cut(0)[kind][axis])
    return abs(np.mean(values))


@pytest.mark.parametrize("points", [5, 10])
def test_plastic_moment_of_a_strip(points, record_figure):
    """End turned without a force: every section yields, and the moment is the plastic one."""
    turn = PrescribedVelocity(0, "ry", [0, 0.01], [0, -30.0], rigid_set=True)
    state = strip(points, [turn], 200.0, rigid_sets=[RigidSet(range(200, 205), mass=1e-3)])
    moment = late(state, 1, 1, np.linspace(0.014, 0.022, 60))
    # of ten points the two nearest the middle, which carry 2 %, are just about to yield
    name = f"plastic moment of a strip, {points} points"
    record_figure(name, moment, plastic_moment(points), 0.03, "N m", relative=True)


@pytest.mark.parametrize("points", [5, 10])
def test_limit_load_of_a_cantilever(points, record_figure):
    """End pushed aside: a hinge as short as one element, held in width by what stays elastic.

    So the load lies between those of plane stress and plane strain (factor 1.155); the arm ends in the
    middle of the first element.
    """
    motions = [PrescribedVelocity(n, "z", [0, 0.01, 0.012], [0, 1.0, 0.01]) for n in range(200, 205)]
    state = strip(points, motions)
    force = late(state, 0, 2, np.linspace(0.014, 0.018, 20))
    limit = plastic_moment(points) / (LENGTH - 0.5 * LENGTH / 40)
    # the middle of the bounds; the tolerance is half their distance
    record_figure(f"limit load of a cantilever over M_p/L, {points} points", force / limit, 1.0774, 0.0773)
    e = state.energies
    assert e["hourglass"] < 0.05 * e["plastic"]
    assert abs(e["residual"]) < 1e-3 * e["external_work"]


def disc(n, radius):
    """Quarter of a disc, n x n quadrilaterals, and which nodes lie on its rim."""
    x, quads = grid(n, n)
    out = x.max(axis=1)
    far = np.maximum(np.hypot(x[:, 0], x[:, 1]), 1e-12)
    return x * ((1 - out) + out**2 / far)[:, None] * radius, quads, out > 1 - 1e-9


def with_triangles(quads):
    a, b, c, d = quads.T
    return np.concatenate([np.stack([a, b, c, c], axis=1), np.stack([a, c, d, d], axis=1)])


@pytest.mark.parametrize("kind", ["belytschko-tsay", "stabilised", "triangles"])
def test_limit_load_of_a_circular_plate(kind, record_figure):
    """Pressure at a deflection of t/20: yielding has spread, membrane forces do not carry yet."""
    radius, t, yields, points = 0.2, 0.02, 30e6, 10
    x, quads, rim = disc(8, radius)
    elements = with_triangles(quads) if kind == "triangles" else quads
    fixed = np.zeros((len(x), 6), dtype=bool)
    fixed[rim, 2] = True
    fixed[x[:, 0] < 1e-9] |= np.array([1, 0, 0, 0, 1, 1], dtype=bool)
    fixed[x[:, 1] < 1e-9] |= np.array([0, 1, 0, 1, 0, 1], dtype=bool)
    z, weight = thickness_rule(points)
    tresca = 6 * yields * t**2 * (weight @ abs(z)) / radius**2
    share = np.zeros(len(x))
    for element in elements:
        corners = np.unique(element)
        area = np.linalg.norm(np.cross(x[element[2]] - x[element[0]], x[element[3]] - x[element[1]])) / 2
        share[corners] += area / len(corners)
    loads = [
        NodalLoad(int(n), "z", [0, 0.1], [0, 1.3 * tresca * share[n]]) for n in np.flatnonzero(~fixed[:, 2])
    ]
    metal = ShellMaterial(7850.0, 210e9, 0.3, yield_stress=yields)
    settings = {
        "damping": 300.0,
        "element": Element.STABILISED if kind == "stabilised" else Element.BELYTSCHKO_TSAY,
    }
    state = ShellState(model(x, elements, t, metal, points, settings, fixed=fixed, loads=loads))
    pressure, deflection = [0.0], [0.0]
    for time in np.linspace(0.0, 0.1, 40)[1:]:
        state.advance(time)
        pressure.append(1.3 * state.time / 0.1)
        deflection.append(state.position[0, 2] / t)
    limit = float(np.interp(0.05, deflection, pressure))
    # the middle of the bounds; the tolerance is half their distance
    record_figure(f"circular plate, {kind}, over Tresca's load", limit, 1.0774, 0.0773)


def tension_then_shear(steps):
    """Stress (axial, shear) over the yield stress, and the closed form.

    With sigma = Y cos(phi), sqrt(3) tau = Y sin(phi) and no axial strain, flow gives
    dep/Y = -dsigma/(E sigma), and for E = 3 G the shear strain is the integral of Y/(sqrt(3) G cos(phi)).
    """
    young, yields = 210e9, 300e6
    G, gamma = young / 3, 2.5 * yields / (young / 3)
    metal = ShellMaterial(7850.0, young, 0.5, yield_stress=yields)
    x, quads = grid(1, 1, 0.01, 0.01)
    state = ShellState(model(x, quads, 2e-3, metal))
    strain = yields / young
    for e, g, number in ((strain, 0.0, 1), (0.0, gamma, steps)):
        u = x @ np.array([[e, g / 2, 0], [g / 2, -e / 2, 0], [0, 0, 0]]) / number
        for _ in range(number):
            state.deform(x, u, 0 * x, 1.0)
    s = np.sqrt(3) * G * gamma / yields
    exact = np.array([1 / np.cosh(s), np.tanh(s) / np.sqrt(3)])
    found = np.array([state.point_field(name)[0, 0] for name in ("stress_x", "stress_xy")]) / yields
    return found, exact


def test_tension_then_shear(record_figure):
    """The implicit return is of first order in the step: half the step, half the error."""
    coarse, exact = tension_then_shear(200)
    fine, _ = tension_then_shear(400)
    record_figure("axial stress over yield", fine[0], exact[0], 0.005)
    record_figure("shear stress over yield", fine[1], exact[1], 0.002)
    assert np.abs(fine - exact).max() < 0.6 * np.abs(coarse - exact).max()


@pytest.mark.slow
@pytest.mark.skipif(not REFERENCE.exists(), reason="the reference runs are not here")
def test_tube_like_the_other_code():
    """Same mesh and element: rotations, time, root moment, absorbed energy within 3 %."""
    r = np.genfromtxt(REFERENCE / "tube_weak_axis_bt_5mm.csv", delimiter=",", names=True)
    h = run(tube(REFERENCE / "tube_weak_axis_bt_5mm_0000.rad", warping_correction=False), threads=2)
    for name, ours, theirs in compared(h, r):
        assert ours == pytest.approx(theirs, rel=0.03), name
    assert h["hourglass"].max() < 0.05 * h["kinetic"][0]
    assert abs(h["residual"]).max() < 1e-4 * h["kinetic"][0]


@pytest.mark.slow
@pytest.mark.skipif(not REFERENCE.exists(), reason="the reference runs are not here")
def test_tube_like_the_other_code_s_stabilised_element(record_figure):
    """The other code's QEPH on 2.5 mm elements: rotations, their time, peak moment, energy within 5 %."""
    r = np.genfromtxt(REFERENCE / "tube_weak_axis_qeph_fine.csv", delimiter=",", names=True)
    deck = REFERENCE / "tube_weak_axis_qeph_fine_0000.rad"
    h = run(tube(deck, element=Element.STABILISED), threads=2)
    for name, ours, theirs in compared(h, r):
        # moments at a time hold bending vibration of the tube
        if " at " not in name or "energy" in name:
            record_figure(f"QEPH, {name}", ours, theirs, 0.05, relative=True)
    assert abs(h["residual"]).max() < 1e-4 * h["kinetic"][0]
