import math
import subprocess
import sys

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from crumple.errors import InputError
from crumple.material import Material
from crumple.section import (
    Angle,
    Channel,
    CircularTube,
    ClosedHat,
    Hat,
    MultiCellTube,
    RectangularTube,
    Section,
    Wall,
    WallSection,
    Weld,
    moment_capacity,
    outline_section,
    walls_of,
)

MM = 1e-3
SHAPES = [
    Channel(50 * MM, 100 * MM, 2 * MM),
    Channel(50 * MM, 100 * MM, 2 * MM, 4 * MM, 15 * MM),
    Angle(50 * MM, 40 * MM, 3 * MM, 5 * MM),
    Hat(60 * MM, 50 * MM, 1.5 * MM, 20 * MM, 4 * MM),
    ClosedHat(60 * MM, 50 * MM, 1.5 * MM, 20 * MM, 4 * MM),
    MultiCellTube(100 * MM, 60 * MM, 2 * MM, 3, 2),
    walls_of(RectangularTube(50 * MM, 25 * MM, 2.65 * MM, 5 * MM)),
]
HALF = 50 * MM
STEEL = Material("steel", 210e9, 0.3, 7850.0, 300e6)


def refused(*walls, welds=()):
    with pytest.raises(InputError) as error:
        WallSection(tuple(walls), tuple(welds))
    return error.value.problems


def line(*points, thickness=2 * MM, name="", closed=False, corner_radius=0.0):
    return Wall(tuple((MM * y, MM * z) for y, z in points), thickness, corner_radius, closed, name=name)


@pytest.mark.parametrize("section", SHAPES, ids=lambda section: section.title)
def test_every_shape_is_a_section(section):
    assert isinstance(section, Section)
    assert isinstance(hash(section), int)
    assert section.title
    assert section.mass_per_length(7850.0) == pytest.approx(7850.0 * section.area)
    for axis in ("y", "z"):
        assert 0.0 < section.elastic_section_modulus(axis) < section.plastic_section_modulus(axis)
    assert section.flange_width("y") == pytest.approx(section.bending_depth("z"))
    contours = [section.outer_outline(), *section.inner_outlines()]
    enclosed = [float(y @ np.roll(z, -1) - z @ np.roll(y, -1)) / 2 for y, z in (c.T for c in contours)]
    assert all(area > 0 for area in enclosed)
    if not section.welds:
        # chords cut a little off the arcs
        assert enclosed[0] - sum(enclosed[1:]) == pytest.approx(section.area, rel=3e-3)
    assert bool(len(section.inner_outline())) == (bool(section.skeleton.cells) and len(contours) > 1)


def test_outline_of_an_open_section_goes_there_and_back():
    outline = Channel(50 * MM, 100 * MM, 2 * MM).outline()
    y, z = outline.T
    assert len(outline) == 6
    assert float(y @ np.roll(z, -1) - z @ np.roll(y, -1)) == pytest.approx(0.0, abs=1e-15)


def test_outline_of_a_tube_is_its_midline():
    tube = RectangularTube(50 * MM, 25 * MM, 2.65 * MM)
    ours, theirs = walls_of(tube).outline(), tube.outline()
    assert {tuple(point) for point in ours.round(9)} == {tuple(point) for point in theirs.round(9)}


def test_walls_of_knows_every_section_and_keeps_walls():
    assert walls_of(SHAPES[0]) is SHAPES[0]
    assert walls_of(CircularTube(50 * MM, 2 * MM)).skeleton.cells
    assert walls_of(CircularTube(50 * MM, 2 * MM)) is walls_of(CircularTube(50 * MM, 2 * MM))


def test_channel_by_hand_is_the_channel():
    drawn = outline_section([(49e-3, -49e-3), (0, -49e-3), (0, 49e-3), (49e-3, 49e-3)], 2e-3, closed=False)
    shape = Channel(50 * MM, 100 * MM, 2 * MM)
    assert drawn.properties == shape.properties


def test_wall_that_ends_on_another_joins_it():
    # a T: the stem ends on the flat of the flange
    flange, stem = line((-HALF / MM, 0), (HALF / MM, 0)), line((0, 0), (0, -60), thickness=3 * MM)
    tee = WallSection((flange, stem))
    assert tee.area == pytest.approx(0.1 * 2e-3 + (60 * MM - 1 * MM) * 3e-3)
    # two flats that meet in one point: the shear centre is there
    y, z = tee.properties.centroid
    np.testing.assert_allclose(tee.shear_centre, (-y, -z), atol=1e-9)


def test_step_in_thickness_is_cut_square():
    blank = WallSection((line((-40, 0), (0, 0), thickness=1 * MM), line((0, 0), (40, 0), thickness=3 * MM)))
    assert blank.area == pytest.approx(40e-3 * 4e-3)
    assert blank.thickness == pytest.approx(2 * MM)


# as far away as the axes of a vehicle are; there points are rounded at 2e-15 m, 1e-12 of a thickness
@given(st.floats(-3.2, 3.2), st.floats(-10.0, 10.0), st.floats(-10.0, 10.0), st.sampled_from(SHAPES))
@example(0.125, 0.0, 0.1875, SHAPES[4])
@example(1.0, 9.0, -7.0, SHAPES[4])
def test_properties_turn_and_move_with_the_section(angle, dy, dz, shape):

    def placed(point):
        y, z = point
        c, s = math.cos(angle), math.sin(angle)
        return (c * y - s * z + dy, s * y + c * z + dz)

    walls = [
        Wall(tuple(map(placed, w.points)), w.thickness, w.corner_radius, w.closed, name=w.name)
        for w in shape.walls
    ]
    welds = [Weld(placed(w.first), placed(w.second)) for w in shape.welds]
    moved, own = WallSection(tuple(walls), tuple(welds)), shape.properties
    new = moved.properties
    np.testing.assert_allclose(new.centroid, placed(own.centroid), rtol=0, atol=1e-12)
    y, z = own.shear_centre
    c, s = math.cos(angle), math.sin(angle)
    np.testing.assert_allclose(new.shear_centre, (c * y - s * z, s * y + c * z), rtol=0, atol=1e-12)
    np.testing.assert_allclose(new.principal_moments, own.principal_moments, rtol=1e-10)
    for name in ("area", "torsion_constant", "warping_constant"):
        np.testing.assert_allclose(getattr(new, name), getattr(own, name), rtol=1e-10, err_msg=name)
    for name in ("plastic_section_modulus", "elastic_section_modulus", "bending_depth"):
        turned, expected = getattr(moved, name)(0.4 + angle), getattr(shape, name)(0.4)
        np.testing.assert_allclose(turned, expected, rtol=1e-10, err_msg=name)
    # about axes along and across most walls
    for axis in (0.0, math.pi / 2):
        turned, expected = moment_capacity(moved, STEEL, axis + angle), moment_capacity(shape, STEEL, axis)
        np.testing.assert_allclose(turned.effective_moment, expected.effective_moment, rtol=1e-10)


def test_welds_close_a_cell_as_rigid_lines():
    # Bredt through the weld lines in the middle of the flanges, and every strip by itself
    t, hat = 1.5 * MM, ClosedHat(60 * MM, 50 * MM, 1.5 * MM, 20 * MM)
    area = (60 * MM - t) * (50 * MM - t) + 80 * MM * t
    around = 2 * (40 * MM - (30 * MM - t / 2)) + 2 * (50 * MM - t) + 60 * MM - t + 80 * MM
    strips = around + 4 * 10 * MM
    expected = 4 * area**2 * t / around + strips * t**3 / 3
    twice = WallSection(hat.walls, hat.welds * 2)
    for section in (hat, twice):
        np.testing.assert_allclose(section.torsion_constant, expected, rtol=1e-13)
    np.testing.assert_allclose(twice.warping_constant, hat.warping_constant, rtol=1e-12)


@given(st.floats(20e-3, 200e-3), st.floats(20e-3, 200e-3), st.floats(0.3e-3, 6e-3))
def test_principal_axes_bound_every_other(width, depth, thickness):
    angle = Angle(width, depth, thickness)
    largest, smallest = angle.properties.principal_moments
    every = [angle.second_moment(turn) for turn in np.linspace(0, np.pi, 13)]
    assert max(every) <= largest * (1 + 1e-9)
    assert min(every) >= smallest * (1 - 1e-9)
    assert angle.second_moment(angle.properties.principal_angle) == pytest.approx(largest)
    total = angle.second_moment_y + angle.second_moment_z
    assert largest + smallest == pytest.approx(total)


@given(st.floats(1e-3, 8e-3))
def test_sharp_is_the_limit_of_round(radius):
    # second order in the radius: a bend lacks (1 - pi/4)(R^2 - (R - t)^2) of the sharp corner
    sharp, t = Hat(60 * MM, 50 * MM, 1 * MM, 20 * MM), 1 * MM
    bent = Hat(60 * MM, 50 * MM, 1 * MM, 20 * MM, radius)
    lacking = 4 * (1 - math.pi / 4) * (radius**2 - (radius - t) ** 2)
    assert sharp.area - bent.area == pytest.approx(lacking, rel=1e-6)


def test_walls_may_be_of_other_metals():
    light = Material("light", 70e9, 0.33, 2700.0, 200e6)
    heavy = Material("heavy", 210e9, 0.3, 7850.0, 400e6)
    section = WallSection((Wall(((0, 0), (0.1, 0)), 2e-3), Wall(((0, 0), (0, 0.1)), 2e-3, material=light)))
    names = [metal.name for metal in section.metals(heavy)]
    assert names == ["heavy", "light"]
    assert section.transformed(heavy).centroid[1] < section.properties.centroid[1]


def test_walls_stay_light_to_import():
    heavy = "{'pydantic', 'pint', 'scipy', 'matplotlib', 'h5py', 'pandas', 'ruamel'}"
    code = (
        "import sys, crumple.section as s; [getattr(s, name) for name in s.__all__]; "
        f"print(sorted({heavy} & set(sys.modules)))"
    )
    answer = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert answer.stdout.strip() == "[]"


# what cannot be a section


def test_crossing_walls():
    (problem,) = refused(line((-40, 0), (40, 0), name="shelf"), line((0, -40), (0, 40), name="post"))
    assert problem.what == "walls cross: shelf and post"
    assert problem.todo


def test_outline_that_crosses_itself():
    problems = refused(line((0, 0), (40, 40), (40, 0), (0, 40), closed=True))
    assert problems[0].what == "walls cross: walls[0] and itself"


def test_gap_of_a_wall_that_stops_short():
    problems = refused(line((-40, 0), (40, 0), name="shelf"), line((0, -1.2), (0, -40), name="post"))
    assert "gap between post and shelf" in [problem.what for problem in problems]


def test_gap_between_two_ends():
    problems = refused(line((-40, 0), (0, 0)), line((1.0, 0), (40, 0)))
    assert any(problem.what.startswith("gap between") for problem in problems)


def test_overlapping_walls():
    problems = refused(line((-40, 0), (40, 0)), line((-40, 0), (-40, 30), (-20, 30), (-20, 1.2), (20, 1.2)))
    assert any(problem.what.startswith("walls overlap") for problem in problems)


def test_side_of_no_length():
    (problem,) = refused(line((0, 0), (40, 0), (40, 0), (40, 30)))
    assert problem.what == "the wall has a side without length"
    assert problem.where == "walls[0].points[1]"


def test_closed_wall_that_repeats_its_first_point():
    (problem,) = refused(line((0, 0), (40, 0), (40, 40), (0, 0), closed=True))
    assert "does not repeat its first" in problem.todo


def test_loose_parts():
    (problem,) = refused(line((-40, 0), (40, 0), name="upper"), line((-40, -20), (40, -20), name="lower"))
    assert problem.what == "the section consists of 2 separate parts"
    assert problem.came == "upper; lower" or problem.came == "lower; upper"


def test_walls_folded_on_each_other():
    problems = refused(line((0, 0), (40, 0), (0, 4)))
    assert any(problem.what.startswith("walls fold back") for problem in problems)


def test_thick_wall():
    (problem, *_) = refused(line((0, 0), (40, 0), (40, 5), (0, 5), closed=True, thickness=6 * MM))
    assert "overlap" in problem.what or "too thick" in problem.what


def test_radius_without_room():
    problems = refused(line((0, 0), (40, 0), (40, 10), (80, 10), corner_radius=12 * MM))
    assert problems[0].what == "the corner radius does not fit the side"


def test_weld_off_the_walls_or_between_walls_apart():
    first, second = line((-40, 0), (40, 0)), line((-40, -2), (40, -2))
    good = Weld((0.02, 0.0), (0.02, -0.002))
    assert WallSection((first, second), (good,)).skeleton.cells == []
    problems = refused(first, second, welds=[Weld((0.02, 0.001), (0.02, -0.002))])
    assert problems[0].what == "the weld is not on a wall"
    problems = refused(first, line((-40, -9), (40, -9)), welds=[Weld((0.02, 0.0), (0.02, -0.009))])
    assert problems[0].what == "the welded walls do not touch"


@pytest.mark.parametrize(
    ("build", "where"),
    [
        (lambda: WallSection(()), ""),
        (lambda: WallSection((line((0, 0)),)), "walls[0].points"),
        (lambda: WallSection((line((0, 0), (math.nan, 0)),)), "walls[0].points"),
        (lambda: WallSection((line((0, 0), (40, 0), thickness=-1.0),)), "walls[0].thickness"),
        (lambda: WallSection((line((0, 0), (40, 0), corner_radius=-1.0),)), "walls[0].corner_radius"),
        (lambda: Channel(50 * MM, 100 * MM, 60 * MM), "thickness"),
        (lambda: Channel(50 * MM, 100 * MM, 2 * MM, lip=50 * MM), "lip"),
        (lambda: Channel(-1.0, 100 * MM, 2 * MM), "width"),
        (lambda: Angle(50 * MM, 4 * MM, 2 * MM), "thickness"),
        (lambda: Hat(60 * MM, 50 * MM, 1 * MM, 0.0), "flange"),
        (lambda: ClosedHat(60 * MM, 50 * MM, 1 * MM, 20 * MM, -1.0), "corner_radius"),
        (lambda: MultiCellTube(60 * MM, 50 * MM, 1 * MM, 0), "columns"),
        (lambda: MultiCellTube(60 * MM, 50 * MM, 1 * MM, 2, 1, corner_radius=30 * MM), "corner_radius"),
    ],
)
def test_impossible_dimensions_are_refused_by_name(build, where):
    with pytest.raises(InputError) as error:
        build()
    assert error.value.problems[0].where == where


def test_absurd_slenderness_is_warned_about_by_name():
    (sentence,) = WallSection(
        (line((0, 0), (100, 0), (100, 30), thickness=0.15 * MM, name="skin"),)
    ).warnings[:1]
    assert sentence.startswith("skin, 100 mm flat: ")
    assert Hat(60 * MM, 50 * MM, 1.5 * MM, 20 * MM).warnings == ()


def test_cells_need_not_be_wide():
    with pytest.raises(InputError, match=r"overlap|too thick"):
        MultiCellTube(60 * MM, 50 * MM, 2 * MM, columns=20, inner_thickness=3 * MM)
