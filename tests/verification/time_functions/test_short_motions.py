"""Short motions of obstacles, of supports in quasi-static stages, and pulses in later stages.

A round obstacle that starts at once at the speed v takes the tip of a bar along; when it stops after T the
bar goes on from the angle a at the rate w and its plastic hinge takes up I w^2/(2 M): a + I w^2/(2 M) in all.
With the obstacle's centre at (x, z) from the hinge, and R its radius and half the bar's height,
x sin a - z cos a = R and w = v cos a/(x cos a + z sin a).  A hinge between a clamp and a support that goes
out by an angle and back dissipates 2 M times the angle, however short the way.  Two equal pulses in two
stages turn twice as far as one.

Kind: closed form.  Source: derived here.
"""

import math

import numpy as np
import pytest
from tests.support.multibody.pulses import Pulse

from crumple.multibody import Run, solve_multibody
from crumple.structure import Stage, Structure


def test_an_obstacle_that_moves_in_a_blink(record_figure):
    """10 mm in 0.3 ms of 0.5 s: a sphere and a cylinder."""
    bar = Pulse(1.0, 5.0, 3000.0, np.array([0.0, 1.0]), np.zeros(2))
    motion = {"z": {"table": {"time": [0.0, 0.1504, 0.1507, 0.5], "value": [0.0, 0.0, 0.01, 0.01]}}}
    base = bar.structure
    below = -0.05 - 5e-5 - 1e-7
    shapes = {
        "sphere": {"type": "sphere", "point": (1.0 - 5e-5, 0.0, below), "radius": 0.05},
        "cylinder": {
            "type": "cylinder",
            "point": (1.0 - 5e-5, 0.0, below),
            "axis": (0.0, 1.0, 0.0),
            "radius": 0.05,
        },
    }
    for name, shape in shapes.items():
        structure = Structure(
            **{
                key: getattr(base, key)
                for key in ("materials", "sections", "nodes", "members", "supports", "masses")
            },
            obstacles={"ram": {**shape, "motion": motion}},
        )
        hinge = solve_multibody(structure, Run(duration=0.5, every=0.5)).hinges["h"]
        x, z, apart = 1.0 - 5e-5, below + 0.01, 0.05 + 5e-5
        angle = math.asin(apart / math.hypot(x, z)) + math.atan2(z, x)
        rate = 0.01 / 3e-4 * math.cos(angle) / (x * math.cos(angle) + z * math.sin(angle))
        expected = angle + bar.inertia * rate**2 / (2.0 * 3000.0)
        record_figure(f"struck by a {name}", hinge.rotation_max, expected, 1e-4, "rad", relative=True)


@pytest.mark.parametrize("points", [5, 10_000])
def test_a_quasi_static_motion_out_and_back(points, record_figure):
    """A driven rotation of 0.2 rad and back within a hundredth of the stage, as few or as many points."""
    bar = Pulse(1.0, 5.0, 300.0, np.array([0.0, 1.0]), np.zeros(2))
    base = bar.structure
    corners = np.array([0.0, 0.5, 0.505, 0.51, 1.0])
    times = corners if points == 5 else np.union1d(corners, np.linspace(0.0, 1.0, points))
    values = np.interp(times, corners, [0.0, 0.0, 0.2, 0.0, 0.0])
    motion = {"ry": {"table": {"time": times.tolist(), "value": values.tolist()}}}
    supports = {"far": {"node": "tip", "fix": ["rx", "rz"], "motion": motion}} | dict(base.supports)
    structure = Structure(
        **{key: getattr(base, key) for key in ("materials", "sections", "nodes", "members", "masses")},
        supports=supports,
    )
    run = Run(duration=1.0, every=0.25, stages=(Stage(name="bend", kind="quasi-static", duration=1.0),))
    result = solve_multibody(structure, run)
    assert result.status.ok
    record_figure(
        f"dissipated on the way out and back, {points} points",
        result.hinges["h"].energy,
        2 * 300.0 * 0.2,
        1e-3,
        "J",
        relative=True,
    )


def test_functions_count_from_the_start_of_each_stage(record_figure):
    """A pulse of 0.3 ms, 0.15 s after the start of either stage."""
    pulse = Pulse(
        1.0,
        20.0,
        1000.0,
        np.array([0.0, 0.15, 0.150001, 0.1503, 0.150301, 0.5]),
        333.333e3 * np.array([0, 0, 1, 1, 0, 0]),
    )
    stages = tuple(Stage(name=name, duration=0.5) for name in ("first", "second"))
    hinge = solve_multibody(pulse.structure, Run(duration=1.0, every=1.0, stages=stages)).hinges["h"]
    record_figure("two stages", hinge.rotation_max, 2.0 * pulse.expected[0], 1e-3, "rad", relative=True)
