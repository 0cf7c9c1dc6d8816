"""Contacts of obstacles in a comparison: impulse, where they touch, what is dissipated there, and targets."""

from copy import copy
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from rich.markup import render
from tests.support.structures import STEEL

from crumple.cli.compare import _contact_lines
from crumple.comparison.cautions.verdict import _figure_text
from crumple.comparison.measure.contacts import dissipated_at, impulse
from crumple.comparison.measure.decisive import figures_of
from crumple.comparison.measure.energy import hinge_work
from crumple.comparison.measure.measures import Measures, measure
from crumple.multibody import Run, solve_multibody
from crumple.report.wording.comparison_wording import contact_table
from crumple.structure import Outputs, Structure, joint_reach

LAW = {"type": "constant", "moment": 1000.0}
POLE = {
    "type": "cylinder", "point": (0.5, 0.0, 0.06), "axis": (0.0, 1.0, 0.0), "radius": 0.03, "mass": 20.0,
    "velocity": (0.0, 0.0, -3.0),
}  # fmt: skip


def beam(**obstacles):
    """A beam clamped at both ends, hinges at the ends and on both sides of its middle, under a pole."""
    tube = {"type": "circular_tube", "diameter": 0.05, "thickness": 1.5e-3}
    return Structure(
        materials={"steel": STEEL},
        sections={"tube": tube},
        nodes={"a": (0.0, 0.0, 0.0), "b": (1.0, 0.0, 0.0)},
        members={
            "bar": {
                "nodes": ("a", "b"),
                "section": "tube",
                "material": "steel",
                "hinges": [{"name": f"h{i}", "at": at, "law": LAW} for i, at in enumerate((0.02, 0.5, 0.98))],
            }
        },
        supports={"a": {"node": "a", "fix": "all"}, "b": {"node": "b", "fix": ("y", "z", "rx", "ry", "rz")}},
        obstacles={"pole": POLE, **obstacles},
    )


def solved(structure):
    """A run of 20 ms with shapes at every output."""
    times = tuple(np.linspace(0.0, 0.02, 41))
    return solve_multibody(structure, Run(0.02, 5e-4, outputs=Outputs(pictures=times)))


@pytest.fixture(scope="module", name="one")
def _one():
    structure = beam()
    return structure, solved(structure)


def at_contact(result, structure, impulses):
    return dissipated_at(result, structure, impulses, hinge_work(result, structure))


def test_the_impulse_is_the_length_of_the_integral():
    force = np.tile([3.0, 0.0, -4.0], (5, 1))
    assert impulse(np.linspace(0.0, 2.0, 5), force) == pytest.approx(10.0)
    # what is pushed back counts against it
    assert impulse(np.array([0.0, 1.0, 2.0]), np.array([[0, 0, 0], [1.0, 0, 0], [-1.0, 0, 0]])) == 0.0


def test_a_force_is_the_mean_since_the_time_before():
    """An impact of 10 N s in one of several unequal intervals, as pictures between the outputs make them."""
    force = np.zeros((4, 3))
    force[2, 0] = 10.0 / 0.05
    assert impulse(np.array([0.0, 0.2, 0.25, 0.4]), force) == pytest.approx(10.0)


def test_the_hinge_under_the_pole_and_what_contact_takes_are_dissipated_there(one):
    structure, result = one
    measures = measure(result, structure)
    taken = result["energy.contact"][-1] + result["energy.friction"][-1]
    assert taken > 0
    assert measures.at_contact == {"pole": pytest.approx(result["hinge.h1.energy"][-1] + taken)}
    # the pole stops: its momentum
    speed = 3.0 + result["obstacle.pole.velocity.z"][-1]
    assert measures.impulse["pole"] == pytest.approx(20.0 * speed, rel=0.02)


def test_a_joint_that_yields_does_so_over_the_length_up_to_half_way_to_its_neighbours(one):
    structure, result = one
    # hinges at 20, 500 and 980 mm: half way to them are 60 and 300 mm
    yielding = replace(result, yielded={"bar": ((0.1, 8.0),)})
    places, work = np.array([entry[1:] for entry in hinge_work(yielding, structure)[3:]]).T
    assert work.sum() == pytest.approx(8.0)
    assert places.mean() == pytest.approx(0.18)
    assert 0.06 < places.min() < 0.08
    assert 0.28 < places.max() < 0.3
    # the zone of the node, two sides of 50 mm, has a sixth of it, to one piece
    added = measure(yielding, structure).zones["a"] - measure(result, structure).zones["a"]
    assert added == pytest.approx(8.0 / 6.0, abs=8.0 / 16.0)
    assert added < 8.0


def test_an_obstacle_that_does_not_press_has_no_figure_and_takes_no_share(one):
    _, result = one
    structure = beam(floor={"type": "plane", "point": (0.0, 0.0, -0.5), "normal": (0.0, 0.0, 1.0)})
    found = at_contact(result, structure, {"pole": 60.0, "floor": 0.0})
    assert set(found) == {"pole"}


def test_of_two_that_press_neither_is_given_what_contact_takes(one):
    structure, result = one
    two = beam(other=POLE | {"point": (0.02, 0.0, 0.06)})
    found = at_contact(result, two, {"pole": 60.0, "other": 1.0})
    assert found["pole"] == pytest.approx(result["hinge.h1.energy"][-1])
    # it never comes near in these shapes: nothing is dissipated there
    assert found["other"] == 0.0
    alone = at_contact(result, structure, {"pole": 60.0})
    assert alone["pole"] > found["pole"]


def test_only_members_that_may_touch_count_and_turning_obstacles_do_not(one):
    structure, result = one
    elsewhere = structure.obstacles["pole"].model_copy(update={"members": ("other",)})
    # unchecked: there is no other member
    apart = copy(structure)
    apart.__dict__["obstacles"] = {"pole": elsewhere}
    found = dissipated_at(result, apart, {"pole": 60.0}, hinge_work(result, structure))
    taken = result["energy.contact"][-1] + result["energy.friction"][-1]
    assert found["pole"] == pytest.approx(taken)
    angle = {"table": {"time": (0.0, 1.0), "value": (0.0, 1.0)}}
    still = {key: POLE[key] for key in ("type", "point", "axis", "radius")}
    turning = beam(pole=still | {"turning": {"about": (0, 0, 0), "axis": (0, 1, 0), "angle": angle}})
    assert at_contact(result, turning, {"pole": 60.0}) == {}


@pytest.mark.parametrize(("outside", "known"), [(0.029, True), (0.031, False)])
def test_what_yields_along_a_member_has_no_place(one, outside, known):
    structure, result = one
    hinges = sum(energy for *_, energy in hinge_work(result, structure))
    put_in = result["energy.kinetic"][0] + np.abs(result["energy.external_work"]).max()
    values = np.full(len(result.time), hinges + outside * put_in)
    total = replace(result.channels["energy.dissipated"], name="member.bar.energy", values=values)
    spread = replace(result, channels={**result.channels, total.name: total})
    assert (at_contact(spread, structure, {"pole": 60.0}) != {}) is known
    # what is not known is not judged
    model = replace(OWN, at_contact={})
    assert "dissipation at contact" not in figures_of(model, OWN)
    assert "impulse" in figures_of(model, OWN)


OWN = Measures(
    status="complete", impulse={"pole": 100.0}, at_contact={"pole": 200.0}, energy={"put_in": 2000.0}
)


@pytest.mark.parametrize(
    ("impulses", "dissipated", "right"),
    [(104.0, 255.0, (True, True)), (94.0, 265.0, (False, False)), (100.0, 145.0, (True, True))],
)
def test_targets_are_5_percent_and_20_or_3_percent_of_the_energy(impulses, dissipated, right):
    """3 % of 2000 J are 60 J, more than 20 % of 200 J."""
    model = replace(OWN, impulse={"pole": impulses}, at_contact={"pole": dissipated})
    figures = figures_of(model, OWN)
    assert tuple(figures[kind][0].right for kind in ("impulse", "dissipation at contact")) == right
    # the share of a large one counts
    large = replace(OWN, at_contact={"pole": 1000.0})
    assert figures_of(replace(OWN, at_contact={"pole": 1190.0}), large)["dissipation at contact"][0].right
    assert not figures_of(replace(OWN, at_contact={"pole": 790.0}), large)["dissipation at contact"][0].right


def test_references_without_them_judge_no_contacts_and_failed_runs_are_wrong():
    assert not {"impulse", "dissipation at contact"} & set(figures_of(OWN, Measures(status="complete")))
    failed = figures_of(Measures(status="refused"), OWN)
    assert not failed["impulse"][0].right
    assert not failed["dissipation at contact"][0].right


def compared(model, reference=OWN):
    """What the table and the lines use of a comparison."""
    source = SimpleNamespace(name="multibody", result=SimpleNamespace(channels={}))
    return SimpleNamespace(
        candidate=source, reference=SimpleNamespace(name="shell", result=source.result),
        figures=figures_of(model, reference),
    )  # fmt: skip


def test_the_page_and_the_command_show_both_values_and_what_is_beyond_its_target():
    shown = compared(replace(OWN, impulse={"pole": 90.0}))
    table = contact_table(shown)
    assert ("pole: impulse", "90 N s", "100 N s", "−10.0 %, beyond its target", "5 %") in table.rows
    assert ("pole: dissipation at contact", "200 J", "200 J", "0.0 %", "20 %") in table.rows
    assert ("Taken by contact", "—", "—", "—", "—") in table.rows
    lines = [render(line).plain for line in _contact_lines(shown)]
    assert lines == [
        "Obstacle pole, impulse: 90 N s (multibody), 100 N s (shell), beyond its target",
        "Obstacle pole, dissipation at contact: 200 J (multibody), 200 J (shell)",
        "Dissipation at contact: plastic work within one side of the section of the place of contact, with "
        "the energies of contact and friction if only one obstacle presses",
    ]
    assert not contact_table(SimpleNamespace(**(vars(shown) | {"figures": {}}))).rows


def test_without_a_dissipation_it_is_not_explained():
    shown = compared(OWN)
    del shown.figures["dissipation at contact"]
    assert [render(line).plain for line in _contact_lines(shown)] == [
        "Obstacle pole, impulse: 100 N s (multibody), 100 N s (shell)"
    ]


def test_peak_forces_say_their_filter():
    struck = replace(OWN, peak_force={"wall": 108.2e3})
    shown = compared(replace(OWN, peak_force={"wall": 77.04e3}), struck)
    table = contact_table(shown)
    (row,) = [row for row in table.rows if row[0].startswith("wall")]
    assert row == ("wall: peak force (CFC 60)", "77.04 kN", "108.2 kN", "−28.8 %, beyond its target", "15 %")
    assert "Peak force: through the filter CFC 60, which lowers short peaks" in table.caption
    (peak,) = shown.figures["peak force"]
    assert _figure_text("peak force", peak, shown) == (
        "peak force (CFC 60) of wall 77 kN multibody, 108 kN shell"
    )


def test_a_struck_joint_counts_alike_with_and_without_rings_in_it():
    """Shells have no walls where a joint cuts its members back; the obstacle strikes the outline there."""
    tube = {"type": "square_tube", "side": 0.04, "thickness": 2e-3}
    nodes = {"a": (-0.4, 0.0, 0.0), "b": (0.0, 0.4, 0.0), "c": (0.0, 0.0, -0.4), "m": (0.0, 0.0, 0.0)}
    plane = {"type": "plane", "point": (0.05, -0.05, 0.05), "normal": (-1.0, 1.0, -1.0), "mass": 50.0}
    tripod = Structure(
        materials={"steel": STEEL},
        sections={"tube": tube},
        nodes=nodes,
        members={
            n: {
                "nodes": (n, "m"),
                "section": "tube",
                "material": "steel",
                "hinges": [{"name": f"h{n}", "at": 0.345, "axes": ("y", "z", "x"), "axial": True}],
            }
            for n in "abc"
        },
        supports={n: {"node": n, "fix": "all"} for n in "ab"},
        obstacles={"wall": plane | {"velocity": (-3.0, 3.0, -3.0)}},
    )
    result = solved(tripod)
    states = result.states
    kept = states.station < 0.4 - joint_reach(tripod, "a", "m") - 1e-6
    walls = SimpleNamespace(
        times=states.times, member_names=states.member_names, points=states.points[kept],
        displacement=states.displacement[:, kept], member=states.member[kept], station=states.station[kept],
    )  # fmt: skip
    whole = at_contact(result, tripod, {"wall": 60.0})
    hinges = sum(float(result[f"hinge.h{n}.energy"][-1]) for n in "abc")
    taken = result["energy.contact"][-1] + result["energy.friction"][-1]
    assert hinges > 0.0
    assert whole["wall"] == pytest.approx(hinges + taken)
    shells = replace(result, fidelity="shell", states=walls)
    assert dissipated_at(shells, tripod, {"wall": 60.0}, hinge_work(result, tripod)) == whole


def test_a_joint_that_reaches_along_one_of_its_members_alone_is_bounded_by_both():
    """At an obtuse bend of unequal sections the walls of the deeper tube end at the node."""
    deep = {"type": "rectangular_tube", "width": 0.04, "depth": 0.06, "thickness": 2e-3}
    square = {"type": "square_tube", "side": 0.04, "thickness": 2e-3}
    plane = {"type": "plane", "point": (0.0, 0.0, 0.033), "normal": (0.0, 0.0, -1.0), "mass": 50.0}
    bars = {"deep": ("a", "m", "deep", 0.39), "thin": ("m", "b", "square", 0.03)}
    bent = Structure(
        materials={"steel": STEEL},
        sections={"deep": deep, "square": square},
        nodes={"a": (-0.4, 0.0, 0.0), "m": (0.0, 0.0, 0.0), "b": (0.36, 0.0, -0.16)},
        members={
            name: {
                "nodes": (first, second),
                "section": section,
                "material": "steel",
                "hinges": [{"name": f"h{name}", "at": at, "axes": ("y", "z", "x"), "axial": True}],
            }
            for name, (first, second, section, at) in bars.items()
        },
        supports={n: {"node": n, "fix": "all"} for n in "ab"},
        obstacles={"plate": plane | {"velocity": (0.0, 0.0, -3.0)}},
    )
    reaches = [joint_reach(bent, name, "m") for name in bars]
    assert min(reaches) == 0.0 < max(reaches)
    result = solved(bent)
    found = at_contact(result, bent, {"plate": 150.0})
    hinges = sum(float(result[f"hinge.h{name}.energy"][-1]) for name in bars)
    taken = result["energy.contact"][-1] + result["energy.friction"][-1]
    assert hinges > 0.0
    assert found["plate"] == pytest.approx(hinges + taken)
