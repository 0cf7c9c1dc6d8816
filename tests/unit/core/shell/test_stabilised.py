"""What the stabilised quadrilateral, the triangle and the drill add to the one-point shell."""

import numpy as np
import pytest
from tests.support.shell.sheets import ELASTIC, STEEL, distorted_patch, grid, model, rotation

from crumple._core.shell.simulation import Element, ShellState, thickness_rule

E, NU, T = 210e9, 0.3, 2e-3
G = E / 2 / (1 + NU)
SMALL = 1e-9
STABILISED = {"element": Element.STABILISED, "thickness_update": False}
TRIANGLE = (np.array([[0, 0, 0], [0.01, 0.001, 0], [0.004, 0.008, 0]]), np.array([[0, 1, 2, 2]]))
SQUARE = grid(1, 1, 0.01, 0.01)
TRAPEZOID = (np.array([[0, 0, 0], [0, 0.006, 0], [0.012, -0.002, 0], [0.01, 0.01, 0]]), SQUARE[1])
WARPED = (SQUARE[0] + 1e-3 * np.array([[0, 0, 1], [0, 0, -1], [0, 0, -1], [0, 0, 1]]), SQUARE[1])


def deformed(x, elements, displacement, turn, settings=None, material=ELASTIC):
    """State and nodal forces after one step of a given displacement and rotation."""
    state = ShellState(model(x, elements, T, material, settings=settings or STABILISED))
    return state, state.deform(x + displacement, displacement, turn, 1.0)


def stiffness(x, elements, settings):
    """Tangent of one element by differences, (6 n, 6 n)."""
    n = len(x)
    K = np.zeros((6 * n, 6 * n))
    for k in range(6 * n):
        u = np.zeros((n, 6))
        u[k // 6, k % 6] = SMALL * (0.01 if k % 6 < 3 else 1.0)
        _, force = deformed(x, elements, u[:, :3], u[:, 3:], settings)
        K[:, k] = force.ravel() / u[k // 6, k % 6]
    return K


def lumped(x, elements):
    """Masses and rotary inertias as the stepper lumps them, (6 n,)."""
    shear, plane = 5 / 6 / (2 * (1 + NU)), 1 / (1 - NU**2)
    three = elements[0, 2] == elements[0, 3]
    a, b, c, d = x[elements[0]]
    area = np.linalg.norm(np.cross(c - a, d - b)) / 2
    mass = 7850 * T * area / len(x)
    inertia = mass * (T**2 + (2 if three else 1) * 3 * shear / (plane - shear) * area) / 12
    return np.tile([mass] * 3 + [inertia] * 3, len(x))


@pytest.mark.parametrize("shape", [SQUARE, TRAPEZOID, WARPED, TRIANGLE])
@pytest.mark.parametrize("drill", [0.0, 0.05])
def test_rank_symmetry_and_stable_step(shape, drill):
    """Only rigid motion and a free drill strain nothing, and no mode is beyond the step that is taken."""
    settings = {**STABILISED, "warping_correction": drill > 0, "drill_stiffness": drill, "safety": 1.0}
    K, M = stiffness(*shape, settings), lumped(*shape)
    assert np.abs(K - K.T).max() < 1e-7 * np.abs(K).max()
    squared = np.linalg.eigvalsh((K + K.T) / 2 / np.sqrt(np.outer(M, M)))
    free = len(shape[0]) if len(shape[0]) == 3 or drill == 0 else 0
    assert np.sum(np.abs(squared) < 1e-8 * squared[-1]) == 6 + free + (len(shape[0]) == 3)
    assert squared[0] > -1e-8 * squared[-1]
    # a warped element lies 0.3 % beyond the bound of a flat one, which the factor of safety covers
    assert np.sqrt(squared[-1]) * ShellState(model(*shape, T, settings=settings)).first_time_step < 2.006


@pytest.mark.parametrize("triangles", [False, True])
def test_constant_strains_of_a_distorted_patch(triangles):
    """Membrane and transverse shear: exact stress in every element, inner nodes in balance."""
    x, quads = distorted_patch()
    if triangles:
        quads = np.concatenate([quads[:, [0, 1, 2, 2]], quads[:, [0, 2, 3, 3]]])
    gradient = SMALL * np.array([[1.0, 0.3, 0], [0.4, -0.7, 0], [0.8, 0.5, 0]])
    state, force = deformed(x, quads, x @ gradient.T, 0 * x)
    trace = state.point_field("stress_x") + state.point_field("stress_y")
    assert trace == pytest.approx(E / (1 - NU) * SMALL * 0.3, rel=1e-8)
    size = np.hypot(state.element_field("shear_xz"), state.element_field("shear_yz"))
    assert size == pytest.approx(5 / 6 * G * SMALL * np.hypot(0.8, 0.5), rel=1e-8)
    assert np.abs(force[4:, :3]).max() < 1e-8 * np.abs(force[:4, :3]).max()
    assert state.element_field("hourglass_energy") == pytest.approx(0, abs=1e-25)


def test_bending_in_its_plane_is_exact():
    """One rectangle bent in its plane: the moment of a beam, E I kappa, free of shear and of nu."""
    x, quads = grid(1, 1, 0.02, 0.01)
    x = x - x.mean(axis=0)
    # the corners of pure bending: u = -kappa x y
    u = np.stack([-SMALL * x[:, 0] * x[:, 1] / 0.01, 0 * x[:, 0], 0 * x[:, 0]], axis=1)
    _, force = deformed(x, quads, u, 0 * x)
    moment = -np.sum(force[2:, 0] * x[2:, 1])
    assert moment == pytest.approx(E * T * 0.01**3 / 12 * SMALL / 0.01, rel=1e-7)
    assert force[:, 1] == pytest.approx(0, abs=1e-9 * np.abs(force).max())


def test_twist_is_free_of_shear():
    """w = x y with the rotations of Kirchhoff's plate: the moment of twist alone, no transverse shear."""
    x, quads = SQUARE
    x = x - x.mean(axis=0)
    twist = SMALL / 0.01
    w = np.stack([0 * x[:, 0], 0 * x[:, 0], twist * x[:, 0] * x[:, 1]], axis=1)
    turn = np.stack([twist * x[:, 0], -twist * x[:, 1], 0 * x[:, 0]], axis=1)
    state, force = deformed(x, quads, w, turn)
    energy = 0.5 * np.sum(force[:, :3] * w) + 0.5 * np.sum(force[:, 3:] * turn)
    assert energy == pytest.approx(0.5 * G * T**3 / 12 * (2 * twist) ** 2 * 1e-4, rel=1e-7)
    assert state.element_field("hourglass_energy") == pytest.approx(0, abs=1e-9 * energy)


def test_triangle_bends_without_shear():
    """Corners of a quadratic deflection with its slopes: constant curvature and no transverse shear."""
    x, triangle = TRIANGLE
    k = SMALL * np.array([1.0, -0.5, 0.7])
    w = 0.5 * (k[0] * x[:, 0] ** 2 + k[1] * x[:, 1] ** 2) + k[2] * x[:, 0] * x[:, 1]
    slope = np.stack([k[0] * x[:, 0] + k[2] * x[:, 1], k[1] * x[:, 1] + k[2] * x[:, 0]], axis=1)
    turn = np.stack([slope[:, 1], -slope[:, 0], 0 * w], axis=1)
    state, _ = deformed(x, triangle, np.outer(w, [0, 0, 1]), turn)
    z, weight = thickness_rule(5)
    bending = (state.point_field("stress_x") + state.point_field("stress_y")) @ (weight * z)
    assert bending == pytest.approx(-E / (1 - NU) * T * (k[0] + k[1]) / 12, rel=1e-7)
    assert np.hypot(state.element_field("shear_xz"), state.element_field("shear_yz")) == pytest.approx(
        0, abs=1e-9 * G * SMALL * 0.01
    )


@pytest.mark.parametrize("shape", [SQUARE, WARPED, TRIANGLE])
def test_large_rigid_rotation_is_free_of_force(shape):
    """Two turns about a skew axis in steps of a twentieth of a degree."""
    settings = {**STABILISED, "warping_correction": True, "drill_stiffness": 0.01}
    x = shape[0] - shape[0].mean(axis=0)
    state = ShellState(model(x, shape[1], T, settings=settings))
    axis = np.radians(0.05) * np.array([0.3, -0.5, 0.81]) / np.linalg.norm([0.3, -0.5, 0.81])
    turn, now = rotation(axis), x
    for _ in range(1440):
        after = now @ turn.T
        force = state.deform(after, after - now, np.broadcast_to(axis, x.shape), 1.0)
        now = after
    assert np.abs(force[:, :3]).max() < 1e-6 * E * T * 0.01


def test_held_strains_yield_with_the_metal():
    """In-plane bending far beyond yield while the middle flows: the held moment stays below plastic."""
    x, quads = grid(1, 1, 0.01, 0.01)
    x = x - x.mean(axis=0)
    state = ShellState(model(x, quads, T, STEEL, settings=STABILISED))
    v = np.stack([5e-4 * x[:, 0] - 0.03 * x[:, 0] * x[:, 1], -2.5e-4 * x[:, 1], 0 * x[:, 0]], axis=1)
    for _ in range(400):
        force = state.deform(x, v, 0 * x, 1.0)
    moment = abs(np.sum(force[2:, 0] * x[2:, 1]))
    assert moment < 488e6 * T * 0.01**2 / 4
    assert moment > 0.1 * 488e6 * T * 0.01**2 / 4


def test_drill_resists_and_books_its_work():
    x, quads = SQUARE
    turn = np.zeros((4, 3))
    turn[:, 2] = 1e-6 * np.array([1, 2, 0, 0])
    settings = {**STABILISED, "drill_stiffness": 0.02}
    state, force = deformed(x, quads, 0 * x, turn, settings)
    assert force[:, 5] == pytest.approx(0.02 / 4 * G * T * 1e-4 * turn[:, 2], rel=1e-6)
    assert state.element_field("hourglass_energy")[0] == pytest.approx(
        0.5 * np.sum(force[:, 3:] * turn), rel=1e-6
    )
    # moments of the corners are balanced by a couple of forces
    couple = np.sum(np.cross(x, force[:, :3]), axis=0)[2]
    assert couple + force[:, 5].sum() == pytest.approx(0, abs=1e-12 * np.abs(force).max())
