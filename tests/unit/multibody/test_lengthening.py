"""Members whose forces fold or yield their walls are solved again with hinges that change their length."""

import pickle
from dataclasses import replace

import pytest

from crumple._core.outcome import Outcome
from crumple.analysis import loads, solve
from crumple.analysis.solve import run_of
from crumple.multibody import solve_multibody
from crumple.multibody.solve import solver_of
from crumple.structure import placed_hinges, with_elastic_members
from crumple.structure.hinges.lengthening.found import lengthening_members

BRACKET = """crumple: 1
materials:
  steel: {{youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: 355 MPa}}
sections:
  arm: {{type: rectangular_tube, width: 50 mm, depth: 60 mm, thickness: 5 mm}}
  strut: {{type: circular_tube, diameter: {diameter} mm, thickness: 1.2 mm}}
nodes:
  high: [0 m, 0 m, 0 m]
  joint: [0.3 m, 0 m, 0 m]
  tip: [0.5 m, 0 m, 0 m]
  low: [0 m, 0 m, -0.3 m]
members:
  inner: {{nodes: [high, joint], section: arm, material: steel, up: [0, 0, 1]}}
  outer: {{nodes: [joint, tip], section: arm, material: steel, up: [0, 0, 1]}}
  strut: {{nodes: [low, joint], section: strut, material: steel{hinges}}}
hinges: auto
supports: {{a: {{node: high, fix: all}}, b: {{node: low, fix: all}}}}
masses: {{load: {{node: tip, mass: 50 kg}}}}
initial_velocity:
  - {{nodes: [tip], translation: [0 m/s, 0.2 m/s, {speed} m/s]}}
analysis: {{duration: {time} ms, multibody: {{members: {members}}}}}
outputs: {{every: 0.2 ms, nodes: [tip]}}
"""


def bracket(speed=-6.0, members="elastic", hinges="", diameter=25, time=12):
    """A stiff arm on a thin strut, its tip thrown down: the strut is pressed; or thrown up: it is pulled."""
    given = {"speed": speed, "members": members, "diameter": diameter, "time": time}
    return loads(BRACKET.format(hinges=f", hinges: {hinges}" if hinges else "", **given))


def noted(analysis):
    return lengthening_members(analysis.structure, analysis.multibody, analysis.time_in_motion)


def of_strut(result):
    return {name for name in result.hinges if name.startswith("strut")}


@pytest.fixture(scope="module")
def pressed():
    analysis = bracket()
    return analysis, solve(analysis)


def test_a_strut_that_would_carry_more_than_its_walls_is_solved_again_and_named(pressed):
    analysis, result = pressed
    assert result.status.ok
    assert noted(analysis) == {"strut"}
    assert of_strut(result) == {"strut-low", "strut-1", "strut-joint"}
    (told,) = (text for text in result.warnings if "solved again" in text)
    assert told.startswith("Member strut carries more along its axis than folds or yields the walls")
    assert "members.strut.hinges: {axial: {law: circular}, spacing: 212 mm}" in told
    assert "axial_compression" not in {caution.code for caution in result.cautions}
    moved = solve(bracket(hinges="{axial: {law: circular}, spacing: 212.1 mm}"))
    for name, hinge in result.hinges.items():
        assert hinge.rotation_max == pytest.approx(moved.hinges[name].rotation_max, rel=1e-3, abs=1e-4)


def test_the_strut_gives_way(pressed):
    stiff = solve(bracket(hinges="{axes: [y, z, x], axial: false}"), checks=False)
    assert "axial_compression" in {caution.code for caution in stiff.cautions}
    tip = "node.tip.displacement.z"
    assert pressed[1][tip].min() < 1.5 * stiff[tip].min() < 0.0


def test_a_second_solution_is_the_same_and_so_is_that_of_another_process(pressed):
    analysis, first = pressed
    copy = pickle.loads(pickle.dumps(analysis))
    assert noted(copy) == {"strut"}
    for again in (solve(analysis), solve(copy)):
        assert again.hinges.keys() == first.hinges.keys()
        assert all((again[name] == first[name]).all() for name in first.channels)
        assert any("solved again" in text for text in again.warnings)


def test_others_see_the_candidates_that_a_solution_has_shown():
    analysis = bracket(time=6)

    def candidates():
        bent = with_elastic_members(analysis.structure, analysis.multibody, analysis.time_in_motion)
        return {hinge.name for hinge in placed_hinges(bent) if hinge.plastic and hinge.member == "strut"}

    assert candidates() == {"strut-low", "strut-joint"}
    solve(analysis, checks=False)
    assert candidates() == {"strut-low", "strut-1", "strut-joint"}


def test_a_strut_that_is_pulled_yields():
    analysis = bracket(speed=9.0)
    result = solve(analysis, checks=False)
    assert noted(analysis) == {"strut"}
    assert "axial_tension" not in {caution.code for caution in result.cautions}
    assert max(result[f"hinge.{name}.slip.x.travel"].max() for name in of_strut(result)) > 1e-3


@pytest.mark.parametrize("keys", [{"speed": -0.5}, {"members": "rigid"}, {"hinges": "{axial: false}"}])
def test_strong_struts_rigid_ones_and_those_that_are_to_keep_their_length_do(keys):
    analysis = bracket(**keys)
    result = solve(analysis, checks=False)
    assert not noted(analysis)
    assert not any("solved again" in text for text in result.warnings)


def test_if_the_further_run_does_not_complete_the_first_one_is_the_answer(monkeypatch):
    made = []

    def solver(structure, run):
        made.append(solver_of(structure, run))
        if len(made) == 2:
            whole = made[1].run
            made[1].run = lambda *args, **keys: replace(whole(*args, **keys), outcome=Outcome.STALLED)
        return made[-1]

    monkeypatch.setattr("crumple.multibody.solve.solver_of", solver)
    analysis = bracket(time=6)
    result = solve(analysis, checks=False)
    assert len(made) == 2
    assert result.status.ok
    assert of_strut(result) == {"strut-low", "strut-joint"}
    assert not noted(analysis)


def test_what_one_run_shows_changes_no_other():
    analysis = bracket(time=6)
    alone = solve(analysis, checks=False)
    rigid = bracket(time=6, members="rigid")
    before = solve(rigid, checks=False)
    shared = rigid.model_copy(update={"structure": analysis.structure})
    assert of_strut(solve(shared, checks=False)) == of_strut(before) == {"strut-low", "strut-joint"}
    brief = analysis.model_copy(update={"duration": 0.4e-3})
    assert "strut-1" not in of_strut(solve(brief, checks=False))
    assert of_strut(solve(analysis, checks=False)) == of_strut(alone)


def test_members_that_are_elastic_by_themselves_lengthen_too():
    text = BRACKET.replace("material: steel", "material: steel, elastic: true")
    given = {"speed": -6.0, "members": "rigid", "diameter": 25, "time": 6, "hinges": ""}
    analysis = loads(text.format(**given))
    result = solve(analysis, checks=False)
    assert of_strut(result) == {"strut-low", "strut-1", "strut-joint"}
    assert any("solved again" in text for text in result.warnings)


def test_two_members_in_one_place_keep_their_lengths():
    twice = BRACKET.replace(
        "hinges: auto\n", "  twin: {{nodes: [low, joint], section: strut, material: steel}}\nhinges: auto\n"
    )
    given = {"speed": -6.0, "members": "elastic", "diameter": 18, "time": 3, "hinges": ""}
    analysis = loads(twice.format(**given))
    solve(analysis, checks=False)
    assert not noted(analysis)


def test_members_in_line_lengthen_together_and_kink_in_the_middle_of_all(monkeypatch):
    made = []
    monkeypatch.setattr(
        "crumple.multibody.solve.solver_of", lambda *args: made.append(args) or solver_of(*args)
    )
    parts = "[low, third], section: strut, material: steel{hinges}}}\n"
    for name, nodes in {"next": "[third, other]", "last": "[other, joint]"}.items():
        parts += f"  {name}: {{{{nodes: {nodes}, section: strut, material: steel{{hinges}}}}}}\n"
    text = BRACKET.replace("[low, joint], section: strut, material: steel{hinges}}}\n", parts)
    text = text.replace(
        "members:\n", "  third: [0.12 m, 0 m, -0.18 m]\n  other: [0.18 m, 0 m, -0.12 m]\nmembers:\n", 1
    )
    given = {"speed": -6.0, "members": "elastic", "diameter": 25, "time": 6, "hinges": ""}
    analysis = loads(text.format(**given))
    result = solve(analysis, checks=False)
    assert noted(analysis) == {"strut", "next", "last"}
    assert {name for name in result.hinges if name.split("-")[0] in noted(analysis)} == {
        *("strut-low", "next-1", "last-joint"),
    }
    # all were found at once
    assert len(made) == 2


def test_candidates_that_are_asked_for_at_smaller_distances_stay():
    result = solve(bracket(hinges="{spacing: 130 mm}", time=6), checks=False)
    assert {"strut-1", "strut-2"} < of_strut(result)


def test_a_run_with_changed_capacities_looks_for_nothing():
    analysis = bracket(time=6)
    run = replace(run_of(analysis), capacities={"strut-low": 0.9}, checks=False)
    assert of_strut(solve_multibody(analysis.structure, run)) == {"strut-low", "strut-joint"}
    assert not noted(analysis)


def test_members_whose_hinges_change_their_length_already_are_not_solved_again():
    hard = ", hardening: {{type: swift, prestrain: 0.005, exponent: 0.2}}"
    text = BRACKET.replace("yield_stress: 355 MPa", f"yield_stress: 355 MPa{hard}")
    text = text.replace("node: tip", "node: joint").replace("nodes: [tip], trans", "nodes: [joint], trans")
    given = {"speed": 9.0, "members": "elastic", "diameter": 25, "time": 6, "hinges": ""}
    analysis = loads(text.format(**given))
    result = solve(analysis, checks=False)
    # the metal hardens: the strut carries more than its squash force
    assert max(result["hinge.strut-low.slip.x.force"]) > 355e6 * 3.14 * 0.0238 * 0.0012
    assert not noted(analysis)
