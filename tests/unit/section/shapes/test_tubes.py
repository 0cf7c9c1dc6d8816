import dataclasses
import subprocess
import sys

import numpy as np
import pytest

import crumple
from crumple.errors import InputError
from crumple.section import CircularTube, RectangularTube, Section

TUBE = RectangularTube(0.050, 0.025, 0.00265)
ROUNDED = RectangularTube(0.050, 0.025, 0.00265, 0.005)
PIPE = CircularTube(0.040, 0.002)
TUBES = [TUBE, ROUNDED, PIPE]


def enclosed_area(polygon):
    """Area inside a polygon, positive when it runs counter-clockwise."""
    y, z = polygon.T
    return (y @ np.roll(z, -1) - z @ np.roll(y, -1)) / 2.0


@pytest.mark.parametrize("section", TUBES)
def test_every_tube_is_a_section(section):
    assert isinstance(section, Section)
    assert section.mass_per_length(7850.0) == pytest.approx(7850.0 * section.area)
    assert hash(section) == hash(dataclasses.replace(section))


def test_axes_are_those_of_the_conventions():
    # bending about y: moment vector along y, so the flange runs along y
    assert TUBE.flange_width("y") == TUBE.bending_depth("z") == 0.050
    assert TUBE.bending_depth("y") == TUBE.flange_width("z") == 0.025
    assert TUBE.second_moment_y < TUBE.second_moment_z
    assert TUBE.second_moment("y") == TUBE.second_moment_y
    assert TUBE.second_moment("z") == TUBE.second_moment_z
    with pytest.raises(InputError, match="unknown bending axis"):
        TUBE.second_moment("x")


@pytest.mark.parametrize("section", TUBES)
def test_turned_tube_bends_about_y_as_the_tube_about_z(section):
    turned = section.turned("z")
    assert section.turned("y") == section
    assert turned.second_moment_y == pytest.approx(section.second_moment_z)
    assert turned.plastic_section_modulus_y == pytest.approx(section.plastic_section_modulus_z)
    assert turned.elastic_section_modulus_z == pytest.approx(section.elastic_section_modulus_y)
    assert turned.torsion_constant == pytest.approx(section.torsion_constant)


@pytest.mark.parametrize("section", TUBES)
def test_outlines_run_counter_clockwise_and_bound_the_metal(section):
    outer, inner = enclosed_area(section.outer_outline()), enclosed_area(section.inner_outline())
    # arcs are drawn as chords, which cut off a little
    assert outer - inner == pytest.approx(section.area, rel=0.01)
    midline = section.outline()
    assert inner < enclosed_area(midline) < outer
    np.testing.assert_allclose(midline.mean(axis=0), 0.0, atol=1e-12)


def test_sharp_outline_has_four_corners_on_the_midline():
    half = np.array([0.050 - 0.00265, 0.025 - 0.00265]) / 2.0
    expected = half * np.array([[1, -1], [1, 1], [-1, 1], [-1, -1]])
    np.testing.assert_allclose(TUBE.outline(), expected, atol=1e-15)


def test_arc_points_lie_on_the_arcs_and_none_repeats():
    outline = RectangularTube(0.050, 0.025, 0.00265, 0.0125).outer_outline()
    right = outline[outline[:, 0] > 0.0125]
    np.testing.assert_allclose(np.hypot(right[:, 0] - 0.0125, right[:, 1]), 0.0125, rtol=1e-12)
    steps = np.linalg.norm(outline - np.roll(outline, 1, axis=0), axis=1)
    assert steps.min() > 1e-4


def test_no_radius_is_the_limit_of_a_small_radius():
    almost = RectangularTube(0.050, 0.025, 0.00265, 1e-9)
    for name in ("area", "second_moment_y", "plastic_section_modulus_z", "torsion_constant"):
        assert getattr(almost, name) == pytest.approx(getattr(TUBE, name), rel=1e-12)


def test_elastic_modulus_is_below_the_plastic_one():
    for section in TUBES:
        for axis in ("y", "z"):
            assert section.elastic_section_modulus(axis) < section.plastic_section_modulus(axis)


@pytest.mark.parametrize(
    ("build", "where"),
    [
        (lambda: RectangularTube(-0.05, 0.025, 0.002), "width"),
        (lambda: RectangularTube(0.05, float("nan"), 0.002), "depth"),
        (lambda: RectangularTube(0.05, 0.025, 0.0), "thickness"),
        (lambda: RectangularTube(0.05, 0.025, 0.0125), "thickness"),
        (lambda: RectangularTube(0.05, 0.025, 0.002, 0.0126), "corner_radius"),
        (lambda: RectangularTube(0.05, 0.025, 0.002, -0.001), "corner_radius"),
        (lambda: CircularTube(0.0, 0.002), "diameter"),
        (lambda: CircularTube(0.04, float("inf")), "thickness"),
        (lambda: CircularTube(0.04, 0.02), "thickness"),
    ],
)
def test_impossible_dimensions_are_refused_by_name(build, where):
    with pytest.raises(InputError) as error:
        build()
    assert [problem.where for problem in error.value.problems] == [where]
    assert error.value.problems[0].todo


def test_import_stays_light():
    heavy = "{'pydantic', 'pint', 'scipy', 'matplotlib', 'h5py', 'pandas', 'ruamel'}"
    code = f"import sys, crumple.section, crumple.hinge; print(sorted({heavy} & set(sys.modules)))"
    answer = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert answer.stdout.strip() == "[]"


@pytest.mark.parametrize(
    ("kind", "sizes"),
    [
        (
            crumple.RectangularTube,
            {"width": 0.05, "depth": 0.025, "thickness": 0.002, "corner_radius": 0.004},
        ),
        (crumple.CircularTube, {"diameter": 0.05, "thickness": 0.002}),
        (crumple.square_tube, {"side": 0.05, "thickness": 0.002}),
        (crumple.MultiCellTube, {"width": 0.06, "depth": 0.04, "thickness": 0.002, "columns": 2}),
        (crumple.Channel, {"width": 0.05, "depth": 0.03, "thickness": 0.002, "lip": 0.01}),
        (crumple.Angle, {"width": 0.05, "depth": 0.03, "thickness": 0.002}),
        (crumple.Hat, {"width": 0.05, "depth": 0.03, "thickness": 0.002, "flange": 0.02}),
        (crumple.ClosedHat, {"width": 0.05, "depth": 0.03, "thickness": 0.002, "flange": 0.02}),
        (crumple.Wall, {"points": ((0.0, 0.0), (0.05, 0.0)), "thickness": 0.002}),
    ],
)
def test_dimensions_are_numbers_or_texts_with_units(kind, sizes):
    def text(size):
        if isinstance(size, tuple):
            return tuple(map(text, size))
        return size if isinstance(size, int) else f"{1e3 * size:.6g} mm"

    assert kind(**{name: text(size) for name, size in sizes.items()}) == kind(**sizes)


def test_texts_that_are_no_lengths_are_refused_by_name():
    with pytest.raises(InputError, match="depth: MPa is the unit of a stress"):
        crumple.RectangularTube(width="50 mm", depth="25 MPa", thickness="2 mm")
