"""Quasi-static stages of what nothing holds: refused where that is plain, else ended with a status."""

import numpy as np
import pytest
from tests.support.structures import STEEL, TUBE

from crumple.errors import InputError, Status
from crumple.multibody import Run, link, solve_multibody, unheld_notes
from crumple.structure import Outputs, Stage, Structure

RAM = {"type": "sphere", "point": (0.5, 0, 0.2), "radius": 0.1, "velocity": (0, 0, -0.1)}
FLOOR = {"type": "plane", "point": (0, 0, -0.1), "normal": (0, 0, 1)}
LOAD = {"node": "tip", "force": {"z": {"table": {"time": (0.0, 1.0), "value": (0.0, 100.0)}}}}
PUSH = Stage(name="push", kind="quasi-static", duration=0.5)


def bar(**parts):
    member = {"nodes": ("root", "tip"), "section": "tube", "material": "steel"}
    return Structure(
        materials={"steel": STEEL},
        sections={"tube": TUBE},
        nodes={"root": (0.0, 0.0, 0.0), "tip": (1.0, 0.0, 0.0)},
        members={"bar": member},
        **parts,
    )


def solved(structure, stage=PUSH):
    return solve_multibody(structure, Run(stage.duration, 0.1, stages=(stage,)))


@pytest.mark.parametrize("parts", [{"obstacles": {"ram": RAM}}, {"loads": [LOAD]}], ids=["ram", "load"])
def test_floating_part_without_anything_to_rest_on_is_refused(parts):
    with pytest.raises(InputError, match="nothing supports member bar in a quasi-static stage") as refused:
        solved(bar(**parts))
    assert refused.value.problems[0].where == "analysis.stages[0].kind"


def test_a_stage_counts_the_obstacles_that_it_has():
    both = {"ram": RAM, "floor": FLOOR}
    with pytest.raises(InputError, match="nothing supports"):
        solved(bar(obstacles=both), PUSH.model_copy(update={"obstacles": ("ram",)}))


def test_what_loads_move_freely_ends_with_a_status():
    result = solved(bar(supports={"pin": {"node": "root", "fix": "pin"}}, loads=[LOAD]))
    assert result.status is Status.UNHELD
    assert "nothing resists" in result.reason
    assert "Equilibrium ended 0 s into stage push (force z on tip" in result.reason
    assert "member bar" in result.reason
    assert np.isfinite(result["energy.external_work"]).all()


def reported(stage=PUSH, **parts):
    structure = bar(**parts)
    return unheld_notes(structure, link(structure), (stage,))


def test_unsupported_loads_are_reported_before_solving():
    """By the power of loads and weights in what can move while no hinge turns."""
    pin = {"pin": {"node": "root", "fix": "pin"}}
    (text,) = reported(supports=pin, loads=[LOAD])
    assert "Stage push is quasi-static, and nothing resists the force on node tip" in text
    assert Status.UNHELD.value in text
    along = {"node": "tip", "force": {"x": LOAD["force"]["z"]}}
    assert reported(supports=pin, loads=[along]) == ()
    twist = {"node": "tip", "moment": {"x": LOAD["force"]["z"]}}
    (text,) = reported(supports=pin, loads=[twist], gravity=(0.0, 0.0, -9.81))
    assert "nothing resists gravity and the moment on node tip" in text
    assert reported(supports={"clamp": {"node": "root", "fix": "all"}}, loads=[LOAD]) == ()
    assert reported(PUSH.model_copy(update={"kind": "dynamic"}), supports=pin, loads=[LOAD]) == ()
    assert reported(gravity=(0.0, 0.0, -9.81), obstacles={"floor": FLOOR}) == ()


def test_what_falls_a_short_way_rests_on_the_floor():
    """A snap that ends near by goes on; a floor below the longest one is as none."""
    result = solved(bar(obstacles={"floor": FLOOR}, gravity=(0.0, 0.0, -9.81)))
    assert result.status.ok, result.reason
    # 1 m of 2.8998685 kg/m
    assert result["obstacle.floor.force.z"][-1] == pytest.approx(-9.81 * 2.8998685, rel=1e-6)
    deep = {**FLOOR, "point": (0.0, 0.0, -2.0)}
    result = solved(bar(obstacles={"floor": deep}, gravity=(0.0, 0.0, -9.81)))
    assert result.status is Status.UNHELD
    assert "gravity alone" in result.reason
    assert "The structure has no supports" in result.reason


def test_impulses_beyond_every_crash_are_refused():
    clamp = {"supports": {"clamp": {"node": "root", "fix": "pin"}}}
    blow = {"impulses": [{"node": "tip", "impulse": (0.0, 0.0, 1e7)}]}
    with pytest.raises(InputError, match="the impulses accelerate a part") as refused:
        solve_multibody(bar(**clamp, **blow), Run(0.01, 0.01))
    assert refused.value.problems[0].where == "impulses"


def test_motion_removed_by_a_quasi_static_stage_is_reported():
    hinge = {"name": "fold", "at": 0.1, "law": {"type": "constant", "moment": 100.0}, "axis": "y"}
    member = {"nodes": ("root", "tip"), "section": "tube", "material": "steel", "hinges": (hinge,)}
    structure = bar(supports={"clamp": {"node": "root", "fix": "all"}}, loads=[LOAD])
    whole = Structure.model_validate({**structure.model_dump(exclude_unset=True), "members": {"bar": member}})
    thrown = {"rotation": 5.0, "axis": (0.0, 1.0, 0.0), "about": (0.1, 0.0, 0.0)}
    throw = Stage(name="throw", duration=0.001, initial_velocity=(thrown,))
    hold = Stage(name="hold", kind="quasi-static", duration=0.01)
    result = solve_multibody(whole, Run(0.011, 0.001, stages=(throw, hold)))
    assert result.status.ok, result.reason
    moving = result["energy.kinetic"][1]
    assert result["energy.damping"][-1] == pytest.approx(moving, rel=1e-3)
    assert any("from the motion" in text for text in result.warnings)
    assert result.energy_residual < 1e-3


def test_sections_carry_what_pushes_at_rest():
    """Shear of a cantilever is the force at its tip, however fast the stage bends it; nothing moves."""
    law = {"type": "constant", "moment": 1e5, "rate": "off", "form": "elastic-plastic"}
    hinge = {"name": "root", "at": 0.1, "law": law, "axis": "y"}
    member = {"nodes": ("root", "tip"), "section": "tube", "material": "steel", "hinges": (hinge,)}
    clamp = {"clamp": {"node": "root", "fix": "all"}}
    plain = bar(supports=clamp, loads=[LOAD]).model_dump(exclude_unset=True)
    structure = Structure.model_validate({**plain, "members": {"bar": member}})
    outputs = Outputs(nodes=("tip",), section_forces={"cut": {"member": "bar", "at": 0.5}})
    stage = PUSH.model_copy(update={"duration": 0.01})
    result = solve_multibody(structure, Run(0.01, 0.001, outputs=outputs, stages=(stage,)))
    assert result.status.ok, result.reason
    assert result["node.tip.displacement.z"][-1] > 0.0
    assert not result["node.tip.velocity.z"].any()
    assert not result["node.tip.acceleration.z"].any()
    # the mean over the last step, of 0.5 ms at most, while the force grows by 100 N/s
    np.testing.assert_allclose(result["cut.force.z"][1:], 100.0 * result.time[1:], rtol=0.0, atol=0.025)
