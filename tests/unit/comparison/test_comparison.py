"""A multibody run against a shell-like result: pairs, ratings, order, trust in plain sentences."""

import pickle
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from tests.support.result.folded_tube import EXAMPLE, analysis, angle_over_time, folded_result

from crumple.analysis import load, solve
from crumple.comparison import CurveFile, Signal, Timing, compare, with_frames, with_pictures
from crumple.comparison.cautions.fold_trust import across_joint, fold_sentences
from crumple.comparison.measure.metrics import percent, signed
from crumple.comparison.measure.motion import HingeMotion
from crumple.comparison.rating.pairing import pairs_of
from crumple.comparison.solving import mesh_name, with_mesh
from crumple.comparison.variant import (
    ELASTIC_MEMBERS,
    RIGID_MEMBERS,
    SHELL_LAWS,
    measured_law,
    variants_of,
    with_elastic_hinges,
    with_measured_laws,
)
from crumple.errors import InputError, Status
from crumple.report.wording.comparison_wording import busy_note, key_figures, signed_percent, speed_table
from crumple.result import Provenance
from crumple.structure.hinges.hinges import placed_hinges
from crumple.structure.hinges.places import hinge_places, law_spec

TIMES = np.linspace(0.0, 0.1, 101)


@pytest.fixture(scope="module", name="case")
def _case():
    return analysis()


@pytest.fixture(scope="module", name="multibody")
def _multibody(case):
    return solve(with_frames(case, 21))


@pytest.fixture(scope="module", name="found")
def _found(case, multibody):
    return compare(multibody, folded_result(largest=0.545), case.structure)


def test_a_result_agrees_with_itself(case, multibody):
    found = compare(multibody, multibody, case.structure)
    assert found.candidate.name != found.reference.name
    (hinge,) = found.hinges
    assert hinge.error("rotation_max") == 0.0
    assert all(pair.rating.overall == pytest.approx(1.0) for pair in found.pairs if pair.rating)
    assert all(pair.largest_difference == 0.0 for pair in found.pairs)


def test_the_hinge_is_found_in_both(found):
    (hinge,) = found.hinges
    assert hinge.name == "root"
    assert hinge.error("rotation_max") == pytest.approx(0.0, abs=0.002)
    assert hinge.fold_extent == pytest.approx((0.01, 0.04))
    assert [o.name for o in found.opened["shell"]] == ["root"]
    channels = [pair.channel for pair in found.pairs]
    assert channels[:2] == ["hinge.root.rotation", "hinge.root.rotation_rate"]
    assert "member.tube.chord_rotation" in channels
    assert found.pairs[0].rating.overall > 0.9


def test_the_comparison_travels(found):
    again = pickle.loads(pickle.dumps(found))
    assert again.hinges[0].first == found.hinges[0].first or again.trust == found.trust
    assert again.speed_ratio == found.speed_ratio


def test_solve_times_state_the_number_of_threads(case, multibody):
    shell = folded_result(provenance=Provenance(version="0.1.0", input_hash="0" * 64, threads=2))
    found = compare(multibody, shell, case.structure)
    assert found.candidate.with_threads == "multibody"
    assert found.reference.with_threads == "shell, 2 threads"
    value, note = next((value, note) for name, value, note in key_figures(found) if name == "Faster")
    assert note.startswith("multibody than shell, 2 threads")
    # no more digits than the clock knows
    assert set(value.removesuffix(" ×")[3:]) <= {"0"}


def test_solve_times_are_compared_with_the_reference_solve(case, multibody):
    shell = folded_result(solve_seconds=20.0)
    found = compare(replace(multibody, solve_seconds=2e-3), shell, case.structure)
    table = speed_table(found)
    assert table.rows == [
        ("multibody", "1", "2 ms", "10000", "—", "—", "—", "—"),
        ("shell", "1", "20 s", "—", "—", "—", "—", "—"),
    ]
    timed = replace(found, timings={"multibody": Timing(again=1e-3, stepping=1.234e-4)})
    assert speed_table(timed).rows[0] == (
        "multibody", "1", "2 ms", "10000", "1 ms", "20000", "123 µs", "162000",
    )  # fmt: skip
    ((value, note),) = ((value, note) for name, value, note in key_figures(timed) if name == "Faster")
    assert value == "20000 ×"
    assert note == "multibody than shell, shortest of several solves; first solve 10000 ×"


@pytest.mark.parametrize(
    ("share", "seconds", "reported"),
    [(0.5, 20.0, True), (0.95, 20.0, False), (0.5, 2.0, False), (None, 20.0, False)],
)
def test_waiting_of_the_reference_is_reported(case, multibody, share, seconds, reported):
    found = replace(
        compare(multibody, folded_result(solve_seconds=seconds), case.structure), busy_share=share
    )
    message = "The threads of the shell run were busy for 50 % of its solve time"
    assert busy_note(found).startswith(message) is reported
    assert (message in speed_table(found).caption) is reported


def test_curves_are_paired_by_name_and_the_rest_is_named(case, multibody):
    shell = folded_result()
    values = -angle_over_time(TIMES)
    curve = CurveFile(
        "test",
        "test.csv",
        {
            "hinge.root.rotation": Signal("hinge.root.rotation", "rad", TIMES, values),
            "unheard of": Signal("unheard of", "rad", TIMES, values),
        },
    )
    found = compare(multibody, shell, case.structure, curves=[curve])
    rated = {p.candidate: p.rating.overall for p in found.pairs if p.reference == "test"}
    assert set(rated) == {"multibody", "shell"}
    assert rated["shell"] == pytest.approx(1.0, abs=1e-6)
    assert found.unpaired["test"] == ("unheard of",)


def test_histories_of_other_units_are_not_paired():
    a = {"x": Signal("x", "rad", TIMES, TIMES)}
    b = {"x": Signal("x", "J", TIMES, TIMES)}
    assert pairs_of(("a", a), ("b", b)) == []
    assert len(pairs_of(("a", a), ("b", a))) == 1


def test_agreement_is_called_so(case, multibody):
    trust = compare(multibody, multibody, case.structure).trust
    assert trust.level == "good"
    assert trust.headline.startswith("Both results agree")
    assert trust.cautions == ()


def test_an_equal_rotation_does_not_excuse_another_energy(found):
    assert found.trust.level == "bad"
    assert (
        "differs by 0.0 %, the plastic energy at equal plastic rotation by up to 34" in found.trust.headline
    )
    assert any("inside the range" in fact for fact in found.trust.facts)
    assert any("one mesh" in fact for fact in found.trust.facts)


def test_a_second_mesh_shows_how_accurate_the_reference_is(case, multibody):
    shell = folded_result(largest=0.6)
    near, far = (folded_result(largest=largest) for largest in (0.605, 0.7))
    for other, doubtful in ((near, False), (far, True)):
        trust = compare(multibody, shell, case.structure, variants={"shell, 10 mm": other}).trust
        message = trust.cautions if doubtful else trust.facts
        assert any("On another mesh (shell, 10 mm" in text for text in message)
        assert not any("one mesh" in text for text in (*trust.facts, *trust.cautions))


def test_further_models_split_the_difference(case, multibody):
    shell = folded_result()
    trust = compare(multibody, shell, case.structure, variants={SHELL_LAWS: shell}).trust
    assert any("explain the difference" in fact for fact in trust.facts)
    other = folded_result(largest=0.5)
    trust = compare(multibody, shell, case.structure, variants={SHELL_LAWS: other}).trust
    assert any("do not explain the whole difference" in fact for fact in trust.facts)


def test_another_mesh_has_elements_of_another_size(case):
    fine = case.model_copy(update={"shell": case.shell.model_copy(update={"fine_size": 4e-3})})
    assert with_mesh(fine, 2.0).shell.fine_size == 8e-3
    assert with_mesh(fine, 2.0).shell.element_size == 2.0 * fine.shell.element_size
    assert mesh_name(with_mesh(case, 2.0)) == f"shell, {2e3 * case.shell.element_size:g} mm"
    for factor in (0.0, -1.0, 1.0, float("nan"), float("inf")):
        with pytest.raises(InputError, match="no second mesh"):
            with_mesh(case, factor)


def test_a_fold_without_a_hinge_is_reported(case, multibody):
    folds = [(0.01, 0.04, angle_over_time(TIMES)), (0.60, 0.63, 0.5 * angle_over_time(TIMES))]
    found = compare(multibody, folded_result(folds), case.structure)
    assert found.trust.level == "bad"
    assert "folds where there is no hinge (tube at 615 mm)" in found.trust.headline
    assert [h.name for h in found.hinges] == ["root", "tube at 615 mm"]
    assert found.hinges[1].first is None


@pytest.mark.parametrize(("station", "beside"), [(0.48, "knee"), (0.25, "")])
def test_a_fold_across_a_joint_is_distinguished_from_one_without_a_hinge(station, beside):
    structure = load(EXAMPLE.parent / "06_two_bars.yaml").structure
    hinges = {hinge.name: hinge for hinge in placed_hinges(structure)}
    motion = HingeMotion("first at", "first", station, *[np.zeros(1)] * 6, how="")
    assert across_joint(structure, motion, hinges) == beside


def turned(name, member, station, degrees):
    """Motion that turns evenly to an angle."""
    rotation = np.radians(degrees) * np.linspace(0.0, 1.0, 5)
    return HingeMotion(name, member, station, np.arange(5.0), rotation, *[np.zeros(5)] * 4, how="")


def test_both_members_of_a_corner_share_its_rotation():
    structure = load(EXAMPLE.parent / "06_two_bars.yaml").structure
    hinges = {hinge.name: hinge for hinge in placed_hinges(structure)}
    knees = {
        "multibody": turned("knee", "second", 0.06, 10.0),
        "shell": turned("knee", "second", 0.016, -4.0),
    }
    sources = {
        name: SimpleNamespace(name=name, extra=(), hinge={"knee": knee}.get) for name, knee in knees.items()
    }
    sources["shell"].extra = (turned("first at 480 mm", "first", 0.48, -5.5),)
    comparison = SimpleNamespace(
        candidate=sources["multibody"],
        reference=sources["shell"],
        opened=dict.fromkeys(sources, ()),
        hinges=(),
    )
    ((sentence, caution),) = fold_sentences(comparison, structure, hinges)
    assert "folds in member first at 480 mm (by 5.5°), at the joint next to hinge knee" in sentence
    assert "(9.5° in total; 10.0° multibody)" in sentence
    assert caution


def test_hinges_that_open_in_one_result_alone_are_reported_together():
    structure = load(EXAMPLE.parent / "06_two_bars.yaml").structure
    (any_place, *_) = placed_hinges(structure)
    names = [f"h{i}" for i in range(9)]
    openings = [SimpleNamespace(name=name) for name in names]
    comparison = SimpleNamespace(
        candidate=SimpleNamespace(name="multibody", extra=()),
        reference=SimpleNamespace(name="shell", extra=()),
        opened={"multibody": openings[:8], "shell": openings[8:]},
        hinges=[
            SimpleNamespace(name=name, member="first", station=0.1, fold_extent=None, fold_station=None)
            for name in names
        ],
    )
    found = list(fold_sentences(comparison, structure, dict.fromkeys(names, any_place)))
    assert found == [
        (
            "Hinges h0, h1, h2, h3, h4, h5 and 2 more open in the multibody result only; the shell result "
            "has no fold there.",
            True,
        ),
        ("Hinge h8 opens in the shell result only.", True),
    ]


def test_jamming_and_contact_are_reported(case, multibody):
    found = compare(multibody, folded_result(largest=1.6, contact=0.05), case.structure)
    message = " ".join(found.trust.cautions)
    assert "beyond the jamming angle of its law" in message
    assert "Walls touch" in message
    assert found.trust.level == "bad"


def test_missing_elastic_energy_of_rigid_bars_is_reported(case, multibody):
    shell = folded_result()
    elastic = replace(shell.channels["energy.elastic"], values=0.2 * shell["energy.kinetic"])
    found = compare(
        multibody, replace(shell, channels={**shell.channels, "energy.elastic": elastic}), case.structure
    )
    assert any("lack the elastic part" in text for text in found.trust.cautions)


def test_a_run_that_failed_is_compared_and_reported(case, multibody):
    shell = folded_result(status=Status.NOT_FINITE, reason="element 7 failed")
    found = compare(multibody, shell, case.structure)
    assert found.trust.level == "bad"
    assert any("element 7 failed" in text for text in found.trust.cautions)
    assert found.trust.headline == "A run did not complete: the figures below are of limited value."


def test_shapes_whose_times_differ_by_rounding_are_one(case, multibody):
    states = multibody.states
    rows = np.array([*range(5), 4, *range(5, len(states.times))])
    times = states.times[rows].copy()
    times[5] += 1e-18
    cells = {name: values[rows] for name, values in states.cell_data.items()}
    twice = replace(states, times=times, displacement=states.displacement[rows], cell_data=cells)
    found = compare(replace(multibody, states=twice), folded_result(), case.structure)
    (rated,) = (p.rating for p in found.pairs if p.channel == "hinge.root.rotation_rate")
    once = compare(multibody, folded_result(), case.structure)
    assert rated == next(p.rating for p in once.pairs if p.channel == "hinge.root.rotation_rate")


def test_a_result_without_histories_is_refused(case, multibody):
    empty = replace(folded_result(), time=np.zeros(0), channels={})
    with pytest.raises(InputError, match="contains no histories"):
        compare(multibody, empty, case.structure)


def test_a_reference_without_shapes_is_compared_by_its_channels(case, multibody):
    found = compare(multibody, replace(folded_result(), states=None), case.structure)
    assert found.hinges[0].second is None
    assert [pair.channel for pair in found.pairs] == ["energy.kinetic", "energy.dissipated"]


def test_the_ramp_of_a_regularised_hinge_is_left_behind(case):
    law = {"type": "kecman", "form": "regularised", "regularisation": {"rate": 0.2}}
    tube = case.structure.members["tube"]
    hinges = tuple(hinge.model_copy(update={"law": law}) for hinge in tube.hinges)
    members = {"tube": tube.model_copy(update={"hinges": hinges})}
    elastic = with_elastic_hinges(case.structure.model_copy(update={"members": members}))
    (place,) = hinge_places(elastic)
    assert law_spec(elastic, place).form == "elastic-plastic"


def test_variants_change_forms_and_members_alone(case):
    elastic = with_elastic_hinges(case.structure)
    assert law_spec(elastic, hinge_places(elastic)[0]).form == "elastic-plastic"
    assert law_spec(case.structure, hinge_places(case.structure)[0]).form == "set-valued"
    assert with_elastic_hinges(elastic) is None
    variant = variants_of(case, ())[ELASTIC_MEMBERS]
    assert (variant.structure, variant.multibody.members) == (case.structure, "elastic")


def test_members_that_bend_are_rigid_in_a_variant(case):
    bending = case.model_copy(update={"multibody": case.multibody.model_copy(update={"members": "elastic"})})
    (variant,) = variants_of(bending, ()).items()
    assert variant[0] == RIGID_MEMBERS
    assert variant[1].multibody.members == "rigid"
    tube = case.structure.members["tube"].model_copy(update={"elastic": 0})
    own = case.structure.model_copy(update={"members": {"tube": tube}})
    assert ELASTIC_MEMBERS not in variants_of(case.model_copy(update={"structure": own}), ())


def test_a_law_read_off_a_fold_gives_its_moment_back(found, case):
    motion = found.reference.hinges[0]
    law = measured_law(motion)
    assert law.rotation[0] == 0.0
    assert np.allclose(law.moment[2:], 1200.0, rtol=1e-6)
    changed = with_measured_laws(case.structure, found.reference.hinges)
    assert law_spec(changed, hinge_places(changed)[0]).type == "table"
    assert with_measured_laws(case.structure, []) is None


def test_stored_pictures_are_those_asked_for(multibody):
    kept = with_pictures(multibody, (0.0, 0.05, 0.1))
    assert kept.states.times == pytest.approx([0.0, 0.05, 0.1])


@pytest.mark.parametrize(
    ("error", "text"), [(-4e-4, "0.0 %"), (4e-4, "0.0 %"), (-0.012, "−1.2 %"), (0.05, "+5.0 %")]
)
def test_what_is_rounded_to_zero_has_no_sign(error, text):
    assert signed(error) == signed_percent(error) == text
    assert percent(-1e-9) == "0.0 %"
