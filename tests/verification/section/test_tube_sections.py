"""Properties of rectangular and circular tubes equal closed forms and numerical integration.

Sharp corners: textbook differences of two rectangles; the 50 x 25 x 2.65 mm tube has an area of 369.41
mm^2.  Rounded corners: Gauss integration of the chord width over the depth, tolerance 1e-10 (rounding).
Torsion: finite elements of Prandtl's membrane over the wall of the tube with a free constant in the hole,
extrapolated from two meshes (converged to 1e-4).  Bredt's formula with the term of the wall is approximate:
it neglects the stiffness of sharp corners, 2.8 % in the 50x25x2.65 tube, 0.4 % in a thin one.

Kind: closed form; independent calculation.  Source: textbook; derived here.
"""

import math

import numpy as np
import pytest
from scipy.sparse import coo_matrix
from scipy.sparse.linalg import spsolve

from crumple.section import CircularTube, RectangularTube

PAPER = RectangularTube(0.050, 0.025, 0.00265)


def test_area_of_the_tube(record_figure):
    record_figure("area of the 50x25x2.65 tube", PAPER.area * 1e6, 369.41, 1e-9, "mm^2")
    record_figure("mass per length", PAPER.mass_per_length(7850.0), 2.8998685, 1e-9, "kg/m")


def test_sharp_corners_closed_forms():
    w, d, t = 0.050, 0.025, 0.00265
    wi, di = w - 2 * t, d - 2 * t
    assert PAPER.second_moment_y == pytest.approx((w * d**3 - wi * di**3) / 12, rel=1e-14)
    assert PAPER.second_moment_z == pytest.approx((d * w**3 - di * wi**3) / 12, rel=1e-14)
    assert PAPER.elastic_section_modulus_y == pytest.approx((w * d**3 - wi * di**3) / (6 * d), rel=1e-14)
    assert PAPER.plastic_section_modulus_y == pytest.approx(
        t * (w * (d - t) + (d - 2 * t) ** 2 / 2), rel=1e-13
    )
    assert PAPER.plastic_section_modulus_z == pytest.approx(
        t * (d * (w - t) + (w - 2 * t) ** 2 / 2), rel=1e-13
    )


def chord(width, depth, radius, z):
    """Width of a rounded rectangle at height z; zero outside."""
    from_flat = np.maximum(np.abs(z) - (depth / 2 - radius), 0.0)
    cut = radius - np.sqrt(np.maximum(radius**2 - from_flat**2, 0.0))
    return np.where(np.abs(z) <= depth / 2, width - 2 * cut, 0.0)


def integrated(section, power):
    """Integral of |z|**power over the metal, bending about y."""
    t, radius = section.thickness, section.corner_radius
    outer = (section.width, section.depth, radius)
    inner = (section.width - 2 * t, section.depth - 2 * t, max(radius - t, 0.0))
    place, weight = np.polynomial.legendre.leggauss(60)
    total = 0.0
    for (width, depth, r), sign in ((outer, 1.0), (inner, -1.0)):
        # flat part, then the arcs with z = centre + r sin(angle), which makes their integrand smooth
        centre = depth / 2 - r
        z = centre * (place + 1) / 2
        total += sign * 2 * centre / 2 * weight @ (width * z**power)
        angle = math.pi / 4 * (place + 1)
        z = centre + r * np.sin(angle)
        total += sign * 2 * math.pi / 4 * weight @ (chord(width, depth, r, z) * z**power * r * np.cos(angle))
    return total


@pytest.mark.parametrize("radius", [0.0, 0.001, 0.00265, 0.004, 0.0125])
def test_rounded_corners_against_integration(radius, record_figure):
    tube = RectangularTube(0.050, 0.025, 0.00265, radius)
    for section in (tube, tube.turned("z")):
        assert section.area == pytest.approx(integrated(section, 0), rel=1e-10)
        assert section.plastic_section_modulus_y == pytest.approx(integrated(section, 1), rel=1e-10)
        assert section.second_moment_y == pytest.approx(integrated(section, 2), rel=1e-10)
    name = f"plastic modulus, corner radius {1e3 * radius:g} mm"
    record_figure(name, tube.plastic_section_modulus_y * 1e9, integrated(tube, 1) * 1e9, 1e-6, "mm^3")


def test_round_ends_all_the_way_are_half_circles():
    # radius of half the side: the flat of the web vanishes, and a circle is what remains when w = d
    tube, pipe = RectangularTube(0.04, 0.04, 0.002, 0.02), CircularTube(0.04, 0.002)
    for name in ("area", "second_moment_y", "plastic_section_modulus_y", "elastic_section_modulus_z"):
        assert getattr(tube, name) == pytest.approx(getattr(pipe, name), rel=1e-12)
    # Bredt with t^2/3 in place of the circle's exact t^2/4
    assert tube.torsion_constant == pytest.approx(pipe.torsion_constant, rel=1e-3)


def test_circular_tube_closed_forms():
    D, t = 0.040, 0.002
    pipe, middle = CircularTube(D, t), D - t
    assert pipe.area == pytest.approx(math.pi * middle * t, rel=1e-13)
    assert pipe.second_moment_y == pytest.approx(math.pi * middle * t * (middle**2 + t**2) / 8, rel=1e-13)
    assert pipe.torsion_constant == pytest.approx(2 * pipe.second_moment_z, rel=1e-14)
    assert pipe.plastic_section_modulus_z == pytest.approx(t * (middle**2 + t**2 / 3), rel=1e-13)


def membrane_torsion_constant(section, divisions):
    """Torsion constant by bilinear elements on a quarter of a sharp tube, the hole one unknown."""
    t = section.thickness
    wall = np.linspace(0, t, divisions + 1)

    def lines(half):
        flat = np.linspace(0, half - t, max(2, round((half - t) / t * divisions)) + 1)
        return np.concatenate([flat, half - t + wall[1:]])

    y, z = lines(section.width / 2), lines(section.depth / 2)
    number = np.arange(y.size * z.size).reshape(y.size, z.size)
    hole = (y[:, None] <= section.width / 2 - t + 1e-12) & (z[None, :] <= section.depth / 2 - t + 1e-12)
    number[hole] = number[0, 0]
    fixed = np.zeros_like(hole)
    fixed[-1, :] = fixed[:, -1] = True
    corners = np.stack([number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]], axis=-1).reshape(
        -1, 4
    )
    hy, hz = (np.repeat(np.diff(y), z.size - 1), np.tile(np.diff(z), y.size - 1))
    along_y = np.array([[2, -2, -1, 1], [-2, 2, 1, -1], [-1, 1, 2, -2], [1, -1, -2, 2]]) / 6
    along_z = np.array([[2, 1, -1, -2], [1, 2, -2, -1], [-1, -2, 2, 1], [-2, -1, 1, 2]]) / 6
    stiffness = (hz / hy)[:, None, None] * along_y + (hy / hz)[:, None, None] * along_z
    rows, columns = np.repeat(corners, 4, axis=1), np.tile(corners, (1, 4))
    size = number.size
    matrix = coo_matrix((stiffness.ravel(), (rows.ravel(), columns.ravel())), shape=(size, size)).tocsr()
    load = np.bincount(corners.ravel(), np.repeat(hy * hz / 4, 4), minlength=size)
    free = np.setdiff1d(np.unique(number), number[fixed])
    height = np.zeros(size)
    height[free] = spsolve(matrix[free][:, free].tocsc(), 2.0 * load[free])
    # twice the volume under the membrane, four quarters
    return 2.0 * 4.0 * float(load @ height)


def test_torsion_constant_against_the_membrane(record_figure):
    for tube, tolerance in ((PAPER, 0.03), (RectangularTube(0.1, 0.1, 0.001), 0.005)):
        coarse, fine = (membrane_torsion_constant(tube, divisions) for divisions in (4, 8))
        # the re-entrant corner makes the error fall as h^(4/3)
        exact = fine + (fine - coarse) / (2 ** (4 / 3) - 1)
        name = f"torsion constant, {tube.title}"
        record_figure(name, tube.torsion_constant * 1e12, exact * 1e12, tolerance, "mm^4", relative=True)
