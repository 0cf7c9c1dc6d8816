"""Linear benchmarks of the shell elements, solved statically: pinched cylinder, twisted beam, bent plate.

- Pinched cylinder with diaphragms, R/t = 100, L/R = 2, nu = 0.3: 164.24 P/(E t) under the load (Lindberg,
  Olson and Cowper, Quarterly Bulletin of the National Aeronautical Establishment of Canada, 1969), which is
  1.8248e-5 in the usual numbers.
- Twisted beam, 90 degrees over 12 x 1.1 x 0.32, unit end loads: 5.424e-3 in the plane of the end, 1.754e-3
  across (MacNeal and Harder, Finite Elements in Analysis and Design 1, 1985, 3-20).
- Simply supported square plate under q sin(pi x/a) sin(pi y/a): q a^4/(4 pi^4 D) + q a^2/(2 pi^2 k G t),
  the exact solution of Mindlin's plate for this load.

Tolerances are those of the mesh.  The tangent stiffness comes from the elements of the time integration
(`tests/support/shell/statics.py`).

Kind: published; closed form.  Source: quoted; textbook.
"""

import numpy as np
import pytest
from tests.support.shell.sheets import distorted_patch, grid, model
from tests.support.shell.statics import solve

from crumple._core.shell.simulation import Element, ShellMaterial

BELYTSCHKO_TSAY = {"warping_correction": True, "drill_stiffness": 0.01}
STABILISED = {**BELYTSCHKO_TSAY, "element": Element.STABILISED}
ELEMENTS = {"belytschko-tsay": BELYTSCHKO_TSAY, "stabilised": STABILISED}


def sheet(x, elements, thickness, material, settings):
    return model(x, elements, thickness, material, settings={"thickness_update": False, **settings})


def pinched(n, settings):
    """Deflection under the load of an eighth of the cylinder, n x n elements."""
    x, quads = grid(n, n, 300.0, np.pi / 2)
    along, angle = x[:, 0].copy(), x[:, 1].copy()
    x = np.stack([along, 300 * np.sin(angle), 300 * np.cos(angle)], axis=1)
    held = np.zeros((len(x), 6), dtype=bool)
    middle, top = along < 1e-9, angle < 1e-9
    held[middle] |= np.array([1, 0, 0, 0, 1, 1], dtype=bool)
    held[along > 300 - 1e-9] |= np.array([0, 1, 1, 1, 0, 0], dtype=bool)
    held[top] |= np.array([0, 1, 0, 1, 0, 1], dtype=bool)
    held[angle > np.pi / 2 - 1e-9] |= np.array([0, 0, 1, 1, 1, 0], dtype=bool)
    force = np.zeros((len(x), 6))
    load = int(np.flatnonzero(middle & top)[0])
    force[load, 2] = -0.25
    u = solve(sheet(x, quads, 3.0, ShellMaterial(1.0, 3e6, 0.3), settings), force, held)
    return -u[load, 2]


@pytest.mark.parametrize(("element", "coarse"), [("belytschko-tsay", 0.961), ("stabilised", 0.932)])
def test_pinched_cylinder(element, coarse, record_figure):
    """16 x 16 elements as one-point shells have it, 32 x 32 within 2 %."""
    shares = [pinched(n, ELEMENTS[element]) / 1.8248e-5 for n in (16, 32)]
    record_figure(f"pinched cylinder, {element}, 32 x 32, over 1.8248e-5", shares[1], 1.0, 0.02)
    assert shares[0] == pytest.approx(coarse, abs=0.005)
    assert abs(shares[1] - 1) < abs(shares[0] - 1)


@pytest.mark.parametrize(("element", "bare"), [(Element.BELYTSCHKO_TSAY, 1.093), (Element.STABILISED, 0.993)])
def test_pinched_cylinder_without_warping_terms(element, bare, record_figure):
    """The plain one-point element has no stiffness against drilling and stays 9 % too soft; the other has."""
    share = pinched(32, {"element": element}) / 1.8248e-5
    record_figure(
        f"pinched cylinder, {element}, no warping terms, 32 x 32, over 1.8248e-5", share, bare, 0.005
    )


def twisted(direction, settings, nx=24, ny=4):
    """Deflection of the twisted beam under a unit end load along y or z (inch, pound, second)."""
    x, quads = grid(nx, ny, 12.0, 1.1)
    y, angle = x[:, 1] - 0.55, 0.5 * np.pi * x[:, 0] / 12
    held = np.zeros((len(x), 6), dtype=bool)
    held[x[:, 0] == 0] = True
    x = np.stack([x[:, 0], y * np.cos(angle), y * np.sin(angle)], axis=1)
    share = np.full(ny + 1, 1.0 / ny)
    share[[0, -1]] /= 2
    force, axis = np.zeros((len(x), 6)), "xyz".index(direction)
    force[-ny - 1 :, axis] = share
    u = solve(sheet(x, quads, 0.32, ShellMaterial(7.3e-4, 29e6, 0.22), settings), force, held)
    return u[-ny - 1 :, axis].mean()


@pytest.mark.parametrize("element", ELEMENTS)
@pytest.mark.parametrize(("direction", "exact"), [("z", 5.424e-3), ("y", 1.754e-3)])
def test_twisted_beam(element, direction, exact, record_figure):
    """With warping terms and drill stiffness within 1 %; with neither the drill is a mechanism."""
    name = f"twisted beam, {element}, load along {direction}"
    record_figure(name, twisted(direction, ELEMENTS[element]), exact, 0.01, "in", relative=True)
    bare = {"element": ELEMENTS[element].get("element", Element.BELYTSCHKO_TSAY)}
    assert twisted(direction, bare) > 100 * exact


@pytest.mark.parametrize("direction", ["z", "y"])
def test_drill_stiffness_is_no_tuning_knob(direction):
    """Ten times less or five times more changes little; without it the beam is 18 % too soft and more."""
    exact = {"z": 5.424e-3, "y": 1.754e-3}[direction]
    for share in (0.001, 0.05):
        chosen = {**BELYTSCHKO_TSAY, "drill_stiffness": share}
        assert twisted(direction, chosen) == pytest.approx(exact, rel=0.011)
    assert twisted(direction, {**BELYTSCHKO_TSAY, "drill_stiffness": 0.0}) > 1.17 * exact


def with_triangles(quads):
    """Every quadrilateral cut into two triangles."""
    a, b, c, d = quads.T
    return np.concatenate([np.stack([a, b, c, c], axis=1), np.stack([a, c, d, d], axis=1)])


def plate(n, thickness, elements, settings, distortion=0.0):
    """Deflection in the middle of the simply supported plate over the exact one."""
    x, quads = grid(n, n)
    rim = np.abs(x[:, :2] - 0.5).max(axis=1) > 0.5 - 1e-9
    shift = np.random.default_rng(1).random((len(x), 2)) - 0.5
    x[:, :2] += distortion / n * shift * ~rim[:, None]
    elements = elements(quads)
    at_x, at_y = np.abs(x[:, 0] - 0.5) > 0.5 - 1e-9, np.abs(x[:, 1] - 0.5) > 0.5 - 1e-9
    held = np.zeros((len(x), 6), dtype=bool)
    held[:, [0, 1, 5]] = True
    held[rim, 2] = True
    held[at_x, 3] = True
    held[at_y, 4] = True
    force = np.zeros((len(x), 6))
    for element in elements:
        corners = np.unique(element)
        area = np.linalg.norm(np.cross(x[element[2]] - x[element[0]], x[element[3]] - x[element[1]])) / 2
        at = np.pi * x[corners, :2]
        force[corners, 2] += area / len(corners) * np.sin(at[:, 0]) * np.sin(at[:, 1])
    young, nu = 1e7, 0.3
    u = solve(sheet(x, elements, thickness, ShellMaterial(1.0, young, nu), settings), force, held)
    bending = 12 * (1 - nu**2) / (4 * np.pi**4 * young * thickness**3)
    shear = 2 * (1 + nu) / (2 * np.pi**2 * 5 / 6 * young * thickness)
    middle = int(np.argmin(np.linalg.norm(x[:, :2] - 0.5, axis=1)))
    return u[middle, 2] / (bending + shear)


@pytest.mark.parametrize("thickness", [0.1, 0.001])
def test_plate_of_stabilised_quadrilaterals(thickness, record_figure):
    """A distorted mesh converges with the square of the element size, thick or thin."""
    settings = {"element": Element.STABILISED}
    shares = [plate(n, thickness, lambda q: q, settings, distortion=0.3) for n in (8, 16)]
    record_figure(f"distorted plate, t/a = {thickness}, 16 x 16, over exact", shares[1], 1.0, 0.006)
    assert shares[0] - 1 > 3 * (shares[1] - 1) > 0


def test_one_point_quadrilaterals_lock_when_distorted_and_thin():
    """What the stabilised element is for: curvature of a skew element shears the one-point one."""
    assert plate(16, 0.001, lambda q: q, {}) == pytest.approx(1.0, abs=0.006)
    assert plate(16, 0.001, lambda q: q, {}, distortion=0.3) < 0.9


@pytest.mark.parametrize("distortion", [0.0, 0.3])
def test_plate_of_triangles(distortion, record_figure):
    """Walls as thick as a twentieth of their width and more: 16 x 16 x 2 triangles within 1 %."""
    share = plate(16, 0.05, with_triangles, {}, distortion)
    record_figure(f"plate of triangles, distortion {distortion}, over exact", share, 1.0, 0.01)


def patch_of(kind):
    """Distorted patch of quadrilaterals, of triangles, or of both."""
    x, quads = distorted_patch()
    elements = {"quadrilaterals": quads, "triangles": with_triangles(quads)}
    return x, elements.get(kind, np.concatenate([quads[:2], with_triangles(quads[2:])]))


@pytest.mark.parametrize("kind", ["quadrilaterals", "triangles", "both"])
def test_bending_patch(kind):
    """Constant curvature and twist: inner nodes settle on the exact deflection, without any shear."""
    x, elements = patch_of(kind)
    force, held = np.zeros((8, 6)), np.zeros((8, 6), dtype=bool)
    held[:4] = True
    held[:, [0, 1, 5]] = True
    K = (1.0, 0.5, 0.4)
    exact = np.zeros((8, 6))
    exact[:, 2] = K[0] * x[:, 0] ** 2 / 2 + K[1] * x[:, 1] ** 2 / 2 + K[2] * x[:, 0] * x[:, 1]
    exact[:, 3] = K[1] * x[:, 1] + K[2] * x[:, 0]
    exact[:, 4] = -K[0] * x[:, 0] - K[2] * x[:, 1]
    patch = sheet(x, elements, 1e-3, ShellMaterial(1.0, 1e6, 0.25), {"element": Element.STABILISED})
    u = solve(patch, force, held, exact)
    assert u[4:, 2:5] == pytest.approx(exact[4:, 2:5], rel=1e-5, abs=1e-7)
