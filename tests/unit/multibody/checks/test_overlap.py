"""Members that overlap at the start, with contact of members, are reported by name."""

from unittest.mock import patch

import numpy as np
import pytest
from tests.support.structures import STEEL
from typer.testing import CliRunner

from crumple.cli.main import app
from crumple.multibody import Run, solve_multibody
from crumple.multibody.bodies.crossing import segment_distance
from crumple.multibody.checks.overlap import obstacle_overlap_warnings
from crumple.structure import MultibodySettings, Outputs, Stage, Structure

SQUARE = {"type": "square_tube", "side": 0.05, "thickness": 0.003}


def two_bars(height, contact=True):
    """One bar above another at right angles, their centre lines `height` apart [m]."""
    nodes = {"a": (0, 0, 0), "b": (1, 0, 0), "c": (0.5, -0.5, height), "d": (0.5, 0.5, height)}
    bar = {"section": "tube", "material": "steel"}
    return Structure(
        materials={"steel": STEEL},
        sections={"tube": SQUARE},
        nodes=nodes,
        members={"low": {"nodes": ("a", "b"), **bar}, "high": {"nodes": ("c", "d"), **bar}},
        member_contact={} if contact else None,
    )


@pytest.mark.parametrize(
    ("height", "expected"),
    [
        (0.06, None),
        (0.04, "Members low and high overlap at the start by up to 10 mm"),
        (0.002, "Members low and high cross at the start"),
    ],
)
def test_overlap_is_reported(height, expected):
    result = solve_multibody(two_bars(height), Run(0.001, 0.001))
    reported = [text for text in result.warnings if "at the start" in text]
    assert len(reported) == (expected is not None)
    assert expected is None or reported[0].startswith(expected)


def test_elastic_joints_of_members_count_as_hinges():
    """Without its elastic joint, the hinge of the low bar would sit in a part that is held at both ends."""
    bars = two_bars(0.04).model_dump()
    bars["supports"] = {name: {"node": name, "fix": "all"} for name in ("a", "b")}
    bars["hinge_laws"] = {"plastic": {"type": "constant", "moment": 2e3, "form": "elastic-plastic"}}
    bars["members"]["low"]["hinges"] = [{"name": "h", "at": 0.1, "axis": "y", "law": "plastic"}]
    result = solve_multibody(Structure(**bars), Run(0.001, 0.001))
    assert any("overlap at the start by up to 10 mm" in text for text in result.warnings)


@pytest.mark.parametrize(
    ("obstacle", "depth"),
    [
        ({"type": "plane", "point": (0, 0, -0.025), "normal": (0, 0, 1)}, None),
        ({"type": "plane", "point": (0, 0, -0.021), "normal": (0, 0, 1)}, "4 mm"),
        # between two of the places that are tried first, and between two corners of the section
        ({"type": "cylinder", "point": (0.37, 0, -0.072), "axis": (0, 1, 0), "radius": 0.05}, "3 mm"),
        ({"type": "sphere", "point": (0.613, 0.075, 0.0), "radius": 0.06}, "10 mm"),
        # narrow: between two corners of the section
        ({"type": "sphere", "point": (0.4, 0.043, 0.007), "radius": 0.02}, "2 mm"),
        # at a node that the bar shares with one in line
        ({"type": "cylinder", "point": (0.0, 0, -0.061), "axis": (0, 1, 0), "radius": 0.05}, "14 mm"),
        # the face at the node that a post shares
        ({"type": "plane", "point": (1.01, 0, 0), "normal": (-1, 0, 0)}, None),
    ],
)
def test_walls_inside_an_obstacle_are_reported(obstacle, depth):
    """A bar between one in line and a post; surfaces 25 mm from their lines."""
    structure = Structure(
        materials={"steel": STEEL},
        sections={"tube": SQUARE},
        nodes={"a": (0, 0, 0), "b": (1, 0, 0), "c": (1, 0, 0.6), "o": (-0.5, 0, 0)},
        members={
            name: {"nodes": nodes, "section": "tube", "material": "steel"}
            for name, nodes in (("bar", ("a", "b")), ("post", ("b", "c")), ("before", ("o", "a")))
        },
        obstacles={"block": {**obstacle, "members": ["bar"]}},
    )
    found = obstacle_overlap_warnings(structure)
    assert len(found) == (depth is not None)
    assert depth is None or found[0].startswith(f"Member bar starts up to {depth} inside obstacle block: ")


@pytest.mark.parametrize(
    ("share", "said"), [(0.4, "zero gap, as shells do;"), (0.6, "and shells refuse it;")]
)
def test_shells_refuse_an_obstacle_beyond_the_middle_of_a_wall(share, said):
    """A tube of 50 mm on a floor: its walls in shells are their middle surface."""
    whole = Structure(
        materials={"steel": STEEL},
        sections={"tube": SQUARE},
        nodes={"a": (0, 0, 0), "b": (1, 0, 0)},
        members={"bar": {"nodes": ("a", "b"), "section": "tube", "material": "steel"}},
        obstacles={"floor": {"type": "plane", "point": (0, 0, 0), "normal": (0, 0, 1)}},
    )
    section = whole.section_of("bar")
    height = section.depth / 2.0 - share * section.thickness
    floor = {"type": "plane", "point": (0, 0, -height), "normal": (0, 0, 1)}
    sunk = Structure(**whole.model_dump() | {"obstacles": {"floor": floor}})
    (text,) = obstacle_overlap_warnings(sunk)
    assert said in text


def test_obstacles_of_later_stages_are_not_there_at_the_start():
    structure = Structure(
        materials={"steel": STEEL},
        sections={"tube": SQUARE},
        nodes={"a": (0, 0, 0), "b": (1, 0, 0)},
        members={"bar": {"nodes": ("a", "b"), "section": "tube", "material": "steel"}},
        obstacles={"late": {"type": "plane", "point": (0, 0, -0.02), "normal": (0, 0, 1)}},
    )
    stages = [Stage(name=name, duration=0.1, obstacles=there) for name, there in (("one", ()), ("two", None))]
    assert not obstacle_overlap_warnings(structure, stages)
    assert len(obstacle_overlap_warnings(structure, stages[1:])) == 1


def test_many_members_far_from_an_obstacle_take_one_look():
    """The distance of their middles alone: no member's surface is asked for."""
    number = 200
    nodes = {f"n{k}{end}": (0.1 * k, 0.5 * end, 5.0) for k in range(number) for end in (0, 1)}
    bars = {
        f"m{k}": {"nodes": (f"n{k}0", f"n{k}1"), "section": "tube", "material": "steel"}
        for k in range(number)
    }
    floor = {"type": "plane", "point": (0, 0, 0), "normal": (0, 0, 1)}
    structure = Structure(
        materials={"steel": STEEL},
        sections={"tube": SQUARE},
        nodes=nodes,
        members=bars,
        obstacles={"floor": floor},
    )
    with patch("crumple.multibody.checks.overlap._depth") as depth:
        assert not obstacle_overlap_warnings(structure)
    assert not depth.called


def test_a_solution_reports_walls_inside_an_obstacle():
    bars = two_bars(0.2).model_dump()
    bars["obstacles"] = {"floor": {"type": "plane", "point": (0, 0, -0.01), "normal": (0, 0, 1)}}
    result = solve_multibody(Structure(**bars), Run(0.001, 0.001))
    assert any("starts up to 15 mm inside obstacle floor" in text for text in result.warnings)


def test_without_contact_nothing_overlaps():
    result = solve_multibody(two_bars(0.04, contact=False), Run(0.001, 0.001))
    assert not [text for text in result.warnings if "at the start" in text]


def test_members_that_cross_do_not_clamp_each_other_beside_the_crossing():
    """High moves along low in many short bars, whose ends overlap those of low from the start."""
    kinetic = []
    for contact in (True, False):
        bars = two_bars(0.002, contact).model_dump()
        bars["hinge_laws"] = {"plastic": {"type": "constant", "moment": 500.0}}
        for member in bars["members"].values():
            member["hinges"] = [
                {"name": f"{member['nodes'][0]}{k}", "at": 0.05 * k, "axis": "y", "law": "plastic"}
                for k in range(8, 13)
            ]
        bars["initial_velocity"] = [{"translation": (5.0, 0.0, 0.0), "members": ["high"]}]
        result = solve_multibody(Structure(**bars), Run(0.01, 0.001))
        kinetic.append(result["energy.kinetic"])
    np.testing.assert_allclose(kinetic[0], kinetic[1])


def test_distance_of_segments_is_the_least_of_many_places():
    random = np.random.default_rng(7)
    share = np.linspace(0.0, 1.0, 201)[:, None]
    for _ in range(50):
        ends = random.normal(size=(4, 3)) * random.choice([0.3, 1.0])
        places = [a + share * (b - a) for a, b in (ends[:2], ends[2:])]
        least = np.linalg.norm(places[0][:, None] - places[1][None], axis=2).min()
        found = segment_distance((ends[0], ends[1]), (ends[2], ends[3]))
        assert found <= least + 1e-12
        assert found == pytest.approx(least, abs=0.02)


@pytest.mark.parametrize(("height", "named"), [("40 mm", True), ("60 mm", False)])
def test_check_names_members_that_overlap(height, named, tmp_path):
    path = tmp_path / "bars.yaml"
    path.write_text(
        f"""
crumple: 1
materials: {{steel: {{grade: S355}}}}
sections: {{tube: {{type: square_tube, side: 50 mm, thickness: 3 mm}}}}
nodes: {{a: [0 m, 0 m, 0 m], b: [1 m, 0 m, 0 m], c: [0.5 m, -0.5 m, {height}], d: [0.5 m, 0.5 m, {height}]}}
members:
  low: {{nodes: [a, b], section: tube, material: steel}}
  high: {{nodes: [c, d], section: tube, material: steel}}
supports: {{a: {{node: a, fix: all}}, b: {{node: b, fix: all}}}}
initial_velocity: [{{translation: [0 m/s, 0 m/s, -5 m/s], members: [high]}}]
member_contact: {{friction: 0.1}}
analysis: {{duration: 5 ms}}
""",
        encoding="utf-8",
    )
    found = CliRunner().invoke(app, ["check", str(path)])
    assert found.exit_code == 0, found.output
    said = "Members high and low overlap at the start by up to 10 mm"
    assert (said in " ".join(found.output.split())) == named


BALL = {"type": "sphere", "point": (0.0, 0.0, 2.0), "radius": 0.1}
STONE = {"stone": BALL | {"mass": 1.0, "guide": (0, 0, 1)}}


@pytest.mark.parametrize("obstacles", [{}, STONE], ids=["alone", "with an obstacle of mass"])
@pytest.mark.parametrize("side", [0.0, 2.0])
def test_members_that_supports_hold_stop_others(side, obstacles):
    """A bar falls on one that is rigid between clamps: it stops where the walls touch, and goes on along."""
    whole = two_bars(0.06).model_dump(exclude_none=True)
    supports = {name: {"node": name, "fix": "all"} for name in ("a", "b")}
    fall = [{"members": ["high"], "translation": (side, 0.0, -5.0)}]
    structure = Structure(**whole | {"supports": supports, "initial_velocity": fall, "obstacles": obstacles})
    settings = MultibodySettings(members="rigid", kernel="spatial")
    result = solve_multibody(structure, Run(0.02, 0.001, settings, Outputs(every=0.001, nodes=["c", "d"])))
    assert result.status.ok
    for node in ("c", "d"):
        assert result[f"node.{node}.displacement.z"][-1] == pytest.approx(-0.01, abs=2e-5)
        assert result[f"node.{node}.displacement.x"][-1] == pytest.approx(side * 0.02, rel=1e-3, abs=1e-9)
    mass = structure.mass_of_members / 2.0
    assert result["energy.contact"][-1] == pytest.approx(0.5 * mass * 25.0, rel=1e-3)
