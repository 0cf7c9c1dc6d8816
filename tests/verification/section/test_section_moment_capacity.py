"""Moment capacity of sections of walls: closed forms, and effective sections assembled by hand.

Thick-walled tubes: the exact plastic moment (1696 N m for 50x25x2.65 mm at 488 MPa).  Thin-walled ones:
linear stress with reduced plates, assembled from rectangles by hand with its own iteration of the neutral
axis; 2 %, because yield is checked in the outer fibre in the product and in the mid-line here.  Axial
force: exact limit analysis of the thin box.

Kind: closed form; independent calculation.  Source: derived here; derived here.
"""

import math

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
    moment_capacity,
)
from crumple.section.capacity.buckling import held_coefficient, plate_stress, width_factor

MM = 1e-3
STEEL = Material("steel", 206e9, 0.3, 7850.0, 488e6)
SECTIONS = [
    RectangularTube(50 * MM, 25 * MM, 2.65 * MM),
    CircularTube(50 * MM, 2 * MM),
    Channel(50 * MM, 100 * MM, 2 * MM, 4 * MM, 15 * MM),
    Angle(50 * MM, 40 * MM, 3 * MM),
    Hat(60 * MM, 50 * MM, 1.5 * MM, 20 * MM, 4 * MM),
    ClosedHat(60 * MM, 50 * MM, 1.5 * MM, 20 * MM, 4 * MM),
    MultiCellTube(100 * MM, 60 * MM, 2 * MM, 2, 2),
]


@pytest.mark.parametrize(("axis", "expected"), [("y", 1696.09), ("z", 2822.79)])
def test_stout_tube_reaches_its_plastic_moment(axis, expected, record_figure):
    capacity = moment_capacity(RectangularTube(50 * MM, 25 * MM, 2.65 * MM), STEEL, axis)
    assert capacity.buckling_ratio > 2.0
    record_figure(f"50x25x2.65 about {axis}", capacity.moment, expected, 0.01, "N m")


def iterated_box(a, b, t, metal):
    """Effective moment of a thin box by fixed-point iteration of the neutral axis, rectangles by hand."""
    yield_stress = metal.yield_stress
    flange = a * width_factor(plate_stress(4.0, a, t, metal) / yield_stress)
    depth = b / 2
    for _ in range(200):
        psi = -(b - depth) / depth
        web = b * width_factor(plate_stress(held_coefficient(psi), b, t, metal) / yield_stress)
        near, far = web / (3 - psi), web / 2
        hole = max(depth - near - far, 0.0)
        # parts: length, distance of the centre from the compressed edge, own extent in depth
        parts = [(flange, 0.0, 0.0), (a, b, 0.0)]
        for sign, length, centre in ((1, b, b / 2), (-1, hole, near + hole / 2)):
            parts += 2 * [(sign * length, centre, length)]
        area = sum(length for length, _, _ in parts)
        middle = sum(length * centre for length, centre, _ in parts) / area
        depth = middle
    second = t * sum(
        length * (centre - middle) ** 2 + length * extent**2 / 12 for length, centre, extent in parts
    )
    return yield_stress * second / max(middle, b - middle)


def test_slender_box_against_an_iteration_by_hand(record_figure):
    # mid-line 100 x 60, t = 0.5: outer fibres are 0.8 % further out, the only difference
    a, b, t = 100 * MM, 60 * MM, 0.5 * MM
    capacity = moment_capacity(RectangularTube(a + t, b + t, t), STEEL)
    assert capacity.moment == capacity.effective_moment
    assert capacity.buckling_ratio < 1.0
    record_figure("slender box", capacity.moment, iterated_box(a, b, t, STEEL), 0.02, "N m", relative=True)


def test_stout_webs_give_the_bracket_of_a_reduced_flange(record_figure):
    # thin flanges on thick webs: only the compression flange is reduced
    a, b, flange, web = 100 * MM, 40 * MM, 0.5 * MM, 1.5 * MM
    half, top = a / 2, b / 2
    walls = [
        Wall(((-half, sign * top), (half, sign * top)), flange, name=f"flange {sign}") for sign in (-1, 1)
    ]
    walls += [Wall(((sign * half, -top), (sign * half, top)), web, name=f"web {sign}") for sign in (-1, 1)]
    capacity = moment_capacity(WallSection(tuple(walls)), STEEL)
    assert {part.plate.split(",")[0] for part in capacity.lost} == {"flange -1"}
    left = a * width_factor(plate_stress(4.0, a, flange, STEEL) / STEEL.yield_stress)
    parts = [(left * flange, 0.0, 0.0), (a * flange, b, 0.0), (2 * b * web, b / 2, b)]
    area = sum(size for size, _, _ in parts)
    middle = sum(size * z for size, z, _ in parts) / area
    second = sum(size * ((z - middle) ** 2 + extent**2 / 12) for size, z, extent in parts)
    expected = STEEL.yield_stress * second / max(middle, b - middle)
    record_figure("reduced flange", capacity.effective_moment, expected, 0.02, "N m", relative=True)


def test_box_with_axial_force(record_figure):
    a, b, t = 50 * MM, 25 * MM, 0.025 * MM
    stiff = Material("stiff", 1e18, 0.3, 7850.0, 488e6)  # nothing buckles
    tube = RectangularTube(a + t, b + t, t)
    squash = 488e6 * tube.area
    whole = moment_capacity(tube, stiff).moment
    for n, m in ((0.2, 0.928), (1 / 3, 0.8), (0.5, 0.6)):
        for sign in (1, -1):
            value = moment_capacity(tube, stiff, axial_force=sign * n * squash).moment / whole
            record_figure(f"m at n = {sign * n:.3f}", value, m, 5e-4)


def test_regimes_join_without_jumps():
    # thickness from slender to stout in small steps: no step larger than its neighbours explain
    for build in (
        lambda t: RectangularTube(60 * MM, 40 * MM, t),
        lambda t: Hat(60 * MM, 50 * MM, t, 20 * MM, 4 * MM),
        lambda t: Channel(50 * MM, 100 * MM, t),
    ):
        thickness = np.linspace(0.6, 4.0, 137) * MM
        moments = np.array([moment_capacity(build(t), STEEL).moment for t in thickness])
        steps = np.diff(moments)
        assert (steps > 0.0).all()
        # smooth: second differences small against the steps
        assert np.abs(np.diff(steps)).max() < 0.6 * steps.max()


@pytest.mark.parametrize("section", SECTIONS, ids=lambda section: section.title)
def test_values_lie_in_order(section):
    for axis in ("y", "z", 0.3):
        for sense in (1, -1):
            c = moment_capacity(section, STEEL, axis, sense=sense)
            assert 0.0 < c.effective_moment <= c.elastic_moment * (1 + 1e-9)
            assert c.elastic_moment <= c.plastic_moment * (1 + 1e-9)
            assert c.effective_moment * (1 - 1e-9) <= c.moment <= c.plastic_moment * (1 + 1e-9)
            assert c.regime


def test_symmetric_sections_are_as_strong_both_ways_and_a_hat_is_not(record_figure):
    for section in (SECTIONS[0], SECTIONS[2], SECTIONS[6]):
        plus, minus = (moment_capacity(section, STEEL, "y", sense=s).moment for s in (1, -1))
        assert plus == pytest.approx(minus, rel=1e-6)
    thin = Hat(60 * MM, 50 * MM, 1.0 * MM, 20 * MM)
    # sense +1 stretches the crown and compresses the free flanges, sense -1 the other way round
    plus, minus = (moment_capacity(thin, STEEL, "y", sense=s) for s in (1, -1))
    assert abs(plus.moment / minus.moment - 1) > 0.05
    assert "free" not in minus.governing
    # turned upside down the senses change places
    turned = moment_capacity(thin, STEEL, math.pi, sense=1)
    assert turned.moment == pytest.approx(minus.moment, rel=1e-9)


def test_elastic_moment_is_first_yield_of_the_gross_section(record_figure):
    for section in SECTIONS[2:]:
        value = moment_capacity(section, STEEL).elastic_moment
        record_figure(
            f"first yield, {section.title}",
            value,
            488e6 * section.elastic_section_modulus("y"),
            1e-3,
            "N m",
            relative=True,
        )


def test_weak_plate_yields_first():
    soft = Material("soft", 206e9, 0.3, 7850.0, 200e6)
    hat = ClosedHat(60 * MM, 50 * MM, 3 * MM, 20 * MM, plate_material=soft)
    both = moment_capacity(hat, STEEL)
    strong = moment_capacity(ClosedHat(60 * MM, 50 * MM, 3 * MM, 20 * MM), STEEL)
    weak = moment_capacity(ClosedHat(60 * MM, 50 * MM, 3 * MM, 20 * MM), soft)
    assert weak.plastic_moment < both.plastic_moment < strong.plastic_moment
    assert weak.elastic_moment <= both.elastic_moment < strong.elastic_moment
