"""Structures that an impact stops if their members keep their lengths: their members shorten."""

from __future__ import annotations

import numpy as np
import pytest

from crumple.analysis import loads, solve
from crumple.errors import InputError
from crumple.hinge import Freedom, build_axial_law
from crumple.structure import hinge_places, placed_hinges, with_elastic_members
from crumple.structure.hinges.lengthening.pressed import struck_ends
from crumple.structure.hinges.lengthening.stopped import LOST, THROWN, lost_share, stopped

FRAME = """crumple: 1
materials:
  steel: {youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: 300 MPa}
sections:
  rail: {type: square_tube, side: 40 mm, thickness: 2 mm}
  beam: {type: rectangular_tube, width: 40 mm, depth: 60 mm, thickness: 2.5 mm}
nodes:
  left_end: [0 m, 0.3 m, 0 m]
  left: [0 m, 0.2 m, 0 m]
  right: [0 m, -0.2 m, 0 m]
  left_rear: [0.4 m, 0.2 m, 0 m]
  right_rear: [0.4 m, -0.2 m, 0 m]
members:
  tip: {nodes: [left_end, left], section: beam, material: steel}
  front: {nodes: [left, right], section: beam, material: steel}
  left_rail: {nodes: [left, left_rear], section: rail, material: steel}
  right_rail: {nodes: [right, right_rear], section: rail, material: steel}
hinges: auto
masses: {car: {node: left_rear, mass: 100 kg}}
obstacles:
  wall: {type: plane, point: [-0.1 m, 0 m, 0 m], normal: [1, 0, 0]}
initial_velocity: [{translation: [-5 m/s, 0 m/s, 0 m/s]}]
analysis: {duration: 1 ms}
"""
RAIL = """crumple: 1
materials:
  steel: {youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: 300 MPa}
sections: {rail: {type: square_tube, side: 40 mm, thickness: 2 mm}}
nodes: {front: [0 m, 0 m, 0 m], rear: [0.4 m, 0 m, 0 m]}
members: {rail: {nodes: [front, rear], section: rail, material: steel}}
hinges: auto
masses: {car: {node: rear, mass: 100 kg}}
obstacles:
  wall: {type: plane, point: [-0.1 m, 0 m, 0 m], normal: [1, 0, 0]}
initial_velocity: [{translation: [-5 m/s, 0 m/s, 0 m/s]}]
analysis: {duration: 40 ms, multibody: {mechanism_check: off}}
outputs: {nodes: [rear]}
"""
WALL = "normal: [1, 0, 0]"
AT = ("point: [-0.1 m, 0 m, 0 m]", "point: [0 m, 0 m, -0.1 m]")
CORNERS = [
    ("  left_end: [0 m, 0.3 m, 0 m]\n", ""),
    ("  tip: {nodes: [left_end, left], section: beam, material: steel}\n", ""),
    ("section: beam", "section: rail"),
]
"""A front beam that ends at its rails, of the same tube."""


def lost(text, *changes):
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    return lost_share(loads(text).structure)


def test_what_a_wall_stops_along_its_members_is_lost_but_for_what_can_bend():
    # the tip beside the rail turns on
    assert lost(FRAME) == pytest.approx(1.0, abs=0.02)
    assert lost(FRAME, *CORNERS) == pytest.approx(1.0, abs=1e-6)


def test_a_mass_that_is_met_itself_loses_its_speed_towards_the_wall():
    # a rail that falls flat on a floor
    across = lost(RAIL, ("[-5 m/s, 0 m/s, 0 m/s]", "[0 m/s, 0 m/s, -5 m/s]"), (WALL, "normal: [0, 0, 1]"), AT)
    assert across == pytest.approx(1.0)
    free = lost(RAIL, ("node: rear", "node: front"), (WALL, "normal: [1, 1, 0]"))
    # a mass that meets a frictionless wall at 45 degrees keeps half of its energy
    assert free == pytest.approx(0.5, abs=0.01)


def test_a_tilted_wall_meets_the_rails_behind_the_tips_of_their_beam():
    assert lost(FRAME, (WALL, "normal: [1, -0.2, 0]")) > LOST
    # a wall along the way meets nothing
    assert lost(FRAME, AT, (WALL, "normal: [0, 0, 1]")) < 1e-9


def test_a_clamp_stands_on_a_wall_and_does_not_meet_it():
    assert lost(RAIL, ("masses:", "supports: {foot: {node: front, fix: all}}\nmasses:")) == pytest.approx(1.0)
    swung = ("[-5 m/s, 0 m/s, 0 m/s]", "[0 m/s, -5 m/s, 0 m/s]")
    held = ("masses:", "supports: {foot: {node: front, fix: all}}\nmasses:")
    # what moves with the clamp is lost: half of the rail
    assert lost(RAIL, swung, held) < 0.01


@pytest.mark.parametrize(
    ("support", "share"),
    [
        ("fix: [y, z, rx, ry, rz]", 1.0),
        ("fix: [x, y, z]", 0.0),
        ("fix: [y, z], motion: {x: {step: {x0: 0 ms, h0: 0 mm, x1: 9 ms, h1: 9 mm}}}", 0.0),
    ],
)
def test_supports_take_the_blow_only_in_the_directions_that_they_hold(support, share):
    guided = ("obstacles:", f"supports: {{end: {{node: front, {support}}}}}\nobstacles:")
    rest = ("initial_velocity: [{translation: [-5 m/s, 0 m/s, 0 m/s]}]\n", "")
    ram = ("type: plane,", "type: plane, mass: 1 kg, velocity: [5 m/s, 0 m/s, 0 m/s],")
    assert lost(RAIL, guided, rest, ram) == pytest.approx(share, abs=0.02)


RAMS = [
    "sphere, point: [-0.11 m, 0 m, 0 m], radius: 100 mm, mass: 50 kg, velocity: [5 m/s, 0 m/s, 0 m/s]",
    "cylinder, point: [-0.11 m, 0 m, 0 m], axis: [0, 1, 0], radius: 0.1 m, velocity: [5 m/s, 0 m/s, 0 m/s]",
    f"plane, point: [-9 mm, 0.1 m, 0 m], {WALL}, edge: [0, 1, 0], velocity: [5 m/s, 0 m/s, 0 m/s]",
    f"plane, point: [-9 mm, 0 m, 0 m], {WALL}, "
    "motion: {x: {step: {x0: 0 ms, h0: 0 mm, x1: 9 ms, h1: 9 mm}}}",
]


@pytest.mark.parametrize("ram", RAMS)
def test_obstacles_of_all_kinds_push_a_column_along_its_axis(ram):
    wall = "{type: plane, point: [-0.1 m, 0 m, 0 m], normal: [1, 0, 0]}"
    rest = ("initial_velocity: [{translation: [-5 m/s, 0 m/s, 0 m/s]}]\n", "")
    clamped = ("masses: {car: {node: rear, mass: 100 kg}}", "supports: {foot: {node: rear, fix: all}}")
    assert lost(RAIL, (wall, f"{{type: {ram}}}"), rest, clamped) == pytest.approx(1.0, abs=1e-3)
    # a free rail is carried along
    light = ("mass: 100 kg", "mass: 0.1 kg")
    assert lost(RAIL, (wall, f"{{type: {ram}}}"), rest, light) < 0.06


def test_a_motion_that_changes_a_length_is_lost_at_the_start():
    thrown = ("{translation:", "{nodes: [rear], translation:")
    clamped = ("obstacles:", "supports: {foot: {node: front, fix: all}}\nobstacles:")
    assert lost(RAIL, thrown, clamped) == pytest.approx(1.0)
    assert lost(RAIL, ("initial_velocity: [{translation: [-5 m/s, 0 m/s, 0 m/s]}]\n", "")) == 0.0


def test_a_mass_thrown_along_a_member_that_leads_to_the_ground_presses_it():
    thrown = ("{translation: [-5 m/s, 0 m/s, 0 m/s]}", "{nodes: [rear], translation: [-2 m/s, 5 m/s, 0 m/s]}")
    clamp = ("obstacles:", "supports: {foot: {node: front, fix: all}}\nobstacles:")
    # a seventh of the energy is along the rail
    assert THROWN < lost(RAIL, thrown, clamp) == pytest.approx(4.0 / 29.0, rel=0.02)
    assert stopped(loads(RAIL.replace(*thrown).replace(*clamp)).structure)
    # a rail that leads nowhere has its own mass alone to move
    light = ("mass: 100 kg", "mass: 0.3 kg")
    assert lost(RAIL, thrown, light) > THROWN
    assert not stopped(loads(RAIL.replace(*thrown).replace(*light)).structure)


@pytest.mark.parametrize("held", [True, False])
def test_members_of_a_stopped_structure_shorten(held):
    support = ("obstacles:", "supports: {guide: {node: rear, fix: [y, z, rx, ry, rz]}}\nobstacles:")
    read = loads(RAIL.replace(*support) if held else RAIL)
    whole = with_elastic_members(read.structure, read.multibody, read.time_in_motion)
    (place,) = hinge_places(whole)
    # between free ends it is in the middle
    assert place.station == pytest.approx(0.2) or held
    assert place.keys.axial.law == "superfolding"
    result = solve(read)
    assert 0.02 < float(np.abs(result["node.rear.displacement.x"]).max()) - 0.1 < 0.06


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("{type: plane,", "{type: plane, members: [nobody],", "there is no member 'nobody'"),
        (
            "section: rail, material: steel}\nhinges",
            "section: none, material: steel}\nhinges",
            "no section 'none'",
        ),
        ("left_rear]", "nowhere]", "there is no node 'nowhere'"),
    ],
)
def test_names_that_are_not_there_are_refused_where_members_are_elastic(old, new, message):
    text = FRAME.replace("analysis: {", "analysis: {multibody: {members: elastic}, ")
    text = (
        text.replace("material: steel}\n", "material: steel, elastic: true}\n")
        if "section" not in old
        else text
    )
    assert old in text
    with pytest.raises(InputError, match=message):
        loads(text.replace(old, new))


HARDENS = (
    "yield_stress: 300 MPa",
    "yield_stress: 300 MPa, hardening: {type: swift, prestrain: 0.01, exponent: 0.1}",
)
RAM = (
    ("[-0.1 m, 0 m, 0 m], normal: [1, 0, 0]", "[-30 mm, 0 m, 0 m], normal: [1, 0, 0], mass: 300 kg, MOVES"),
    ("MOVES", "velocity: [5 m/s, 0 m/s, 0 m/s]"),
    ("initial_velocity: [{translation: [-5 m/s, 0 m/s, 0 m/s]}]", ""),
)


def candidates(text, *changes):
    """Number of hinges by member."""
    for old, new in changes:
        assert old in text, old
        text = text.replace(old, new)
    read = loads(text)
    whole = with_elastic_members(read.structure, read.multibody, read.time_in_motion)
    return {name: sum(place.member == name for place in hinge_places(whole)) for name in whole.members}


@pytest.mark.parametrize("ram", [(), RAM], ids=["thrown at a wall", "struck by a ram"])
def test_members_pressed_along_their_axes_may_kink_where_their_metal_hardens(ram):
    plain, hard = candidates(FRAME, *ram), candidates(FRAME, HARDENS, *ram)
    added = {name: hard[name] - plain[name] for name in plain}
    assert added == {"tip": 0, "front": 0, "left_rail": 2, "right_rail": 2}


def test_what_swings_across_its_axis_does_not_kink():
    across = ("[-5 m/s, 0 m/s, 0 m/s]", "[-1 m/s, 0 m/s, 5 m/s]")
    assert candidates(FRAME, HARDENS, across) == candidates(FRAME, across)


def test_metal_that_hardens_yields_along_its_length_before_a_hinge_folds_and_at_once_otherwise():
    for change, strain in (((), 0.0), ((HARDENS,), None)):
        text = RAIL
        for old, new in change:
            text = text.replace(old, new)
        read = loads(text)
        whole = with_elastic_members(read.structure, read.multibody, read.time_in_motion)
        slips = [
            part
            for hinge in placed_hinges(whole)
            if hinge.spatial is not None
            for part in hinge.spatial.components
            if part.freedom is Freedom.AXIAL
        ]
        if strain == 0.0:
            assert all(part.spread is None for part in slips)
            continue
        material = whole.material_of("rail")
        law = build_axial_law("superfolding", whole.section_of("rail"), material)
        ends = [part.spread.shortening[0][-1] for part in slips]
        # together they stand for all of the rail
        assert sum(ends) == pytest.approx(law.peak_strain * 0.4, rel=1e-9)
        for part in slips:
            assert part.record.negative.moment[0] == pytest.approx(law.peak_force, rel=1e-9)
            assert part.spread.shortening[1][0] == pytest.approx(
                300e6 * 0.152 * 2e-3 / law.peak_force, rel=1e-9
            )
            assert part.spread.lengthening[0][-1] / part.spread.shortening[0][-1] == pytest.approx(
                0.09 / law.peak_strain, rel=0.05
            )


BOX = """crumple: 1
materials:
  mild: {youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: 350 MPa}
  strong: {youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: 600 MPa}
sections:
  box: {type: square_tube, side: 50 mm, thickness: 1.5 mm}
  rail: {type: square_tube, side: 60 mm, thickness: 2 mm}
nodes:
  front: [0 m, 0 m, 0 m]
  flange: [0.2 m, 0 m, 0 m]
  kink: [0.4 m, 0 m, 0 m]
  rear: [0.82 m, 0 m, 0.0893 m]
members:
  box: {nodes: [front, flange], section: box, material: mild}
  horn: {nodes: [flange, kink], section: rail, material: strong}
  rail: {nodes: [kink, rear], section: rail, material: strong}
hinges: auto
supports: {sled: {node: rear, fix: [y, z, rx, ry, rz]}}
masses: {sled: {node: rear, mass: 200 kg}}
obstacles:
  wall: {type: plane, point: [-1 mm, 0 m, 0 m], normal: [1, 0, 0]}
initial_velocity: [{translation: [-8 m/s, 0 m/s, 0 m/s]}]
analysis: {duration: 30 ms, multibody: {mechanism_check: off}}
outputs: {distances: {box: {from: front, to: flange}}}
"""
"""A crash box in front of a rail with a kink, whose bend keeps the structure from stopping."""


@pytest.mark.parametrize(
    ("changes", "struck"),
    [
        ((), {"box", "horn", "rail"}),
        ((("[front, flange]", "[flange, front]"),), {"box", "horn", "rail"}),
        # a node without a mass of its own moves with the others
        ((("{translation", "{nodes: [rear], translation"),), {"box", "horn", "rail"}),
        # what leads away across the blow is not pressed
        ((("rear: [0.82 m, 0 m, 0.0893 m]", "rear: [0.5 m, 0 m, 0.4 m]"),), {"box", "horn"}),
        # behind a joint, too, what leads away along the blow: not a beam on the front of the box
        (
            (
                ("front: [0 m", "tip: [0 m, 0.1 m, 0 m]\n  front: [0 m"),
                ("members:\n", "members:\n  tip: {nodes: [front, tip], section: box, material: mild}\n"),
            ),
            {"box", "horn", "rail"},
        ),
        (
            (("members:\n", "members:\n  link: {nodes: [front, rear], section: box, material: mild}\n"),),
            {"box", "horn", "rail", "link"},
        ),
        # across the box, moving away, or where a support is at its end
        (((WALL, "normal: [1, 0, 1]"),), set()),
        ((("[-8 m/s", "[8 m/s"),), set()),
        ((("supports: {", "supports: {end: {node: front, fix: [z]}, "),), set()),
    ],
)
def test_members_behind_a_node_that_is_struck_along_their_axes(changes, struck):
    text = BOX
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    assert struck_ends(loads(text).structure) == struck


def test_they_shorten_if_they_are_elastic():
    for members, slipping in (("elastic", {"box", "horn", "rail"}), ("rigid", set())):
        read = loads(BOX.replace("{mechanism_check: off", f"{{members: {members}, mechanism_check: off"))
        whole = with_elastic_members(read.structure, read.multibody, read.time_in_motion)
        found = {
            hinge.member
            for hinge in placed_hinges(whole)
            if hinge.spatial is not None and Freedom.AXIAL in hinge.spatial.freedoms
        }
        assert found == slipping


def test_a_crash_box_in_front_of_a_rail_with_a_kink_folds():
    """In shells by 166 mm, while the kink turns by 0.3 degrees; without slip the kink took everything."""
    result = solve(loads(BOX))
    assert result.status.ok
    assert np.abs(result["box"]).max() > 0.15
    assert result.hinges["corner-kink"].rotation_max < np.radians(2.0)
    declined = solve(loads(BOX.replace("hinges: auto", "hinges: {axial: false}")))
    assert np.abs(declined["box"]).max() < 1e-3


BULKHEAD = """crumple: 1
materials:
  box: {youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: 210 MPa}
  frame: {youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: 600 MPa}
sections:
  box: {type: square_tube, side: 45 mm, thickness: 1.4 mm}
  cross: {type: rectangular_tube, width: 45 mm, depth: 60 mm, thickness: 3 mm}
nodes: {tip: [0 m, 0 m, 0 m], b: [0.14 m, 0 m, 0 m], l: [0.14 m, 0.2 m, 0 m], r: [0.14 m, -0.2 m, 0 m]}
members:
  box: {nodes: [tip, b], section: box, material: box}
  left: {nodes: [b, l], section: cross, material: frame}
  right: {nodes: [b, r], section: cross, material: frame}
hinges: auto
masses: {car: {node: b, mass: 70 kg, rotary_inertia: [1 kg*m^2, 1 kg*m^2, 1 kg*m^2]}}
obstacles:
  wall: {type: plane, point: [-1 mm, 0 m, 0 m], normal: [1, 0, 0], friction: 0.3}
initial_velocity: [{translation: [-8 m/s, 0 m/s, 0 m/s]}]
analysis: {duration: 16 ms, multibody: {members: elastic, mechanism_check: off}}
outputs: {every: 0.1 ms, distances: {box: {from: tip, to: b}}}
"""
"""A crash box that a mass on a bulkhead crushes until its folds close."""


def test_a_wall_does_not_meet_the_cuts_within_a_box_that_folds_towards_it():
    """It met the round end of the piece behind the last cut when 46 mm were left, and took 3 MN."""
    result = solve(loads(BULKHEAD))
    assert result.status.ok
    assert np.abs(result["box"]).max() > 0.095
    late = result.time > 2e-3
    assert np.abs(result["obstacle.wall.force.x"][late]).max() < 60e3
