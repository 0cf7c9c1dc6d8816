"""Facts and cautions: runs that ended early, hinges in one fold, oscillations, contact, many hinges."""

from dataclasses import replace
from functools import partial
from types import SimpleNamespace

import numpy as np
import pytest
from tests.support.result.folded_tube import EXAMPLE, analysis, angle_over_time, folded_result

from crumple.analysis import loads, solve
from crumple.comparison import compare, with_frames
from crumple.comparison.cautions.fold_trust import fold_sentences
from crumple.comparison.cautions.trust import _order, swings_of
from crumple.comparison.cautions.verdict import agreement
from crumple.comparison.measure.motion import HingeMotion, channel_motions, measured
from crumple.errors import Status
from crumple.result import Channel
from crumple.structure import Structure
from crumple.structure.hinges.hinges import placed_hinges

TIMES = np.linspace(0.0, 0.1, 101)


@pytest.fixture(scope="module", name="case")
def _case():
    return analysis()


@pytest.fixture(scope="module", name="multibody")
def _multibody(case):
    return solve(with_frames(case, 21))


def shortened(result, end):
    """The same run, stopped on the way."""
    inside, shapes = result.time <= end, result.states.times <= end
    states = replace(
        result.states,
        times=result.states.times[shapes],
        displacement=result.states.displacement[shapes],
        cell_data={name: values[shapes] for name, values in result.states.cell_data.items()},
    )
    channels = {name: replace(c, values=c.values[inside]) for name, c in result.channels.items()}
    return replace(
        result, status=Status.CANCELLED, time=result.time[inside], channels=channels, states=states
    )


def test_a_run_that_was_stopped_is_compared_as_far_as_it_got(case, multibody):
    whole = folded_result(largest=0.545)
    found = compare(multibody, shortened(whole, 0.03), case.structure)
    (hinge,) = found.hinges
    # a tube thrown to 31 deg in 80 ms has turned by half of that at 30 ms, in both
    assert hinge.first.rotation_max < 0.7 * multibody.hinges["root"].rotation_max
    assert abs(hinge.error("rotation_max")) < 0.25
    assert "only the first 30 ms, which both contain, are compared" in found.trust.headline
    assert compare(multibody, whole, case.structure).hinges[0].first.rotation_max == pytest.approx(
        multibody.hinges["root"].rotation_max, rel=1e-3
    )


def test_a_second_mesh_that_was_stopped_does_not_change_the_verdict(case, multibody):
    whole = folded_result(largest=0.545)
    other = {"shell, 20 mm": shortened(whole, 0.03)}
    found = compare(multibody, whole, case.structure, variants=other)
    assert found.trust.headline == compare(multibody, whole, case.structure).trust.headline
    assert any("The shell, 20 mm run: cancelled" in text for text in found.trust.cautions)


def test_a_reference_with_a_coarse_mesh_says_so_beside_the_verdict(case, multibody):
    few = "The mesh has as few as 2.6 elements along half a fold of member tube. Below 4 folds take too much."
    whole = folded_result(largest=0.545)
    found = compare(multibody, replace(whole, warnings=(few,)), case.structure)
    plain = compare(multibody, whole, case.structure)
    assert found.trust.level != "good"
    said = " The mesh of the shell run is too coarse to judge: 2.6 elements along half a fold of member tube."
    assert found.trust.headline.endswith(said)
    assert "coarse" not in plain.trust.headline
    assert f"Of the shell run: {few}" in found.trust.cautions


def test_runs_without_folds_do_not_disagree(case, multibody):
    flat = folded_result([(0.01, 0.04, 0.0 * TIMES)])
    still = folded_result([(0.01, 0.04, 0.0 * TIMES)])
    trust = compare(still, flat, case.structure).trust
    assert (trust.level, trust.headline.partition(":")[0]) == (
        "caution",
        "Nothing folds in the shell (reference) run",
    )
    # the candidate's alone is a disagreement
    trust = compare(multibody, flat, case.structure).trust
    assert trust.level == "bad"
    assert "it folds where the shell run does not (root)" in trust.headline


def test_a_largest_rotation_does_not_hide_its_plastic_part():
    hinge = SimpleNamespace(
        name="root",
        first=SimpleNamespace(plastic_energy=100.0, rotation_max=0.5, plastic_rotation=0.5),
        second=SimpleNamespace(plastic_energy=100.0, rotation_max=0.5, plastic_rotation=0.4),
        error={"rotation_max": 0.0, "plastic_rotation": 0.25}.get,
        energy_errors=lambda: (0.02,),
    )
    comparison = SimpleNamespace(
        candidate=SimpleNamespace(name="multibody"), reference=SimpleNamespace(name="shell"), hinges=(hinge,)
    )
    ((message, wrong),) = agreement(comparison)
    assert wrong
    assert "28.6° shell (0.0 %), of which plastic 28.6° and 22.9° (+25.0 %); plastic energy" in message


def test_hinges_in_one_fold_are_reported_with_their_total_rotation():
    path = EXAMPLE.parent / "01_tube_bending.yaml"
    text = path.read_text().replace(
        "      - {name: root, at: root, law: kecman}",
        "      - {name: root, at: root, law: kecman}\n      - {name: next, at: 60 mm, law: kecman}",
    )
    two = loads(text)
    found = compare(
        solve(with_frames(two, 21)), folded_result([(0.01, 0.08, angle_over_time(TIMES))]), two.structure
    )
    (message,) = (text for text in found.trust.cautions if "are in one fold" in text)
    assert message.startswith("Hinges root and next are in one fold of the shell result, from 10 mm to 80 mm")
    assert "31.2° multibody and 34.4° shell" in message


def test_the_total_rotation_of_a_corner_is_reported():
    # laws of the members, so that there are hinges on both sides of a corner
    text = (
        (EXAMPLE.parent / "08_s_rail.yaml")
        .read_text("utf-8")
        .replace("hinges: auto", "hinges: {law: kecman}")
    )
    structure = loads(text).structure
    hinges = {hinge.name: hinge for hinge in placed_hinges(structure)}
    degrees = {
        "multibody": {"middle-upper_bend": 0.3, "rear-upper_bend": 72.6},
        "shell": {"middle-upper_bend": 48.0, "rear-upper_bend": 27.0},
    }

    def motion(source, name):
        rotation = np.radians(degrees[source].get(name, 0.2)) * np.linspace(0.0, 1.0, 5)
        place = hinges[name]
        return HingeMotion(name, place.member, 0.0, np.arange(5.0), rotation, *[np.zeros(5)] * 4, how="")

    comparison = SimpleNamespace(
        **{
            role: SimpleNamespace(name=name, extra=(), hinge=partial(motion, name))
            for role, name in (("candidate", "multibody"), ("reference", "shell"))
        },
        opened={"multibody": (), "shell": ()},
        hinges=[
            SimpleNamespace(
                name=name, member=hinge.member, station=0.1 * i, fold_extent=None, fold_station=None
            )
            for i, (name, hinge) in enumerate(hinges.items())
        ],
    )
    ((message, caution),) = fold_sentences(comparison, structure, hinges)
    assert message.startswith(
        "Hinges middle-upper_bend and rear-upper_bend are on both sides of corner upper_bend"
    )
    assert "total rotation of the corner is 72.9° multibody and 75.0° shell" in message
    assert not caution


def test_a_hinge_that_bends_two_ways_is_measured_whatever_the_axis():
    path = EXAMPLE.parent / "01_tube_bending.yaml"
    text = path.read_text().replace("at: root, law: kecman}", "at: root, axes: [y, z], coupling: ellipsoid}")
    two = loads(text.replace("roll: 0 deg", "roll: 30 deg"))
    (hinge,) = placed_hinges(two.structure)
    shell = folded_result(largest=0.6)
    (motion,) = measured(shell, two.structure, [hinge]).hinges
    assert abs(motion.rotation).max() == pytest.approx(0.6, rel=1e-3)
    assert motion.far.max() == pytest.approx(0.6 * (1.0 - 0.025), rel=5e-3)
    assert "conjugate" in motion.how
    # the cut's moment counts as far as it lies along the axis of bending
    cut = {
        f"cut.root.moment.{axis}": size + 0.0 * shell.time
        for axis, size in (("x", 50.0), ("y", -900.0), ("z", 70.0))
    }
    reported = replace(
        shell, channels={**shell.channels, **{name: Channel(name, "N*m", v) for name, v in cut.items()}}
    )
    (motion,) = measured(reported, two.structure, [hinge]).hinges
    assert motion.moment[5:] == pytest.approx(900.0)
    # the multibody answer counts the same: the length of its vector of bending
    rotation = np.linspace(0.0, 1.0, 5)
    histories = ("rotation", "plastic_rotation", "moment")
    sizes = {
        f"{key}{axis}": size for key in histories for axis, size in (("", 5.0), (".y", 0.6), (".z", -0.8))
    }
    channels = {f"hinge.root.{name}": Channel(name, "", size * rotation) for name, size in sizes.items()}
    (motion,) = channel_motions(replace(shell, channels=channels, time=rotation), [hinge], {})
    for history in histories:
        assert getattr(motion, history) == pytest.approx(rotation)


def test_amplitudes_are_measured_between_turning_points():
    time = np.linspace(0.0, 4.0, 81)
    values = 2.0 + 0.8 * np.sin(2.0 * np.pi * time)
    values[0] = 0.0
    swings = swings_of(values, 0.2)
    assert len(swings) == 7
    assert swings == pytest.approx([0.8] * 7, rel=0.02)
    # a rise alone, and noise, are no swings
    assert swings_of(time, 0.2) == []
    assert swings_of(2.0 - 0.05 * np.cos(40.0 * time), 0.2) == []


def test_contact_with_an_obstacle_is_not_reported_as_contact_of_walls(case, multibody):
    shell = folded_result(contact=0.05)
    floor = {"floor": {"type": "plane", "point": (0.0, 0.0, -1.0), "normal": (0.0, 0.0, 1.0)}}
    open_air = compare(multibody, shell, case.structure).trust
    before = Structure.model_validate({**case.structure.model_dump(by_alias=True), "obstacles": floor})
    with_floor = compare(multibody, shell, before).trust
    assert any("Walls touch in" in text for text in open_air.cautions)
    assert not any("Walls touch in" in text for text in with_floor.cautions)
    assert any("walls press on obstacles" in text for text in with_floor.facts)


def test_many_hinges_and_a_long_order_are_cut():
    names = [f"hinge {i}" for i in range(12)]
    hinges = tuple(
        SimpleNamespace(
            name=name,
            first=SimpleNamespace(plastic_energy=100.0, rotation_max=1.0 + 0.1 * i, plastic_rotation=1.0),
            second=SimpleNamespace(plastic_energy=100.0, rotation_max=1.0, plastic_rotation=1.0),
            error={"rotation_max": 0.1 * i, "plastic_rotation": 0.0}.get,
            energy_errors=lambda: (),
        )
        for i, name in enumerate(names)
    )
    opened = {
        "multibody": opened_at(names),
        "shell": opened_at((*names[:3], *names[:2:-1])),
    }
    comparison = SimpleNamespace(
        candidate=SimpleNamespace(name="multibody"),
        reference=SimpleNamespace(name="shell"),
        hinges=hinges,
        opened=opened,
    )
    reported = list(agreement(comparison))
    assert len(reported) == 9
    assert reported[0][0].startswith("Hinge hinge 11: largest rotation")
    assert reported[-1] == (
        "4 further hinges have smaller errors or absorbed little energy; "
        "2 of them differ by more than 12.0 %.",
        True,
    )
    ((order, wrong),) = _order(comparison)
    assert wrong
    assert order.startswith("After the first 3, which agree, the hinges open in different orders: hinge 3,")
    assert order.count("and 3 more") == 2


def opened_at(names, times=()):
    """Openings of hinges at these times, or one after the other."""
    given = times or range(1, 1 + len(names))
    return [SimpleNamespace(name=name, time=time) for name, time in zip(names, given, strict=True)]


@pytest.mark.parametrize(
    ("order", "times", "told"),
    [
        ("abc", (1.0, 2.0, 3.0), "Hinges open in the same order in both: a, b, c."),
        # mirror images: together in one result, in either order in the other
        (
            "acb",
            (1.0, 2.0, 2.01),
            "Hinges open in the same order in both, but for those that open at the same",
        ),
        (
            "acb",
            (1.0, 2.0, 2.1),
            "After the first 1, which agree, the hinges open in different orders: b, c in",
        ),
        # nothing agrees before the first difference if the first two open together
        (
            "cab",
            (1.0, 1.01, 3.0),
            "The hinges open in different orders: a, b, c in the multibody result, c, a",
        ),
    ],
)
def test_the_order_of_hinges_that_open_together_is_chance(order, times, told):
    source = [SimpleNamespace(name=name) for name in ("multibody", "shell")]
    opened = {"multibody": opened_at("abc"), "shell": opened_at(order, times)}
    ((text, wrong),) = _order(SimpleNamespace(candidate=source[0], reference=source[1], opened=opened))
    assert text.startswith(told)
    assert wrong == ("different" in told)


def test_what_agrees_before_the_first_difference_is_the_same_hinges():
    """The first to open are a and c, by chance, as they open together in the first result."""
    source = [SimpleNamespace(name=name) for name in ("multibody", "shell")]
    opened = {
        "multibody": opened_at("abcd", (1.0, 1.01, 1.015, 3.0)),
        "shell": opened_at("cdab", (1.0, 2.0, 2.01, 3.0)),
    }
    ((text, _),) = _order(SimpleNamespace(candidate=source[0], reference=source[1], opened=opened))
    assert text.startswith("The hinges open in different orders: a, b, c, d in the multibody result")


def test_welds_that_failed_are_a_caution(case, multibody):
    shell = folded_result(largest=0.545)
    share = np.where(shell.time < 0.03, 0.0, 0.25)
    failed = {"weld.seam.failed": Channel("weld.seam.failed", "1", share)}
    trust = compare(multibody, replace(shell, channels={**shell.channels, **failed}), case.structure).trust
    assert any(
        "25.0 % of the spot welds seam failed in the shell result, the first by 30 ms" in text
        for text in trust.cautions
    )
    none = {"weld.seam.failed": Channel("weld.seam.failed", "1", 0.0 * share)}
    trust = compare(multibody, replace(shell, channels={**shell.channels, **none}), case.structure).trust
    assert not any("spot welds" in text for text in (*trust.cautions, *trust.facts))


def test_a_run_that_ends_before_the_peak_is_a_caution(case, multibody):
    whole = folded_result(largest=0.545)
    early = compare(shortened(multibody, 0.04), shortened(whole, 0.04), case.structure).trust
    (message,) = (text for text in early.cautions if "Still rotating" in text)
    assert "ends at 40 ms: root (multibody); root (shell)" in message
    assert not any(
        "Still rotating" in text for text in compare(multibody, whole, case.structure).trust.cautions
    )
    # rounding that grows is no turning
    tiny = {
        name: replace(channel, values=1e-12 * channel.values)
        for name, channel in multibody.channels.items()
        if name.startswith("hinge.")
    }
    still = replace(multibody, channels={**multibody.channels, **tiny})
    trust = compare(shortened(still, 0.04), shortened(whole, 0.04), case.structure).trust
    assert any("at 40 ms: root (shell)" in text for text in trust.cautions)


def test_warnings_of_the_runs_are_mentioned(case, multibody):
    shell = replace(folded_result(largest=0.545), warnings=("something", "else"))
    facts = compare(multibody, shell, case.structure).trust.facts
    assert any("2 of the shell run" in text for text in facts)


def test_a_hinge_that_is_crushed_is_a_caution(case, multibody):
    crushed = Channel("hinge.root.slip.x.plastic_travel", "m", np.linspace(0.0, -0.08, multibody.time.size))
    channels = {**multibody.channels, crushed.name: crushed}
    shell = folded_result(largest=0.545)
    trust = compare(replace(multibody, channels=channels), shell, case.structure).trust
    assert any("Hinge root is crushed by 80 mm along its member" in text for text in trust.cautions)
    assert not any("is crushed" in text for text in compare(multibody, shell, case.structure).trust.cautions)


def test_plastic_work_outside_folds_is_reported(case, multibody):
    still = folded_result([(0.01, 0.04, 0.0 * TIMES)])
    # crushed along itself: work and strain, and no section turns
    work = replace(still.channels["energy.dissipated"], values=300.0 * still.time / still.time[-1])
    start = replace(still.channels["energy.kinetic"], values=300.0 - work.values)
    strain = np.zeros_like(still.states.cell_data["plastic_strain"])
    strain[:, :20] = np.linspace(0.0, 0.4, len(strain))[:, None]
    shapes = replace(still.states, cell_data={"plastic_strain": strain})
    channels = {**still.channels, "energy.dissipated": work, "energy.kinetic": start}
    crushed = replace(still, channels=channels, states=shapes)
    trust = compare(still, crushed, case.structure).trust
    assert trust.level == "bad"
    assert "100.0 % of its plastic work is outside folds" in trust.headline
    assert any("where sections do not rotate" in text for text in trust.cautions)
    assert not any(
        "outside its folds" in text
        for text in compare(multibody, folded_result(), case.structure).trust.cautions
    )


def test_the_shortening_of_a_crushed_fold_is_reported(case, multibody):
    def sentence(shell):
        found = compare(multibody, shell, case.structure)
        return next(text for text in found.trust.cautions if "folds in member tube at" in text)

    turned = folded_result([(0.5, 0.6, 0.2 * TIMES / TIMES[-1])])
    assert "(by 11.5°), where the multibody model has no hinge" in sentence(turned)
    # everything beyond the fold moves back by 40 mm along x, at half the angle to the fold's own line
    states = turned.states
    way = np.zeros_like(states.displacement)
    beyond = np.clip((states.station - 0.5) / 0.1, 0.0, 1.0)
    way[..., 0] = -0.04 * (states.times / states.times[-1])[:, None] * beyond
    crushed = replace(turned, states=replace(states, displacement=states.displacement + way))
    assert ", shortened by 39 mm of 160 mm)" in sentence(crushed)
