"""A structure is frozen plain data; what follows from it is right."""

import pickle

import numpy as np
import pytest
from pydantic import ValidationError

from crumple.errors import InputError
from crumple.material import CowperSymonds, JohnsonCook, Material
from crumple.section import CircularTube, RectangularTube
from crumple.structure import (
    FrozenMapping,
    Hinge,
    MaterialSpec,
    Member,
    MultibodySettings,
    Structure,
    Support,
)
from crumple.structure.schema.problems import DECIMAL_POINT


def test_quantities_with_units_and_plain_si_numbers_are_one(keys):
    with_units = Structure(**keys)
    keys["sections"]["tube"] |= {"width": 0.05, "depth": 0.025, "thickness": 0.00265}
    keys["materials"]["steel"] |= {"youngs_modulus": 210e9, "density": 7850, "yield_stress": 488e6}
    assert Structure(**keys) == with_units
    assert with_units.section_of("arm") == RectangularTube(0.05, 0.025, 0.00265)


def test_parts_may_be_objects_of_their_rooms(keys):
    steel = Material("any", 2e11, 0.3, 7850.0, 3e8, 4e8, 3.5e8, CowperSymonds(40.4, 5.0))
    keys["materials"]["steel"] = steel
    keys["sections"] = {"tube": RectangularTube(0.05, 0.025, 0.00265), "pipe": CircularTube(0.04, 0.002)}
    keys["members"]["arm"] = Member(nodes=("root", "tip"), section="tube", material="steel")
    structure = Structure(**keys)
    made = structure.material_of("arm")
    assert made.name == "steel"
    assert (made.flow_stress, made.ultimate_stress, made.flow_rate) == (3.5e8, 4e8, None)
    assert made.yield_rate == CowperSymonds(40.4, 5.0)
    assert structure.sections["pipe"].section() == CircularTube(0.04, 0.002)


def test_a_metal_with_every_curve_makes_the_round_trip(keys):
    """From a file's keys to the physics room and back through a Material."""
    rate = {"type": "johnson-cook", "C": 0.014, "reference": "2 1/s"}
    curves = [
        {"type": "swift", "prestrain": 0.002, "exponent": 0.12},
        {"type": "voce", "saturation": "150 MPa", "strain": 0.05},
        {"type": "table", "plastic_strain": [0.0, 0.1], "true_stress": ["488 MPa", "600 MPa"]},
    ]
    for curve in curves:
        keys["materials"]["steel"] |= {"flow_rate": rate, "hardening": curve, "failure_strain": 0.35}
        metal = Structure(**keys).material_of("arm")
        assert metal.flow_rate == JohnsonCook(0.014, 2.0)
        assert metal.hardening.stress(0.0) == pytest.approx(488e6)
        assert metal.hardening.stress(0.1) > 530e6
        assert metal.failure_strain == 0.35
        again = MaterialSpec.model_validate(metal).material(metal.name)
        assert again == metal


def hardening(*stresses):
    return {"hardening": {"type": "table", "plastic_strain": [0.0, 0.1], "true_stress": list(stresses)}}


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (hardening("300 MPa", "400 MPa"), "does not begin at the yield stress"),
        (hardening("488 MPa"), "as many stresses as strains"),
        ({"hardening": {"type": "swift", "prestrain": 0.0, "exponent": 0.1}}, "out of range"),
        ({"hardening": {"type": "ludwik"}}, "table, swift, voce"),
        ({"flow_rate": {"type": "johnson-cook", "C": -0.1}}, "out of range"),
        ({"flow_rate": {"D": "40 1/s"}}, "missing"),
        ({"failure_strain": 0.0}, "out of range"),
    ],
)
def test_a_metal_that_cannot_be_is_refused(keys, change, words):
    keys["materials"]["steel"] |= change
    with pytest.raises(InputError, match=words):
        Structure(**keys)


def test_a_structure_is_frozen_hashable_and_travels(keys):
    structure = Structure(**keys)
    with pytest.raises(ValidationError, match="frozen"):
        structure.gravity = (0, 0, 1)
    with pytest.raises(TypeError, match="frozen"):
        structure.nodes["new"] = (0, 0, 0)
    with pytest.raises(TypeError, match="frozen"):
        structure.members.update(a=1)
    with pytest.raises(InputError, match="no node 'root'"):
        structure.model_copy(update={"nodes": {}})
    again = pickle.loads(pickle.dumps(structure))
    assert again == structure
    assert hash(again) == hash(structure)


@pytest.mark.parametrize("change", ["clear", "popitem", "setdefault", "pop", "__delitem__", "__ior__"])
def test_a_frozen_mapping_refuses_every_change(change):
    mapping = FrozenMapping({"a": 1})
    arguments = {"clear": (), "popitem": (), "__ior__": ({"b": 2},)}.get(change, ("a",))
    with pytest.raises(TypeError, match="frozen"):
        getattr(mapping, change)(*arguments)
    assert dict(mapping) == {"a": 1}


def test_every_mistake_is_reported_at_once_with_its_path(keys):
    keys["sections"]["tube"]["width"] = "50 kg"
    keys["members"]["arm"]["rol"] = "90 deg"
    keys["materials"]["steel"]["poissons_ratio"] = 0.5
    with pytest.raises(InputError) as refusal:
        Structure(**keys)
    where = {problem.where for problem in refusal.value.problems}
    assert where == {"sections.tube.width", "members.arm.rol", "materials.steel.poissons_ratio"}
    misspelt = next(p for p in refusal.value.problems if p.where == "members.arm.rol")
    assert misspelt.todo == "did you mean 'roll'?"


def test_what_a_decimal_comma_leaves_of_a_number_is_named(keys):
    # width: 50,5 mm
    keys["sections"]["tube"] |= {"width": 50, "5 mm": None}
    with pytest.raises(InputError) as refusal:
        Structure(**keys)
    rest = next(p for p in refusal.value.problems if p.where == "sections.tube.5 mm")
    assert rest.todo == DECIMAL_POINT


def test_commas_in_lists_and_words_that_begin_with_a_number(keys):
    # tip: [0,5 m, 0 m, 0 m]
    node = next(iter(keys["nodes"]))
    keys["nodes"][node] = [0, "5 m", "0 m", "0 m"]
    with pytest.raises(InputError) as refusal:
        Structure(**keys)
    assert next(p for p in refusal.value.problems if p.where == f"nodes.{node}").todo == DECIMAL_POINT
    keys["nodes"][node] = ["1 m", "5 m", "0 m", "0 m"]
    with pytest.raises(InputError, match="remove what is too much"):
        Structure(**keys)
    keys["nodes"][node] = ["1 m", "0 m", "0 m"]
    keys["hinge_laws"] = {"k": {"type": "kecman", "stops": "30 deg"}}
    with pytest.raises(InputError) as refusal:
        Structure(**keys)
    assert "decimal point" not in str(refusal.value)


def test_a_misspelt_key_is_one_mistake_not_two():
    with pytest.raises(InputError) as refusal:
        Member(nodes=("a", "b"), sektion="s", material="m")
    assert [problem.what for problem in refusal.value.problems] == ["unknown key 'sektion'"]


def test_supports_hold_what_they_name_and_drive_the_rest():
    assert Support(node="a", fix="pin").held == ("x", "y", "z")
    driven = Support(node="a", fix="all", motion={"z": {"step": {"x0": 0, "h0": 0, "x1": 1, "h1": 0.1}}})
    assert driven.held == ("x", "y", "rx", "ry", "rz")
    assert float(driven.driven["z"](2.0)) == 0.1
    assert Support(node="a", fix="x").held == ("x",)
    for wrong in ({"fix": ()}, {"fix": "alll"}, {"fix": ["x", 3]}, {"fix": ["x"], "motion": {"x": 0}}):
        with pytest.raises(InputError):
            Support(node="a", **wrong)


def test_bars_may_be_a_plain_number():
    arm = {"nodes": ("a", "b"), "section": "s", "material": "m"}
    assert Member(**arm, bars=4) == Member(**arm, bars={"number": 4})
    for wrong in (0, 2.5, True, 10_001):
        with pytest.raises(InputError):
            Member(**arm, bars=wrong)


@pytest.mark.parametrize(
    ("at", "meant"), [("root", "root"), ("300 mm", 0.3), (0.3, 0.3), ("1e-1 m", 0.1), ("12", "12")]
)
def test_a_hinge_is_at_a_node_or_at_a_distance(at, meant):
    assert Hinge(name="h", at=at).at == meant
    with pytest.raises(InputError, match="unit of a time"):
        Hinge(name="h", at="3a")


@pytest.mark.parametrize("name", ["", "a b", "a.b", "x" * 65, "ü/ö", 1.5, None, True])
def test_names_are_words(name):
    with pytest.raises(InputError):
        Hinge(name=name, at="root")


def test_numbers_are_names_too():
    assert Member(nodes=(1, "2"), section="s", material="m").nodes == ("1", "2")


def test_a_structure_takes_the_numbers_of_numpy(keys):
    one, two = np.int64(1), np.float32(2.0)
    keys["nodes"] = {"root": (np.int64(0), 0, 0), "tip": (one, 0, 0)}
    keys["members"]["arm"]["bars"] = np.int64(3)
    curve = {"rotation": [np.int64(0), np.float64(0.5)], "moment": [two, two], "units": {"moment": "kN*m"}}
    keys["members"]["arm"]["hinges"][0]["law"] = {"type": "table", **curve}
    keys["loads"] = [{"node": "tip", "force": {"z": two}}]
    structure = Structure(**keys)
    assert structure.nodes["tip"] == (1.0, 0.0, 0.0)
    assert structure.members["arm"].bars.number == 3
    assert structure.members["arm"].hinges[0].law.moment == (2e3, 2e3)
    assert float(structure.loads[0].force.z(0.0)) == 2.0
    keys["members"]["arm"]["bars"] = {"number": np.int64(3)}
    assert Structure(**keys) == structure
    assert Structure.model_validate_json(structure.model_dump_json()) == structure


def test_the_smallest_step_is_below_the_largest():
    with pytest.raises(InputError, match="the smallest time step is above the largest"):
        MultibodySettings(minimum_time_step=1e-2)
    assert MultibodySettings(minimum_time_step=1e-4, maximum_time_step=1e-4).maximum_time_step == 1e-4


def test_contradictory_keys_and_fields_that_move_nothing_are_refused(keys):
    name = next(iter(keys["members"]))
    keys["members"][name] |= {"rigid": True, "elastic": True}
    keys["initial_velocity"] = [{"nodes": [], "translation": (0.0, 0.0, 1.0)}]
    with pytest.raises(InputError) as refusal:
        Structure(**keys)
    found = {problem.where: problem.what for problem in refusal.value.problems}
    assert found[f"members.{name}.elastic"] == "the member is rigid and elastic"
    assert found["initial_velocity[0].nodes"] == "it moves nothing"
