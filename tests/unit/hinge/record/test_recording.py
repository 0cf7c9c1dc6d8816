import math
from dataclasses import fields

import numpy as np
import pytest

from crumple.errors import InputError
from crumple.hinge import (
    ConstantLaw,
    Form,
    KecmanLaw,
    SofteningVariable,
    Stop,
    TabulatedLaw,
    record_of,
    tributary_stiffness,
)
from crumple.hinge.axial.axial_collapse import AxialCollapse
from crumple.hinge.record.sampling import sampled_envelope
from crumple.hinge.torsion.plastic import PlasticTorsion
from crumple.material import CowperSymonds, Material
from crumple.section import RectangularTube

STEEL = Material("steel", 210e9, 0.3, 7850.0, 488e6, flow_rate=CowperSymonds(6844.0, 3.91))
TUBE = RectangularTube(0.050, 0.025, 0.00265)


def test_default_record_is_set_valued_and_rigid():
    record = record_of(ConstantLaw(1000.0))
    assert record.form is Form.SET_VALUED
    assert record.softening_variable is SofteningVariable.PEAK
    assert record.elastic_stiffness == math.inf
    assert record.rate_reference == math.inf
    assert record.stop_positive is record.stop_negative is None
    np.testing.assert_array_equal(record.positive.moment, 1000.0)


def test_table_is_kept_point_by_point():
    law = TabulatedLaw([0.0, 0.1, 0.4], [900.0, 1000.0, 500.0], [0.0], [300.0])
    record = record_of(law)
    np.testing.assert_array_equal(record.positive.rotation[:3], [0.0, 0.1, 0.4])
    np.testing.assert_array_equal(record.positive.moment, [900.0, 1000.0, 500.0, 500.0])
    np.testing.assert_array_equal(record.negative.moment, 300.0)


@pytest.mark.parametrize("sense", [1, -1])
@pytest.mark.parametrize(
    "law",
    [
        ConstantLaw(1000.0),
        TabulatedLaw([0.0, 0.1, 0.4, 3.0, 3.3], [900.0, 1000.0, 500.0, 700.0, 100.0], [0.0], [300.0]),
        PlasticTorsion.of(TUBE, STEEL, 0.1),
        AxialCollapse.given(9e3, 4e3, 0.2, tension=8e3, fold=0.03),
    ],
    ids=lambda law: law.name,
)
def test_straight_laws_have_the_points_that_sampling_finds(law, sense):
    class Unsaid(type(law)):
        pass

    unsaid = Unsaid(**{key.name: getattr(law, key.name) for key in fields(law) if key.init})
    found, sampled = sampled_envelope(law, sense), sampled_envelope(unsaid, sense)
    np.testing.assert_array_equal(found.rotation, sampled.rotation)
    np.testing.assert_array_equal(found.moment, sampled.moment)
    assert not found.moment.flags.writeable


def test_a_moment_that_falls_early_needs_few_points():
    """Constant up to 0.04 deg and then as 1/rotation: no more chords than its curvature asks for."""

    class Early(ConstantLaw):
        def kinks(self, sense=1):
            return (7e-4,)

        def moment_capacity(self, rotation, sense=1):
            turned = np.maximum(np.asarray(rotation, float), 1e-300)
            return self.moment * np.minimum(1.0, 7e-4 / turned)

    law = Early(1000.0)
    found = sampled_envelope(law, error=1e-4)
    # chords of equal relative error: log(pi/7e-4)/sqrt(4 error)
    assert found.rotation.size < 1.5 * math.log(math.pi / 7e-4) / math.sqrt(4e-4)
    at = np.geomspace(1e-4, 3.0, 1000)
    np.testing.assert_allclose(
        np.interp(at, found.rotation, found.moment), law.moment_capacity(at), rtol=1e-4
    )


def test_points_grow_with_the_root_of_the_accuracy():
    law = KecmanLaw.of(TUBE, STEEL, after_jamming="hold")
    coarse, fine = (record_of(law, error=error).positive.rotation.size for error in (1e-3, 1e-5))
    assert 6.0 < fine / coarse < 14.0
    assert record_of(law).positive.rotation.size <= 100


class _Counted(ConstantLaw):
    """A law without symmetry, kinked and curved, that counts how often it is asked."""

    calls = 0
    symmetric = False

    def kinks(self, sense=1):
        return (0.2, 0.5, 0.9)

    def moment_capacity(self, rotation, sense=1):
        type(self).calls += 1
        return 1000.0 * (1.0 + sense * 0.1 * np.cos(3.0 * np.asarray(rotation)))


def test_a_law_is_asked_a_few_times_for_many_rotations():
    record = record_of(_Counted(1000.0))
    # twice for each sense, and once more where the first spread of points does not hold
    assert _Counted.calls <= 6
    for sense, envelope in ((1, record.positive), (-1, record.negative)):
        seen = np.linspace(0.0, math.pi, 5000)
        exact = 1000.0 * (1.0 + sense * 0.1 * np.cos(3.0 * seen))
        np.testing.assert_allclose(np.interp(seen, envelope.rotation, envelope.moment), exact, rtol=1e-4)
        assert {0.2, 0.5, 0.9} <= set(envelope.rotation)
        assert not envelope.moment.flags.writeable


def test_elastic_stiffness_is_given_or_the_laws_or_the_tributary_lengths():
    rigidity = STEEL.youngs_modulus * TUBE.second_moment_y
    own = TabulatedLaw([0.0], [500.0], elastic_stiffness=7e3)

    def stiffness(law, **options):
        return record_of(law, form=Form.ELASTIC_PLASTIC, **options).elastic_stiffness

    assert stiffness(own, elastic_stiffness=9e3) == 9e3
    assert stiffness(own, flexural_rigidity=rigidity, tributary_length=0.5) == 7e3
    # one hinge for a cantilever of 1 m loaded at its tip: 3 E I/L
    constant = ConstantLaw(1000.0)
    assert stiffness(constant, flexural_rigidity=rigidity, tributary_length=1 / 3) == pytest.approx(
        3 * rigidity
    )
    assert tributary_stiffness(rigidity, 0.5) == pytest.approx(2 * rigidity)
    # the other forms are rigid whatever is known
    assert record_of(own, form=Form.REGULARISED, elastic_stiffness=9e3).elastic_stiffness == math.inf
    for options in ({}, {"elastic_stiffness": 0.0}, {"elastic_stiffness": float("nan")}):
        with pytest.raises(InputError, match="elastic stiffness"):
            stiffness(constant, **options)


def test_stops_come_from_the_law_or_from_the_caller():
    law = KecmanLaw.of(TUBE, STEEL, after_jamming="stop")
    record = record_of(law)
    assert record.stop_positive == record.stop_negative == law.stop
    assert law.stop.rotation == law.jamming_angle
    # the tube over the length of the fold, 2 h = 25 mm
    assert law.stop.stiffness == pytest.approx(210e9 * TUBE.second_moment_y / 0.025)
    assert math.isnan(law.stop.damping)
    mine = Stop(1.0, 1e4, damping=5.0)
    assert record_of(law, stops=None).stop_positive is None
    assert record_of(law, stops=mine).stop_negative is mine
    assert record_of(law, stops=(None, mine)).stop_positive is None
    with pytest.raises(InputError, match="stops"):
        record_of(law, stops="none")


def test_softening_rate_and_ramp_are_passed_on():
    law = KecmanLaw.of(TUBE, STEEL)
    record = record_of(
        law, softening=SofteningVariable.ROTATION, viscous_damping=2.0, regularisation_rate=0.1
    )
    assert record.softening_variable is SofteningVariable.ROTATION
    assert record.viscous_damping == 2.0
    assert record.regularisation_rate == 0.1
    assert record.rate_reference == pytest.approx(15 * 6844.0)
    assert record.rate_exponent == 3.91
    assert record_of(law, rate=False).rate_reference == math.inf
    with pytest.raises(InputError, match="regularisation"):
        record_of(law, regularisation_rate=0.0)


class _HiddenJump(ConstantLaw):
    def moment_capacity(self, rotation, sense=1):
        return np.where(np.asarray(rotation) < 1.0, 1000.0, 500.0)


def test_a_jump_that_a_law_hides_is_not_smoothed_over():
    with pytest.raises(InputError, match="must report its kinks"):
        record_of(_HiddenJump(1000.0))


class _Fading(ConstantLaw):
    """Capacity that falls in a straight line and is gone from 1 rad on."""

    def kinks(self, sense=1):
        return (1.0,)

    def moment_capacity(self, rotation, sense=1):
        return 1000.0 * np.maximum(1.0 - np.asarray(rotation), 0.0)


class _Gap(ConstantLaw):
    """Capacity without a value at one place, which no first point meets."""

    def moment_capacity(self, rotation, sense=1):
        return np.where(np.abs(np.asarray(rotation) - math.pi / 2.0) < 1e-9, np.nan, 1000.0)


@pytest.mark.parametrize(
    ("law", "came"), [(_Fading(1000.0), "0 N m at 57.3 deg"), (_Gap(1000.0), "nan N m at 90 deg")]
)
def test_a_law_without_capacity_somewhere_is_refused_with_the_place(law, came):
    with pytest.raises(InputError, match="has no capacity") as refusal:
        record_of(law)
    assert came in str(refusal.value)
    assert "fracture" in str(refusal.value)


def test_a_table_that_falls_to_zero_is_refused_with_what_helps():
    with pytest.raises(InputError, match="residual"):
        TabulatedLaw([0.0, 0.5], [1000.0, 0.0])
    with pytest.raises(InputError, match="elastic rise"):
        TabulatedLaw([0.0, 0.5], [0.0, 1000.0])
