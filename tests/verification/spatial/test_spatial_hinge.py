"""The hinge of several components: the planar hinge, closed forms and accurate explicit integration.

Rig: one hinge between the ground and a mass that moves freely in the directions of the hinge, so every
history is an ordinary differential equation of as many rates as the hinge has components.

    one component      the wheel of the planar kernel, step by step
    proportional       inertia I_k ~ C_k^2 keeps the direction; with capacities C_k f(s), s the work at the
                       first capacities, the hinge absorbs the integral of f: f = 1 - s/L stops it at
                       s = L (1 - sqrt(1 - 2 E/L)), E the energy at the start
    non-proportional   SciPy's DOP853; the set-valued step is of second order in its length
    axial collapse     peak force over a first shortening, mean force after, stop at the stroke: energies
    tension flange     |M| + N b/2 = C(rotation) with axial slip b/2 |rotation|; under a dead axial force
                       (I + m b^2/4) w' = M_ext + N b/2 - C
    fracture           I w^2/2 decreases by C times the angle at fracture, then the wheel continues

Kind: closed form; independent calculation.  Source: derived here; derived here.
"""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from tests.support.multibody.chains import hinge as tree_hinge
from tests.support.multibody.chains import wheel
from tests.support.multibody.hinge_rig import (
    ABOUT_Y,
    ABOUT_Z,
    ACCUMULATED,
    AXIAL,
    ELASTIC_PLASTIC,
    ELLIPSOID,
    FORMS,
    NONE,
    PEAK,
    ROTATION,
    SECTION,
    TENSION_FLANGE,
    component,
    hinge,
    rig,
)

from crumple._core.planar.simulation import Simulation, TreeDrive, TreeLoad, TreeModel

CURVE = ([0.0, 0.1, 0.4, 1.0], [700.0, 700.0, 400.0, 300.0])
OTHER = ([0.0, 0.2, 1.0], [500.0, 300.0, 250.0])
INERTIA = 2.0


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("softening", [PEAK, ROTATION, ACCUMULATED])
def test_one_component_is_the_planar_hinge(form, softening):
    """A wheel shaken to and fro: rotation, rate, moment and energy agree to rounding in every step."""
    more = {
        "viscous_damping": 0.5,
        "rate_reference": 40.0,
        "rate_exponent": 5.0,
        "stop_positive": (0.6, 2e4, 1.0, 8.0, 0.01),
        "stop_negative": (0.5, 3e4, 1.0, 0.0, 0.0),
        "elastic_stiffness": 2e4 if form == ELASTIC_PLASTIC else math.inf,
    }
    law = {"form": form, "softening": softening}
    planar = tree_hinge(0, tuple(map(np.array, CURVE)), **law, **more)
    planar = type(planar)(**{**planar.__dict__, "negative": tuple(map(np.array, OTHER))})
    # as fine as the steps, so that the mean over a step is the value at its middle
    times = np.linspace(0.0, 1.0, 501)
    push = TreeLoad(0, (0.0, 0.0), (1.0, 0.0, 0.0), times, 1500.0 * np.sin(12.0 * times))
    # something else that is driven: the planar step then leaves the turn of a hinge that stops as it is
    idle = TreeDrive(1, (0.0, 0.0), (1.0, 0.0, 0.0), np.zeros(1), np.zeros(1), np.zeros(1))
    model = TreeModel((wheel(INERTIA), wheel(INERTIA)), (planar,), (push,), (idle,))
    simulation = Simulation(model)
    # the damper weighs its rates by the inertia that it feels
    one = component(
        ABOUT_Y, CURVE, OTHER, **{k: list(v) if isinstance(v, tuple) else v for k, v in more.items()}
    )
    made = rig(hinge(one, **law), INERTIA)
    made.element.set_damped_inertia(0, INERTIA)
    step = 2e-3
    for i in range(400):
        assert simulation.step(step)
        made.step(step, np.interp((i + 0.5) * step, times, 1500.0 * np.sin(12.0 * times)))
        assert made.q[0] == pytest.approx(simulation.q[0], abs=1e-9)
        assert made.w[0] == pytest.approx(simulation.w[0], abs=1e-8)
    summary = simulation.summary()
    rotation, moment, lost = summary.rotation_max[0], summary.moment_max[0], summary.energy[0]
    state = made.state
    assert np.abs(made.q).max() > 0.0
    assert state["rotation_max"] == pytest.approx(rotation, rel=1e-9)
    lost_here = state["dissipated"] + state["damped"] + state["stop_dissipated"]
    assert lost_here == pytest.approx(lost, rel=1e-8)
    assert moment > 0.0
    assert made.energy == pytest.approx(0.0, abs=1e-9 * lost)


def test_proportional_biaxial_stop_meets_the_closed_form(record_figure):
    first, length = np.array([600.0, 400.0]), 500.0
    inertia = first**2 / 2e5

    def curve(c):
        # capacity c (1 - s/length) read at s/c
        return [0.0, 0.8 * length / c], [c, 0.2 * c]

    w0 = np.array([3.0, 4.0])
    energy = w0 @ (inertia * w0) / 2
    made = rig(
        hinge(
            *(component(f, curve(c)) for f, c in zip((ABOUT_Y, ABOUT_Z), first, strict=True)),
            coupling=ELLIPSOID,
        ),
        inertia,
        w0,
    )
    direction = w0 / np.linalg.norm(w0)
    for _ in range(400):
        made.step(5e-5)
    s = length * (1.0 - math.sqrt(1.0 - 2.0 * energy / length))
    record_figure("work measure at rest", made.state["softening"], s, 1e-4, "J", relative=True)
    record_figure("dissipated energy", made.state["dissipated"], energy, 1e-9, "J", relative=True)
    np.testing.assert_allclose(made.q / np.linalg.norm(made.q), direction, atol=1e-9)


def explicit(constants, first, inertia, w0, force, duration, *, power, rows):
    """End of a set-valued hinge's motion; it softens by the accumulated work measure."""
    curves = [
        (np.array(c["positive_rotation"]), np.array(c["positive_moment"])) for c in constants["components"]
    ]

    def support(y):
        # x with g = 1 and normal y
        if rows is None:
            return y / np.linalg.norm(y)
        from scipy.optimize import minimize

        def gauge(x):
            return (np.abs(rows @ x) ** power).sum() ** (1.0 / power)

        # minimise g on y.x = 1, in coordinates of that line
        base, along = y / (y @ y), np.array([-y[1], y[0]]) / np.linalg.norm(y)
        found = minimize(lambda s: gauge(base + s[0] * along), [0.0], method="BFGS", options={"gtol": 1e-13})
        x = base + found.x[0] * along
        return x / gauge(x)

    def rates(t, state):
        w, s = state[2:4], state[4]
        capacity = np.array([np.interp(s / c, *curve) for c, curve in zip(first, curves, strict=True)])
        tau = capacity * support(capacity * w)
        return np.concatenate([w, (force(t) - tau) / inertia, [first * w @ support(first * w)]])

    start = np.concatenate([[0.0, 0.0], w0, [0.0]])
    return solve_ivp(rates, (0.0, duration), start, method="DOP853", rtol=1e-9, atol=1e-11).y[:, -1]


@pytest.mark.parametrize("coupling", [ELLIPSOID, SECTION])
def test_turning_axis_meets_explicit_integration_at_second_order(coupling, record_figure):
    first, inertia, w0, duration = np.array([500.0, 300.0]), np.array([2.0, 1.0]), np.array([9.0, 2.0]), 0.02
    power, rows = 6.0, np.array([[0.9, 0.35], [0.9, -0.35], [0.4, 0.85], [0.4, -0.85]])
    extra = {"rows": rows.ravel().tolist(), "power": power} if coupling == SECTION else {}

    def curve(c):
        return [0.0, 1.0], [c, 0.4 * c]

    constants = hinge(
        component(ABOUT_Y, curve(first[0])),
        component(ABOUT_Z, curve(first[1])),
        softening=ACCUMULATED,
        coupling=coupling,
        **extra,
    )

    def force(t):
        return np.array([0.0, 400.0 * math.sin(100.0 * t)])

    rows_used = rows if coupling == SECTION else None
    exact = explicit(constants, first, inertia, w0, force, duration, power=power, rows=rows_used)
    errors = []
    for steps in (20, 40, 80):
        made = rig(constants, inertia, w0)
        h = duration / steps
        for i in range(steps):
            made.step(h, force((i + 0.5) * h))
        errors.append(np.abs(made.q - exact[:2]).max())
        assert made.energy == pytest.approx(w0 @ (inertia * w0) / 2, rel=1e-9)
    name = "ellipsoid" if coupling == ELLIPSOID else "section"
    record_figure(f"{name}: rotation error at 80 steps over the rotation", errors[-1] / exact[0], 0.0, 2e-5)
    record_figure(f"{name}: order", math.log2(errors[0] / errors[1]), 2.0, 0.25)


def test_elastic_plastic_circle_meets_explicit_integration(record_figure):
    """Rotations led on a circle: the moment follows on the surface, never normal to the path."""
    capacity, stiffness = np.array([500.0, 300.0]), np.array([4e4, 3e4])
    parts = [
        component(f, c, elastic_stiffness=k)
        for f, c, k in zip((ABOUT_Y, ABOUT_Z), capacity, stiffness, strict=True)
    ]

    def rate(t):
        return np.array([math.cos(t), math.sin(t)]) * 0.05

    def stress_rate(t, tau):
        normal = tau / capacity**2
        drive = stiffness * rate(t)
        flow = max(normal @ drive, 0.0) / (normal @ (stiffness * normal))
        return drive - flow * stiffness * normal

    # elastic until the surface is met
    def outside(t, tau):
        return ((tau / capacity) ** 2).sum() - 1.0

    outside.terminal = True
    tight = {"method": "DOP853", "rtol": 1e-11, "atol": 1e-9}
    rise = solve_ivp(lambda t, tau: stiffness * rate(t), (0.0, 3.0), [0.0, 0.0], events=outside, **tight)
    exact = solve_ivp(stress_rate, (rise.t[-1], 3.0), rise.y[:, -1], max_step=0.01, **tight).y[:, -1]
    made = rig(hinge(*parts, form=ELASTIC_PLASTIC, coupling=ELLIPSOID), 1.0)
    steps = 3000
    for i in range(steps):
        made.led(3.0 / steps, rate((i + 0.5) * 3.0 / steps))
    found = np.array(made.state["moment"])
    record_figure("moment about y at the end", found[0], exact[0], 1e-3 * 500.0, "N m")
    record_figure("moment about z at the end", found[1], exact[1], 1e-3 * 300.0, "N m")
    assert ((found / capacity) ** 2).sum() == pytest.approx(1.0, abs=1e-12)


def test_axial_collapse_takes_the_energy_under_its_curve(record_figure):
    """Squash peak 90 kN falling to a mean of 30 kN within 5 mm; stroke 0.2 m; 60 kg."""
    mass, peak, mean, fall, stroke = 60.0, 90e3, 30e3, 5e-3, 0.2
    stop = [stroke, 5e7, 1.0, 0.0, 0.0]
    crushed = component(AXIAL, 200e3, ([0.0, fall, 1.0], [peak, mean, mean]), stop_negative=stop)
    slow, fast = 8.0, 16.0
    made = rig(hinge(crushed), mass, [-slow])
    for _ in range(800):
        made.step(1e-4)
    shortening = (mass * slow**2 / 2 - (peak - mean) * fall / 2) / mean
    record_figure("shortening under 1.92 kJ", -made.q[0], shortening, 2e-5, "m")
    assert not made.state["sliding"]
    bottomed = rig(hinge(crushed), mass, [-fast])
    deepest = 0.0
    for _ in range(1500):
        bottomed.step(2e-5)
        deepest = min(deepest, bottomed.q[0])
    folded = mean * stroke + (peak - mean) * fall / 2
    left = mass * fast**2 / 2 - folded
    # beyond the stroke the folds still carry their mean force beside the spring
    root = (-mean + math.sqrt(mean**2 + 2 * 5e7 * left)) / 5e7
    record_figure("shortening where the folds are closed", -deepest, stroke + root, 1e-5, "m")
    assert bottomed.energy == pytest.approx(mass * fast**2 / 2, rel=1e-9)


def test_fold_about_the_tension_flange_shortens_by_normality(record_figure):
    """Dead compression of 8 kN and a moment: the fold takes C(rotation) = M + N b/2 and shortens by b/2."""
    half_depth, capacity, compression, moment = 0.05, 1200.0, 8e3, 1300.0
    inertia, mass, duration = 3.0, 40.0, 0.05
    constants = hinge(
        component(AXIAL, 200e3, 150e3),
        component(ABOUT_Y, ([0.0, 1e-6, 1.0], [1500.0, capacity, capacity])),
        coupling=TENSION_FLANGE,
        arm=half_depth,
    )
    made = rig(constants, [mass, inertia])
    for _ in range(100):
        made.step(duration / 100, [-compression, moment])
    acceleration = (moment + compression * half_depth - capacity) / (inertia + mass * half_depth**2)
    rotation = acceleration * duration**2 / 2
    record_figure("rotation", made.q[1], rotation, 1e-3, "rad", relative=True)
    record_figure("shortening over rotation", -made.q[0] / made.q[1], half_depth, 1e-6, "m", relative=True)
    record_figure(
        "work of the hinge over C rotation", made.state["dissipated"] / (capacity * made.q[1]), 1.0, 1e-3
    )
    assert made.energy == pytest.approx(0.0, abs=1e-8 * capacity)
    # under tension the fold does not lengthen, and the hinge carries its first moment at most
    pulled = rig(constants, [mass, inertia])
    for _ in range(100):
        pulled.step(duration / 100, [+compression, 1700.0])
    assert pulled.q[0] == pytest.approx(0.0, abs=1e-9)
    rate = (1700.0 - (capacity + compression * half_depth)) / inertia * duration
    assert pulled.w[1] == pytest.approx(max(rate, (1700.0 - 1500.0) / inertia * duration), rel=1e-3)


def test_the_arm_of_a_fold_gains_with_compression(record_figure):
    """Between two gains the fold takes M + N arm + gain (N - share N_y), and shortens by arm + gain."""
    arm, gain, share, yield_force = 0.02, 0.03, 0.1, 200e3
    compression, moment, capacity = 30e3, 500.0, 1200.0
    constants = hinge(
        component(AXIAL, yield_force, 150e3),
        component(ABOUT_Y, capacity),
        coupling=TENSION_FLANGE,
        arm=arm,
        arm_gains=[gain, 0.04],
        arm_gain_shares=[share, 0.5],
    )
    inertia, mass, duration = 3.0, 40.0, 0.05
    made = rig(constants, [mass, inertia])
    for _ in range(100):
        made.step(duration / 100, [-compression, moment])
    reduced = compression * arm + gain * (compression - share * yield_force)
    acceleration = (moment + reduced - capacity) / (inertia + mass * (arm + gain) ** 2)
    record_figure("rotation", made.q[1], acceleration * duration**2 / 2, 1e-3, "rad", relative=True)
    record_figure("shortening over rotation", -made.q[0] / made.q[1], arm + gain, 1e-6, "m", relative=True)
    assert made.energy == pytest.approx(0.0, abs=1e-8 * capacity)


def test_fracture_leaves_the_rest_of_the_motion(record_figure):
    moment, rate, angle = 700.0, 15.0, 0.2
    made = rig(hinge(component(ABOUT_Y, moment), coupling=NONE, fracture=angle), INERTIA, [rate])
    for _ in range(100):
        made.step(5e-4)
    left = math.sqrt(rate**2 - 2 * moment * angle / INERTIA)
    record_figure("rate after fracture", made.w[0], left, 1e-4, "rad/s", relative=True)
    record_figure(
        "energy of the torn hinge", made.state["dissipated"], moment * angle, 1e-3, "J", relative=True
    )
    assert made.energy == pytest.approx(INERTIA * rate**2 / 2, rel=1e-9)


def test_forms_agree_as_they_become_stiff():
    """A stiff elastic hinge and a narrow ramp turn as far as the rigid one."""
    ends = []
    for form in FORMS:
        parts = [
            component(
                f, c, elastic_stiffness=1e6 if form == ELASTIC_PLASTIC else math.inf, regularisation_rate=1e-4
            )
            for f, c in ((ABOUT_Y, 500.0), (ABOUT_Z, 300.0))
        ]
        made = rig(hinge(*parts, form=form, coupling=ELLIPSOID), [2.0, 1.0], [8.0, 3.0])
        for _ in range(400):
            made.step(1.5e-4)
        ends.append(made.q)
    np.testing.assert_allclose(ends[1], ends[0], atol=2e-3)
    np.testing.assert_allclose(ends[2], ends[0], atol=2e-3)
