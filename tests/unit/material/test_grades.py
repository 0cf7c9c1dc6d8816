"""Named grades: every one usable, sourced and marked; names found in any spelling."""

import pytest

from crumple.errors import InputError
from crumple.material import Evidence, Grade, grade, grade_material, grades
from crumple.material.grade_table import GRADES


@pytest.mark.parametrize("found", grades().values(), ids=lambda found: found.name)
def test_every_grade_is_sourced_marked_and_plausible(found):
    assert isinstance(found, Grade)
    assert isinstance(found.evidence, Evidence)
    assert "typical, not design values" in found.statement
    assert found.citation in found.statement
    metal = found.material
    assert metal.yield_stress < metal.flow_stress < metal.ultimate_stress
    assert 100e6 < metal.yield_stress < 1000e6
    assert found.elongation is None or 0.05 < found.elongation < 0.6


def test_spellings_are_unique():
    plain = [
        "".join(c for c in text.lower() if c.isalnum()) for n, e in GRADES.items() for text in (n, *e.also)
    ]
    by_grade = {
        "".join(c for c in text.lower() if c.isalnum()): n for n, e in GRADES.items() for text in (n, *e.also)
    }
    assert {by_grade[text] for text in plain} == set(GRADES)
    for spelling, name in by_grade.items():
        assert grade(spelling).name == name


@pytest.mark.parametrize(
    ("spelling", "name"), [("s355", "S355"), ("hsla-340", "HSLA 340"), ("dp 600", "DP600"), ("304", "1.4301")]
)
def test_spelling(spelling, name):
    assert grade(spelling).name == name


def test_flow_rules_and_rate():
    metal = grade_material("S355")
    assert metal.flow_stress == pytest.approx(412.5e6)
    assert metal.flow_rate is None
    assert grade_material("S355", flow="ultimate").flow_stress == 470e6
    assert grade_material("S355", flow="yield").flow_stress == 355e6
    assert grade_material("S355", rate=True).flow_rate.D == 6844.0
    assert grade_material("6060-T6", rate=True).yield_rate.q == 4.0


def test_unknown_names_are_refused_with_the_known_ones():
    with pytest.raises(InputError, match="S355"):
        grade("S999")
    with pytest.raises(InputError, match="mean, ultimate, yield"):
        grade_material("S355", flow="guess")
