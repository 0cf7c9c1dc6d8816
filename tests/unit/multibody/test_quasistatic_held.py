"""Quasi-static stages of what nothing holds: refused where that is plain, else ended with a status."""

import numpy as np
import pytest
from tests.verification.structures import STEEL, TUBE

from crumple.errors import InputError, Status
from crumple.multibody import Run, solve_multibody
from crumple.structure import Stage, Structure

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
    with pytest.raises(InputError, match="nothing holds member bar in a quasi-static stage") as refused:
        solved(bar(**parts))
    assert refused.value.problems[0].where == "analysis.stages[0].kind"


def test_a_stage_counts_the_obstacles_that_it_has():
    both = {"ram": RAM, "floor": FLOOR}
    with pytest.raises(InputError, match="nothing holds"):
        solved(bar(obstacles=both), PUSH.model_copy(update={"obstacles": ("ram",)}))


@pytest.mark.parametrize(
    ("parts", "says"),
    [
        ({"obstacles": {"floor": FLOOR}, "gravity": (0.0, 0.0, -9.81)}, "Nothing holds the structure"),
        ({"supports": {"pin": {"node": "root", "fix": "pin"}}, "loads": [LOAD]}, "member bar"),
    ],
    ids=["falling", "swinging"],
)
def test_what_loads_move_freely_ends_with_a_status(parts, says):
    result = solved(bar(**parts))
    assert result.status is Status.UNHELD
    assert "nothing but inertia resists" in result.reason
    assert says in result.reason
    assert np.isfinite(result["energy.external_work"]).all()


def test_impulses_beyond_every_crash_are_refused():
    clamp = {"supports": {"clamp": {"node": "root", "fix": "pin"}}}
    blow = {"impulses": [{"node": "tip", "impulse": (0.0, 0.0, 1e7)}]}
    with pytest.raises(InputError, match="the impulses throw a part") as refused:
        solve_multibody(bar(**clamp, **blow), Run(0.01, 0.01))
    assert refused.value.problems[0].where == "impulses"


def test_motion_that_a_quasi_static_stage_takes_away_is_told():
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
    assert any("out of the motion" in text for text in result.warnings)
    assert result.energy_residual < 1e-3
