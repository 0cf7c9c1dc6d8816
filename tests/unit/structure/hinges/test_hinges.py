"""Where hinges lie, what they stand for, and which law they get."""

import math

import numpy as np
import pytest

from crumple.hinge import Form, Freedom, HingeRecord, SofteningVariable
from crumple.hinge.record.record import Envelope
from crumple.section import fold_distance
from crumple.structure import (
    Structure,
    hinge_places,
    placed_hinges,
    plastic_hinges,
    shares_left_out,
)
from crumple.structure.hinges.spatial_hinges import flattened


def placed(keys):
    return placed_hinges(Structure(**keys))


def test_a_hinge_at_a_clamp_lies_where_its_fold_turns(keys):
    (hinge,) = placed(keys)
    structure = Structure(**keys)
    inside = fold_distance(structure.section_of("arm"), "y")
    assert hinge.station == inside > 0.016
    np.testing.assert_allclose(hinge.position, [inside, 0, 0])
    np.testing.assert_allclose(hinge.direction, [0, 1, 0])


def test_the_offset_overrides_it(keys):
    keys["members"]["arm"]["hinges"][0]["offset"] = "0 mm"
    assert placed(keys)[0].station == 0.0
    keys["members"]["arm"]["hinges"][0] |= {"at": "400 mm", "offset": "100 mm"}
    assert placed(keys)[0].station == 0.5


def test_offsets_point_into_the_member_from_either_end(keys):
    keys["members"]["arm"]["nodes"] = ("tip", "root")
    (hinge,) = placed(keys)
    assert hinge.station == pytest.approx(1.0 - fold_distance(Structure(**keys).section_of("arm"), "y"))


@pytest.mark.parametrize(
    ("fix", "clamped"), [("all", True), (["x", "z", "ry"], True), (["x", "y", "z", "rx"], False)]
)
def test_only_a_held_rotation_about_the_hinge_is_a_clamp(keys, fix, clamped):
    keys["supports"]["clamp"]["fix"] = fix
    # a second member at the root, so that the hinge has something to turn against
    keys["nodes"]["side"] = (-1, 0, 0)
    keys["members"]["other"] = {"nodes": ("side", "root"), "section": "tube", "material": "steel"}
    assert (placed(keys)[0].station > 0.0) is clamped


def test_a_driven_rotation_is_a_clamp(keys):
    ramp = {"havsin": {"x0": 0, "h0": 0, "x1": 1, "h1": 1}}
    keys["supports"]["clamp"] = {"node": "root", "fix": "pin", "motion": {"rx": 0, "ry": ramp, "rz": 0}}
    assert placed(keys)[0].station > 0.0


def test_the_roll_turns_a_named_hinge_axis(keys):
    keys["members"]["arm"]["roll"] = "90 deg"
    keys["members"]["arm"]["hinges"][0]["axis"] = "y"
    np.testing.assert_allclose(placed(keys)[0].direction, [0, 0, 1], atol=1e-15)
    keys["members"]["arm"]["hinges"][0]["axis"] = "z"
    np.testing.assert_allclose(placed(keys)[0].direction, [0, -1, 0], atol=1e-15)


def test_bars_put_a_hinge_between_neighbours(keys):
    keys["members"]["arm"]["bars"] = {"number": 4, "law": "constant"}
    hinges = placed(keys)
    assert [hinge.name for hinge in hinges] == ["fold", "arm-1", "arm-2", "arm-3"]
    assert [hinge.station for hinge in hinges[1:]] == [0.25, 0.5, 0.75]
    assert len({id(hinge.law) for hinge in hinges[1:]}) == 1


def test_the_hinge_of_a_cantilever_stands_for_its_triangle_of_moments(keys):
    (hinge,) = placed(keys)
    # the third of its length, for a hinge at the clamp itself
    assert hinge.tributary_length == pytest.approx(1.0 / 3.0 / (1.0 - hinge.station) ** 2)
    keys["members"]["arm"] |= {"bars": 4, "hinges": []}
    # the tributary lengths 3/8, 2/8, 3/8, times what gives the tip of the beam
    expected = np.array([0.375, 0.25, 0.375])
    expected *= 1.0 / 3.0 / (expected @ np.array([0.75, 0.5, 0.25]) ** 2)
    assert [hinge.tributary_length for hinge in placed(keys)] == pytest.approx(expected)


ELASTIC = {"type": "constant", "form": "elastic-plastic"}


def between_clamps(keys, **hinge):
    """The arm between two clamps, with hinges at 0.1 and 0.8 m."""
    keys["supports"]["other"] = {"node": "tip", "fix": "all"}
    keys["members"]["arm"]["hinges"] = [
        {"name": name, "at": at, "law": ELASTIC} | hinge for name, at in (("a", 0.1), ("b", 0.8))
    ]
    return keys


def test_a_member_that_needs_it_gets_an_elastic_joint(keys):
    hinges = placed(between_clamps(keys))
    assert [hinge.name for hinge in hinges] == ["a", "b", "arm elastic"]
    assert [hinge.plastic for hinge in hinges] == [True, True, False]
    stations, lengths = ([getattr(hinge, key) for hinge in hinges] for key in ("station", "tributary_length"))
    for k in range(3):
        assert np.sum(np.array(lengths) * np.array(stations) ** k) == pytest.approx(1.0 / (k + 1))
    rigidity = Structure(**keys).flexural_rigidity("arm", "y")
    for hinge, length in zip(hinges, lengths, strict=True):
        assert hinge.record.elastic_stiffness == pytest.approx(rigidity / length)
    # never reached
    assert hinges[2].record.positive.moment.min() == pytest.approx(
        100.0 * hinges[0].record.positive.moment.max()
    )
    assert [hinge.name for hinge in plastic_hinges(Structure(**keys))] == ["a", "b"]


def test_rigid_forms_and_given_stiffnesses_get_no_joint(keys):
    for law in (
        "constant",
        {"type": "constant", "form": "regularised"},
        ELASTIC | {"elastic_stiffness": 1e4},
    ):
        assert all(hinge.plastic for hinge in placed(between_clamps(keys, law=law)))
    structure = Structure(**between_clamps(keys, law="constant"))
    # but the warning about elastic energy knows where they would be
    assert shares_left_out(structure)["arm"]["y"].joints
    assert not shares_left_out(Structure(**between_clamps(keys)))["arm"]


def test_the_elastic_hinge_of_a_member_stands_for_all_of_it(keys):
    keys = between_clamps(keys)
    keys["members"]["arm"]["hinges"][1]["law"] = "constant"
    first, second, joint = placed(keys)
    assert (joint.name, second.tributary_length) == ("arm elastic", 0.0)
    assert first.tributary_length + joint.tributary_length == pytest.approx(1.0)
    assert second.record.form is Form.SET_VALUED


def test_a_joint_bends_about_the_axes_of_its_hinges(keys):
    hinges = placed(between_clamps(keys, axes=["y", "z"], coupling="none"))
    joint = hinges[-1]
    assert joint.spatial.freedoms == (Freedom.Y, Freedom.Z)
    structure = Structure(**keys)
    for component, axis in zip(joint.spatial.components, "yz", strict=True):
        rigidity = structure.flexural_rigidity("arm", axis)
        assert component.record.elastic_stiffness == pytest.approx(rigidity / joint.tributary_length)


@pytest.mark.parametrize(
    ("more", "joint"),
    [
        ({}, False),
        ({"masses": {"m": {"node": "tip", "mass": 1.0}}}, False),
        ({"masses": {"m": {"node": "tip", "mass": 1.0, "offset": (0.1, 0, 0)}}}, True),
        ({"loads": [{"node": "tip", "force": {"z": 1.0}}]}, False),
        ({"loads": [{"node": "tip", "moment": {"y": 1.0}}]}, True),
        ({"impulses": [{"node": "tip", "angular_impulse": (0.0, 1.0, 0.0)}]}, True),
    ],
)
def test_what_bends_the_end_of_a_cantilever(keys, more, joint):
    keys["members"]["arm"]["hinges"][0]["law"] = ELASTIC
    assert any(not hinge.plastic for hinge in placed(keys | more)) is joint


def test_elastic_stiffness_follows_the_share_of_each_hinge(keys):
    keys["members"]["arm"] |= {"bars": {"number": 4, "law": ELASTIC}, "hinges": []}
    structure = Structure(**keys)
    rigidity = 210e9 * structure.section_of("arm").second_moment("y")
    stiffness = [hinge.record.elastic_stiffness for hinge in placed_hinges(structure)]
    lengths = [hinge.tributary_length for hinge in placed_hinges(structure)]
    assert stiffness == pytest.approx([rigidity / length for length in lengths])
    keys["members"]["arm"]["bars"]["law"]["elastic_stiffness"] = "12 kN*m/rad"
    assert {hinge.record.elastic_stiffness for hinge in placed(keys)} == {12e3}


def test_a_law_by_name_by_type_and_in_place_are_one(keys):
    keys["hinge_laws"] = {"mine": {"type": "kecman", "rolling_weight": 1.0}}
    moments = []
    for law in ("mine", "kecman", {"type": "kecman"}, None):
        keys["members"]["arm"]["hinges"][0]["law"] = law
        moments.append(placed(keys)[0].record.positive.moment)
    for moment in moments[1:]:
        np.testing.assert_array_equal(moment, moments[0])


def test_a_named_law_hides_the_type_of_its_name(keys):
    keys["hinge_laws"] = {"kecman": {"type": "constant", "moment": "1 kN*m"}}
    keys["members"]["arm"]["hinges"][0]["law"] = "kecman"
    assert placed(keys)[0].law.name == "constant"


def test_every_key_of_a_law_reaches_the_record(keys):
    keys["hinge_laws"] = {
        "mine": {
            "type": "constant",
            "moment": "800 N*m",
            "form": "regularised",
            "regularisation": {"rate": "0.1 rad/s"},
            "softening": "accumulated",
            "viscous_damping": "3 N*m*s/rad",
            "stops": {
                "rotation": "60 deg",
                "stiffness": "5 kN*m/rad",
                "exponent": 1.5,
                "penetration": "2 deg",
            },
        }
    }
    keys["members"]["arm"]["hinges"][0]["law"] = "mine"
    record = placed(keys)[0].record
    assert record.form is Form.REGULARISED
    assert record.softening_variable is SofteningVariable.ACCUMULATED
    assert (record.regularisation_rate, record.viscous_damping) == (0.1, 3.0)
    assert set(record.positive.moment) == {800.0}
    stop = record.stop_positive
    assert stop == record.stop_negative or np.isnan(stop.damping)
    assert (stop.rotation, stop.stiffness, stop.exponent) == (pytest.approx(np.pi / 3), 5e3, 1.5)
    assert np.isnan(stop.damping)
    keys["hinge_laws"]["mine"]["stops"]["damping"] = 7.0
    assert placed(keys)[0].record.stop_negative.damping == 7.0


@pytest.mark.parametrize(("stops", "there"), [("law", True), ("none", False), (None, False), (False, False)])
def test_the_stop_of_the_law_can_be_left_out(keys, stops, there):
    law = {"type": "kecman", "after_jamming": "stop", "stops": stops}
    keys["members"]["arm"]["hinges"][0]["law"] = law
    assert (placed(keys)[0].record.stop_positive is not None) is there


def test_the_rate_law_can_be_switched_off(keys):
    keys["materials"]["steel"]["flow_rate"] = {"D": "6844 1/s", "q": 3.91}
    assert np.isfinite(placed(keys)[0].record.rate_reference)
    keys["members"]["arm"]["hinges"][0]["law"] = {"type": "kecman", "rate": "off"}
    assert np.isinf(placed(keys)[0].record.rate_reference)


def test_a_hinge_without_a_law_has_the_formula_of_its_shape(keys):
    keys["members"]["arm"]["section"] = "pipe"
    assert placed(keys)[0].law.name == "circular"
    keys["members"]["arm"]["hinges"][0]["law"] = "constant"
    assert len(hinge_places(Structure(**keys))) == 1


def test_works_that_differ_by_rounding_are_of_one_rotation_of_the_twist():
    """A hat under a pole: two works next to each other gave one rotation twice, which no curve may have."""

    def record(capacity, turn):
        curve = Envelope(np.array([0.0, turn, math.pi]), capacity * np.array([1.0, 0.9, 0.4]))
        return HingeRecord(Form.SET_VALUED, SofteningVariable.PEAK, curve, curve)

    for turn in np.linspace(0.1, 0.3, 41):
        twist, first = record(3.0, turn), 7.0
        # the next number after the work of the twist there
        bending = record(first, np.nextafter(3.0 * turn, 1.0) / first)
        flat = flattened(twist, [bending], 1.5)
        assert np.all(np.diff(flat.positive.rotation) > 0.0)
        assert flat.positive.moment[0] == pytest.approx(3.0)
