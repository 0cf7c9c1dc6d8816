"""The tube of example 01 equals an independent integration of one equation of motion with the same law.

The tube (50x25x2.65 mm, 1 m, 6 kg at its tip, 15 rad/s about its root) with one hinge 0.7 of half a fold
length from its root is a body that rotates about that hinge: I theta'' = -M, integrated by SciPy's Radau
method.  I and the initial rate are computed here from outer dimensions: I = m L'^3/3 + rho I_y L' + 6 L'^2,
L' = 1 - 0.0162 m, and the rate from the angular momentum about the hinge of what lies beyond it.  The law is
used as a formula, not as samples.  The tolerance is the sampling error of the law, 1e-4 of the moment and so
of the rotation, in addition to an accuracy of 1e-5.

Kind: independent calculation.  Source: derived here.
"""

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp
from tests.support.structures import cantilever

from crumple.hinge import build_law
from crumple.material import Material
from crumple.multibody import Run, solve_multibody
from crumple.section import RectangularTube, fold_distance
from crumple.structure import MultibodySettings

WIDTH, DEPTH, WALL, DENSITY, PAYLOAD, RATE = 0.050, 0.025, 0.00265, 7850.0, 6.0, 15.0
DURATION, TOLERANCE, RAMP = 0.12, 2e-4, 0.05
TIGHT = {"method": "Radau", "rtol": 1e-9, "atol": 1e-11, "max_step": 2e-3}

SECTION = RectangularTube(WIDTH, DEPTH, WALL)
LAW = build_law("kecman", SECTION, Material("steel", 210e9, 0.3, DENSITY, 488e6), "y")


def inertia_and_start():
    """Moment of inertia about the hinge, and rate that keeps the angular momentum about it."""
    inner = (WIDTH - 2 * WALL, DEPTH - 2 * WALL)
    line = DENSITY * (WIDTH * DEPTH - inner[0] * inner[1])
    across = DENSITY * (WIDTH * DEPTH**3 - inner[0] * inner[1] ** 3) / 12
    hinge = fold_distance(SECTION, "y")
    beyond = 1.0 - hinge
    inertia = line * beyond**3 / 3 + across * beyond + PAYLOAD * beyond**2
    # velocity RATE x at x from the root, arm x - hinge; every slice also spins with RATE
    momentum = line * quad(lambda x: (x - hinge) * RATE * x, hinge, 1.0)[0]
    momentum += across * beyond * RATE + PAYLOAD * beyond * RATE
    return inertia, momentum / inertia


def moment(rotation):
    return float(LAW.moment_capacity(np.array([rotation]), 1)[0])


def slid_to_rest(start, rate, inertia):
    """Rigid-plastic motion until it stops: rotation and time."""

    def motion(t, y):
        return y[1], -moment(y[0]) / inertia

    def stop(t, y):
        return y[1]

    stop.terminal, stop.direction = True, -1
    found = solve_ivp(motion, (0, 1), (start, rate), events=stop, **TIGHT)
    return found.y_events[0][0][0], found.t_events[0][0]


def solved(form, **keys):
    structure = cantilever(
        {"type": "kecman", "form": form, **keys},
        initial_velocity=[{"rotation": RATE, "axis": (0.0, 1.0, 0.0)}],
    )
    result = solve_multibody(structure, Run(DURATION, 0.0005, MultibodySettings(accuracy=1e-5)))
    assert result.status.ok
    assert result.energy_residual < 1e-6
    return result


def test_set_valued(record_figure):
    inertia, rate = inertia_and_start()
    rotation, rest = slid_to_rest(0.0, rate, inertia)
    hinge = solved("set-valued").hinges["root"]
    record_figure("rotation, set-valued", hinge.rotation_final, rotation, TOLERANCE, "rad", relative=True)
    record_figure("time of rest, set-valued", hinge.time_of_rest, rest, TOLERANCE, "s", relative=True)
    record_figure("energy, set-valued", hinge.energy, inertia * rate**2 / 2, 1e-6, "J", relative=True)


def test_regularised(record_figure):
    """HAVSIN ramp from -1 to 1 over twice 0.05 rad/s; at the end the hinge creeps."""
    inertia, rate = inertia_and_start()

    def motion(t, y):
        ramp = np.sin(np.pi / 2 * np.clip(y[1] / RAMP, -1.0, 1.0))
        return y[1], -moment(y[0]) * ramp / inertia

    found = solve_ivp(motion, (0, DURATION), (0.0, rate), dense_output=True, **TIGHT)
    result = solved("regularised")
    rotation = result.hinges["root"].rotation_final
    record_figure("rotation, regularised", rotation, found.y[0, -1], TOLERANCE, "rad", relative=True)
    path = np.abs(result["hinge.root.rotation"] - found.sol(result.time)[0]).max()
    record_figure("path, regularised", path, 0.0, TOLERANCE * rotation, "rad")


def test_elastic_plastic(record_figure):
    """Elastic rise, plastic flow with a spring in series, elastic vibration after the first stop.

    While it flows theta = p + C(p)/k, so theta' = p' (1 + C'(p)/k): one equation for p.
    """
    inertia, rate = inertia_and_start()
    result = solved("elastic-plastic")
    # 3 E I/L^3 at the tip of the whole tube, with the lever arm of what lies beyond the hinge
    second = (WIDTH * DEPTH**3 - (WIDTH - 2 * WALL) * (DEPTH - 2 * WALL) ** 3) / 12
    stiffness = 3 * 210e9 * second * (1.0 - fold_distance(SECTION, "y")) ** 2
    omega, cap = np.sqrt(stiffness / inertia), moment(0.0)
    # elastic until the capacity is reached
    rise = np.arcsin(cap / stiffness * omega / rate) / omega
    entry = rate * np.cos(omega * rise)
    step = 1e-6

    def slope(p):
        return (moment(p + step) - moment(max(p - step, 0.0))) / (step + min(p, step))

    def flow(t, y):
        return y[1] / (1 + slope(y[0]) / stiffness), -moment(y[0]) / inertia

    def stop(t, y):
        return y[1]

    stop.terminal, stop.direction = True, -1
    found = solve_ivp(flow, (rise, 1), (0.0, entry), events=stop, **TIGHT)
    plastic, rest = found.y_events[0][0][0], found.t_events[0][0]
    hinge = result.hinges["root"]
    largest = plastic + moment(plastic) / stiffness
    record_figure(
        "largest rotation, elastic-plastic", hinge.rotation_max, largest, TOLERANCE, "rad", relative=True
    )
    # afterwards it swings between both capacities, which are equal: no further flow
    found_plastic = result["hinge.root.plastic_rotation"][-1]
    record_figure("plastic rotation", found_plastic, plastic, TOLERANCE, "rad", relative=True)
    record_figure("time of rest, elastic-plastic", hinge.time_of_rest, rest, TOLERANCE, "s", relative=True)
    swing = largest - plastic
    after = result.time > rest + 0.01
    vibration = plastic + swing * np.cos(np.sqrt(stiffness / inertia) * (result.time[after] - rest))
    off = np.abs(result["hinge.root.rotation"][after] - vibration).max()
    record_figure("vibration after the stop", off, 0.0, 2e-2 * swing, "rad")


def test_start_keeps_the_angular_momentum_about_the_hinge():
    inertia, rate = inertia_and_start()
    result = solved("set-valued")
    assert result["energy.kinetic"][0] == pytest.approx(inertia * rate**2 / 2, rel=1e-9)
