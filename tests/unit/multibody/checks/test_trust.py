"""Warnings that an engineer reads before believing a result."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from crumple.hinge.law import BEYOND_RANGE
from crumple.multibody import Run, solve_multibody
from crumple.multibody.answer.solved import HingeHistory
from crumple.multibody.checks.trust import inaccurate
from crumple.report.wording.wording import outside_range
from crumple.result import Result
from crumple.structure import MultibodySettings, Structure, placed_hinges

STEEL = {"youngs_modulus": 210e9, "poissons_ratio": 0.3, "density": 7850.0, "yield_stress": 488e6}
TUBE = {"type": "rectangular_tube", "width": 0.05, "depth": 0.025, "thickness": 0.00265}


def thrown(rate: float, bars: int = 1, **law: Any) -> Result:
    """A tube with 6 kg at its tip, thrown against its clamp."""
    law = {"type": "kecman"} | law
    member = {
        "nodes": ("root", "tip"),
        "section": "tube",
        "material": "steel",
        "bars": {"number": bars, "law": law},
        "hinges": [{"name": "root", "at": "root", "law": law}],
    }
    structure = Structure(
        materials={"steel": STEEL},
        sections={"tube": TUBE},
        nodes={"root": (0.0, 0.0, 0.0), "tip": (1.0, 0.0, 0.0)},
        members={"tube": member},
        supports={"clamp": {"node": "root", "fix": "all"}},
        masses={"payload": {"node": "tip", "mass": 6.0}},
        initial_velocity=[{"rotation": rate, "axis": (0.0, 1.0, 0.0)}],
    )
    return solve_multibody(structure, Run(duration=0.1, every=2e-3))


def about(result: Result, word: str) -> list[str]:
    return [text for text in result.warnings if word in text]


def test_rigid_bars_that_hide_much_elastic_energy_are_named() -> None:
    (text,) = about(thrown(15.0), "elastically")
    # M^2 L / (6 E I) of the moment at the clamp, 1696.09 N m/(1 - 0.01618), of 783.7 J:
    # 1723.98^2 * 1 / (6 * 210e9 * 3.66254e-8) = 64.4 J
    assert "64.4 J" in text
    assert "8%" in text
    assert not about(thrown(15.0, form="elastic-plastic"), "elastically")


def test_elastic_energy_above_the_energy_input_is_reported_in_words() -> None:
    # 3.1 J at 1 rad/s
    (text,) = about(thrown(1.0), "elastically")
    assert "(more than the energy input)" in text
    assert "%" not in text


def test_a_stop_does_not_count_as_elastic_energy() -> None:
    stop = {"rotation": 0.3, "stiffness": 1e6, "damping": 0.0}
    (text,) = about(thrown(15.0, stops=stop), "elastically")
    assert "64.4 J" in text


def test_rotation_beyond_the_range_and_jamming_are_distinguished() -> None:
    assert not about(thrown(15.0), "valid up to")
    (text,) = about(thrown(17.8), "valid up to 42.0 deg only")
    assert text.endswith(BEYOND_RANGE)
    (text,) = about(thrown(24.0), "jam at 53.1 deg")
    assert text.startswith("Hinge root turned by")


def post(z_law: dict[str, Any], impulse: float, along: int = 1, **hinge: Any) -> Result:
    """A cantilever with hinges about y and z, struck along y, so that it bends about z, or along z."""
    structure = post_structure(z_law, impulse, along, **hinge)
    return solve_multibody(structure, Run(duration=0.05, every=1e-3))


def post_structure(z_law: dict[str, Any], impulse: float = 1.0, along: int = 1, **hinge: Any) -> Structure:
    """Its structure."""
    short = {"type": "table", "rotation": (0.0, 0.02), "moment": (900.0, 900.0), "rate": "off"}
    hinge = {"name": "foot", "at": "root", "axes": ("y", "z"), "law": short, "laws": {"z": z_law}} | hinge
    return Structure(
        materials={"steel": STEEL},
        sections={"tube": TUBE},
        nodes={"root": (0.0, 0.0, 0.0), "tip": (1.0, 0.0, 0.0)},
        members={
            "tube": {
                "nodes": ("root", "tip"),
                "section": "tube",
                "material": "steel",
                "elastic": True,
                "hinges": [hinge],
            }
        },
        supports={"clamp": {"node": "root", "fix": "all"}},
        impulses=[{"node": "tip", "impulse": [impulse * (i == along) for i in range(3)]}],
    )


def test_a_hinge_is_judged_by_the_laws_of_the_axes_about_which_it_yields() -> None:
    long = {"type": "table", "rotation": (0.0, 2.0), "moment": (1500.0, 1500.0), "rate": "off"}
    result = post(long, 60.0)
    summary = result.hinges["foot"]
    assert summary.law_rotation is not None
    assert 0.03 < summary.law_rotation < summary.rotation_max
    assert summary.validity_rotation == pytest.approx(2.0)
    assert summary.envelope["positive"][0] == pytest.approx(1500.0)
    assert summary.law_use is not None
    assert not about(result, "valid up to")
    assert outside_range(result, "foot") == ""
    short = long | {"rotation": (0.0, 0.01)}
    (text,) = about(post(short, 60.0), "valid up to")
    turned = math.degrees(summary.law_rotation)
    assert f"turned by {turned:.3g} deg about the section's z axis; there the law is valid up to" in text


def test_what_a_hinge_creeps_about_its_other_axis_is_outside_of_no_range() -> None:
    """By 0.3 deg, while it folds by 17 deg about an axis whose law has a range; by 0.6 deg it counts."""
    table = {"type": "table", "rotation": (0.0, 2.0), "moment": (900.0, 900.0), "rate": "off"}
    structure = post_structure({"type": "estimate", "rate": "off"}, law=table)
    (hinge,) = [one for one in placed_hinges(structure) if one.plastic]
    judged = []
    for crept in np.radians([0.3, 0.6]):
        columns = {name: np.array([0.0, 0.3]) for name in ("plastic_rotation", "plastic_rotation.y")}
        columns["plastic_rotation.z"] = np.array([0.0, crept])
        judged.append(HingeHistory(hinge, columns, 0.3, 900.0, None, 300.0).judged_by()[0])
    assert judged == ["y", "z"]


def test_doubts_about_a_law_are_told_of_hinges_that_fold_or_nearly_do() -> None:
    """A clamped foot that carries a tenth of its moment stays silent; one that yields does not."""
    constant = {"type": "constant", "rate": "off"}
    assert not about(post(constant, 1.0, law=constant), "a constant capacity")
    assert about(post(constant, 60.0, law=constant), "a constant capacity")


def test_of_two_axes_that_yield_the_one_beyond_its_range_is_judged() -> None:
    """About y, with the longer range, the hinge yields by more."""
    short = {"type": "table", "rotation": (0.0, 0.01), "moment": (900.0, 900.0), "rate": "off"}
    long = short | {"rotation": (0.0, 2.0)}
    columns = {"plastic_rotation": np.array([0.0, 0.31]), "plastic_rotation.y": np.array([0.0, 0.3])}
    columns["plastic_rotation.z"] = np.array([0.0, 0.05])
    structure = post_structure(short, law=long)
    (hinge,) = [one for one in placed_hinges(structure) if one.plastic]
    history = HingeHistory(hinge, columns, 0.31, 900.0, None, 300.0)
    axis, law, turned = history.judged_by()
    assert (axis, turned) == ("z", pytest.approx(0.05))
    assert law.validity.rotation_max == pytest.approx(0.01)


def test_elastic_rotation_is_outside_of_no_range() -> None:
    """The range of a law is one of plastic rotation: an estimate has none."""
    estimate = {"type": "estimate", "rate": "off"}
    result = post(estimate, 2.0, law=estimate)
    assert result.hinges["foot"].rotation_max > 1e-3
    assert result.hinges["foot"].law_rotation == 0.0
    assert not about(result, "valid up to")
    assert outside_range(result, "foot") == ""


def test_folds_are_closed_about_the_axis_about_which_they_yield() -> None:
    """The walls jam at 25.8 deg about z, the first axis, and at 53.1 deg about y."""
    kecman = {"type": "kecman"}
    result = post(kecman, 40.0, law=kecman, axes=("z", "y"), along=2)
    assert math.radians(26.0) < (result.hinges["foot"].law_rotation or 0.0) < math.radians(53.0)
    assert not [caution for caution in result.cautions if caution.code == "beyond_jamming"]
    result = post(kecman, 80.0, law=kecman, axes=("z", "y"), along=1)
    (jammed,) = [caution for caution in result.cautions if caution.code == "beyond_jamming"]
    assert math.degrees(jammed.limit) == pytest.approx(25.8, abs=0.05)


def test_a_warning_of_several_hinges_is_given_once() -> None:
    result = thrown(15.0, bars=12, type="constant")
    (text,) = about(result, "a constant capacity")
    # tube-3 and three at the tip carry less than four fifths of their moment
    assert text.startswith("Hinges root, tube-1, tube-2, tube-4, tube-5, tube-6 and 2 more: ")


@pytest.mark.parametrize("form", ["set-valued", "elastic-plastic", "regularised"])
def test_every_assumption_names_its_hinge_and_place(form: str) -> None:
    result = thrown(15.0, form=form)
    (text,) = [
        text for text in result.assumptions if text.startswith("Hinge root lies 16.18 mm from node root")
    ]
    assert {"set-valued": "rigid until", "elastic-plastic": "kN m/rad", "regularised": "HAVSIN"}[form] in text


def test_a_grade_is_typical_and_no_design_value() -> None:
    keys: dict[str, Any] = {
        "materials": {"steel": {"grade": "S355"}, "other": STEEL},
        "sections": {"tube": TUBE},
        "nodes": {"root": (0, 0, 0), "tip": (1, 0, 0)},
        "members": {
            "arm": {
                "nodes": ("root", "tip"),
                "section": "tube",
                "material": "steel",
                "hinges": [{"name": "fold", "at": "root"}],
            }
        },
        "supports": {"clamp": {"node": "root", "fix": "all"}},
        "initial_velocity": [{"rotation": 1.0, "axis": (0, -1, 0)}],
    }
    result = solve_multibody(Structure(**keys), Run(duration=0.01, every=1e-3))
    (warning,) = about(result, "typical")
    assert warning.startswith("Material steel: S355: typical, not design values")


@pytest.mark.parametrize(("restitution", "message"), [(0.0, True), (0.9, True), (0.96, False)])
def test_energy_that_rigid_impacts_took_is_named(restitution: float, message: bool) -> None:
    """A bar that falls flat: no hinge takes anything, and 1 - e^2 of its energy is gone."""
    structure = Structure(
        materials={"steel": STEEL},
        sections={"tube": TUBE},
        nodes={"a": (0, 0, 0), "b": (1, 0, 0)},
        members={"bar": {"nodes": ("a", "b"), "section": "tube", "material": "steel"}},
        initial_velocity=[{"translation": (0.0, 0.0, -5.0)}],
        obstacles={
            "ground": {
                "type": "plane",
                "point": (0, 0, -0.1),
                "normal": (0, 0, 1),
                "restitution": restitution,
            }
        },
    )
    result = solve_multibody(structure, Run(0.03, 1e-3))
    assert any("are lost in impacts" in warning for warning in result.warnings) == message


def test_similar_hinges_are_reported_together() -> None:
    result = thrown(15.0, bars=130)
    reported = [text for text in result.assumptions if "capacity" in text]
    (text,) = reported
    assert text.startswith(f"{len(result.hinges)} hinges (tube-1, ")
    assert (
        f" and {len(result.hinges) - 6} more) are rigid until their capacity is reached; their curves run"
        in text
    )
    assert len(result.warnings) < 8


def test_rotations_beyond_the_range_are_reported_in_one_sentence() -> None:
    law = {"type": "table", "rotation": (0.0, 0.02), "moment": (900.0, 900.0), "rate": "off"}
    members = {
        name: {
            "nodes": (f"{name}0", f"{name}1"),
            "section": "tube",
            "material": "steel",
            "hinges": [{"name": name, "at": f"{name}0", "law": law, "axis": "y"}],
        }
        for name in "ab"
    }
    structure = Structure(
        materials={"steel": STEEL},
        sections={"tube": TUBE},
        nodes={f"{name}{i}": (float(i), float(k), 0.0) for k, name in enumerate("ab") for i in (0, 1)},
        members=members,
        supports={name: {"node": f"{name}0", "fix": "all"} for name in "ab"},
        impulses=[{"node": "a1", "impulse": (0, 0, 20.0)}, {"node": "b1", "impulse": (0, 0, 25.0)}],
    )
    result = solve_multibody(structure, Run(duration=0.1, every=0.01))
    (text,) = about(result, "turned by")
    turns = [f"{math.degrees(result.hinges[name].rotation_max):.3g}" for name in "ab"]
    assert text.startswith(
        f"Hinges a, b: turned by {turns[0]} to {turns[1]} deg; the law is valid up to 1.1 deg"
    )


@pytest.mark.parametrize(
    ("largest", "errors", "said"),
    [
        (math.radians(60.0), (0.5, 0.7), "of 1 of 2 hinges err by up to 0.7 deg"),
        # a hundredth of the largest rotation
        (math.radians(60.0), (0.5, 0.59), ""),
        # rotations of a column that is pressed together: nobody decides on hundredths of a degree
        (math.radians(0.02), (0.011, 0.02), ""),
        (math.radians(0.1), (0.04, 0.02), "of 1 of 2 hinges err by up to 0.04 deg"),
    ],
)
def test_estimated_errors_count_beyond_a_hundredth_and_a_floor(largest, errors, said) -> None:
    result = thrown(1.0)
    (summary,) = result.hinges.values()
    hinges = {
        str(i): replace(summary, rotation_max=largest, rotation_error=math.radians(error))
        for i, error in enumerate(errors)
    }
    texts = inaccurate(hinges, largest)
    assert len(texts) == bool(said)
    assert all(said in text for text in texts)


@pytest.mark.parametrize("form", ["set-valued", "elastic-plastic"])
@pytest.mark.parametrize("kernel", ["tree", "spatial"])
def test_a_rotation_that_is_turned_back_between_outputs_is_judged(form: str, kernel: str) -> None:
    """The tip is driven up by 0.9 m and back: outputs at both ends alone see none of 66 deg."""
    law = {"type": "kecman", "form": form}
    bar = {"section": "tube", "material": "steel", "hinges": [{"name": "root", "at": "root", "law": law}]}
    drive = {"z": {"table": {"time": (0.0, 0.1, 0.2), "value": (0.0, 0.9, 0.0)}}}
    structure = Structure(
        materials={"steel": STEEL},
        sections={"tube": TUBE},
        nodes={"root": (0.0, 0.0, 0.0), "tip": (1.0, 0.0, 0.0)},
        members={"tube": {"nodes": ("root", "tip"), **bar}},
        supports={"clamp": {"node": "root", "fix": "all"}, "push": {"node": "tip", "motion": drive}},
    )
    settings = MultibodySettings(members="rigid", kernel=kernel)
    fine, coarse = (solve_multibody(structure, Run(0.2, every, settings)) for every in (0.002, 0.2))
    told = [text for text in coarse.assumptions if text.endswith("than their interval may have no caution.")]
    assert len(told) == (kernel == "spatial")
    assert abs(coarse["hinge.root.plastic_rotation"]).max() < 0.1
    assert [one.code for one in coarse.cautions] == [one.code for one in fine.cautions] == ["beyond_jamming"]
    assert coarse.cautions[0].text == fine.cautions[0].text
    assert coarse.hinges["root"].law_rotation == pytest.approx(fine.hinges["root"].law_rotation, rel=1e-4)
