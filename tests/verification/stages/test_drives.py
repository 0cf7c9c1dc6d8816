"""Prescribed motion: the driven point follows it, and its work is what the structure absorbs.

A point moved by a HAVSIN starts and ends at rest, so the work of its force is the energy that the hinges
absorb: for constant moments the sum of M |rotation|, known from the geometry if one hinge rotates.  What
the drive does not reach by its rate alone is corrected as drift, so the position is reached to the
requested accuracy.

Kind: closed form.  Source: derived here.
"""

import math

import numpy as np
import pytest
from tests.support.structures import STEEL, cantilever, constant_law

from crumple.multibody import Run, solve_multibody
from crumple.structure import MultibodySettings, Outputs, Structure

MOMENT = 800.0
OUTPUTS = Outputs(nodes=("tip", "root"))
CLAMP = {"node": "root", "fix": "all"}


def havsin(height, end=0.1):
    return {"havsin": {"x0": 0.0, "h0": 0.0, "x1": end, "h1": height}}


def driven(motion, at="tip", **keys):
    supports = {"driver": {"node": at, "motion": motion}}
    if at == "tip":
        supports["clamp"] = CLAMP
    else:
        supports["driver"]["fix"] = "all"
    structure = cantilever(constant_law(MOMENT), supports=supports, hinge_place=0.1, **keys)
    result = solve_multibody(structure, Run(0.12, 0.002, MultibodySettings(accuracy=1e-4), OUTPUTS))
    assert result.status.ok
    assert result.energy_residual < 1e-4
    return result


def test_tip_led_aside(record_figure):
    """One hinge at 0.1 m: the tip 0.3 m down means asin(0.3/0.9) about y."""
    result = driven({"z": havsin(-0.3)})
    rotation = math.asin(0.3 / 0.9)
    record_figure("tip", result["node.tip.displacement.z"][-1], -0.3, 1e-5, "m")
    record_figure("hinge", result.hinges["root"].rotation_final, rotation, 1e-4, "rad", relative=True)
    record_figure("work", result["energy.external_work"][-1], MOMENT * rotation, 2e-4, "J", relative=True)
    t = result.time
    reported = -0.3 * (1 - np.cos(np.pi * np.minimum(t / 0.1, 1.0))) / 2
    worst = float(np.abs(result["node.tip.displacement.z"] - reported).max())
    record_figure("largest distance from the prescribed path", worst, 0.0, 1e-4, "m")


def test_chain_led_aside(record_figure):
    """Four hinges: only the weakest mechanism moves; its work is M times what turned."""
    result = driven({"z": havsin(-0.2)}, bars=4)
    record_figure("tip of the chain", result["node.tip.displacement.z"][-1], -0.2, 1e-5, "m")
    turned = sum(abs(np.diff(result[f"hinge.{name}.rotation"])).sum() for name in result.hinges)
    work = result["energy.external_work"][-1]
    left = result["energy.kinetic"][-1]
    record_figure("work and absorbed energy", MOMENT * turned, work - left, 2e-3, "J", relative=True)


def test_turning_clamp(record_figure):
    """A clamp that turns slowly takes the whole cantilever with it; a violent one leaves it behind."""
    slow = driven({"ry": havsin(0.5)}, at="root", payload=0.5)
    record_figure("rotation of the root", slow["node.root.rotation.y"][-1], 0.5, 1e-5, "rad")
    assert slow["energy.dissipated"][-1] < 1e-3
    np.testing.assert_allclose(slow["node.tip.displacement.z"][-1], -math.sin(0.5), atol=1e-4)
    fast = driven({"ry": havsin(0.5, end=0.01)}, at="root", payload=6.0)
    assert abs(fast["hinge.root.rotation"]).max() > 0.1
    record_figure("rotation of the violent root", fast["node.root.rotation.y"][-1], 0.5, 1e-4, "rad")
    taken = fast["energy.dissipated"][-1] + fast["energy.kinetic"][-1]
    record_figure(
        "work of the violent root", fast["energy.external_work"][-1], taken, 1e-4, "J", relative=True
    )


def test_roller_holds_one_direction():
    """A node held in z alone slides in x while the tube folds under its weight, here of a thousand times."""
    supports = {"clamp": CLAMP, "roller": {"node": "tip", "fix": ["z"]}}
    weight = (0.0, 0.0, -1e4)
    structure = cantilever(constant_law(MOMENT), supports=supports, bars=2, hinge_place=0.0, gravity=weight)
    result = solve_multibody(structure, Run(0.01, 0.001, outputs=OUTPUTS))
    assert np.abs(result["node.tip.displacement.z"]).max() == pytest.approx(0.0, abs=1e-6)
    assert np.abs(result["node.tip.displacement.x"]).max() > 0.1


def test_kinked_motion(record_figure):
    """A table of displacements has a rate that jumps; every corner is met all the same."""
    table = {"table": {"time": [0.0, 0.02, 0.05, 0.08, 0.2], "value": [0.0, -0.1, -0.1, 0.05, 0.05]}}
    result = driven({"z": table})
    reported = np.interp(result.time, table["table"]["time"], table["table"]["value"])
    worst = float(np.abs(result["node.tip.displacement.z"] - reported).max())
    record_figure("largest distance from a kinked path", worst, 0.0, 2e-4, "m")


def test_a_knee_driven_from_rest_at_speed(record_figure):
    """All of the kinetic energy comes within the first step, which was judged by what was there before it."""
    nodes = {"a": (0.0, 0.0, 0.0), "b": (0.0, 0.0, 0.8), "c": (1.0, 0.0, 0.8), "d": (1.0, 0.0, 0.0)}
    bars = {"ab": ("a", "b", "post"), "bc": ("b", "c", "beam"), "dc": ("d", "c", "post")}

    def work(speed):
        path = {"x": {"table": {"time": [0.0, 0.3 / speed], "value": [0.0, 0.3]}}}
        held = {node: {"node": node, "fix": "all"} for node in "ad"}
        structure = Structure(
            materials={"steel": {**STEEL, "yield_stress": 350e6}},
            sections={
                "post": {"type": "square_tube", "side": 0.05, "thickness": 0.002},
                "beam": {"type": "rectangular_tube", "width": 0.05, "depth": 0.07, "thickness": 0.002},
            },
            nodes=nodes,
            members={
                name: {"nodes": (first, second), "section": section, "material": "steel"}
                for name, (first, second, section) in bars.items()
            },
            hinges="auto",
            supports={**held, "ram": {"node": "b", "motion": path}},
            masses={"c": {"node": "c", "mass": 10.0}},
        )
        result = solve_multibody(structure, Run(0.3 / speed, 3e-3 / speed))
        assert result.status.ok, result.reason
        assert result.energy_residual < 1e-3
        return float(result["energy.dissipated"][-1])

    slow, fast = work(0.5), work(3.0)
    record_figure("work of a portal led aside six times as fast", fast / slow, 1.0, 0.01)
    assert fast == pytest.approx(slow, rel=0.01)
