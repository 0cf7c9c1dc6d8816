"""Hinges of several components: surfaces through the capacities of their axes, convex; axial collapse."""

import math

import numpy as np
import pytest
from scipy.integrate import trapezoid

from crumple import hinge
from crumple.errors import InputError
from crumple.hinge import (
    AxialCollapse,
    Coupling,
    Form,
    Freedom,
    HingeComponent,
    SofteningVariable,
    Stop,
    build_axial_law,
    build_law,
    build_torsion_law,
    record_of,
    spatial_record,
)
from crumple.hinge.record.sensitivity import capacity_sensitivity
from crumple.material import Material
from crumple.section import (
    CircularTube,
    InteractionFit,
    RectangularTube,
    fitted_interaction,
    plastic_interaction,
)

STEEL = Material("steel", youngs_modulus=210e9, poissons_ratio=0.3, density=7850.0, yield_stress=300e6)
TUBE = RectangularTube(0.08, 0.06, 0.002)
SQUARE = RectangularTube(0.06, 0.06, 0.002)
ROUND = CircularTube(0.06, 0.002)
INTERACTION = fitted_interaction(plastic_interaction(TUBE, STEEL))
AXES = {Freedom.Y: "y", Freedom.Z: "z"}


def bending(freedom, form=Form.SET_VALUED, **options):
    law = build_law("kecman", TUBE, STEEL, AXES[freedom])
    return HingeComponent(freedom, record_of(law, form=form, elastic_stiffness=1e5, **options))


def axial(collapse=None):
    law = collapse or AxialCollapse.given(90e3, 30e3, 0.2, tension=200e3, closed_stiffness=1e7)
    return HingeComponent(Freedom.AXIAL, record_of(law, stops=(None, law.stop)))


def twist():
    law = build_torsion_law("plastic", TUBE, STEEL, 0.5)
    return HingeComponent(Freedom.X, record_of(law))


def all_four():
    return [bending(Freedom.Z), twist(), bending(Freedom.Y), axial()]


def test_components_come_in_one_order():
    record = spatial_record(all_four(), interaction=INTERACTION)
    assert record.freedoms == (Freedom.AXIAL, Freedom.X, Freedom.Y, Freedom.Z)
    assert record.surface.torsion == 1
    assert record.form is Form.SET_VALUED
    assert record.fracture == math.inf


def test_pure_loads_reach_their_capacities():
    surface = spatial_record(all_four(), interaction=INTERACTION).surface
    np.testing.assert_allclose(surface.gauge(np.eye(4)), 1.0, atol=1e-14)
    np.testing.assert_allclose(surface.gauge(-np.eye(4)), 1.0, atol=1e-14)


def test_the_surface_is_that_of_the_walls_within_the_fit():
    """Mirrored rows of a tube that is symmetric anyway change the fit by no more than its error."""
    surface = spatial_record(all_four(), interaction=INTERACTION).surface
    generator = np.random.default_rng(2)
    x = generator.normal(size=(500, 4))
    exact = INTERACTION.gauge(x[:, [0, 2, 3, 1]] * INTERACTION.scales)
    assert np.abs(surface.gauge(x) / exact - 1.0).max() < 2.0 * INTERACTION.error


def test_unequal_senses_stay_convex():
    """Two capacities stretch one half of a mirror-symmetric set."""
    record = spatial_record(all_four(), interaction=INTERACTION)
    force, *_ = (component.record for component in record.components)
    capacity = np.array([[force.positive.moment[0], force.negative.moment[-1]], [1, 1], [1, 1], [1, 1]])
    generator = np.random.default_rng(3)
    flipped = generator.normal(size=(200, 4))
    np.testing.assert_allclose(
        record.surface.gauge(flipped), record.surface.gauge(flipped * [-1, 1, 1, 1]), rtol=1e-12
    )

    def value(tau):
        return record.surface.gauge(tau / np.where(tau >= 0.0, capacity[:, 0], capacity[:, 1]))

    a, b = generator.normal(size=(2, 2000, 4)) * [1e5, 1, 1, 1]
    assert (value((a + b) / 2.0) <= (value(a) + value(b)) / 2.0 + 1e-12).all()


def test_mirrored_rows_are_the_mean_of_the_surface_and_its_image():
    rows = np.array([[1.0, 0.0, 0.0], [0.6, 0.8, 0.1], [0.0, 0.9, 0.3], [0.2, -0.5, 0.9]])
    fit = InteractionFit(np.ones(4), rows, 6.0)
    surface = spatial_record([axial(), bending(Freedom.Y), bending(Freedom.Z)], interaction=fit).surface
    pure = (rows**6).sum(axis=0) ** (1.0 / 6.0)
    x = np.random.default_rng(4).normal(size=(50, 3))
    powers = [(((x * [sign, 1.0, 1.0] / pure) @ rows.T) ** 6).sum(axis=1) for sign in (1.0, -1.0)]
    np.testing.assert_allclose(surface.gauge(x), (np.mean(powers, axis=0)) ** (1.0 / 6.0), rtol=1e-12)


@pytest.mark.parametrize("rows", [16, 24])
def test_rows_of_a_symmetric_section_are_not_doubled(rows):
    """Shortening and lengthening differ, but the image of each row is among them."""
    fit = fitted_interaction(plastic_interaction(TUBE, STEEL), rows=rows)
    record = spatial_record(all_four(), interaction=fit)
    assert len(record.surface.rows) == len(fit.rows)
    x = np.random.default_rng(5).normal(size=(50, 4))
    pure = (np.abs(fit.rows) ** fit.power).sum(axis=0) ** (1.0 / fit.power)
    own = x[:, [0, 2, 3, 1]] / [*pure, 1.0] * fit.scales
    np.testing.assert_allclose(record.surface.gauge(x), fit.gauge(own), rtol=1e-12)


def test_round_tube_bends_about_all_axes_alike():
    fit = fitted_interaction(plastic_interaction(CircularTube(0.05, 0.002), STEEL), rows=16)
    surface = spatial_record(all_four(), interaction=fit).surface
    assert surface.axisymmetric
    assert surface.rows.shape[1] == 2
    x = np.random.default_rng(7).normal(size=(50, 4))
    turned = np.column_stack([x[:, 0], x[:, 1], np.zeros(50), np.hypot(x[:, 2], x[:, 3])])
    np.testing.assert_allclose(surface.gauge(x), surface.gauge(turned), rtol=1e-14)
    # about one axis alone the resultant is the moment about it
    flat = spatial_record([axial(), bending(Freedom.Z)], interaction=fit).surface
    assert not flat.axisymmetric
    np.testing.assert_allclose(
        flat.gauge(turned[:, [0, 3]]), surface.gauge(turned * [1, 0, 1, 1]), rtol=1e-14
    )
    rolled = spatial_record([bending(Freedom.Y), bending(Freedom.Z)], interaction=fit).surface
    assert rolled.coupling is Coupling.ELLIPSOID


def test_equal_rows_are_merged():
    rows = np.array([[0.5, 0.8, 0.1], [-0.5, 0.8, 0.1], [0.5, -0.8, -0.1], [0.2, 0.0, 0.9], [1.0, 0.0, 0.0]])
    fit = InteractionFit(np.ones(4), rows, 6.0)
    surface = spatial_record([bending(Freedom.Y), bending(Freedom.Z)], interaction=fit).surface
    assert len(surface.rows) == 2
    pure = (rows[:, 1:] ** 6).sum(axis=0) ** (1.0 / 6.0)
    x = np.random.default_rng(6).normal(size=(50, 2))
    wanted = (((x / pure) @ rows[:, 1:].T) ** 6).sum(axis=1) ** (1.0 / 6.0)
    np.testing.assert_allclose(surface.gauge(x), wanted, rtol=1e-12)


def test_only_the_columns_of_the_components_count():
    record = spatial_record([bending(Freedom.Y), bending(Freedom.Z)], interaction=INTERACTION)
    assert record.surface.rows.shape[1] == 2
    assert record.surface.torsion == -1
    alone = spatial_record([bending(Freedom.Y)], fracture=0.5)
    assert alone.surface.coupling is Coupling.NONE
    assert alone.fracture == 0.5


def test_gauges_of_the_other_couplings():
    x = np.array([0.6, 0.8])
    for coupling, wanted in ((Coupling.NONE, 0.8), (Coupling.ELLIPSOID, 1.0)):
        record = spatial_record([bending(Freedom.Y), bending(Freedom.Z)], coupling=coupling)
        assert record.surface.gauge(x) == pytest.approx(wanted, abs=1e-15)


@pytest.mark.parametrize(
    ("components", "options", "message"),
    [
        (lambda: [], {}, "one to four"),
        (lambda: [bending(Freedom.Y), bending(Freedom.Y)], {}, "one to four"),
        (lambda: [bending(Freedom.Y), bending(Freedom.Z)], {}, "interaction of the section is not known"),
        (lambda: [bending(Freedom.Y), bending(Freedom.Z, Form.ELASTIC_PLASTIC)], {}, "differ in form"),
        (
            lambda: [bending(Freedom.Y), bending(Freedom.Z, softening=SofteningVariable.ROTATION)],
            {},
            "differ in softening",
        ),
        (
            lambda: [bending(Freedom.Y), bending(Freedom.Z)],
            {"coupling": Coupling.TENSION_FLANGE},
            "one bending axis",
        ),
        (lambda: [bending(Freedom.Y), axial()], {"coupling": Coupling.TENSION_FLANGE}, "arm"),
        (lambda: [bending(Freedom.Y), bending(Freedom.Z)], {"coupling": Coupling.BALL}, "one curve"),
        (lambda: [bending(Freedom.Y)], {"fracture": 0.0}, "fracture must be positive"),
        (lambda: [bending(Freedom.Y)], {"fracture": math.nan}, "fracture must be positive"),
    ],
)
def test_what_does_not_fit_is_refused(components, options, message):
    with pytest.raises(InputError, match=message):
        spatial_record(components(), **options)


def test_axial_collapse_keeps_the_energy_of_its_mean():
    law = AxialCollapse.of(build_axial_law("square", SQUARE, STEEL), 0.4, tension=150e3, closed_stiffness=1e7)
    u = np.linspace(0.0, law.stroke, 200_001)
    work = trapezoid(law.moment_capacity(u, -1), u)
    crushing = build_axial_law("square", SQUARE, STEEL)
    assert work == pytest.approx(crushing.mean_crushing_force * crushing.effective_stroke * 0.4, rel=1e-6)
    assert law.moment_capacity(np.zeros(1), -1)[0] == pytest.approx(crushing.peak_force)
    assert (law.moment_capacity(u, 1) == 150e3).all()
    # then the folds close until a tenth of the length is left
    assert law.stop == Stop(0.9 * 0.4, 1e7)
    at = np.array([law.stroke, 0.8 * 0.4, 0.9 * 0.4])
    wanted = law.mean * (1.0 + 10.0 * (at - law.stroke) / 0.4)
    np.testing.assert_allclose(law.moment_capacity(at, -1), wanted, rtol=1e-12)


@pytest.mark.parametrize("name", ["square", "superfolding", "circular"])
def test_every_fold_takes_the_same_work(name):
    crushing = build_axial_law(name, ROUND if name == "circular" else SQUARE, STEEL)
    law = AxialCollapse.of(crushing, 0.4, tension=150e3)
    # without the corners of the folds that close
    at, force = (part[:-2] for part in law.points)
    # the rise after the first fold has its end in the middle
    fold = 2.0 * crushing.half_fold_length * crushing.effective_stroke
    assert (at[-1] + at[-2]) / 2.0 == pytest.approx(fold)
    u = np.linspace(0.0, at[-1], 200_001)
    work = trapezoid(law.moment_capacity(u, -1), u)
    assert work == pytest.approx(law.mean * at[-1], rel=1e-6)
    # walls turn by t = sqrt(u/H) with constant moments, from the shortening at which they stop yielding
    assert force[0] == law.peak
    assert force[1] == pytest.approx(0.95 * law.peak)
    np.testing.assert_allclose(np.array(force[1:-1]) * np.sqrt(at[1:-1]), force[1] * math.sqrt(at[1]))
    assert force[-1] == law.mean
    # a column of one fold at most never rises before it closes
    short = AxialCollapse.of(crushing, crushing.half_fold_length, tension=150e3)
    assert short.points[0][-2] == pytest.approx(short.stroke)
    assert (np.diff(short.points[1][:-1]) <= 0.0).all()
    slope = 16.0 if name == "circular" else 10.0
    closed = short.points[1][-2] + slope * short.mean * (0.9 - crushing.effective_stroke)
    assert short.points[1][-1] == pytest.approx(closed)


def test_axial_collapse_limits():
    constant = AxialCollapse.given(50e3, 50e3, 0.1)
    np.testing.assert_allclose(constant.moment_capacity(np.linspace(0, 1, 11), -1), 50e3)
    assert AxialCollapse.given(60e3, 50e3, 0.1, closed_stiffness=1e6).stop == Stop(0.1, 1e6)
    whole = build_axial_law("superfolding", SQUARE, STEEL, crush_distance="full")
    full = AxialCollapse.of(whole, 0.4, tension=150e3, closed_stiffness=1e6)
    assert full.stop == Stop(0.4, 1e6)
    assert full.points[1][-1] == full.mean
    endless = AxialCollapse.given(50e3, 50e3, math.inf, closed_stiffness=1e6)
    assert endless.stop is None
    assert endless.kinks(-1) == ()
    folding = AxialCollapse.given(50e3, 50e3, 0.1, fold=0.02)
    np.testing.assert_allclose(folding.moment_capacity(np.linspace(0, 1, 11), -1), 50e3)
    high = AxialCollapse.given(1e6, 20e3, 0.1)
    u = np.linspace(0.0, 0.1, 100_001)
    assert trapezoid(high.moment_capacity(u, -1), u) == pytest.approx(20e3 * 0.1, rel=1e-6)
    record = record_of(high, stops=(None, high.stop))
    assert (record.negative.moment > 0.0).all()


@pytest.mark.parametrize(
    ("numbers", "message"),
    [
        ((1e4, 2e4, 0.1), "above the peak"),
        ((-1.0, 1.0, 0.1), "peak must be positive"),
        ((1e4, 1e3, 0.0), "stroke"),
    ],
)
def test_axial_numbers_that_make_no_sense_are_refused(numbers, message):
    with pytest.raises(InputError, match=message):
        AxialCollapse.given(*numbers)


def test_plastic_torque_is_that_of_the_section():
    law = build_torsion_law("plastic", TUBE, STEEL, 0.5)
    width, depth, wall = 0.078, 0.058, 0.002
    bredt = 2.0 * width * depth * wall * 300e6 / math.sqrt(3.0)
    assert law.steady_torque == pytest.approx(bredt, rel=1e-9)
    assert law.elastic_stiffness == pytest.approx(STEEL.shear_modulus * TUBE.torsion_constant / 0.5)
    assert build_torsion_law("plastic", TUBE, STEEL, 0.5, torque=100.0).steady_torque == 100.0
    with pytest.raises(InputError, match="torque must be positive"):
        build_torsion_law("plastic", TUBE, STEEL, 0.5, torque=-1.0)


def test_sensitivity_of_a_capacity_to_yield_stress_and_wall():
    """Plastic moment: proportional to the yield stress; over the wall the formula's own derivative."""

    def of_yield(stress):
        steel = Material(
            "steel", youngs_modulus=210e9, poissons_ratio=0.3, density=7850.0, yield_stress=stress
        )
        return build_law("constant", TUBE, steel, "y")

    slope = capacity_sensitivity(of_yield, 300e6, np.array([0.0, 0.3]))
    moment = of_yield(300e6).moment_capacity(np.zeros(2))
    np.testing.assert_allclose(slope, moment / 300e6, rtol=1e-8)

    def of_wall(wall):
        return build_law("constant", RectangularTube(0.08, 0.06, wall), STEEL, "y")

    a, b, t = 0.08, 0.06, 0.002
    # s_y (a b^2 - (a - 2t) (b - 2t)^2)/4
    exact = 300e6 * ((b - 2 * t) ** 2 * 2 + (a - 2 * t) * 4 * (b - 2 * t)) / 4.0
    assert capacity_sensitivity(of_wall, t, np.zeros(1))[0] == pytest.approx(exact, rel=1e-7)
    assert hinge.spatial_record is spatial_record
