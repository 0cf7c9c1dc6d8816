"""Named grades: every one usable, sourced and marked; names found in any spelling."""

import math

import pytest

from crumple.errors import InputError
from crumple.material import Evidence, Grade, grade, grade_curve, grade_material, grades
from crumple.material.grade_table import GRADES, NECKING


@pytest.mark.parametrize("found", grades().values(), ids=lambda found: found.name)
def test_every_grade_is_sourced_marked_and_plausible(found):
    assert isinstance(found, Grade)
    assert isinstance(found.evidence, Evidence)
    assert "typical, not design values" in found.statement
    assert found.citation in found.statement
    metal = found.material
    # a true stress at a strain of 0.1, and a nominal one
    assert metal.yield_stress < metal.flow_stress < 1.2 * metal.ultimate_stress
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


@pytest.mark.parametrize("found", grades().values(), ids=lambda found: found.name)
def test_the_curve_of_a_grade_necks_at_its_ultimate_stress(found):
    metal, curve = found.material, found.material.hardening
    share, least = NECKING[GRADES[found.name].family]
    strain = share * (least - metal.yield_stress / metal.ultimate_stress)
    if found.elongation is not None:
        strain = min(strain, math.log1p(found.elongation))
    assert float(curve.stress(0.0)) == pytest.approx(metal.yield_stress)
    true = metal.ultimate_stress * math.exp(strain)
    assert float(curve.stress(strain)) == pytest.approx(true)
    assert float(curve.slope(strain)) == pytest.approx(true, rel=1e-6)


def test_uniform_strains_are_those_of_the_table_up_to_the_elongation():
    # 0.60 (1 - 355/470); of DP780 the elongation of 14 % is less than 0.60 (1 - 440/780) = 0.26
    for name, strain in (("S355", 0.1468), ("DP780", math.log(1.14)), ("6060-T6", math.log(1.08))):
        curve = grade(name).material.hardening
        assert float(curve.slope(strain)) == pytest.approx(float(curve.stress(strain)), rel=1e-3), name
        assert float(curve.slope(0.9 * strain)) > 1.05 * float(curve.stress(0.9 * strain)), name


def test_a_grade_whose_ultimate_stress_is_its_yield_stress_has_no_curve():
    assert grade_curve("S355", 470e6, 470e6) is None
    assert grade_curve("6082-T6", 286e6, 290e6) is None
    assert grade_curve("S355", 400e6).yield_stress == 400e6


def test_flow_rules_and_rate():
    metal = grade_material("S355")
    assert metal.hardening == grade("S355").material.hardening
    assert metal.flow_stress == pytest.approx(float(metal.hardening.stress(0.1)))
    assert metal.flow_rate is None
    mean = grade_material("S355", flow="mean")
    assert mean.hardening is None
    assert mean.flow_stress == pytest.approx(412.5e6)
    assert grade_material("S355", flow="ultimate").flow_stress == 470e6
    assert grade_material("S355", flow="yield").flow_stress == 355e6
    assert grade_material("S355", rate=True).flow_rate.D == 6844.0
    assert grade_material("6060-T6", rate=True).yield_rate.q == 4.0


def test_unknown_names_are_refused_with_the_known_ones():
    with pytest.raises(InputError, match="S355"):
        grade("S999")
    with pytest.raises(InputError, match="curve, mean, ultimate, yield"):
        grade_material("S355", flow="guess")
