"""Properties of thin-walled sections equal closed forms.

Mid-line closed forms derived from the definitions (channel, slit tube, angle, cells): rounding (1e-9) where
the mid-line is straight, 1e-3 where chords represent arcs.  Solid closed forms (differences of rectangles,
parallel axes): rounding.

Kind: closed form.  Source: derived here.
"""

import math
from itertools import pairwise

import numpy as np
import pytest

from crumple.material import Material
from crumple.section import (
    Angle,
    Channel,
    CircularTube,
    ClosedHat,
    Hat,
    MultiCellTube,
    RectangularTube,
    Wall,
    WallSection,
    outline_section,
    square_tube,
    walls_of,
)

MM = 1e-3


def composed(rectangles):
    """Area, centroid, second moment about it of rectangles (width, depth, height of centre)."""
    area = sum(w * d for w, d, _ in rectangles)
    centre = sum(w * d * z for w, d, z in rectangles) / area
    return area, centre, sum(w * d**3 / 12 + w * d * (z - centre) ** 2 for w, d, z in rectangles)


@pytest.mark.parametrize("radius", [0.0, 0.0015, 0.00265, 0.0053, 0.0125])
def test_tubes_as_walls_keep_their_exact_properties(radius, record_figure):
    tube = RectangularTube(0.050, 0.025, 0.00265, radius)
    walls = walls_of(tube)
    for name in ("area", "second_moment_y", "second_moment_z"):
        assert getattr(walls, name) == pytest.approx(getattr(tube, name), rel=1e-6)
    for name in ("plastic_section_modulus_y", "plastic_section_modulus_z"):
        assert getattr(walls, name) == pytest.approx(getattr(tube, name), rel=1e-5)
    assert walls.elastic_section_modulus_y == pytest.approx(tube.elastic_section_modulus_y, rel=1e-3)
    if radius == 0.0 or radius >= tube.thickness:
        assert walls.torsion_constant == pytest.approx(tube.torsion_constant, rel=1e-9)
    name = f"plastic modulus of the tube as walls, corner radius {1e3 * radius:g} mm"
    record_figure(
        name,
        walls.plastic_section_modulus_y * 1e9,
        tube.plastic_section_modulus_y * 1e9,
        1e-3,
        "mm^3",
        relative=True,
    )


def test_circle_as_walls(record_figure):
    tube = CircularTube(0.05, 0.002)
    walls = walls_of(tube)
    for name in ("area", "second_moment_y", "plastic_section_modulus_z", "torsion_constant"):
        value, expected = getattr(walls, name), getattr(tube, name)
        record_figure(f"circular tube as walls, {name}", value, expected, 1e-3, relative=True)
    turned = [walls.elastic_section_modulus(angle) for angle in np.linspace(0, np.pi, 17)]
    np.testing.assert_allclose(turned, tube.elastic_section_modulus("y"), rtol=2e-5)


def test_square_tube_is_the_rectangular_one():
    assert square_tube(0.04, 0.002, 0.003) == RectangularTube(0.04, 0.04, 0.002, 0.003)


def test_channel_solid_and_midline(record_figure):
    width, depth, t = 50 * MM, 100 * MM, 2 * MM
    channel, b, h = Channel(width, depth, t), width - t / 2, depth - t
    area, _, second = composed(
        [(t, depth - 2 * t, 0), (width, t, (depth - t) / 2), (width, t, -(depth - t) / 2)]
    )
    assert channel.area == pytest.approx(area, rel=1e-12)
    record_figure("channel, I_y", channel.second_moment_y * 1e12, second * 1e12, 1e-9, "mm^4", relative=True)
    plastic = width * t * (depth - t) + t * (depth / 2 - t) ** 2
    record_figure(
        "channel, Z_y",
        channel.plastic_section_modulus_y * 1e9,
        plastic * 1e9,
        1e-9,
        "mm^3",
        relative=True,
    )
    torsion = t**3 * (2 * b + h) / 3
    record_figure("channel, J", channel.torsion_constant * 1e12, torsion * 1e12, 1e-9, "mm^4", relative=True)
    # shear centre from the web's mid-line, outwards; sectorial moments of three straight walls
    outwards = 3 * b**2 / (6 * b + h)
    centroid_y = channel.properties.centroid[0]
    place = -(channel.shear_centre[0] + centroid_y)
    record_figure(
        "channel, shear centre from the web", place * 1e3, outwards * 1e3, 1e-9, "mm", relative=True
    )
    assert channel.shear_centre[1] == pytest.approx(0.0, abs=1e-12)
    warping = t * b**3 * h**2 / 12 * (3 * b + 2 * h) / (6 * b + h)
    midline = channel.properties.midline_warping_constant
    record_figure("channel, I_w", midline * 1e18, warping * 1e18, 1e-9, "mm^6", relative=True)


def test_equal_angle(record_figure):
    side, t = 50 * MM, 3 * MM
    angle = Angle(side, side, t)
    # principal axes at 45 degrees, shear centre in the corner of the mid-lines
    assert angle.properties.principal_angle == pytest.approx(math.pi / 4)
    y, z = angle.properties.centroid
    np.testing.assert_allclose(angle.shear_centre, (-y, -z), atol=1e-12)
    area, centre, second = composed([(side, t, t / 2), (t, side - t, (side + t) / 2)])
    assert angle.area == pytest.approx(area)
    assert z + t / 2 == pytest.approx(centre)
    record_figure("angle, I_y", angle.second_moment_y * 1e12, second * 1e12, 1e-9, "mm^4", relative=True)
    # warping across thin walls: (A_midline)^3 / 144
    thin = Angle(side, side, 0.5 * MM)
    midline_area = thin.properties.area
    record_figure(
        "thin equal angle, I_w",
        thin.warping_constant * 1e18,
        midline_area**3 / 144 * 1e18,
        2e-2,
        "mm^6",
        relative=True,
    )


def test_hat_solid(record_figure):
    width, depth, t, flange = 60 * MM, 50 * MM, 1.5 * MM, 20 * MM
    hat = Hat(width, depth, t, flange)
    parts = [(width, t, depth - t / 2), (2 * t, depth - 2 * t, depth / 2), (2 * (flange + t), t, t / 2)]
    area, centre, second = composed(parts)
    assert hat.area == pytest.approx(area, rel=1e-12)
    assert hat.properties.centroid[1] + t / 2 == pytest.approx(centre, rel=1e-12)
    record_figure("hat, I_y", hat.second_moment_y * 1e12, second * 1e12, 1e-9, "mm^4", relative=True)
    # equal areas above and below: the axis lies in the webs
    axis = depth - t - (area / 2 - width * t) / (2 * t)
    plastic = sum(w * d * abs(z - axis) for w, d, z in (parts[0], parts[2]))
    plastic += t * ((depth - t - axis) ** 2 + (axis - t) ** 2)
    record_figure("hat, Z_y", hat.plastic_section_modulus_y * 1e9, plastic * 1e9, 1e-9, "mm^3", relative=True)


def test_slit_circular_tube(record_figure):
    radius, t, n = 30 * MM, 0.5 * MM, 240
    angles = np.linspace(-np.pi, np.pi, n + 1)
    points = radius * np.column_stack([np.cos(angles), np.sin(angles)])
    # a slit wider than the wall, at the left; its width is taken off both ends
    slit = outline_section(points[3:-3], t, closed=False)
    half = angles[-4]
    # closed forms of an arc of half angle a: e = 2 R (sin a - a cos a)/(a - sin a cos a) from its centre
    expected = (
        2 * radius * (math.sin(half) - half * math.cos(half)) / (half - math.sin(half) * math.cos(half))
    )
    place = slit.shear_centre[0] + slit.properties.centroid[0]
    record_figure("slit tube, shear centre", place * 1e3, expected * 1e3, 1e-3, "mm", relative=True)
    torsion = 2 * half * radius * t**3 / 3
    record_figure("slit tube, J", slit.torsion_constant * 1e12, torsion * 1e12, 1e-3, "mm^4", relative=True)


@pytest.mark.parametrize("inner", [1.0, 3.0])
def test_two_equal_cells_carry_no_flow_in_the_wall_between(inner, record_figure):
    tube = MultiCellTube(102 * MM, 42 * MM, 2 * MM, columns=2, inner_thickness=inner * MM)
    w, d, t = 100 * MM, 40 * MM, 2 * MM
    bredt = 4 * (w * d) ** 2 * t / (2 * (w + d))
    walls = (2 * (w + d) * t**3 + d * (inner * MM) ** 3) / 3
    name = f"two equal cells, inner wall {inner:g} mm, J"
    record_figure(name, tube.torsion_constant * 1e12, (bredt + walls) * 1e12, 1e-9, "mm^4", relative=True)


def test_three_cells_against_their_flow_equations(record_figure):
    tube = MultiCellTube(122 * MM, 42 * MM, 2 * MM, columns=3, inner_thickness=1 * MM)
    w, d, t, s = 40 * MM, 40 * MM, 2 * MM, 1 * MM
    # per cell: sum of flow differences times length over thickness = 2 A at unit twist
    end, middle, wall = (2 * w + d) / t + d / s, 2 * w / t + 2 * d / s, d / s
    flow = np.linalg.solve([[end, -wall, 0], [-wall, middle, -wall], [0, -wall, end]], np.full(3, 2 * w * d))
    torsion = 2 * w * d * flow.sum() + ((2 * 3 * w + 2 * d) * t**3 + 2 * d * s**3) / 3
    record_figure("three cells, J", tube.torsion_constant * 1e12, torsion * 1e12, 1e-9, "mm^4", relative=True)


def test_closed_hat_torsion_is_that_of_its_cell_along_the_weld_lines(record_figure):
    width, depth, t, flange = 60 * MM, 50 * MM, 1.5 * MM, 20 * MM
    hat = ClosedHat(width, depth, t, flange)
    weld = hat.welds[1].first[0]
    w, d = width - t, depth - t
    # hat and plate between the welds, the mid-lines of the flanges a thickness above that of the plate
    area = w * d + 2 * weld * t
    length = w + 2 * d + 2 * (weld - w / 2) + 2 * weld
    walls = (hat.skeleton.length * hat.skeleton.thickness**3).sum() / 3
    torsion = 4 * area**2 * t / length + walls
    record_figure("closed hat, J", hat.torsion_constant * 1e12, torsion * 1e12, 1e-6, "mm^4", relative=True)


def test_lipped_channel_shear_centre_and_torsion(record_figure):
    # sectorial integrals by fine sampling of the mid-line, an independent route
    channel = Channel(50 * MM, 100 * MM, 2 * MM, lip=15 * MM)
    points = np.array(channel.walls[0].points)
    steps = [np.linspace(a, b, 4001)[:-1] for a, b in pairwise(points)]
    line = np.concatenate([*steps, points[-1:]])
    middle, side = (line[1:] + line[:-1]) / 2, np.diff(line, axis=0)
    length = np.hypot(*side.T)
    centre = (length @ middle) / length.sum()
    z = middle[:, 1] - centre[1]
    # web at y = 0: pole there, sweep from the middle
    sweep = np.cumsum(middle[:, 0] * side[:, 1] - middle[:, 1] * side[:, 0])
    sweep = sweep - (length @ sweep) / length.sum()
    # symmetric about y: warping -sweep, its moment with z fixes the place of the shear centre on y
    expected = (length @ (sweep * z)) / (length @ (z * z))
    value = channel.shear_centre[0] + channel.properties.centroid[0]
    record_figure(
        "lipped channel, shear centre from the web", value * 1e3, expected * 1e3, 1e-3, "mm", relative=True
    )


def test_two_metals_count_by_their_moduli(record_figure):
    steel = Material("steel", 210e9, 0.3, 7850.0, 300e6)
    aluminium = Material("aluminium", 70e9, 0.3, 2700.0, 200e6)
    hat = ClosedHat(60 * MM, 50 * MM, 1.5 * MM, 20 * MM, plate_thickness=3 * MM, plate_material=aluminium)
    same = ClosedHat(60 * MM, 50 * MM, 1.5 * MM, 20 * MM, plate_thickness=3 * MM)
    both = hat.transformed(steel)
    plate = 100 * MM * 3 * MM
    record_figure(
        "steel and aluminium, area over that of steel",
        both.area * 1e6,
        (same.area - plate + plate / 3) * 1e6,
        1e-9,
        "mm^2",
        relative=True,
    )
    assert hat.area == pytest.approx(same.area)
    assert hat.mass_per_length(7850.0) == pytest.approx(7850.0 * (same.area - plate) + 2700.0 * plate)
    assert both.centroid[1] > same.properties.centroid[1]
    # all of one other metal: moduli over the reference scale everything
    third = WallSection((Wall(((0, 0), (0.1, 0), (0.1, 0.05)), 2 * MM, material=aluminium),))
    assert third.transformed(steel).second_moment_y == pytest.approx(third.second_moment_y / 3)
    assert third.transformed(steel).torsion_constant == pytest.approx(third.torsion_constant / 3)
