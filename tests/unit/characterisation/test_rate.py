"""Rate law of a fold: found again from histories that follow one, left out where there is none."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from crumple.characterisation import Bending, Crush, LawCurve, characterise
from crumple.characterisation.rate import at_rest, faster, rate_law, rate_pair
from crumple.characterisation.resolution import Resolution
from crumple.material import CowperSymonds, JohnsonCook, Material
from crumple.section import RectangularTube

PAIR = CowperSymonds(40.0, 5.0)
STEEL = Material("steel", 210e9, 0.3, 7850.0, 488e6, flow_rate=PAIR)
TUBE = RectangularTube(width=0.050, depth=0.025, thickness=0.00265)
ROTATION = np.linspace(0.0, 0.5, 101)
MOMENT = 1500.0 - 1000.0 * ROTATION
STATIC = LawCurve(
    ROTATION, MOMENT, np.concatenate([[0.0], np.cumsum(0.5 * (MOMENT[1:] + MOMENT[:-1]) * np.diff(ROTATION))])
)


def run(kappa, lasting):
    """A sub-model whose histories follow the law, turned beyond the end of the curve."""
    time = np.linspace(0.0, lasting, 2001)
    rotation = 0.275 * (1.0 - np.cos(np.pi * time / lasting))
    rate = np.gradient(rotation, time)
    moment = np.interp(rotation, ROTATION, MOMENT) * (1.0 + (kappa * rate / PAIR.D) ** (1.0 / PAIR.q))
    return SimpleNamespace(histories=lambda result: (rotation, moment)), SimpleNamespace(time=time)


def test_the_law_of_the_histories_is_found_and_confirmed_at_the_other_speed():
    rate, sentence = rate_law(PAIR, STATIC, (run(0.5, 0.03), run(0.5, 0.01)))
    assert rate is not None
    assert rate.exponent == 5.0
    # the fifth power of the effect, which is found within 0.1 %
    assert PAIR.D / rate.reference == pytest.approx(0.5, rel=0.01)
    assert "differs by +0.0 %" in sentence


def test_another_law_at_the_other_speed_is_reported():
    sentence = rate_law(PAIR, STATIC, (run(0.5, 0.03), run(5.0, 0.01)))[1]
    assert float(sentence.split("differs by ")[1].split(" %")[0]) < -15.0


def test_no_effect_gives_no_law():
    assert rate_law(PAIR, STATIC, (run(0.0, 0.03), run(0.0, 0.01)))[0] is None


def test_shells_use_the_pair_at_large_strain_and_a_logarithm_becomes_a_power():
    assert rate_pair(STEEL) == PAIR
    assert rate_pair(replace(STEEL, flow_rate=None)) is None
    assert rate_pair(replace(STEEL, flow_rate=JohnsonCook(0.02, 1.0))) is not None
    model = Bending(TUBE, STEEL)
    assert rate_pair(at_rest(model).material) is None
    assert faster(model).duration == pytest.approx(model.duration / 3.0)


def test_a_coarse_law_has_the_curve_at_rest_and_a_rate_law():
    coarse = Resolution(2.0, 5.0)
    model = Bending(TUBE, STEEL, largest=0.15, resolution=coarse)
    law, plain = characterise(model).law, characterise(at_rest(model)).law
    assert law.curve == plain.curve
    assert plain.rate is None
    assert law.rate is not None
    assert law.rate.exponent == 5.0
    assert "rad/s" in dict(law.origin)["rate"]
    assert dict(law.origin)["place"] == model.place
    crushed = characterise(Crush(TUBE, STEEL, largest=0.2, resolution=coarse)).law
    assert crushed.rate is None
