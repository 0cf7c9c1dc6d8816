"""What a run says of hinges that shorten or lengthen along their members."""

import pytest
from tests.support.structures import STEEL

from crumple.multibody import Run, solve_multibody
from crumple.structure import MultibodySettings, Structure


def column(tube, axial, speed, metal=None):
    """A tube of 0.4 m on its clamp, whose end has 50 kg and moves along it."""
    law = {"type": "constant", "moment": 5000.0, "rate": "off"}
    hinge = {"name": "foot", "at": 0.05, "law": law, "axes": ("y", "z"), "axial": axial}
    member = {"nodes": ("a", "b"), "section": "tube", "material": "steel", "hinges": (hinge,)}
    return Structure(
        materials={"steel": STEEL | (metal or {})},
        sections={"tube": {"type": "square_tube", **tube}},
        nodes={"a": (0, 0, 0), "b": (0, 0, 0.4)},
        members={"ab": member},
        supports={
            "clamp": {"node": "a", "fix": "all"},
            "guide": {"node": "b", "fix": ("x", "y", "rx", "ry")},
        },
        masses={"m": {"node": "b", "mass": 50.0}},
        initial_velocity=[{"nodes": ("b",), "translation": (0.0, 0.0, speed)}],
    )


def run(structure, duration=0.02):
    return solve_multibody(structure, Run(duration, 1e-3, MultibodySettings()))


THIN = {"side": 0.05, "thickness": 0.0015}
THICK = {"side": 0.05, "thickness": 0.008}


@pytest.mark.parametrize(
    ("tube", "law", "said"),
    [
        (THIN | {"corner_radius": 0.003}, {"law": "superfolding"}, "rounded corners are treated as sharp"),
        (THICK, {"law": "square"}, "is above its peak"),
        (THIN, {"law": "square"}, ""),
        (THIN, True, ""),
    ],
)
def test_what_a_law_of_crushing_says_of_its_section_is_a_warning_as_that_of_bending(tube, law, said):
    texts = [text for text in run(column(tube, law, -8.0)).warnings if "crushing along the member" in text]
    assert bool(texts) == bool(said)
    assert not said or any(text.startswith("Hinge foot: ") and said in text for text in texts)


@pytest.mark.parametrize(
    ("axial", "speed", "code", "part"),
    [
        # the work of 142 kN over 0.4 m is 57 kJ; 50 kg have 36 kJ at 38 m/s and 63 kJ at 50 m/s
        (True, -38.0, "", ""),
        (True, -50.0, "crushed_beyond", "Member ab, 400 mm long, is crushed by "),
        (True, -60.0, "crushed_beyond", "ends have passed each other"),
        # a stroke as long as the member stops nothing
        ({"peak": 142e3, "mean": 142e3, "stroke": 0.5}, -50.0, "crushed_beyond", "no stroke on the member"),
        # folds with a stroke have the caution of their stop
        ({"law": "square"}, -60.0, "bottomed_out", "it is crushed by"),
        (True, 20.0, "", ""),
        (True, 25.0, "stretched_beyond", "structural metals break at about 0.2, reached at "),
    ],
)
def test_members_shorter_than_closed_folds_or_longer_than_metal_stretches_are_named(axial, speed, code, part):
    result = run(column(THIN, axial, speed), 0.04)
    found = [one for one in result.cautions if one.place in {"member ab", "hinge foot"}]
    assert [one.code for one in found if one.code != "impact_loss"] == [code] * bool(code)
    assert all(part in one.text and one.value > one.limit for one in found)


@pytest.mark.parametrize(
    ("metal", "strain", "why"),
    [
        ({"failure_strain": 0.1}, 0.10517, "failure strain"),
        # Swift's curve (e + e0)^n necks at e = n - e0, 0.09
        ({"hardening": {"type": "swift", "prestrain": 0.01, "exponent": 0.1}}, 0.0942, "necks"),
        ({}, 0.2, "structural metals"),
    ],
)
def test_how_far_metal_stretches_is_its_own_where_it_is_known(metal, strain, why):
    cautions = run(column(THIN, True, 35.0, metal), 0.04).cautions
    (found,) = [one for one in cautions if one.code == "stretched_beyond"]
    assert found.limit == pytest.approx(0.4 * strain, rel=0.01)
    assert why in found.text


@pytest.mark.parametrize(("second", "together"), [({"peak": 1e9, "mean": 1e9, "stroke": 0.5}, False)])
def test_folds_that_close_at_one_of_two_hinges_are_told_once(second, together):
    """The force rises to that of a stop there: it is not too small, as where both are crushed in part."""
    whole = column(THIN, {"law": "square"}, -60.0).model_dump(exclude_none=True)
    (hinge,) = whole["members"]["ab"]["hinges"]
    whole["members"]["ab"]["hinges"] = (hinge, hinge | {"name": "head", "at": 0.35, "axial": second})
    texts = [one.text for one in run(Structure(**whole), 0.04).cautions if one.code == "bottomed_out"]
    assert texts
    assert any("at its hinges together" in text for text in texts) == together
