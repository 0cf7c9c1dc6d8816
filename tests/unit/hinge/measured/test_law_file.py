"""The law file: exact round trip of every kind of law, readable text, refusals with lines."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from crumple.errors import InputError
from crumple.hinge import (
    ConstantLaw,
    HingeRate,
    SofteningVariable,
    Source,
    Stop,
    Trust,
    Validity,
    build_law,
    build_torsion_law,
    record_of,
)
from crumple.hinge.band import Bound, band_of
from crumple.hinge.measured.law_file import read_law, stored_law, write_law
from crumple.hinge.measured.measured import bending_band, measured_band
from crumple.hinge.measured.stored import StoredCurve, StoredLaw, bounded
from crumple.material import CowperSymonds, Material
from crumple.section import Channel, CircularTube, RectangularTube

STEEL = Material("steel", 210e9, 0.3, 7850.0, 488e6, flow_rate=CowperSymonds(6844.0, 3.91))
TUBE = RectangularTube(0.05, 0.025, 0.00265)
ORIGIN = {"method": "formula", "section": TUBE.title, "axis": "y", "material": 'steel "488"'}
LAWS = [
    build_law("kecman", TUBE, STEEL),
    build_law("kecman", TUBE, STEEL, after_jamming="stop"),
    build_law("folded_profile", Channel(0.04, 0.08, 0.002), STEEL, "z"),
    build_law("circular", CircularTube(0.05, 0.002), STEEL),
    build_law("oblique", TUBE, STEEL),
    build_torsion_law("square_tube", RectangularTube(0.05, 0.05, 0.002), STEEL, 0.5, decay=0.3),
    ConstantLaw(1000.0),
]


@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.name)
def test_round_trip_is_exact(law):
    stored = stored_law(law, ORIGIN)
    text = write_law(stored)
    again = read_law(text)
    assert again == stored
    assert hash(again) == hash(stored)
    assert write_law(again) == text
    rotation = np.linspace(0.0, 2.0, 200)
    for sense in (1, -1):
        np.testing.assert_allclose(
            again.moment_capacity(rotation, sense), law.moment_capacity(rotation, sense), rtol=1.01e-4
        )
    assert again.source == law.source
    assert again.validity == law.validity
    assert again.stop == law.stop
    np.testing.assert_array_equal(again.rate_factor([0.0, 5.0]), law.rate_factor([0.0, 5.0]))


numbers = st.floats(1e-6, 1e6)
texts = st.text(st.characters(exclude_categories=("C",)), max_size=40)
curves = st.lists(numbers, min_size=1, max_size=5).map(
    lambda steps: (
        tuple(np.concatenate([[0.0], np.cumsum(steps)[:-1]]).tolist()),
        tuple(reversed(steps)),
    )
)
laws = st.builds(
    StoredLaw,
    title=texts,
    law=texts,
    origin=st.dictionaries(st.text("abcdefgh", min_size=1, max_size=8), texts, max_size=3).map(
        lambda pairs: (("method", "shell"), *pairs.items())
    ),
    curve=st.builds(StoredCurve, curves, curves),
    source=st.builds(Source, texts, st.sampled_from(Trust), texts),
    validity=st.builds(
        Validity,
        numbers | st.just(math.inf),
        texts,
        st.lists(texts, max_size=3).map(tuple),
        st.none() | numbers,
    ),
    softening_variable=st.sampled_from(SofteningVariable),
    elastic_stiffness=st.none() | numbers,
    jamming_angle=st.none() | numbers,
    rate=st.none() | st.builds(HingeRate, numbers, st.floats(1.0, 20.0)),
    stop=st.none()
    | st.builds(Stop, numbers, numbers, st.floats(1.0, 3.0), numbers | st.just(math.nan), numbers),
    sampling_error=st.floats(0.0, 0.01),
    lower=st.none() | st.builds(StoredCurve, curves, curves),
)


@settings(max_examples=60)
@given(laws)
def test_any_law_comes_back_bit_for_bit(law):
    text = write_law(law)
    assert read_law(text) == law
    assert write_law(read_law(text)) == text


def test_file_is_readable():
    lines = write_law(stored_law(LAWS[0], ORIGIN)).splitlines()
    assert lines[0].startswith("# A collapse law")
    assert "crumple_law: 1" in lines
    assert "  trust: derived" in lines
    assert any(line.startswith("  rotation_max: 0.7") and line.endswith(" rad") for line in lines)
    assert "  units: {rotation: rad, moment: N*m}" in lines
    assert "  negative: mirror" in lines


def test_band_of_measured_curves_travels():
    plastic = np.linspace(0.0, 0.5, 100)
    curves_ = [
        (
            np.concatenate([[0.0, 0.003, 0.005], plastic + 0.01]),
            f * np.concatenate([[0.0, 300.0, 500.0], 1000 - 800 * plastic]),
        )
        for f in (0.9, 1.1)
    ]
    band = bending_band(measured_band(curves_))
    stored = stored_law(band.nominal, {"method": "measured"}, band=band)
    again = read_law(write_law(stored))
    for bound in Bound:
        np.testing.assert_allclose(
            again.band.law(bound).moment_capacity(0.3), band.law(bound).moment_capacity(0.3), rtol=1.01e-4
        )


def test_stated_band_scales_the_curve_and_reaches_the_stepper():
    text = write_law(stored_law(LAWS[0], ORIGIN))
    records = [
        record_of(bounded(build_law("file", TUBE, STEEL, text=text), bound))
        for bound in ("lower", "nominal", "upper")
    ]
    peaks = np.array([record.positive.moment[0] for record in records])
    width = LAWS[0].validity.uncertainty
    np.testing.assert_allclose(peaks / peaks[1], [1.0 - width, 1.0, 1.0 + width])
    assert float(bounded(LAWS[0], "lower").moment_capacity(0.0)) == pytest.approx((1.0 - width) * peaks[1])
    assert bounded(LAWS[0], "nominal") is LAWS[0]
    assert band_of(LAWS[0]).upper.factor == pytest.approx(1.0 + width)
    with pytest.raises(InputError, match="scatter of this law is unknown"):
        bounded(read_law(write_law(stored_law(LAWS[-1], ORIGIN))), "upper")


GOOD = write_law(stored_law(ConstantLaw(1000.0), {"method": "formula"}))


def line_of(words):
    return next(number for number, line in enumerate(GOOD.splitlines(), 1) if words in line)


@pytest.mark.parametrize(
    ("old", "new", "what"),
    [
        ("crumple_law: 1", "crumple_law: 2", "not a law file of a known format"),
        ("softening: peak", "softening: sideways", "unknown choice"),
        ("softening: peak", "softning: peak", "unknown key"),
        ("jamming_angle: none", "jamming_angle: 3 mm", "an angle"),
        ("jamming_angle: none", "jamming_angle: 9**9**9 rad", "unit|number"),
        ("    - [0.0, 1000.0]", "    - [0.0]", "two plain numbers"),
        ("    - [0.0, 1000.0]", "    - [0.0, many]", "two plain numbers"),
        ("    - [0.0, 1000.0]", "    - [0.1, 1000.0]", "increase strictly from 0"),
        ("    - [0.0, 1000.0]", "    - [0.0, -1.0]", "must be positive"),
        ("    - [0.0, 1000.0]", "    - [0.0, nan]", "must be positive"),
        ("{rotation: rad, moment: N*m}", "{rotation: deg, moment: N*m}", "SI units"),
        ("rate: none", "rate: {reference: 1 rad/s, exponent: 0.5}", "out of range"),
        ("rate: none", "rate: &a none", "anchors"),
        ("rate: none", "rate: !!str none", "tags"),
        ("rate: none", "rate: }", "not YAML"),
        ("rate: none", "rate: none\nrate: none", "is given twice"),
    ],
)
def test_mistakes_are_reported_with_their_line(old, new, what):
    assert old in GOOD
    with pytest.raises(InputError, match=what) as caught:
        read_law(GOOD.replace(old, new, 1), "law.yaml")
    problem = caught.value.problems[0]
    assert problem.file == "law.yaml"
    # invalid YAML is reported at the line where the parser noticed it
    assert line_of(old.strip()) - 1 <= problem.line <= line_of(old.strip()) + 5


@pytest.mark.parametrize("text", ["", "just words", "- a\n- b", "a: 1", "\x00", "crumple_law: 1"])
def test_what_is_no_law_file_is_refused(text):
    with pytest.raises(InputError):
        read_law(text, "law.yaml")


def test_missing_keys_are_named():
    with pytest.raises(InputError, match="jamming_angle is missing"):
        read_law(GOOD.replace("jamming_angle: none\n", ""))
    with pytest.raises(InputError, match="no method"):
        stored_law(LAWS[0], {})


def test_a_change_of_the_content_is_found_by_the_checksum():
    changed = GOOD.replace("1000.0]", "1001.0]")
    with pytest.raises(InputError, match="was changed after it was written") as caught:
        read_law(changed, "law.yaml")
    problem = caught.value.problems[0]
    assert (problem.file, problem.line) == ("law.yaml", line_of("checksum:"))
    assert "delete the line `checksum`" in problem.todo
    # who means it deletes the line, and the law says so, also when it is written again
    edited = "".join(line for line in changed.splitlines(True) if not line.startswith("checksum"))
    law = read_law(edited)
    assert float(law.moment_capacity(0.0)) == 1001.0
    assert not law.has_checksum
    assert write_law(law) == edited
    assert read_law(GOOD).has_checksum


def test_notes_line_ends_and_empty_lines_are_no_change_of_the_content():
    noted = GOOD.replace("title:", "# a note\n\n  # another\ntitle:").replace("\n", " \r\n")
    assert read_law(noted) == read_law(GOOD)
    assert read_law(noted).has_checksum


@pytest.mark.parametrize(
    ("text", "what"),
    [
        ("", "the law file is empty"),
        (" \n", "the law file is empty"),
        ("a: 1", "this is not a law file"),
        ("crumple_law: 7", "not a law file of a known format"),
        (GOOD[:300], "is missing|not YAML"),
        (GOOD.replace("softening: peak\n", ""), "softening is missing"),
    ],
)
def test_every_refusal_of_a_law_file_says_what_to_do(text, what):
    with pytest.raises(InputError, match=what) as caught:
        read_law(text, "law.yaml")
    assert all(one.todo and one.file == "law.yaml" for one in caught.value.problems)
