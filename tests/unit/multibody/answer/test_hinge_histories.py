"""Names, units and senses of a hinge's channels, and the energy ledger, from a kernel's records."""

from dataclasses import dataclass
from types import SimpleNamespace

import numpy as np
import pytest
from tests.support.multibody.frames import member, structure

from crumple._core.records import ComponentRecord, EnergyRecord, HingeEnergyRecord, HingeSummary
from crumple.multibody import Run, solve_multibody
from crumple.multibody.answer.hinge_histories import RecordedHinge, hinge_columns, ledger
from crumple.multibody.spatial.off_dead_centres import with_held_moments
from crumple.result.channels import channel

TIMES, COMPONENTS, HINGES = 3, 4, 2
HINGE = SimpleNamespace(name="root", plastic=True)


@dataclass(frozen=True)
class Rows:
    hinge: ComponentRecord
    hinge_energy: HingeEnergyRecord
    energy: EnergyRecord


@pytest.fixture(name="rows")
def _rows():
    rng = np.random.default_rng(2)

    def filled(kind, *shape):
        return kind(**{name: rng.normal(size=shape) for name in kind.__dataclass_fields__})

    return Rows(
        filled(ComponentRecord, TIMES, COMPONENTS),
        filled(HingeEnergyRecord, TIMES, HINGES),
        filled(EnergyRecord, TIMES),
    )


def columns(rows, free, first=0, sign=1.0):
    ((_, _, found),) = hinge_columns([RecordedHinge(HINGE, free, first, sign)], rows)
    return found


def units(found):
    return {name: channel(f"hinge.root.{name}", values).unit for name, values in found.items()}


def test_one_rotation_is_plain_and_in_the_hinges_own_sense(rows):
    found = columns(rows, (4,), first=2, sign=-1.0)
    assert units(found) == {
        "rotation": "rad", "rotation_rate": "rad/s", "plastic_rotation": "rad", "moment": "N*m",
        "capacity": "N*m", "energy": "J",
    }  # fmt: skip
    for name, kernel in (
        ("rotation", "rotation"), ("rotation_rate", "rate"), ("plastic_rotation", "plastic"),
        ("moment", "moment"),
    ):  # fmt: skip
        np.testing.assert_array_equal(found[name], -getattr(rows.hinge, kernel)[:, 2])
    # a capacity has no sense
    np.testing.assert_array_equal(found["capacity"], rows.hinge.capacity[:, 2])
    np.testing.assert_array_equal(found["energy"], rows.hinge_energy.dissipated[:, 0])


def test_axial_components_have_names_and_units_of_their_own(rows):
    found = columns(rows, (0, 4, 5))
    axial = {name: unit for name, unit in units(found).items() if name.startswith("slip")}
    assert axial == {
        "slip.x.travel": "m", "slip.x.rate": "m/s", "slip.x.plastic_travel": "m", "slip.x.force": "N",
        "slip.x.capacity": "N",
    }  # fmt: skip
    np.testing.assert_array_equal(found["slip.x.force"], rows.hinge.moment[:, 0])
    np.testing.assert_array_equal(found["moment.z"], rows.hinge.moment[:, 2])
    # lengths are those of the rotations alone
    np.testing.assert_allclose(found["moment"], np.linalg.norm(rows.hinge.moment[:, 1:3], axis=1))


def test_the_only_rotation_of_a_hinge_that_also_slips_has_its_sign(rows):
    found = columns(rows, (0, 4), sign=-1.0)
    for name, kernel in (("rotation", "rotation"), ("rotation_rate", "rate"), ("moment", "moment")):
        np.testing.assert_array_equal(found[name], -getattr(rows.hinge, kernel)[:, 1])
        np.testing.assert_array_equal(found[f"{name}.y"], found[name])


def test_a_hinge_that_only_slips_does_not_turn(rows):
    found = columns(rows, (0,))
    np.testing.assert_array_equal(found["slip.x.travel"], rows.hinge.rotation[:, 0])
    assert not found["rotation"].any()


def test_the_ledger_adds_up(rows):
    found = ledger(rows, touched=True, slowed=True)
    kept = sum(values for name, values in found.items() if name != "external_work")
    energy = vars(rows.energy)
    everything = sum(values for name, values in energy.items() if name != "external_work")
    np.testing.assert_allclose(kept, everything)
    np.testing.assert_array_equal(found["dissipated"], rows.hinge_energy.dissipated.sum(axis=1))
    assert {"contact", "friction", "damping"} <= set(found)
    assert not {"contact", "friction", "damping"} & set(ledger(rows))


def test_the_largest_moment_is_the_length_of_the_vector_that_the_channel_has():
    # thrown about both axes: each component is less than the vector
    both = {"axis": None, "axes": ("y", "z")}
    thrown = [{"rotation": 10.0, "axis": (0.0, 1.0, 1.0)}]
    bar = structure(members={"ab": member("a", "b", ("h", "a", both))}, initial_velocity=thrown)
    result = solve_multibody(bar, Run(0.02, 1e-3))
    hinge, channels = result.hinges["h"], [result[f"hinge.h.moment{end}"] for end in ("", ".y", ".z")]
    whole, *parts = (np.abs(values).max() for values in channels)
    assert hinge.moment_max == pytest.approx(whole, rel=1e-3)
    assert hinge.moment_max > 1.1 * max(parts)
    assert hinge.rotation_max == pytest.approx(np.abs(result["hinge.h.rotation"]).max(), rel=1e-3)


@dataclass(frozen=True)
class Held:
    hinge: ComponentRecord
    summary: HingeSummary
    joint_force: np.ndarray


def test_the_moment_that_holds_a_hinge_at_a_dead_centre_is_added_as_a_vector():
    none, held = np.zeros((1, 2)), np.zeros((1, 2, 6))
    moment, held[0, 1, 5] = np.array([[30.0, 0.0]]), -40.0
    record = Held(
        ComponentRecord(none, none, none, moment, np.full((1, 2), 500.0)),
        HingeSummary(*(np.array([30.0]) for _ in HingeSummary.__dataclass_fields__)),
        held,
    )
    linkage = SimpleNamespace(connections=[SimpleNamespace(hinge=HINGE, free=(4, 5))])
    found = with_held_moments(record, linkage, SimpleNamespace(component_offsets=[0, 2]), {0: 1})
    np.testing.assert_array_equal(found.hinge.moment, [[30.0, 40.0]])
    assert found.summary.moment_max == pytest.approx([50.0])
