"""One-point shell: patches of constant strain, objectivity, thickness, warping, bad shapes."""

import numpy as np
import pytest
from tests.support.shell.sheets import ELASTIC, STEEL, distorted_patch, grid, model, rotation

from crumple._core.shell.simulation import ShellState, thickness_rule
from crumple.errors import InputError

E, NU, T = 210e9, 0.3, 2e-3
C, G = E / (1 - NU**2), E / 2 / (1 + NU)
SMALL = 1e-9  # of displacement gradients, so that second-order terms vanish against round-off of the checks
INNER = slice(4, 8)


def patch_forces(displacement, rotations, settings=None):
    """Forces of the distorted patch under a small nodal displacement and rotation field."""
    x, quads = distorted_patch()
    state = ShellState(model(x, quads, T, settings={"thickness_update": False, **(settings or {})}))
    u, w = displacement(x), rotations(x)
    return x, state, state.deform(x + u, u, w, 1.0)


def test_membrane_patch():
    """Constant membrane strain: the stress is exact everywhere and inner nodes are in balance."""
    gradient = SMALL * np.array([[1.0, 0.3, 0], [0.4, -0.7, 0], [0, 0, 0]])
    _, state, force = patch_forces(lambda x: x @ gradient.T, lambda x: 0 * x)
    stress = state.point_field("stress_x") + state.point_field("stress_y")
    assert stress == pytest.approx(E / (1 - NU) * SMALL * 0.3, rel=1e-8)
    assert abs(force[INNER]).max() < 1e-8 * abs(force[:4]).max()


def test_bending_patch():
    """Linear field of rotations: the bending moment of constant curvature, exact in every element."""
    kappa = SMALL * np.array([1.0, -0.5, 0.7])  # w,xx  w,yy  w,xy

    def deflection(x):
        w = 0.5 * (kappa[0] * x[:, 0] ** 2 + kappa[1] * x[:, 1] ** 2) + kappa[2] * x[:, 0] * x[:, 1]
        return np.stack([0 * w, 0 * w, w], axis=1)

    def slopes(x):
        wx, wy = kappa[0] * x[:, 0] + kappa[2] * x[:, 1], kappa[1] * x[:, 1] + kappa[2] * x[:, 0]
        return np.stack([wy, -wx, 0 * wx], axis=1)

    _, state, force = patch_forces(lambda x: 0 * x, slopes, {"hourglass_membrane": 0.0})
    z, weight = thickness_rule(5)
    # the deflection is held at zero: only the bending part is looked at, whose curvature is constant
    trace = (state.point_field("stress_x") + state.point_field("stress_y")) @ (weight * z)
    assert trace == pytest.approx(-E / (1 - NU) * T * (kappa[0] + kappa[1]) / 12, rel=1e-8)
    assert deflection(distorted_patch()[0]).shape == (8, 3)
    assert np.isfinite(force).all()


def test_shear_patch():
    """Constant transverse shear: equal slopes without rotation give stress 5/6 G gamma and balance inside."""
    slope = SMALL * np.array([1.0, 0.4])
    _, state, force = patch_forces(lambda x: np.outer(x[:, :2] @ slope, [0, 0, 1]), lambda x: 0 * x)
    size = np.hypot(state.element_field("shear_xz"), state.element_field("shear_yz"))
    assert size == pytest.approx(5 / 6 * G * np.hypot(*slope), rel=1e-8)
    assert abs(force[INNER, 2]).max() < 1e-8 * abs(force[:4, 2]).max()


def test_triangle_has_the_strain_of_its_corners():
    x = np.array([[0, 0, 0], [0.03, 0.002, 0], [0.01, 0.02, 0.0]])
    state = ShellState(model(x, np.array([[0, 1, 2, 2]]), T, settings={"thickness_update": False}))
    u = SMALL * x @ np.diag([1.0, 0.5, 0.0])
    force = state.deform(x + u, u, 0 * x, 1.0)
    assert (state.point_field("stress_x") + state.point_field("stress_y")) == pytest.approx(
        E / (1 - NU) * 1.5 * SMALL, rel=1e-8
    )
    assert force[:, :3].sum(axis=0) == pytest.approx(0, abs=1e-12 * abs(force).max())
    assert state.element_field("hourglass_energy") == pytest.approx(0, abs=1e-30)


@pytest.mark.parametrize("warp", [0.0, 0.002])
@pytest.mark.parametrize("correction", [True, False])
def test_large_rigid_rotation_is_free_of_stress(warp, correction):
    """Turns about a skew axis, flat and warped: exact but for warping terms of second order in the step."""
    x, quads = distorted_patch()
    x[4:, 2] += warp * np.array([1, -1, 1, -0.5])
    x[:4, 2] += warp * np.array([-1, 1, -0.6, 1])
    state = ShellState(model(x, quads, T, settings={"warping_correction": correction}))
    axis, step = np.array([0.3, -0.5, 0.81]), np.radians(0.05 if warp and correction else 0.5)
    axis /= np.linalg.norm(axis)
    turn, now, worst = rotation(step * axis), x - x.mean(axis=0), 0.0
    for _ in range(1440):
        after = now @ turn.T
        force = state.deform(after, after - now, np.broadcast_to(step * axis, x.shape), 1.0)
        now = after
    assert np.isfinite(force).all()
    for name in ("stress_x", "stress_y", "stress_xy"):
        worst = max(worst, abs(state.point_field(name)).max())
    # sym(grad u) alone would leave (1 - cos 0.5 deg) 1440 = 0.055 of E
    assert worst < (1e-6 if warp and correction else 1e-12) * E
    # third order in the step
    assert abs(state.element_field("shear_xz")).max() < 1e-6 * E


def test_stress_turns_with_the_element():
    """A stressed element that is turned rigidly keeps its stress in its own axes, and its forces turn."""
    x, quads = grid(1, 1, 0.01, 0.01)
    state = ShellState(model(x, quads, T))
    u = 1e-4 * x @ np.diag([1.0, 0, 0])
    before = state.deform(x + u, u, 0 * x, 1.0)
    stress = state.point_field("stress_x")
    now, turn = x + u, rotation(np.radians(0.5) * np.array([0, 0, 1.0]))
    for _ in range(180):
        after = now @ turn.T
        force = state.deform(after, after - now, np.broadcast_to([0, 0, np.radians(0.5)], x.shape), 1.0)
        now = after
    assert state.point_field("stress_x") == pytest.approx(stress, rel=1e-6)
    assert force[:, 1] == pytest.approx(before[:, 0], rel=1e-5)
    assert force[:, 0] == pytest.approx(-before[:, 1], rel=1e-5)


def test_thickness_follows_elastic_and_plastic_strain():
    """Elastic: -nu/E sigma.  Plastic flow in uniaxial strain: volume kept but for the elastic part."""
    x, quads = grid(1, 1, 0.01, 0.01)
    state = ShellState(model(x, quads, T, STEEL))
    u = 1e-3 * x @ np.diag([1.0, -NU, 0])
    state.deform(x + u, u, 0 * x, 1.0)
    assert state.element_field("thickness")[0] / T - 1 == pytest.approx(-NU * 1e-3, rel=3e-3)
    for _ in range(1000):
        v = 1e-4 * (x + u) @ np.diag([1.0, 0, 0])
        u = u + v
        state.deform(x + u, v, 0 * x, 1.0)
    now = x + u
    area = np.ptp(now[:, 0]) * np.ptp(now[:, 1])
    trace = (state.point_field("stress_x") + state.point_field("stress_y"))[0, 0]
    assert state.element_field("thickness")[0] * area / (T * 1e-4) == pytest.approx(
        1 + (1 - 2 * NU) / E * trace, rel=1e-12
    )


def test_hourglass_control_resists_and_books_its_work():
    x, quads = grid(1, 1, 0.01, 0.01)
    mode = 1e-8 * np.array([1, -1, 1, -1.0])[[0, 1, 3, 2]]
    for axis in range(3):
        for kind in ("stiffness", "viscous"):
            from crumple._core.shell.simulation import Hourglass

            state = ShellState(model(x, quads, T, settings={"hourglass": Hourglass(kind)}))
            u = np.zeros((4, 3))
            u[:, axis] = mode
            force = state.deform(x + u, u, 0 * x, 1.0)
            assert np.sum(force[:, :3] * u) > 0
            work = 0.5 * np.sum(force[:, :3] * u)
            assert state.element_field("hourglass_energy")[0] == pytest.approx(work, rel=1e-6)
            assert abs(state.point_field("stress_x")).max() < 1.0


@pytest.mark.parametrize("points", range(1, 11))
@pytest.mark.parametrize("lobatto", [False, True])
def test_thickness_rules_integrate_polynomials(points, lobatto):
    if lobatto and points == 1:
        pytest.skip("Lobatto needs two points")
    z, weight = thickness_rule(points, lobatto)
    for power in range(2 * points - (3 if lobatto else 1) + 1):
        exact = 0.0 if power % 2 else 0.5**power / (power + 1)
        assert (weight @ z**power) == pytest.approx(exact, abs=1e-15)


def moved(x, node, place):
    x = x.copy()
    x[node, :2] = place
    return x


def bad(change):
    x, quads = grid(2, 2, 0.02, 0.02)
    arguments = {"thickness": T, "material": ELASTIC}
    x, quads = change(x, quads.copy(), arguments)
    return model(x, quads, **arguments)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda x, q, a: (x, q[:, [0, 2, 1, 3]]), "element 0: it has no area"),
        (lambda x, q, a: (moved(x, 4, 0.002), q), "element 0: it is crossed or not convex at corner 3"),
        (lambda x, q, a: (x * [1, 0, 1], q), "element 0: it has no area"),
        (lambda x, q, a: (x, np.where(q == 4, 0, q)), "element 0: node 0 appears twice"),
        (lambda x, q, a: (moved(x, 4, x[1, :2]), q), "element 0: corners 3 and 4 coincide"),
        (lambda x, q, a: (x, q + 1), "does not exist"),
        (lambda x, q, a: a.update(thickness=0.0) or (x, q), "element 0: its thickness"),
        (lambda x, q, a: a.update(material=type(ELASTIC)(0.0, E, NU)) or (x, q), "material 0: its density"),
        (lambda x, q, a: (np.where(x == 0.01, np.nan, x), q), "is not finite"),
        (lambda x, q, a: a.update(points=11) or (x, q), "1 to 10 thickness points"),
    ],
)
def test_bad_models_are_refused_by_name(change, words):
    with pytest.raises(InputError, match=words):
        ShellState(bad(change))


def test_frame_prefers_no_side():
    """Under shear stress the stiffness is unsymmetric by what elastic volume change leaves, alike for both.

    A frame tied to side 1-2 gives 0.60 for one side and -0.17 for the other, in units of stress times volume,
    and then short waves gain energy from nothing.
    """
    x, quads = grid(1, 1, 0.01, 0.01)
    x -= x.mean(axis=0)
    stress = 1e-3 * x @ np.array([[0, 0.5, 0], [0.5, 0, 0], [0, 0, 0]])
    unit = 1e-3 * E * T * 1e-4

    def work(motion, test):
        force = []
        for sign in (1e-6, -1e-6):
            state = ShellState(model(x, quads, T))
            state.deform(x + stress, stress, 0 * x, 1.0)
            force.append(state.deform(x + stress + sign * motion, sign * motion, 0 * x, 1.0)[:, :3])
        return np.sum((force[0] - force[1]) * test) / 2e-6 / unit

    shear = np.outer(x[:, 0], [0, 1, 0])
    along, across = np.outer(x[:, 0], [1, 0, 0]), np.outer(x[:, 1], [0, 1, 0])
    first, second = (work(shear, m) - work(m, shear) for m in (along, across))
    assert first == pytest.approx(second, abs=0.02)
    assert abs(first) < 0.3
