"""Where corners out of their plane do their work: along the members that they distort."""

import math
from dataclasses import replace

import numpy as np
import pytest

from crumple.analysis import loads, solve
from crumple.comparison import with_frames
from crumple.comparison.measure.energy import distortions, hinge_work
from crumple.comparison.measure.measures import measure
from crumple.hinge import build_axial_law
from crumple.structure import with_elastic_members

TEXT = """crumple: 1
title: L
materials:
  steel: {youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: 350 MPa}
sections:
  tube: {type: TUBE}
nodes: {foot: [0 m, 0 m, 0 m], corner: [0 m, 0 m, 0.15 m], tip: [0.5 m, 0 m, 0.15 m]}
members:
  post: {nodes: [foot, corner], section: tube, material: steel}
  arm: {nodes: [corner, tip], section: tube, material: steel}
hinges: auto
supports: {foot: {node: foot, fix: all}}
masses: {payload: {node: tip, mass: 10 kg}}
initial_velocity: [{nodes: [tip], translation: [0 m/s, 8 m/s, 0 m/s]}]
analysis: {duration: 15 ms}
outputs: {every: 0.2 ms, nodes: [tip]}
"""
RECTANGULAR = "rectangular_tube, width: 50 mm, depth: 50 mm, thickness: 2 mm"
# sqrt(a/t) times a, of the mid-lines
LENGTH = 0.048 * math.sqrt(24.0)


def solved(tube):
    analysis = loads(TEXT.replace("TUBE", tube), file="l.yaml", directory=".")
    structure = with_elastic_members(analysis.structure, analysis.multibody, analysis.time_in_motion)
    return structure, solve(with_frames(analysis))


@pytest.fixture(scope="module", name="corner")
def _corner():
    return solved(RECTANGULAR)


def test_two_fifths_of_the_work_about_the_bisector_are_done_along_both_members_alike(corner):
    structure, result = corner
    moves = list(distortions(result, structure))
    assert {node for node, _ in moves} == {"corner"}
    totals = {m: sum(work[2] for _, work in moves if work[0] == m) for m in ("post", "arm")}
    assert totals["post"] == pytest.approx(totals["arm"])
    turned, moment = (result[f"hinge.corner-corner.{one}.z"] for one in ("plastic_rotation", "moment"))
    about_bisector = float(np.trapezoid(moment, turned))
    # it turns mostly about its bisector, by some degrees
    assert about_bisector > 0.6 * result["hinge.corner-corner.energy"][-1] > 20.0
    assert sum(totals.values()) == pytest.approx(0.4 * about_bisector, rel=0.1)


def test_the_work_falls_linearly_to_zero_or_to_the_end_of_a_short_member(corner):
    structure, result = corner
    works = {name: [w for _, w in distortions(result, structure) if w[0] == name] for name in ("post", "arm")}
    away = {
        "post": 0.15 - np.array([at for _, at, _ in works["post"]]),
        "arm": np.array([at for _, at, _ in works["arm"]]),
    }
    assert LENGTH * 0.9 < away["arm"].max() < LENGTH
    assert 0.9 * 0.15 < away["post"].max() < 0.15
    for name, places in away.items():
        energies = np.array([energy for *_, energy in works[name]])
        np.testing.assert_allclose(energies / energies[0], (LENGTH - places) / (LENGTH - places[0]))


def test_zones_have_it_and_the_sum_stays(corner):
    structure, result = corner
    zones = measure(result, structure).zones
    assert sum(zones.values()) == pytest.approx(result["energy.dissipated"][-1], rel=1e-6)

    def between(works):
        # the zones of corner and tip end two sides of the mid-line from them
        return sum(energy for name, at, energy in works if name == "arm" and 0.096 < at < 0.404)

    distorting, yielding = (
        between(one for _, one in distortions(result, structure)),
        hinge_work(result, structure),
    )
    assert distorting > 1.0
    assert zones["span of arm"] == pytest.approx(distorting + between(yielding))


def test_round_tubes_keep_their_work_at_the_corner():
    structure, result = solved("circular_tube, diameter: 50 mm, thickness: 2 mm")
    assert result["hinge.corner-corner.energy"][-1] > 20.0
    assert list(distortions(result, structure)) == []


def test_a_corner_that_slips_in_its_plane_turns_about_one_axis_and_distorts_nothing():
    text = TEXT.replace("TUBE", RECTANGULAR).replace("[0 m/s, 8 m/s, 0 m/s]", "[-2 m/s, 0 m/s, -2 m/s]")
    slips = text.replace("hinges: auto", "hinges: {axial: true}")
    analysis = loads(slips, file="l.yaml", directory=".")
    structure = with_elastic_members(analysis.structure, analysis.multibody, analysis.time_in_motion)
    result = solve(with_frames(analysis))
    assert "hinge.corner-corner.slip.x.force" in result.channels
    assert "hinge.corner-corner.moment.x" not in result.channels
    assert list(distortions(result, structure)) == []


COLUMN = """crumple: 1
materials:
  steel:
    youngs_modulus: 210 GPa
    poissons_ratio: 0.3
    density: 7850 kg/m^3
    yield_stress: 280 MPa
    hardening: {type: swift, prestrain: 0.008, exponent: 0.16}
sections: {tube: {type: square_tube, side: 40 mm, thickness: 2 mm}}
nodes: {foot: [0 m, 0 m, 0 m], head: [0 m, 0 m, 0.3 m]}
members: {column: {nodes: [foot, head], section: tube, material: steel}}
hinges: {axial: {law: superfolding}}
supports:
  foot: {node: foot, fix: all}
  head: {node: head, fix: [x, y, rx, ry, rz], motion: {z: {havsin: {x0: 0 s, h0: 0 m, x1: 50 ms, h1: WAY}}}}
analysis: {duration: 50 ms}
outputs: {every: 0.1 ms, nodes: [head]}
"""


@pytest.mark.parametrize(("way", "even"), [("-4 mm", True), ("-12 mm", False)])
def test_what_a_column_takes_before_it_folds_is_spread_evenly_over_it(way, even):
    analysis = loads(COLUMN.replace("WAY", way), file="column.yaml", directory=".")
    structure = with_elastic_members(analysis.structure, analysis.multibody, analysis.time_in_motion)
    result = solve(with_frames(analysis))
    works = [(at, energy) for _, at, energy in hinge_work(result, structure)]
    total = float(result["energy.dissipated"][-1])
    assert sum(energy for _, energy in works) == pytest.approx(total, rel=1e-3)
    lower = sum(energy for at, energy in works if at < 0.15)
    middle = sum(energy for at, energy in works if 0.1 < at < 0.2)
    # the integral of the hardening curve up to the plastic part of 4 mm, or to the peak of the force
    column = structure.section_of("column"), structure.material_of("column")
    peak = build_axial_law("superfolding", *column).peak_strain
    strain = np.linspace(0.0, 0.004 / 0.3 - 323e6 / 210e9 if even else peak, 1001)
    uniform = 304e-6 * 0.3 * np.trapezoid(280e6 * (1.0 + strain / 0.008) ** 0.16 * np.exp(strain), strain)
    if even:
        assert max(energy for _, energy in works) < 0.03 * total
        assert total == pytest.approx(uniform, rel=0.02)
        assert lower == pytest.approx(total / 2.0, rel=0.02)
        assert middle == pytest.approx(total / 3.0, rel=0.05)
    else:
        folded = sum(energy for _, energy in works if energy > 0.03 * total)
        assert total - folded == pytest.approx(uniform, rel=0.03)


def test_beside_a_moment_the_square_of_the_share_of_the_axial_force_is_spread():
    analysis = loads(COLUMN.replace("WAY", "-4 mm"), file="column.yaml", directory=".")
    structure = with_elastic_members(analysis.structure, analysis.multibody, analysis.time_in_motion)
    result = solve(with_frames(analysis))
    before = [energy for _, _, energy in hinge_work(result, structure) if energy > 0.0]
    twice = {
        name: replace(one, values=2.0 * one.values) if name.endswith("slip.x.capacity") else one
        for name, one in result.channels.items()
    }
    after = [energy for _, _, energy in hinge_work(replace(result, channels=twice), structure)]
    # half of the capacity: three quarters are found at the hinges
    assert sum(energy for energy in after if energy > 0.03 * sum(after)) == pytest.approx(
        0.75 * sum(before), rel=0.02
    )


DIVIDED = (
    COLUMN.replace("WAY", "-4 mm")
    .replace("nodes: {foot: ", "nodes: {middle: [0 m, 0 m, 0.12 m], foot: ")
    .replace("members: {column: {nodes: [foot, head], section: tube, material: steel}}", "members: MEMBERS")
)


@pytest.mark.parametrize(
    ("lower", "upper"), [("foot, middle", "middle, head"), ("middle, foot", "head, middle")]
)
def test_a_node_in_a_column_does_not_divide_what_is_spread(lower, upper):
    """Whichever member the hinge at it belongs to, and wherever members begin."""
    members = ", ".join(
        f"{name}: {{nodes: [{nodes}], section: tube, material: steel}}"
        for name, nodes in (("lower", lower), ("upper", upper))
    )
    analysis = loads(DIVIDED.replace("MEMBERS", f"{{{members}}}"), file="column.yaml", directory=".")
    structure = with_elastic_members(analysis.structure, analysis.multibody, analysis.time_in_motion)
    result = solve(with_frames(analysis))
    works = hinge_work(result, structure)
    total = float(result["energy.dissipated"][-1])
    assert sum(energy for _, _, energy in works) == pytest.approx(total, rel=1e-3)
    below = sum(energy for member, _, energy in works if member == "lower")
    assert below == pytest.approx(0.4 * total, rel=0.05)
