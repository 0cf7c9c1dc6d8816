import dataclasses

import numpy as np
import pytest

from crumple.errors import InputError
from crumple.material import CowperSymonds, Material


def steel(**changes):
    values = {
        "name": "steel",
        "youngs_modulus": 210e9,
        "poissons_ratio": 0.3,
        "density": 7850.0,
        "yield_stress": 488e6,
    }
    return Material(**(values | changes))


def test_shear_modulus():
    assert steel().shear_modulus == pytest.approx(210e9 / 2.6)


def test_flow_stress_is_the_yield_stress_unless_given():
    assert steel().flow_stress == 488e6
    # a known ultimate strength alone does not change the curve
    assert steel(ultimate_stress=550e6).flow_stress == 488e6
    assert steel(given_flow_stress=520e6).flow_stress == 520e6
    assert dataclasses.replace(steel(), yield_stress=300e6).flow_stress == 300e6


def test_material_is_frozen_and_hashes():
    material = steel(yield_rate=CowperSymonds(40.4, 5.0))
    with pytest.raises(dataclasses.FrozenInstanceError):
        material.density = 1.0
    assert hash(material) == hash(steel(yield_rate=CowperSymonds(40.4, 5.0)))


@pytest.mark.parametrize(
    ("change", "where"),
    [
        ({"youngs_modulus": 0.0}, "youngs_modulus"),
        ({"youngs_modulus": float("inf")}, "youngs_modulus"),
        ({"density": -1.0}, "density"),
        ({"yield_stress": float("nan")}, "yield_stress"),
        ({"yield_stress": 300e9}, "yield_stress"),
        ({"poissons_ratio": 0.5}, "poissons_ratio"),
        ({"poissons_ratio": float("nan")}, "poissons_ratio"),
        ({"ultimate_stress": 300e6}, "ultimate_stress"),
        ({"given_flow_stress": 0.0}, "flow_stress"),
    ],
)
def test_bad_values_are_refused_by_name(change, where):
    with pytest.raises(InputError) as error:
        steel(**change)
    problems = error.value.problems
    assert [problem.where for problem in problems] == [where]
    assert problems[0].came
    assert problems[0].allowed
    assert problems[0].todo


def test_every_bad_value_is_reported_at_once():
    with pytest.raises(InputError) as error:
        steel(density=0.0, poissons_ratio=0.7, yield_stress=-1.0)
    assert {problem.where for problem in error.value.problems} == {
        "density",
        "poissons_ratio",
        "yield_stress",
    }


def test_cowper_symonds():
    rate = CowperSymonds(40.4, 5.0)
    assert rate.factor(0.0) == 1.0
    assert rate.factor(40.4) == pytest.approx(2.0)
    assert rate.factor(1.0) == pytest.approx(1.0 + (1.0 / 40.4) ** 0.2)
    np.testing.assert_allclose(rate.factor([-1.0, 1.0]), rate.factor(1.0))


@pytest.mark.parametrize(
    ("D", "q"), [(0.0, 5.0), (-1.0, 5.0), (40.4, 0.5), (float("nan"), 5.0), (40.4, float("inf"))]
)
def test_impossible_rate_laws_are_refused(D, q):
    with pytest.raises(InputError):
        CowperSymonds(D, q)


def test_texts_carry_their_units():
    plain = Material("steel", 210e9, 0.3, 7850.0, 350e6, ultimate_stress=450e6)
    texts = Material("steel", "210 GPa", 0.3, "7850 kg/m^3", "350 MPa", ultimate_stress="450 MPa")
    assert texts == plain
    with pytest.raises(InputError) as refused:
        Material("steel", "210 mm", 0.3, "7850", 350e6)
    assert [problem.where for problem in refused.value.problems] == ["youngs_modulus", "density"]
