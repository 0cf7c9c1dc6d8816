"""Hinges in the walls: components, lengths, halfway moments, corners, and the order in which they opened."""

from functools import cache

import numpy as np
import pytest
from tests.support.shell.structures import STEEL, TUBE, thrown

from crumple.multibody import Run, solve_multibody
from crumple.numeric.rotation import turned, vector_quaternion
from crumple.shell import ShellRun, lower, solve_shell
from crumple.shell.answer.hinge_histories import OPEN, hinge_histories, openings, summaries
from crumple.shell.answer.record import Record, Sampler
from crumple.structure import Outputs, ShellSettings, Structure

COARSE = ShellSettings(element_size=24e-3)
QUARTER = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
"""Turns x into y, y into z and z into x."""
AT = np.linspace(0.0, 1.0, 9)[:, None]


def hinged(section=TUBE, turn=None, **axes):
    """Cantilever along x, thrown aside and upwards; `axes`: of its hinge; `turn`: of all of it in space."""
    given = axes or {"axes": ["x", "y", "z"]}

    def to(vector):
        return tuple(float(value) for value in (np.eye(3) if turn is None else turn) @ np.array(vector))

    hinge = {"name": "root", "at": 0.02, "law": "kecman" if section is TUBE else "estimate", **given}
    return Structure(
        materials={"steel": STEEL},
        sections={"tube": section},
        nodes={"root": (0, 0, 0), "tip": to((0.4, 0.0, 0.0))},
        members={
            "tube": {
                "nodes": ("root", "tip"),
                "section": "tube",
                "material": "steel",
                "up": to((0.0, 0.0, 1.0)),
                "hinges": [hinge],
            }
        },
        supports={"clamp": {"node": "root", "fix": "all"}},
        masses={"payload": {"node": "tip", "mass": 6.0, "rotary_inertia": (0.02, 0.02, 0.02)}},
        initial_velocity=[
            {"nodes": ["tip"], "translation": to((0.0, 6.0, 8.0))},
        ],
    )


def corner(first="one", ends=("a", "b"), velocity=(0.0, 6.0, 0.0)):
    """Two tubes at a right angle in the x-z plane, struck across it; member `first` is described first."""
    members = {
        "one": {"nodes": ends, "section": "tube", "material": "steel"},
        "two": {"nodes": ("b", "c"), "section": "tube", "material": "steel"},
    }
    return Structure(
        materials={"steel": STEEL},
        sections={"tube": {"type": "square_tube", "side": 0.05, "thickness": 2.5e-3}},
        nodes={"a": (0, 0, 0), "b": (0, 0, 0.4), "c": (0.3, 0, 0.4)},
        members={name: members[name] for name in sorted(members, key=lambda name: name != first)},
        hinges="auto",
        supports={"clamp": {"node": "a", "fix": "all"}},
        masses={"m": {"node": "c", "mass": 20.0}},
        initial_velocity=[{"nodes": ["c"], "translation": velocity}],
    )


def shells(structure, duration=8e-3, **more):
    return solve_shell(structure, ShellRun(duration, 4e-4, settings=COARSE, outputs=Outputs(**more)))


@cache
def aside():
    return shells(hinged())


def recorded(structure, first, relative, moment, energy=1.0):
    """Sampler and record in which the sides of the only hinge have given rotation vectors."""
    sampler = Sampler.of(lower(structure, COARSE), Outputs())
    start = matrix(first)
    rows = np.stack([start, start @ matrix(relative)], axis=1)
    record = Record()
    for i, rings in enumerate(rows):
        cut = np.concatenate([np.zeros(3), moment[i], np.zeros(3)])[None]
        row = {"time": np.array(1e-3 * i), "ring": rings, "cut": cut, "zone": np.array([energy * i])}
        record.add({name: np.array(values) for name, values in row.items()})
    return sampler, record


def matrix(vectors):
    """Matrices of rotation vectors, (n, 3) to (n, 3, 3)."""
    columns = [turned(vector_quaternion(vectors), np.broadcast_to(one, vectors.shape)) for one in np.eye(3)]
    return np.stack(columns, axis=-1)


def test_components_are_about_the_members_axes_and_their_length_beside():
    structure = hinged(turn=QUARTER)
    vector, axes = np.array([0.1, -0.4, 0.2]), structure.frame_of("tube").axes
    moment = np.zeros((len(AT), 3))
    found = hinge_histories(*recorded(structure, AT * (0.5, 0.2, -0.3), AT * (vector @ axes), moment))["root"]
    for i, axis in enumerate("xyz"):
        np.testing.assert_allclose(found[f"rotation.{axis}"], AT[:, 0] * vector[i], atol=1e-12)
    np.testing.assert_allclose(found["rotation"], AT[:, 0] * np.linalg.norm(vector), atol=1e-12)
    np.testing.assert_allclose(found["rotation_rate.y"], -0.4 / 8e-3, rtol=1e-9)
    np.testing.assert_allclose(found["plastic_rotation"], found["rotation"], atol=1e-12)


def test_a_hinge_without_twist_leaves_the_twist_out():
    moment = np.zeros((len(AT), 3))
    given = recorded(hinged(axes=["z", "y"]), 0.0 * AT * np.ones(3), AT * (0.5, 0.03, 0.04), moment)
    found = hinge_histories(*given)["root"]
    assert not any(name.endswith(".x") for name in found)
    np.testing.assert_allclose(found["rotation"], 0.05 * AT[:, 0], atol=1e-12)


def test_the_moment_is_resolved_halfway_between_both_sides():
    vector = np.array([0.0, 0.0, 0.8])
    first = AT * np.array([0.0, 0.6, 0.0])
    # constant as seen from halfway between the sides
    halfway = matrix(first) @ matrix(AT * vector / 2.0)
    moment = halfway @ np.array([30.0, 200.0, -500.0])
    found = hinge_histories(*recorded(hinged(), first, AT * vector, moment))["root"]
    for axis, value in zip("xyz", (30.0, 200.0, -500.0), strict=True):
        np.testing.assert_allclose(found[f"moment.{axis}"], value, rtol=1e-9)
    np.testing.assert_allclose(found["moment"], np.linalg.norm((30.0, 200.0, -500.0)), rtol=1e-9)


def test_what_the_walls_bear_elastically_is_no_plastic_rotation():
    structure = hinged()
    sampler = Sampler.of(lower(structure, COARSE), Outputs())
    (zone,) = sampler.case.zones
    stations = sampler.case.mesh.tubes["tube"].stations
    length = stations[zone.last[1]] - stations[zone.first[1]]
    section, metal = structure.section_of("tube"), structure.material_of("tube")
    twist = metal.shear_modulus * section.torsion_constant
    stiff = np.array([twist, *(structure.flexural_rigidity("tube", axis) for axis in "yz")]) / length
    moment = np.array([50.0, -300.0, 400.0])
    elastic, rest = moment / stiff, np.array([0.0, -0.02, 0.03])
    nothing = 0.0 * AT * np.ones(3)
    found = hinge_histories(*recorded(structure, nothing, nothing + elastic + rest, nothing + moment))["root"]
    for i, axis in enumerate("xyz"):
        # the moment is resolved halfway, at a hundredth of a radian from either side
        np.testing.assert_allclose(found[f"plastic_rotation.{axis}"], rest[i], atol=3e-4)


def test_walls_that_cannot_warp_have_no_elastic_twist_beyond_their_twist():
    channel = {"type": "channel", "width": 0.04, "depth": 0.08, "thickness": 2e-3}
    nothing = 0.0 * AT * np.ones(3)
    given = recorded(hinged(channel), nothing, AT * (0.01, 0.0, 0.0), nothing + np.array([100.0, 0.0, 0.0]))
    assert given[0].case.zones[0].flexibility[0, 0] * 100.0 > 0.05
    np.testing.assert_allclose(hinge_histories(*given)["root"]["plastic_rotation"], 0.0, atol=1e-12)


def test_channels_of_a_hinge_in_space_are_those_of_the_multibody_solver():
    other = solve_multibody(hinged(), Run(8e-3, 4e-4))
    missing = {name for name in other.channels if name not in aside().channels}
    axes = ("", ".x", ".y", ".z")
    assert missing == {"member.tube.energy", *(f"hinge.root.capacity{axis}" for axis in axes)}
    units = {name: channel.unit for name, channel in other.channels.items() if name not in missing}
    assert units == {name: aside().channels[name].unit for name in units}


def test_a_hinge_in_space_turns_as_in_the_multibody_solver():
    other = solve_multibody(hinged(), Run(8e-3, 4e-4))
    for axis in "yz":
        for name in (f"hinge.root.rotation.{axis}", f"hinge.root.moment.{axis}"):
            assert aside()[name][10] * other[name][10] > 0.0, name
    # elastic walls and a coarse mesh beside rigid bars
    assert aside().hinges["root"].rotation_max == pytest.approx(other.hinges["root"].rotation_max, rel=0.3)
    length = np.linalg.norm([aside()[f"hinge.root.rotation.{axis}"] for axis in "xyz"], axis=0)
    # each channel is interpolated to the output times by itself
    assert aside()["hinge.root.rotation"] == pytest.approx(length, abs=1e-5)
    assert aside().hinges["root"].rotation_max > np.radians(3.0)


def test_a_structure_turned_in_space_has_the_same_components():
    again = shells(hinged(turn=QUARTER))
    for name in (name for name in again if name.startswith("hinge.")):
        values = aside()[name]
        assert again[name] == pytest.approx(values, abs=1e-5 * np.abs(values).max()), name


def test_a_hinge_about_one_axis_keeps_its_sign_and_has_no_components():
    moved = shells(thrown(), 4e-3)
    names = {name.removeprefix("hinge.root.") for name in moved if name.startswith("hinge.")}
    assert names == {"rotation", "rotation_rate", "plastic_rotation", "moment", "energy"}
    assert moved["hinge.root.rotation"][-1] < 0.0


def test_a_hinge_that_slips_beside_one_axis_has_this_component_too():
    (zone,) = lower(hinged(axis="y", axial=True), COARSE).zones
    assert zone.turns == (1,)
    moment = np.zeros((len(AT), 3))
    given = recorded(hinged(axis="y", axial=True), 0.0 * moment, AT * (0.0, -0.3, 0.0), moment)
    found = hinge_histories(*given)["root"]
    np.testing.assert_array_equal(found["rotation.y"], found["rotation"])
    assert found["rotation"][-1] == pytest.approx(-0.3)


@pytest.mark.parametrize("ends", [("a", "b"), ("b", "a")])
def test_a_corner_in_space_is_measured_between_both_members(ends):
    case = lower(corner(ends=ends), COARSE)
    zone = next(zone for zone in case.zones if zone.place.name == "corner-b")
    assert {member for member, _ in (zone.first, zone.last)} == {"one", "two"}
    # the first side is the one towards the first node of its member
    assert zone.first[0] == ("one" if ends == ("a", "b") else "two")
    tubes = case.mesh.tubes
    for member, ring in (zone.first, zone.last):
        away = np.abs(tubes[member].stations[ring] - (0.4 if (member, ends) == ("one", ("a", "b")) else 0.0))
        assert 0.05 < away < 0.1
    expected = sum(len(tubes[s.member].elements_between(s.first, s.last)) for s in zone.spans)
    assert len(np.unique(zone.elements)) == expected


@pytest.mark.parametrize(("first", "ends"), [("one", ("a", "b")), ("two", ("a", "b")), ("one", ("b", "a"))])
def test_a_corner_in_space_turns_as_in_the_multibody_solver(first, ends):
    moved = shells(corner(first, ends), 12e-3)
    other = solve_multibody(corner(first, ends), Run(12e-3, 4e-4))
    most = np.array(
        [[result[f"hinge.corner-b.rotation.{axis}"][-1] for axis in "xyz"] for result in (moved, other)]
    )
    assert np.linalg.norm(most[0]) > np.radians(3.0)
    # as vectors, of walls that bend and twist beside rigid bars
    assert np.linalg.norm(most[0] - most[1]) < 0.35 * np.linalg.norm(most[1])
    assert "corner-b" in [opening.hinge for opening in moved.collapse]


def test_a_corner_and_a_hinge_of_its_second_member_meet_halfway():
    given = corner().model_dump()
    given["nodes"]["c"] = (0.12, 0.0, 0.4)
    given |= {"initial_velocity": [{"nodes": ["b"], "translation": (0.0, 6.0, 0.0)}], "masses": {}}
    given["supports"]["far"] = {"node": "c", "fix": "all"}
    zones = {
        zone.place.name: zone for zone in lower(Structure(**given), ShellSettings(element_size=8e-3)).zones
    }
    assert zones["corner-b"].spans[1].member == "two"
    assert zones["corner-b"].spans[1].last == zones["two-c"].spans[0].first


@pytest.mark.parametrize(("first", "ends"), [("one", ("a", "b")), ("two", ("a", "b")), ("one", ("b", "a"))])
def test_a_corner_in_a_plane_turns_as_in_the_multibody_solver(first, ends):
    flat = corner(first, ends, velocity=(0.0, 0.0, -6.0))
    (zone,) = (zone for zone in lower(flat, COARSE).zones if zone.place.name == "corner-b")
    assert {span.member for span in zone.spans} == {"one", "two"}
    assert len(zone.turns) == 1
    bending = [
        flat.flexural_rigidity(span.member, zone.place.axis)
        / float(np.ptp(lower(flat, COARSE).mesh.tubes[span.member].stations[[span.first, span.last]]))
        for span in zone.spans
    ]
    assert zone.stiffness == pytest.approx(1.0 / sum(1.0 / k for k in bending))
    moved = shells(flat, 12e-3)["hinge.corner-b.rotation"][-1]
    other = solve_multibody(flat, Run(12e-3, 4e-4))["hinge.corner-b.rotation"][-1]
    assert abs(other) > np.radians(3.0)
    # measured in one of its members it was half of this
    assert moved == pytest.approx(other, rel=0.3)


def test_hinges_open_in_the_order_of_their_times_once_their_walls_yield():
    time, grows = np.array([0.0, 1.0, 2.0]), np.array([0.0, -2.0, -4.0]) * OPEN
    yields, late, never = np.array([0.0, 5.0, 9.0]), np.array([0.0, 0.0, 1.0]), np.zeros(3)
    hinges = {
        "late": {"plastic_rotation": grows, "energy": late},
        "soon": {"plastic_rotation": grows, "energy": yields},
        "elastic": {"plastic_rotation": grows, "energy": never},
        "little": {"plastic_rotation": 0.2 * grows, "energy": yields},
    }
    found = openings(time, hinges)
    assert [(opening.hinge, opening.time) for opening in found] == [("soon", 0.5), ("late", 1.25)]
    assert found[0].rotation == -4.0 * OPEN
    assert found[0].energy == 9.0


def test_the_summary_has_the_lengths():
    moment = 0.0 * AT + (30.0, 0.0, 40.0)
    given = recorded(hinged(), 0.0 * moment, AT * (0.0, 0.3, -0.4), moment)
    found = summaries(*given, hinge_histories(*given))["root"]
    assert found.rotation_max == found.rotation_final == pytest.approx(0.5)
    assert found.moment_max == pytest.approx(50.0)
    assert found.energy == 8.0
