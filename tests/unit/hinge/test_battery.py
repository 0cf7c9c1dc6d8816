"""What every law of bending must satisfy, over all registered laws and many sections.

A new law joins by its registration alone, unless it needs options of its own: then give them in `OPTIONS`.
Every case is solved on every section that is drawn, so a law that refuses one fails.  What is left out:

- Sections beyond a law's range: `SECTIONS` brings those drawn into it.  The refusals have a test at the end.
- A turned section has the law of the other axis: not for profiles, whose axis is their own, nor for circular
  tubes, which have no other axis.
- Both senses alike: not for the cases in `ASYMMETRIC`, which must have `symmetric` false.
- Laws of crushing and of torsion: tests/verification/hinge/test_axial_crushing.py, test_torsion_collapse.py.
- Unloading on the elastic line, dissipation and history belong to the kernels:
  tests/unit/core/spatial/test_hinge_element.py.
"""

import dataclasses
import functools
import math
import pickle

import numpy as np
import pytest
from hypothesis import given, seed, settings
from hypothesis import strategies as st

from crumple.errors import InputError
from crumple.hinge import (
    HingeLaw,
    SofteningVariable,
    Trust,
    absorbed_energy,
    build_law,
    law_types,
    record_of,
)
from crumple.hinge.measured.law_file import stored_law, write_law
from crumple.material import CowperSymonds, Material
from crumple.material.hardening.swift import Swift
from crumple.section import Channel, CircularTube, ClosedHat, Hat, RectangularTube
from crumple.section.shapes.angle import Angle
from crumple.section.wall_section import outline_section

ERROR = 1e-4
STEEL = Material("steel", 210e9, 0.3, 7850.0, 355e6, flow_rate=CowperSymonds(6844.0, 3.91))
HARDENING = dataclasses.replace(STEEL, name="hardening", hardening=Swift(355e6, 0.01, 0.15))
FILE = write_law(
    stored_law(build_law("kecman", RectangularTube(0.05, 0.025, 0.00265), STEEL), {"method": "formula"})
)
OPTIONS = {
    "file": [{"text": FILE}],
    "table": [
        {"rotation": [0.0, 0.05, 0.3, 1.0], "moment": [900.0, 1000.0, 500.0, 400.0]},
        {
            "rotation": [0.0, 0.5],
            "moment": [1000.0, 400.0],
            "negative_rotation": [0.0],
            "negative_moment": [300.0],
        },
    ],
    "kecman": [
        {"start": start, "after_jamming": after, "rolling_weight": weight}
        for start, after, weight in [
            ("cap", "second_fold", 1.0),
            ("cap", "hold", 0.0),
            ("cap", "stop", 0.5),
            ("parabola", "second_fold", 0.0),
            ("parabola", "stop", 1.0),
        ]
    ],
    "library": [{}, {}],
    "wierzbicki": [{"after_jamming": after} for after in ("second_fold", "stop", "hold")],
    "oblique": [
        {"angle": 0.3, "after_jamming": "second_fold"},
        {"angle": math.pi / 4, "after_jamming": "hold"},
        {"angle": 1.2, "after_jamming": "stop", "rolling_weight": 0.0},
    ],
    "mitred_corner": [
        {"angle": math.pi / 2},
        {"angle": 0.5, "closing": "negative"},
        {"angle": math.pi / 2},
        {"angle": 0.1, "closing": "negative"},
        {"angle": 1.2},
        {"angle": 0.6, "closing": "negative"},
    ],
    "mitred_corner_across": [{"angle": math.pi / 2}, {"angle": 0.5, "about": "tangent"}],
    "measured": [
        {
            "rotations": [(0.0, 0.004, 0.006, 0.01, 0.02, 0.1, 0.4)],
            "moments": [(0.0, 200.0, 300.0, 500.0, 900.0, 700.0, 400.0)],
            "scatter": 0.1,
        }
    ],
    "hardening_tube": [{}, {}],
    "hardening_section": [{}, {}],
    "circular": [{"after_jamming": "stop", "rolling_weight": 0.0}, {"after_jamming": "second_fold"}],
    "folded_profile": [{}, {"rolling_weight": 0.0}, *({"after_jamming": x} for x in ("second_fold", "stop"))],
    "folded_plates": [{}, {}],
}
ASYMMETRIC = {
    ("table", 1),
    *(("folded_profile", number) for number in range(4)),
    ("folded_plates", 0),
    ("hardening_section", 0),
    *(("mitred_corner", number) for number in range(6)),
}


ROUND = {
    ("library", 1),
    ("hardening_tube", 1),
    ("clamped_tube", 0),
    ("mitred_corner", 2),
    ("mitred_corner", 3),
}
"""Round tubes of laws that take others too."""


def sheet(tube):
    """Wall of a profile: its edges must stay clear of each other."""
    return min(tube.thickness, 0.05 * tube.width, 0.05 * tube.depth)


def square(tube):
    """The only tube that the law of square tubes takes."""
    side = min(tube.width, tube.depth)
    return RectangularTube(side, side, tube.thickness, tube.corner_radius)


def slender(tube):
    """Walls so thin that a parabola touches the mechanism before jamming; it fails from 0.12 sides on."""
    wall = min(tube.thickness, 0.1 * tube.width, 0.1 * tube.depth)
    return RectangularTube(tube.width, tube.depth, wall, tube.corner_radius)


def rectangular_walls(width, depth, thickness):
    """A tube that is given wall by wall, so that it has no formula."""
    y, z = (width - thickness) / 2.0, (depth - thickness) / 2.0
    return outline_section([(-y, -z), (y, -z), (y, z), (-y, z)], thickness)


def solved(tube):
    """Within the proportions of the library, with sharp corners."""
    longest = 1.4 * min(tube.width, tube.depth)
    width, depth = min(tube.width, longest), min(tube.depth, longest)
    larger = max(width, depth)
    return RectangularTube(width, depth, float(np.clip(tube.thickness, larger / 59.0, larger / 18.6)))


def solved_round(tube):
    """A round tube within the proportions of the library."""
    wall = float(np.clip(tube.thickness, tube.width / 59.0, tube.width / 15.5))
    return CircularTube(tube.width, wall)


# sections with the tube's dimensions that the law takes
SECTIONS = {
    ("wierzbicki", None): square,
    ("kecman", 3): slender,
    ("kecman", 4): slender,
    ("library", 0): solved,
    ("library", 1): solved_round,
    ("clamped_tube", None): solved_round,
    ("hardening_tube", 1): lambda s: CircularTube(s.width, s.thickness),
    ("circular", None): lambda s: CircularTube(s.width, s.thickness),
    ("mitred_corner", 2): lambda s: CircularTube(s.width, s.thickness),
    ("mitred_corner", 3): lambda s: CircularTube(s.width, s.thickness),
    ("mitred_corner", 4): lambda s: ClosedHat(s.width, s.depth, sheet(s), 0.3 * s.width),
    ("mitred_corner", 5): lambda s: ClosedHat(s.width, s.depth, sheet(s), 0.3 * s.width),
    ("folded_profile", 0): lambda s: Channel(s.width, s.depth, sheet(s)),
    ("folded_profile", 1): lambda s: Channel(s.width, s.depth, sheet(s), lip=0.2 * s.depth),
    ("folded_profile", 2): lambda s: Hat(s.width, s.depth, sheet(s), 0.3 * s.width),
    ("folded_profile", 3): lambda s: ClosedHat(s.width, s.depth, sheet(s), 0.3 * s.width),
    ("folded_plates", 0): lambda s: Angle(s.width, s.depth, sheet(s)),
    ("folded_plates", 1): lambda s: rectangular_walls(s.width, s.depth, sheet(s)),
    ("hardening_section", 0): lambda s: Hat(s.width, s.depth, sheet(s), 0.3 * s.width),
    ("hardening_section", 1): lambda s: rectangular_walls(s.width, s.depth, sheet(s)),
}
FACE = {Channel: "z", Hat: "y", ClosedHat: "y"}
# auto is one of the others
CASES = [
    (name, number) for name in law_types() if name != "auto" for number in range(len(OPTIONS.get(name, [{}])))
]

tubes = st.builds(
    lambda width, ratio, slender, corner: RectangularTube(
        width, width * ratio, min(width, width * ratio) * slender, corner * min(width, width * ratio) / 2
    ),
    st.floats(0.02, 0.2),
    st.sampled_from([0.3, 0.5, 1.0, 2.0, 3.0]),
    st.floats(0.005, 0.2),
    st.sampled_from([0.0, 0.2]),
)
shares = st.lists(st.floats(0.0, 1.0), min_size=1, max_size=8)


@functools.cache
def law_of(case, section, axis="y"):
    """Law of a case; to build it takes longer than most of what is asked of it."""
    name, number = case
    options = OPTIONS.get(name, [{}])[number]
    build = SECTIONS.get((name, number)) or SECTIONS.get((name, None))
    if build is not None:
        section = build(section)
        axis = FACE.get(type(section), axis)
    return build_law(name, section, HARDENING if name.startswith("hardening") else STEEL, axis, **options)


def every(cases):
    """Run a property over laws and many sections.

    All properties are asked of the same laws, which are then built once; `make verify` asks each property
    of laws of its own too.
    """

    def over(function):
        shared, own = (
            settings(max_examples=number)(given(tubes, shares, st.sampled_from([1, -1]))(function))
            for number in (15, 25)
        )
        asked = {"shared": seed(0)(shared), "own": own}

        @pytest.mark.parametrize("laws", ["shared", pytest.param("own", marks=pytest.mark.slow)])
        @pytest.mark.parametrize("case", cases, ids=lambda case: f"{case[0]}-{case[1]}")
        def test(case, laws):
            asked[laws](case)

        return test

    return over


every_case = every(CASES)


def far(law):
    """Rotations worth looking at: through jamming and beyond."""
    return min(math.pi, 2.5 * (law.jamming_angle or 0.5))


def smooth_points(law, shares, sense):
    """Rotations away from kinks."""
    points = np.array(shares) * far(law)
    kinks = np.array([0.0, *law.kinks(sense), math.pi])
    distance = np.abs(points[:, None] - kinks).min(axis=1)
    return points[distance > 1e-5]


@every_case
def test_capacity_is_finite_positive_and_continuous(case, section, shares, sense):
    law = law_of(case, section)
    points = np.concatenate([np.array(shares) * far(law), [0.0], np.array(law.kinks(sense))])
    capacity = law.moment_capacity(points, sense)
    assert np.all(np.isfinite(capacity))
    assert np.all(capacity > 0.0)
    beside = [law.moment_capacity(np.abs(points + offset), sense) for offset in (-1e-12, 1e-12)]
    np.testing.assert_allclose(beside[0], capacity, rtol=1e-7)
    np.testing.assert_allclose(beside[1], capacity, rtol=1e-7)


@every_case
def test_sampled_curve_equals_the_formula(case, section, shares, sense):
    law = law_of(case, section)
    record = record_of(law, error=ERROR)
    envelope = record.positive if sense > 0 else record.negative
    assert envelope.rotation[0] == 0.0
    assert np.all(np.diff(envelope.rotation) > 0.0)
    # every chord is looked at, and so are points anywhere
    rotation = envelope.rotation
    points = np.concatenate(
        [np.array(shares) * math.pi, (0.37 * rotation[1:] + 0.63 * rotation[:-1]), rotation]
    )
    sampled, exact = np.interp(points, rotation, envelope.moment), law.moment_capacity(points, sense)
    assert np.max(np.abs(sampled / exact - 1.0)) <= ERROR * 1.01


@every_case
def test_sampled_slope_is_that_of_the_formula(case, section, shares, sense):
    law = law_of(case, section)
    envelope = record_of(law, error=ERROR).positive if sense > 0 else record_of(law, error=ERROR).negative
    middle = (envelope.rotation[1:] + envelope.rotation[:-1]) / 2.0
    chord = np.diff(envelope.moment) / np.diff(envelope.rotation)
    step = 1e-3 * np.diff(envelope.rotation)
    slope = (law.moment_capacity(middle + step, sense) - law.moment_capacity(middle - step, sense)) / (
        2 * step
    )
    # the chord of a curve whose middle errs by 1e-4 has the slope of its middle but for the third derivative
    length = np.diff(envelope.rotation)
    assert np.all(
        np.abs(chord - slope) <= 4 * ERROR * law.moment_capacity(middle, sense) / length + 1e-3 * abs(slope)
    )


@every_case
def test_senses_mirror_each_other(case, section, shares, sense):
    law = law_of(case, section)
    points = np.array(shares) * far(law)
    assert law.symmetric == (case not in ASYMMETRIC)
    if law.symmetric:
        np.testing.assert_array_equal(law.moment_capacity(points, 1), law.moment_capacity(points, -1))


@every_case
def test_law_is_pure_and_travels(case, section, shares, sense):
    law = law_of(case, section)
    points = np.array(shares) * far(law)
    before = points.copy()
    first = law.moment_capacity(points, sense)
    np.testing.assert_array_equal(points, before)
    np.testing.assert_array_equal(law.moment_capacity(points, sense), first)
    copy = pickle.loads(pickle.dumps(law))
    assert copy == law
    assert hash(copy) == hash(law)
    np.testing.assert_array_equal(copy.moment_capacity(points, sense), first)
    with pytest.raises(dataclasses.FrozenInstanceError):
        law.rate = None


@every_case
def test_shape_is_kept_and_the_place_in_the_array_does_not_matter(case, section, shares, sense):
    law = law_of(case, section)
    points = np.array([shares, shares]) * far(law)
    capacity = law.moment_capacity(points, sense)
    assert capacity.shape == points.shape
    one_by_one = [float(law.moment_capacity(point, sense)) for point in points[0]]
    np.testing.assert_allclose(capacity[0], one_by_one, rtol=1e-12)


@every_case
def test_energy_grows_and_its_slope_is_the_capacity(case, section, shares, sense):
    law = law_of(case, section)
    for point in smooth_points(law, shares, sense):
        step = 1e-6
        energies = [absorbed_energy(law, point + offset, sense) for offset in (-step, step)]
        slope = (energies[1] - energies[0]) / (2 * step)
        assert slope == pytest.approx(float(law.moment_capacity(point, sense)), rel=1e-3)
        assert energies[1] > energies[0] > 0.0


@every_case
def test_law_has_a_source_and_a_range_of_validity(case, section, shares, sense):
    law = law_of(case, section)
    assert isinstance(law, HingeLaw)
    assert law.name == case[0]
    assert law.title
    assert law.source.citation
    assert isinstance(law.source.trust, Trust)
    assert isinstance(law.softening_variable, SofteningVariable)
    assert law.validity.basis
    assert law.validity.warning_at(0.99 * min(law.validity.rotation_max, 10.0)) is None
    if math.isfinite(law.validity.rotation_max):
        said = "valid up to" if law.validity.rotation_max > 0.0 else "has no range of validity"
        assert said in law.validity.warning_at(law.validity.rotation_max + 0.01)
    # beyond jamming no law is valid
    assert law.jamming_angle is None or law.validity.rotation_max <= law.jamming_angle
    # a law that stays constant has a finite range or a warning
    if law.moment_capacity(math.pi, sense) == law.moment_capacity(3.0, sense):
        assert math.isfinite(law.validity.rotation_max) or law.validity.warnings


@every_case
def test_rate_factor_is_one_at_rest_and_grows(case, section, shares, sense):
    law = law_of(case, section)
    rates = np.array([0.0, 1.0, 10.0, 100.0])
    factor = law.rate_factor(rates)
    assert factor[0] == 1.0
    assert np.all(np.diff(factor) > 0.0)
    np.testing.assert_array_equal(law.rate_factor(-rates), factor)
    record = record_of(law, error=1e-2)
    np.testing.assert_allclose(1.0 + (rates / record.rate_reference) ** (1.0 / record.rate_exponent), factor)


@every(
    [
        case
        for case in CASES
        if case[0] not in {"folded_profile", "circular"} and case not in ROUND | ASYMMETRIC
    ]
)
def test_turned_section_has_the_law_of_the_other_axis(case, section, shares, sense):
    law, turned = law_of(case, section, "z"), law_of(case, section.turned("z"), "y")
    points = np.array(shares) * far(law)
    np.testing.assert_allclose(
        law.moment_capacity(points, sense), turned.moment_capacity(points, sense), rtol=1e-12
    )


@pytest.mark.parametrize(
    ("name", "section", "options", "reason"),
    [
        ("wierzbicki", RectangularTube(0.05, 0.04, 0.002), {}, "equal sides"),
        ("wierzbicki", CircularTube(0.05, 0.002), {}, "square tubes"),
        ("kecman", RectangularTube(0.05, 0.05, 0.01), {"start": "parabola"}, "no parabola"),
        ("kecman", CircularTube(0.05, 0.002), {}, "tube"),
        ("circular", RectangularTube(0.05, 0.05, 0.002), {}, "circular"),
        ("folded_profile", CircularTube(0.05, 0.002), {}, "channel"),
    ],
)
def test_sections_that_are_left_out_are_refused(name, section, options, reason):
    with pytest.raises(InputError, match=reason):
        build_law(name, section, STEEL, "y", **options)
