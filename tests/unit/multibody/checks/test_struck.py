"""A member with hinges of its own that lies in the path of an obstacle, with none of them there."""

import math
from types import SimpleNamespace

import numpy as np
import pytest
from tests.support.multibody.frames import LAW, structure

from crumple.analysis import loads, solve
from crumple.multibody import Run, solve_multibody, struck_cautions, struck_near_ends
from crumple.multibody.checks.struck import pressed_beyond, swept_supports
from crumple.result import Channel, StageSummary
from crumple.structure import MultibodySettings

POLE = {"type": "cylinder", "point": (0.4, 0.0, 0.11), "axis": (0.0, 1.0, 0.0), "radius": 0.05}
DOWN = {"mass": 5.0, "velocity": (0.0, 0.0, -2.0)}
SUPPORTS = {
    "left": {"node": "a", "fix": ("x", "y", "z", "rx", "rz")},
    "right": {"node": "b", "fix": ("y", "z", "rx", "rz")},
}


def beam(*places, hinges=None, obstacle=None, **keys):
    """A beam on two supports with hinges at some places, and a pole above it that comes down."""
    own = [{"name": f"h{i}", "at": at, "axis": "y", "law": LAW} for i, at in enumerate(places)]
    members = {"beam": {"nodes": ("a", "b"), "section": "tube", "material": "steel", "hinges": own or None}}
    members["beam"] |= keys
    obstacle = POLE | DOWN if obstacle is None else obstacle
    return structure(members=members, supports=SUPPORTS, obstacles={"pole": obstacle}, hinges=hinges)


def found(whole):
    return [(caution.code, caution.place, caution.value) for caution in struck_cautions(whole)]


def test_a_place_without_a_hinge_is_named():
    (caution,) = struck_cautions(beam(0.2, 0.55))
    assert (caution.code, caution.place) == ("struck_between_hinges", "member beam")
    assert caution.value == pytest.approx(0.15)
    assert "Member beam is in the path of obstacle pole, 400 mm from node a" in caution.text
    assert "Give it a hinge at 400 mm" in caution.text


@pytest.mark.parametrize(
    "whole",
    [
        beam(0.2, 0.41),
        beam(),
        beam(hinges="auto"),
        beam(0.2, elastic=True),
        beam(0.2, rigid=[{"from": 0.3, "to": 0.5}]),
        beam(0.2, obstacle=POLE | {"velocity": (0.0, 0.0, 2.0)}),
        beam(0.2, obstacle=POLE | DOWN | {"point": (0.02, 0.0, 0.11)}),
    ],
)
def test_nothing_is_said(whole):
    assert not found(whole)


@pytest.mark.parametrize(("height", "cautions"), [(0.11, 1), (0.2, 0)])
def test_the_result_says_so_if_the_obstacle_came_that_far(height, cautions):
    whole = beam(0.2, 0.55, obstacle=POLE | DOWN | {"point": (0.4, 0.0, height)})
    result = solve_multibody(whole, Run(0.03, 0.001, MultibodySettings(members="rigid")))
    assert result.status.ok, result.reason
    assert [one.code for one in result.cautions].count("struck_between_hinges") == cautions
    assert sum("is in the path of obstacle pole" in text for text in result.warnings) == cautions


PRESSED = """crumple: 1
materials: {s: {youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: 355 MPa}}
sections: {post: {type: square_tube, side: 80 mm, thickness: 5 mm}}
nodes: {a: [0 m, 0 m, 0 m], b: [0 m, 0 m, 1.5 m], c: [1 m, 0 m, 1.5 m], e: [1 m, 0 m, 0 m]}
members:
  p1: {nodes: [a, b], section: post, material: s}
  bm: {nodes: [b, c], section: post, material: s}
  p2: {nodes: [c, e], section: post, material: s}
hinges: auto
supports:
  a: {node: a, fix: all}
  e: {node: e, fix: all}
  side: {node: b, motion: {x: {table: {time: [0 s, 1 s], value: [0 mm, 100 mm]}}}}
obstacles:
  press: {type: plane, point: [0 m, 0 m, 1.6 m], normal: [0, 0, -1], velocity: [0 m/s, 0 m/s, -0.3 m/s],
          members: [p1, p2]}
analysis:
  multibody: {members: KIND}
  stages:
  - {name: push, kind: quasi-static, duration: 1 s, drive: [side], obstacles: [], until: [{energy: 500 J}]}
  - {name: crush, kind: quasi-static, duration: 1 s, drive: [press], until: [{force: 80 kN, of: press}]}
outputs: {every: 10 ms}
"""
SQUASH = 3 * 355e6 * 4 * 0.075 * 0.005
"""Squash forces of the three members together [N]."""


@pytest.mark.parametrize("kind", ["rigid", "elastic"])
def test_a_slow_obstacle_on_bars_presses_until_they_give_way(kind):
    """Rigid ones give way to nothing: the force jumps, to a value that depends on rounding."""
    result = solve(loads(PRESSED.replace("KIND", kind)), checks=False)
    largest = np.linalg.norm([result[f"obstacle.press.force.{axis}"] for axis in "xyz"], axis=0).max()
    found = [one for one in result.cautions if one.code == "pressed_beyond"]
    ended = result.stages[-1].ended_by
    assert bool(found) == (largest > SQUASH * 1.01)
    if kind == "elastic":
        assert largest == pytest.approx(80e3, rel=0.02)
        assert ended == "force of press reached 80 kN"
    else:
        assert ended.startswith("force of press passed 80 kN within a step, at the end of which it is ")


def test_forces_of_an_impact_have_no_such_bound():
    text = PRESSED.replace("KIND", "rigid").replace("kind: quasi-static", "kind: dynamic")
    result = solve(loads(text.replace("-0.3 m/s", "-3 m/s")), checks=False)
    assert not [one for one in result.cautions if one.code == "pressed_beyond"]


def test_the_force_at_the_end_of_an_impact_is_not_that_of_the_slow_stage_after_it():
    structure = loads(PRESSED.replace("KIND", "rigid")).structure
    stages = (
        StageSummary("push", 0.0, 0.01, "after 10 ms"),
        StageSummary("crush", 0.01, 0.02, "after 10 ms"),
    )
    force = [Channel(f"obstacle.press.force.{axis}", "N", np.array([0.0, 9e6, 0.0])) for axis in "xyz"]
    solved = SimpleNamespace(stages=stages, time=np.array([0.0, 0.01, 0.02]), further=force)
    assert list(pressed_beyond(structure, solved, ["crush"])) == []
    (caution,) = pressed_beyond(structure, solved, ["push"])
    assert (caution.code, caution.place) == ("pressed_beyond", "obstacle press")
    assert caution.value == pytest.approx(9e6 * math.sqrt(3.0))
    assert caution.limit == pytest.approx(SQUASH, rel=0.01)


MISSED = """crumple: 1
materials: {s: {youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: 355 MPa}}
sections: {t: {type: square_tube, side: 50 mm, thickness: 2 mm}}
nodes: {a: [0 m, 0 m, 0 m], b: [0.5 m, 0 m, 0 m]}
members: {m: {nodes: [a, b], section: t, material: s}}
hinges: auto
supports: {a: {node: a, fix: all}}
masses: {b: {node: b, mass: 5 kg}}
"""
AWAY = (
    "{type: sphere, point: [0.5 m, 0 m, 0.2 m], radius: 80 mm, mass: 10 kg, velocity: [0 m/s, 0 m/s, 3 m/s]}"
)
NEAR = AWAY.replace("0 m/s, 3 m/s", "0 m/s, -20 m/s")
FLOOR = "{type: plane, point: [0 m, 0 m, -1 m], normal: [0, 0, 1]}"
THROWN = "initial_velocity: [{translation: [0 m/s, 0 m/s, -4 m/s]}]\n"
ONLY_BALL = "{stages: [{name: s, duration: 15 ms, obstacles: [ball]}]}"


@pytest.mark.parametrize(
    ("keys", "analysis", "places"),
    [
        (f"obstacles: {{ball: {AWAY}}}\n", "{duration: 15 ms}", ["ball"]),
        (f"obstacles: {{ball: {NEAR}}}\n", "{duration: 15 ms}", []),
        (f"obstacles: {{floor: {FLOOR}}}\n{THROWN}", "{duration: 15 ms}", ["floor"]),
        (f"obstacles: {{ball: {NEAR}, floor: {FLOOR}}}\n", "{duration: 15 ms}", []),
        (f"obstacles: {{ball: {AWAY}, floor: {FLOOR}}}\n", "{duration: 15 ms}", ["ball", "floor"]),
        (f"obstacles: {{ball: {NEAR}, other: {AWAY}}}\n", "{duration: 15 ms}", ["other"]),
        (f"obstacles: {{ball: {NEAR}, other: {AWAY}}}\n", ONLY_BALL, []),
    ],
)
def test_an_obstacle_that_nothing_touches_is_named(keys, analysis, places):
    result = solve(loads(f"{MISSED}{keys}analysis: {analysis}\n"))
    assert result.status.ok, result.reason
    own = [one for one in result.cautions if one.code == "untouched_obstacle"]
    assert [one.place for one in own] == [f"obstacle {place}" for place in places]
    assert sum("nothing in 15 ms: the results are those without" in text for text in result.warnings) == bool(
        own
    )
    if places == ["ball"]:
        assert own[0].text.startswith("Obstacle ball (moves 45 mm) touches nothing in 15 ms: ")
        assert own[0].value == pytest.approx(0.045)


SWAYS = """crumple: 1
materials: {s: {youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: 350 MPa}}
sections: {round: {type: circular_tube, diameter: 60 mm, thickness: 2 mm}}
nodes: {a: [0 m, 0 m, 0 m], b: [0 m, 0 m, 0.6 m], c: [0.4 m, 0 m, 0.6 m], d: [0.4 m, 0 m, 0 m]}
members:
  post: {nodes: [a, b], section: round, material: s}
  beam: {nodes: [b, c], section: round, material: s}
  other: {nodes: [c, d], section: round, material: s}
hinges: auto
supports: {foot: {node: a, fix: all}, end: {node: d, fix: all}HELD}
obstacles:
  pole: {type: cylinder, point: [-81 mm, 0 m, 480 mm], axis: [0, 1, 0], radius: 50 mm, mass: 20 kg,
         velocity: [4 m/s, 0 m/s, 0 m/s], guide: [1, 0, 0]}
analysis: {duration: 10 ms}
"""


@pytest.mark.parametrize("held", ["", ", top: {node: b, fix: all}"])
def test_a_post_that_sways_is_not_dented_as_its_law_assumes(held):
    result = solve(loads(SWAYS.replace("HELD", held)), checks=False)
    said = [text for text in result.warnings if "Compare with obstacles.pole.dents" in text]
    if held:
        assert said == []
        return
    (text,) = said
    (dent,) = result.dents
    assert text.startswith("Hinge post-pole has at most 36% of its moment")
    assert f"it is {1e3 * dent.depth:.4g} mm deep, which leaves 61%" in text


HAT = """crumple: 1
materials: {s: {youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: 350 MPa}}
sections: {hat: {type: closed_hat, width: WIDTH mm, depth: 50 mm, thickness: 1.6 mm, flange: 18 mm}}
nodes: {a: [0 m, 0 m, 0 m], b: [0.9 m, 0 m, 0 m]}
members: {beam: {nodes: [a, b], section: hat, material: s, up: [0, 0, 1]}}
hinges: auto
supports: {a: {node: a, fix: all}, b: {node: b, fix: all}}
obstacles:
  pole: {type: cylinder, point: [0.45 m, 0 m, HEIGHT mm], axis: [0, 1, 0], radius: RADIUS mm, mass: 100 kg,
         velocity: [0 m/s, 0 m/s, -SPEED m/s], guide: [0, 0, 1], friction: 0}
analysis: {duration: 24 ms}
"""


@pytest.mark.parametrize(
    ("width", "radius", "speed", "told"),
    [
        (60, 100, 3.5, True),
        (60, 100, 1.2, False),
        (60, 100, 5, False),
        (60, 130, 3.5, False),
        (45, 100, 3.5, False),
    ],
)
def test_a_hat_into_whose_fold_a_pole_would_sink_is_named(width, radius, speed, told):
    """Not one that hardly folds, is dented deeply, lies under a wider pole, or has a stockier crown."""
    sizes = {"WIDTH": width, "RADIUS": radius, "SPEED": speed, "HEIGHT": radius + 35}
    text = HAT
    for word, size in sizes.items():
        text = text.replace(word, f"{size}")
    result = solve(loads(text), checks=False)
    said = [one for one in result.warnings if "the crown of the hat is too stiff" in one]
    assert len(said) == told
    if told:
        assert said[0].startswith(
            "Member beam: the crown of the hat is too stiff under obstacle pole: its dent"
        )
        assert f" {1e3 * result.dents[0].depth:.4g} mm deep" in said[0]


SWEEP = (
    SWAYS[: SWAYS.index("obstacles:")].replace("HELD", "")
    + """obstacles:
  ram: {type: plane, point: [-40 mm, 0 m, 0.6 m], normal: [1, 0, 0], MEMBERS
        motion: {x: {table: {time: [0 ms, 10 ms], value: [0 mm, WAY mm]}}}}
analysis: {duration: 10 ms}
"""
)


@pytest.mark.parametrize(
    ("way", "members", "nodes"),
    [(100, "", "a"), (30, "", ""), (100, "members: [beam],", ""), (600, "", "a, d")],
)
def test_a_driven_obstacle_that_passes_over_a_held_node_is_named_before_the_run(way, members, nodes):
    whole = loads(SWEEP.replace("WAY", str(way)).replace("MEMBERS", members)).structure
    found = list(swept_supports(whole, 0.01))
    assert len(found) == bool(nodes)
    assert all(nodes in text and "which supports hold" in text for text in found)


@pytest.mark.parametrize(
    ("at", "keys", "place"),
    [
        (0.015, {}, "15 mm from node a"),
        (0.98, {}, "20 mm from node b"),
        (0.4, {}, ""),
        # at the node, and where the input wants no dents
        (0.0, {}, ""),
        (0.015, {"dents": False}, ""),
    ],
)
def test_a_pole_that_strikes_too_near_the_end_of_a_tube_to_dent_it_is_named(at, keys, place):
    supports = {name: {"node": node, "fix": "all"} for name, node in (("left", "a"), ("right", "b"))}
    pole = POLE | DOWN | {"point": (at, 0.0, 0.11)} | keys
    members = {"beam": {"nodes": ("a", "b"), "section": "tube", "material": "steel"}}
    whole = structure(members=members, supports=supports, obstacles={"pole": pole}, hinges="auto")
    texts = list(struck_near_ends(whole))
    assert len(texts) == bool(place)
    assert all(f"strikes member beam {place}, where no fold fits" in text for text in texts)
    run = solve_multibody(whole, Run(0.04, 1e-3))
    assert [text for text in run.warnings if "no dent is modelled" in text] == texts


@pytest.mark.parametrize(
    ("keys", "named"), [({}, True), ({"dents": False}, False), ({"hinges": None}, False)]
)
def test_a_pole_that_meets_a_corner_is_named(keys, named):
    """A kink of 11 degrees; hinges of the input's own have no law of the corner."""
    nodes = {"a": (0.0, 0.0, 0.0), "b": (0.5, 0.0, 0.1), "c": (1.0, 0.0, 0.1)}
    members = {
        name: {"nodes": (name[0], name[1]), "section": "tube", "material": "steel"} for name in ("ab", "bc")
    }
    supports = {name: {"node": node, "fix": "all"} for name, node in (("left", "a"), ("right", "c"))}
    obstacle = {key: value for key, value in keys.items() if key != "hinges"}
    pole = POLE | DOWN | {"point": (0.5, 0.0, 0.22)} | obstacle
    hinges = keys.get("hinges", "auto")
    whole = structure(
        nodes=nodes, members=members, supports=supports, obstacles={"pole": pole}, hinges=hinges
    )
    texts = [text for text in struck_near_ends(whole) if "meets corner b: no dent" in text]
    assert len(texts) == named


@pytest.mark.parametrize(
    ("section", "keys", "named"),
    [
        ({"type": "channel", "width": 0.04, "depth": 0.06, "thickness": 0.002}, {}, True),
        ({"type": "channel", "width": 0.04, "depth": 0.06, "thickness": 0.002}, {"dents": False}, False),
        ({"type": "multi_cell_tube", "width": 0.06, "depth": 0.04, "thickness": 0.002}, {}, False),
        ({"type": "square_tube", "side": 0.04, "thickness": 0.002}, {}, False),
    ],
)
def test_a_section_that_has_no_dent_is_named(section, keys, named):
    supports = {name: {"node": node, "fix": "all"} for name, node in (("left", "a"), ("right", "b"))}
    members = {"beam": {"nodes": ("a", "b"), "section": "own", "material": "steel", "up": (0.0, 0.0, 1.0)}}
    pole = POLE | DOWN | {"point": (0.4, 0.0, 0.2)} | keys
    whole = structure(
        members=members, sections={"own": section}, supports=supports, obstacles={"pole": pole}, hinges="auto"
    )
    texts = [text for text in struck_near_ends(whole) if "have no dent in the model" in text]
    assert len(texts) == named
    assert all("Obstacle pole strikes member beam (channel 40 x 60 x 2 mm)" in text for text in texts)
