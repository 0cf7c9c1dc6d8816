"""The hinge of several components: convex, dissipative, on its surface, its tangent and potential true."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import trapezoid
from tests.support.multibody.hinge_rig import (
    ABOUT_Y,
    ABOUT_Z,
    ACCUMULATED,
    AXIAL,
    BALL,
    ELASTIC_PLASTIC,
    ELLIPSOID,
    NONE,
    PEAK,
    REGULARISED,
    ROTATION,
    SECTION,
    SET_VALUED,
    TENSION_FLANGE,
    TORSION,
    component,
    hinge,
    rig,
)

from crumple._core import _kernels

FALLING = ([0.0, 0.5, 1.0], [100.0, 60.0, 50.0])
WEAKER = ([0.0, 0.5, 1.0], [70.0, 30.0, 20.0])
SHIFTED = "shifted"
SHIFT = {"shift_rotation": [0.0, 0.2, 1.0], "shift_share": [-0.2, -0.5, -0.4], "driver": 0}
"""Of an ellipsoid whose centre moves along its component 1."""
STIFFNESS = (4e3, 3e3, 5e3, 2e3)
MIRRORED = [[0.9, 0.5, 0.3, 0.0], [0.6, -0.8, 0.5, 0.0], [0.2, 0.6, -0.9, 0.0], [0.5, 0.2, 0.8, 0.0]]
ROWS = np.array([np.array(row) * [a, b, 1, 1] for row in MIRRORED for a in (1, -1) for b in (1, -1)])
H = 1e-3


def made(form, coupling, n, softening=PEAK, **more):
    freedoms = [ABOUT_Y, ABOUT_Z, TORSION] if coupling == BALL else [AXIAL, ABOUT_Y, ABOUT_Z, TORSION]
    parts = [
        component(
            freedom,
            FALLING,
            WEAKER if coupling != BALL else None,
            elastic_stiffness=STIFFNESS[i] if form == ELASTIC_PLASTIC else np.inf,
            **more,
        )
        for i, freedom in enumerate(freedoms[:n])
    ]
    if coupling == SHIFTED:
        parts[1] |= SHIFT
        coupling = ELLIPSOID
    extra = {"arm": 0.5} if coupling == TENSION_FLANGE else {}
    if coupling == SECTION:
        extra = {"rows": ROWS[:, :n].ravel().tolist(), "power": 6.0, "torsion": 3 if n == 4 else -1}
    return hinge(*parts, form=form, softening=softening, coupling=coupling, **extra)


KINDS = [
    (NONE, 1),
    (NONE, 3),
    (ELLIPSOID, 2),
    (ELLIPSOID, 4),
    (BALL, 3),
    (SECTION, 3),
    (SECTION, 4),
    (TENSION_FLANGE, 2),
    (SHIFTED, 3),
    (SHIFTED, 4),
]
CASES = [
    (form, coupling, n)
    for form in (SET_VALUED, ELASTIC_PLASTIC, REGULARISED)
    for coupling, n in KINDS
    if form != REGULARISED or coupling not in (TENSION_FLANGE, SHIFTED)
]
LATE = {SET_VALUED: [0.5], ELASTIC_PLASTIC: [0.5, 0.8], REGULARISED: [0.5]}
"""Weights of the end of a step by form: only elastic hinges know them."""
LATE_CASES = [(form, coupling, n, late) for form, coupling, n in CASES for late in LATE[form]]
rates = st.lists(st.floats(-3.0, 3.0), min_size=4, max_size=4)


@pytest.mark.parametrize(("form", "coupling", "n", "late"), LATE_CASES)
@given(led=st.tuples(rates, rates, rates))
def test_response_is_the_gradient_of_a_convex_potential(form, coupling, n, late, led):
    before, start, end = led
    stops = {"stop_positive": [1e-3, 1e4, 1.0, 3.0, 0.0], "stop_negative": [1e-3, 1e4, 1.5, 3.0, 0.0]}
    element = rig(made(form, coupling, n, viscous_damping=0.3, **stops))
    element.led(0.05, before[:n])
    element.element.freeze(0.02, start[:n], end[:n], late)
    element.element.widen(1.0)
    ends = np.array([start[:n], end[:n]]) + 1e-2
    (p0, _, phi0), (p1, t1, phi1) = (element.element.respond(w.tolist()) for w in ends)
    way = ends[1] - ends[0]
    slack = 1e-12 * (abs(phi0) + abs(phi1) + 1.0)
    # the potential lies above its tangents, so it is convex and its gradient the impulse
    assert phi1 - phi0 >= np.dot(p0, way) - slack
    assert phi0 - phi1 >= -np.dot(p1, way) - slack
    tangent = np.reshape(t1, (n, n))
    np.testing.assert_allclose(tangent, tangent.T, atol=1e-12 * np.abs(tangent).max())
    assert np.linalg.eigvalsh((tangent + tangent.T) / 2).min() >= -1e-9 * np.abs(tangent).max()


@pytest.mark.parametrize(("form", "coupling", "n", "late"), LATE_CASES)
def test_tangent_and_potential_against_differences(form, coupling, n, late):
    generator = np.random.default_rng(17)
    good = 0
    for _ in range(40):
        element = rig(made(form, coupling, n, viscous_damping=0.3))
        element.led(0.05, generator.normal(size=n))
        start, w = generator.normal(size=n), generator.normal(size=n) * 3.0
        element.element.freeze(0.02, start.tolist(), w.tolist(), late)
        element.element.widen(1.0)
        impulse, tangent, _ = element.element.respond(w.tolist())
        slope, force = np.zeros((n, n)), np.zeros(n)
        for k, d in enumerate(np.eye(n) * 1e-6):
            up, down = element.element.respond((w + d).tolist()), element.element.respond((w - d).tolist())
            slope[:, k] = (np.array(up[0]) - down[0]) / 2e-6
            force[k] = (up[2] - down[2]) / 2e-6
        np.testing.assert_allclose(force, impulse, atol=1e-6 * np.abs(impulse).max())
        # a kink within the difference is no error of the tangent
        good += np.abs(slope - np.reshape(tangent, (n, n))).max() <= 1e-5 * np.abs(tangent).max()
    assert good >= 38


@pytest.mark.parametrize("coupling", [ELLIPSOID, BALL, SECTION, TENSION_FLANGE, SHIFTED])
@given(w=rates, other=rates)
def test_flow_is_normal_to_the_surface_and_dissipates(coupling, w, other):
    """tau.w >= tau'.w for every tau' that the hinge can carry: associated flow, and dissipation >= 0."""
    n = {TENSION_FLANGE: 2, BALL: 3}.get(coupling, 4)
    w, other = np.array(w[:n]), np.array(other[:n])
    element = rig(made(SET_VALUED, coupling, n))
    element.led(0.1, w if w.any() else 1.0)
    element.element.freeze(H, [0.0] * n, w.tolist())
    tau, tau_other = (np.array(element.element.law(v.tolist())[0]) / H for v in (w, other))
    assert tau @ w >= 0.0
    assert tau @ w >= tau_other @ w - 1e-6 * (1.0 + abs(tau @ w))


@pytest.mark.parametrize("coupling", [NONE, ELLIPSOID, SECTION])
@pytest.mark.parametrize("form", [SET_VALUED, ELASTIC_PLASTIC, REGULARISED])
def test_pure_loads_reach_the_capacities_of_their_axes(form, coupling):
    """Led about one axis, the other components free of load: the curve of that axis, in both senses."""
    for k in range(4):
        for sense, curve in ((1.0, FALLING), (-1.0, WEAKER)):
            constants = made(form, coupling, 4)
            if coupling == SECTION:
                # one row per axis: the surface passes through 1 on each
                constants |= {"rows": np.diag([1.0, 1.0, 1.0, 0.0]).ravel().tolist()}
            element = rig(constants)
            rate = sense * np.eye(4)[k]
            for _ in range(300):
                element.led(H, rate)
            state = element.state
            wanted = sense * np.interp(abs(state["plastic"][k]), *curve) * np.eye(4)[k]
            np.testing.assert_allclose(state["moment"], wanted, atol=2e-3 * abs(wanted).max())


@pytest.mark.parametrize(
    ("form", "coupling", "late"),
    [
        (form, coupling, late)
        for form in (SET_VALUED, ELASTIC_PLASTIC, REGULARISED)
        for coupling in (NONE, ELLIPSOID, SECTION, TENSION_FLANGE, BALL, SHIFTED)
        for late in LATE[form]
        # the kernel refuses both of these as regularised hinges
        if form != REGULARISED or coupling not in (TENSION_FLANGE, SHIFTED)
    ],
)
@pytest.mark.parametrize("softening", [PEAK, ROTATION, ACCUMULATED])
def test_energy_is_balanced_through_cycles(form, coupling, late, softening):
    """Led to and fro at changing rates, what is put in is what is stored and what is lost, term by term."""
    n = 2
    stops = {"stop_positive": [0.25, 4e3, 1.5, 3.0, 0.01], "stop_negative": [0.3, 4e3, 1.0, 0.0, 0.0]}
    element = rig(made(form, coupling, n, softening, viscous_damping=0.5, **stops), late=late)
    lost = 0.0
    for i in range(400):
        t = i * 5e-3
        element.led(5e-3, np.array([np.cos(3.0 * t), np.sin(2.0 * t)]))
        now = element.state["dissipated"]
        assert now >= lost - 1e-12
        lost = now
    assert lost > 10.0
    assert element.energy == pytest.approx(0.0, abs=1e-10 * lost)


def test_locked_hinge_carries_the_load_and_creeps_no_more_than_the_ramp():
    element = rig(made(SET_VALUED, ELLIPSOID, 3), inertia=2.0)
    load = np.array([40.0, -30.0, 20.0])
    for _ in range(20):
        element.step(1e-3, load)
    np.testing.assert_allclose(element.state["moment"], load, rtol=1e-9)
    assert np.abs(element.q).max() < 1e-8 * 0.02
    assert not element.state["sliding"]


def test_swing_of_an_elastic_hinge_keeps_its_energy():
    element = rig(made(ELASTIC_PLASTIC, ELLIPSOID, 3), inertia=1.0, w=[0.3, -0.2, 0.25])
    start = element.energy
    for _ in range(500):
        element.step(2e-3)
    assert element.state["dissipated"] == pytest.approx(0.0, abs=1e-12 * start)
    assert element.energy == pytest.approx(start, rel=1e-12)


@pytest.mark.parametrize("form", [SET_VALUED, ELASTIC_PLASTIC])
def test_a_shifted_set_keeps_the_capacity_about_every_axis_alone(form):
    """Flow along the normals of ((M_n + c)/A)^2 + (M_u/B)^2 + (M_t/T)^2 = 1 at its points on the axes."""
    closing, opening, aside, twist, share = 50.0, 90.0, 80.0, 60.0, 0.4
    parts = [
        component(freedom, *capacity, elastic_stiffness=1e7 if form == ELASTIC_PLASTIC else np.inf)
        for freedom, capacity in ((ABOUT_Y, (closing, opening)), (ABOUT_Z, (aside,)), (TORSION, (twist,)))
    ]
    parts[0] |= {"shift_rotation": [0.0, 1.0], "shift_share": [-share] * 2, "driver": 1}
    far = closing / (1.0 - share)
    centre, narrower = -share * far, np.sqrt(1.0 - share**2)
    for moment, half in (
        ([closing, 0.0, 0.0], far),
        ([-opening, 0.0, 0.0], opening + centre),
        ([0.0, aside, 0.0], far),
        ([0.0, -aside, 0.0], far),
        ([0.0, 0.0, twist], far),
    ):
        half_axes = np.array([half, aside / narrower, twist / narrower])
        flow = (np.array(moment) - [centre, 0.0, 0.0]) / half_axes**2
        element = rig(hinge(*parts, form=form, coupling=ELLIPSOID))
        for _ in range(50):
            found = element.led(H, flow / np.abs(flow).max())
        np.testing.assert_allclose(found, moment, atol=2e-3 * twist)
        assert element.state["dissipated"] > 0.0


def test_a_shift_grows_with_its_other_component_and_softens_like_it():
    parts = [component(ABOUT_Y, 100.0), component(ABOUT_Z, FALLING), component(TORSION, WEAKER)]
    parts[0] |= {"shift_rotation": [0.0, 0.1], "shift_share": [0.0, -0.3], "driver": 1}
    element = rig(hinge(*parts, coupling=ELLIPSOID))
    for _ in range(300):
        element.led(H, [1.0, 0.0, 0.0])
    assert element.state["moment"][0] == pytest.approx(100.0)
    # no shift yet, and the capacity about the other axis after as much rotation
    fallen = np.interp(0.3, *FALLING)
    np.testing.assert_allclose(element.led(1e-6, [0.0, 1.0, 0.0]), [0.0, fallen, 0.0], rtol=1e-4, atol=2e-3)
    for _ in range(200):
        element.led(H, [0.0, -1.0, 0.0])
    # at rest along the shift the moment is that of the centre, and the others are the largest there
    widest = np.interp(np.hypot(0.3, 0.2), *FALLING) / np.sqrt(1.0 - 0.3**2)
    np.testing.assert_allclose(
        element.led(1e-6, [0.0, -1.0, 0.0]), [-0.3 / 0.7 * 100.0, -widest, 0.0], rtol=1e-4, atol=1e-6
    )


@pytest.mark.parametrize("form", [SET_VALUED, ELASTIC_PLASTIC])
def test_a_rotation_about_one_axis_takes_a_share_of_the_capacity_about_another(form):
    parts = [
        component(freedom, *capacity, elastic_stiffness=1e7 if form == ELASTIC_PLASTIC else np.inf)
        for freedom, capacity in ((ABOUT_Y, (100.0, 70.0)), (ABOUT_Z, (90.0,)), (TORSION, (80.0,)))
    ]
    parts[0] |= {"worn_rotation": [0.0, 0.1], "worn_share": [0.0, 0.4], "driver": 1}
    element = rig(hinge(*parts, form=form, coupling=ELLIPSOID))

    def settled(rate):
        for _ in range(50):
            moment = element.led(H, rate)
        return moment

    settled([0.0, 0.0, 1.0])
    np.testing.assert_allclose(settled([1.0, 0.0, 0.0]), [100.0, 0.0, 0.0], atol=0.1)
    # half of the way, and back: what is gone is gone, in both senses, and of this axis alone
    turned = settled([0.0, 1.0, 0.0])
    np.testing.assert_allclose(turned, [0.0, 90.0, 0.0], atol=0.1)
    worn = 1.0 - 0.4 * 50 * H / 0.1
    settled([0.0, -0.5, 0.0])
    np.testing.assert_allclose(settled([1.0, 0.0, 0.0]), [100.0 * worn, 0.0, 0.0], atol=0.1)
    np.testing.assert_allclose(settled([-1.0, 0.0, 0.0]), [-70.0 * worn, 0.0, 0.0], atol=0.1)
    np.testing.assert_allclose(settled([0.0, 0.0, 1.0]), [0.0, 0.0, 80.0], atol=0.1)
    for _ in range(8):
        settled([0.0, 1.0, 0.0])
    np.testing.assert_allclose(settled([1.0, 0.0, 0.0]), [60.0, 0.0, 0.0], atol=0.1)


@pytest.mark.parametrize("form", [SET_VALUED, ELASTIC_PLASTIC])
@pytest.mark.parametrize("softening", [PEAK, ACCUMULATED])
def test_a_component_of_small_weight_softens_the_others_by_less_of_its_work(form, softening):
    parts = [
        component(freedom, *curves, elastic_stiffness=1e7 if form == ELASTIC_PLASTIC else np.inf)
        for freedom, curves in ((ABOUT_Y, (FALLING,)), (TORSION, (WEAKER,)))
    ]
    parts[1] |= {"softens": 0.4}
    element = rig(hinge(*parts, form=form, softening=softening, coupling=ELLIPSOID))
    for _ in range(300):
        twisted = element.led(H, [0.0, 1.0])
    # alone it follows its own curve; the other one has seen its work over its own capacity, times the weight
    np.testing.assert_allclose(twisted, [0.0, np.interp(0.3, *WEAKER)], rtol=2e-3, atol=0.1)
    for _ in range(20):
        bent = element.led(1e-5, [1.0, 0.0])
    seen = 0.4 * 0.3 * WEAKER[1][0] / FALLING[1][0]
    np.testing.assert_allclose(bent, [np.interp(seen, *FALLING), 0.0], rtol=2e-3, atol=0.2)


def test_capacity_sensitivity_against_differences():
    generator = np.random.default_rng(23)
    for form, coupling, n in CASES:
        good = 0
        for _ in range(20):
            element = rig(made(form, coupling, n))
            element.led(0.05, generator.normal(size=n))
            start, w = generator.normal(size=n), generator.normal(size=n) * 3.0
            element.element.freeze(0.02, start.tolist(), w.tolist())
            found = np.reshape(element.element.capacity_sensitivity(w.tolist()), (n, n))
            slope = np.zeros((n, n))
            for k in range(n):
                ends = []
                for factor in (1.0 + 1e-6, 1.0 - 1e-6):
                    element.element.scale_capacity(k, factor)
                    ends.append(np.array(element.element.law(w.tolist())[0]))
                    element.element.scale_capacity(k, 1.0 / factor)
                slope[:, k] = (ends[0] - ends[1]) / 2e-6
            good += np.abs(slope - found).max() <= 1e-6 * max(np.abs(found).max(), 1e-3)
        assert good >= 18, (form, coupling, n)


@pytest.mark.parametrize("form", [SET_VALUED, ELASTIC_PLASTIC])
@pytest.mark.parametrize("coupling", [NONE, ELLIPSOID])
def test_fracture_opens_the_hinge_for_good(form, coupling):
    constants = made(form, coupling, 2) | {"fracture": 0.2}
    element = rig(constants)
    for _ in range(300):
        element.led(1e-3, [0.0, 1.0])
    state = element.state
    assert state["fracture_time"] == pytest.approx(0.2, abs=0.01 if form == SET_VALUED else 0.06)
    assert state["moment"] == [0.0, 0.0]
    assert element.led(1e-3, [0.0, -1.0]).tolist() == [0.0, 0.0]
    area = trapezoid(np.interp(np.linspace(0, 0.2, 2001), *FALLING), np.linspace(0, 0.2, 2001))
    # the elastic form cannot place it within a step: half a step's work at most
    one_step = 0.5 * 90.0 * 1e-3 if form == ELASTIC_PLASTIC else 1e-9
    assert state["dissipated"] - state["fracture_energy"] == pytest.approx(area, abs=one_step)
    assert element.energy == pytest.approx(0.0, abs=1e-10 * area)
    if form == ELASTIC_PLASTIC:
        assert state["fracture_energy"] > 0.0


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"components": []}, "one to four"),
        ({"coupling": 9}, "unknown coupling"),
        ({"coupling": SECTION, "rows": [1.0]}, "one column per component"),
        ({"coupling": SECTION, "rows": [1.0, 1.0], "power": 1.0}, "at least 2"),
        ({"coupling": TENSION_FLANGE}, "tension flange"),
        ({"arm_gains": [0.1], "arm_gain_shares": []}, "a share each"),
        ({"arm_gains": [0.2, 0.1], "arm_gain_shares": [0.1, 0.2]}, "increase"),
        ({"growth_rotation": [0.0], "growth_share": [1.0]}, "growth of an arm are below 1"),
        ({"coupling": BALL}, "rotations only"),
        ({"form": ELASTIC_PLASTIC}, "needs a stiffness"),
        ({"components": [component(ABOUT_Y, 1.0, **SHIFT), component(ABOUT_Z, 1.0)]}, "has shares that"),
        ({"components": [component(ABOUT_Y, 1.0, shift_share=[0.1])]}, "one share per rotation"),
        (
            {"components": [component(ABOUT_Y, 1.0, shift_rotation=[0.0], shift_share=[1.0])]},
            "shares of a shift are below 1",
        ),
        ({"components": [component(ABOUT_Y, 1.0, driver=1)]}, "depends on the rotation about a component"),
        ({"components": [component(ABOUT_Y, 1.0, softens=0.0)]}, "positive weight"),
        (
            {"components": [component(ABOUT_Y, 1.0, worn_rotation=[0.0], worn_share=[0.1])]},
            "depends on the rotation about a component",
        ),
        (
            {"components": [component(ABOUT_Y, 1.0, worn_rotation=[0.0], worn_share=[1.0])]},
            "capacity that is gone are below 1",
        ),
        (
            {"components": [component(ABOUT_Y, 1.0, worn_rotation=[0.0], worn_share=[-0.1], driver=0)]},
            "no capacity is gained",
        ),
    ],
)
def test_constants_that_make_no_sense_are_refused(change, message):
    with pytest.raises(ValueError, match=message):
        _kernels.spatial.HingeElement(made(SET_VALUED, NONE, 2) | change)
