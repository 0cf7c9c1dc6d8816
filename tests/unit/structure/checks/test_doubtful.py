"""Cautions about members that are probably not laid out as meant; none for examples and the suite."""

from pathlib import Path

import pytest
from tests.concordance.suite import FOLDER
from typer.testing import CliRunner

from crumple.analysis import load, loads, solve
from crumple.cli.main import app
from crumple.structure.checks.doubtful import doubtful_members

EXAMPLES = Path(__file__).parents[4] / "examples"
FRAME = """crumple: 1
materials: {s: {youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: 300 MPa}}
sections: {t: {type: rectangular_tube, width: 60 mm, depth: 40 mm, thickness: 2 mm}}
nodes:
  foot: [0 m, 0 m, 0 m]
  knee: [0 m, 0 m, 600 mm]
  tip: [450 mm, 0 m, 600 mm]
NODES
members:
  post: {nodes: [foot, knee], section: t, material: s}
  arm: {nodes: [knee, tip], section: t, material: s}
MEMBERS
hinges: auto
supports: {clamp: {node: foot, fix: all}}
masses: {m: {node: tip, mass: 25 kg}}
initial_velocity: [{nodes: [tip], translation: [0 m/s, 0 m/s, -5 m/s]}]
analysis: {duration: 10 ms}
outputs: {every: 1 ms}
"""


def frame(further=(), /, **nodes):
    """The frame with further nodes [mm] and members between nodes."""
    places = "\n".join(
        f"  {name}: [{', '.join(f'{x:g} mm' for x in place)}]" for name, place in nodes.items()
    )
    members = "\n".join(
        f"  {first}_{second}: {{nodes: [{first}, {second}], section: t, material: s}}"
        for first, second in further
    )
    return FRAME.replace("NODES", places).replace("MEMBERS", members)


def found(text):
    return {(one.code, one.place) for one in doubtful_members(loads(text).structure)}


def test_a_sound_frame_has_none():
    assert not found(frame())
    assert not found(frame([("tip", "end")], end=(450, 0, 0)))


@pytest.mark.parametrize(
    ("place", "lies"),
    [
        ((0, 0, 300), True),
        ((0, 25, 300), True),
        # on the face, where a drawn tube ends; then beside it, and beyond its end
        ((20, 0, 300), True),
        ((23, 0, 300), False),
        ((0, 0, -40), False),
    ],
)
def test_a_node_on_a_member_is_not_joined_to_it(place, lies):
    """The post is 40 mm wide along x and 60 mm along y."""
    text = frame([("q", "r")], q=place, r=(400, 0, 300))
    held = text.replace("fix: all}}", "fix: all}, other: {node: r, fix: all}}")
    assert found(held) == ({("unjoined_node", "node q")} if lies else set())
    (*said,) = doubtful_members(loads(held).structure)
    assert not said or said[0].text.startswith("Not joined: node q on member post. A member is joined at its")


def test_tubes_that_rest_on_each_other_have_contact_in_place_of_a_joint():
    text = frame([("q", "r")], q=(20, 0, 300), r=(400, 0, 300)).replace("hinges: auto", "member_contact: {}")
    assert not found(text)


def test_a_corner_of_a_small_angle_is_a_joint():
    """The far end of a short brace lies inside the walls of the member beside it."""
    assert not found(frame([("knee", "q")], q=(15, 0, 540)))


def test_members_that_cross_are_not_joined():
    crossing = frame([("q", "r")], q=(200, 0, 300), r=(200, 0, 900))
    assert found(crossing) == {("crossing_members", "member arm")}
    # lines that pass at half a side or more, and members that a third one joins
    assert not found(crossing.replace("[200 mm, 0 mm,", "[200 mm, 21 mm,")) - {("loose_part", "member q_r")}
    assert not found(frame([("q", "r"), ("r", "tip")], q=(200, 0, 300), r=(200, 0, 900)))


def test_spot_welds_join():
    welds = "spot_welds: {w: {members: [arm, q_r], points: [[200 mm, 0 mm, 600 mm]]}}\n"
    crossing = frame([("q", "r")], q=(200, 0, 300), r=(200, 0, 900))
    assert not found(crossing + welds)
    assert not found(frame([("q", "r")], q=(0, 0, 300), r=(400, 0, 300)) + welds.replace("arm", "post"))


LOOSE = frame([("q", "r")], q=(3000, 0, 0), r=(4000, 0, 0))


def test_a_part_that_nothing_holds_or_moves_is_loose():
    assert found(LOOSE) == {("loose_part", "member q_r")}
    # that it lacks a joint is said once
    assert found(frame([("q", "r")], q=(0, 0, 300), r=(400, 0, 300))) == {("unjoined_node", "node q")}


@pytest.mark.parametrize(
    "more",
    [
        "initial_velocity: [{members: [q_r], translation: [0 m/s, 0 m/s, 1 m/s]}]",
        "initial_velocity: [{nodes: [q], translation: [0 m/s, 0 m/s, 1 m/s]}]",
        "initial_velocity: [{translation: [0 m/s, 0 m/s, 1 m/s]}]",
        "initial_velocity: [{members: [q_r], rotation: 1 rad/s, axis: [0, 1, 0]}]",
        "impulses: [{node: q, impulse: [1 N*s, 0 N*s, 0 N*s]}]",
        "loads: [{node: r, force: {x: {constant: 1 N}}}]",
        "supports: {clamp: {node: foot, fix: all}, other: {node: q, fix: pin}}",
        "member_contact: {}",
        "gravity: [0 m/s^2, 0 m/s^2, -9.81 m/s^2]\n"
        "obstacles: {floor: {type: plane, point: [0 m, 0 m, -1 m], normal: [0, 0, 1]}}",
    ],
)
def test_parts_that_move_or_may_be_struck_are_not_loose(more):
    key = more.partition(":")[0]
    lines = [line for line in LOOSE.splitlines() if not line.startswith(f"{key}:")]
    assert not found("\n".join([*lines, more]) + "\n")


def test_a_field_without_speed_moves_nothing():
    still = LOOSE.replace("[{nodes:", "[{translation: [0 m/s, 0 m/s, 0 m/s]}, {nodes:")
    assert found(still) == {("loose_part", "member q_r")}


def test_two_members_between_the_same_nodes():
    double = frame([("tip", "knee")])
    assert found(double) == {("double_member", "member tip_knee")}
    (one,) = doubtful_members(loads(double).structure)
    assert one.text.startswith("Members arm, tip_knee lie between the same nodes, knee and tip:")


def test_the_forces_of_members_in_one_place_are_no_cautions():
    codes = {caution.code for caution in solve(loads(frame([("knee", "tip")])), checks=False).cautions}
    assert codes == {"double_member"}


def test_a_member_that_lies_along_another_from_their_common_node():
    assert found(frame([("knee", "mid")], mid=(200, 0, 600))) == {("double_member", "member knee_mid")}
    assert not found(frame([("knee", "mid")], mid=(200, 0, 560)))


def test_a_member_shorter_than_its_section_is_large():
    """The largest side is 60 mm; pieces of a straight line and rigid members are as long as they need."""
    assert found(frame([("tip", "end")], end=(450, 0, 545))) == {("short_member", "member tip_end")}
    assert not found(frame([("tip", "end")], end=(450, 0, 535)))
    assert not found(frame([("tip", "end")], end=(500, 0, 600)))
    rigid = frame([("tip", "end")], end=(450, 0, 590)).replace("tip_end: {", "tip_end: {rigid: true, ")
    assert not found(rigid)


def test_a_chain_of_short_members_is_measured_whole():
    chain = {f"c{i}": (450 + 25 * i, 0, 600) for i in range(1, 5)}
    pieces = [("tip", "c1"), *((f"c{i}", f"c{i + 1}") for i in range(1, 4))]
    assert not found(frame(pieces, **chain))


@pytest.mark.parametrize("fidelity", ["multibody", "shell"])
def test_results_have_the_caution(fidelity):
    text = LOOSE.replace("duration: 10 ms", "duration: 0.02 ms").replace("every: 1 ms", "every: 0.01 ms")
    result = solve(loads(text), fidelity, checks=False)
    (one,) = [caution for caution in result.cautions if caution.code == "loose_part"]
    assert one.text in result.warnings


def test_commands_say_each_sentence_once(tmp_path):
    file = tmp_path / "frame.yaml"
    file.write_text(frame([("q", "r")], q=(0, 0, 300), r=(400, 0, 600)), encoding="utf-8")
    said = CliRunner().invoke(app, ["check", str(file)]).output
    assert said.count("Caution: Not joined: node q on member post; node r on member arm.") == 1


def test_many_members_are_looked_at_together(monkeypatch):
    """In several arrays as in one; none where there are too many."""
    text = frame([("q", "r")], q=(0, 0, 300), r=(200, 0, 600))
    whole = found(text)
    assert len(whole) == 2
    monkeypatch.setattr("crumple.structure.checks.doubtful.AT_ONCE", 1)
    assert found(text) == whole
    monkeypatch.setattr("crumple.structure.checks.doubtful.MOST_PAIRS", 1)
    assert not found(text) - {("loose_part", "member q_r")}


def test_examples_and_structures_of_the_suite_have_none():
    files = [*EXAMPLES.glob("*.yaml"), *(EXAMPLES / "layouts").glob("*.yaml"), *FOLDER.glob("**/*.yaml")]
    assert len(files) > 40
    for file in files:
        assert doubtful_members(load(file).structure) == (), file
