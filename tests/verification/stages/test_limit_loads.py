"""Portal and fixed beam under forces that grow beyond their limit load in a quasi-static stage.

- Limit loads by virtual work: portal under a force at the level of its beam 4 M_p/h, h between the two
  hinges of a column; beam between clamps of which the far one slides along, under a force P in its middle:
  M_p (theta + 2 theta + theta) = P times the deflection of the middle.
- With a constant moment the lever arm of the columns decreases as they rotate, so the portal finds
  equilibrium beyond, at cos(theta) = limit load/force (virtual work in the rotated position, derived here):
  the run follows it.
- With a moment that decreases as a hinge rotates there is none: the run ends and names the limit load.

Kind: closed form.  Source: derived here.
"""

import re

import numpy as np
import pytest
from tests.support.structures import constant_law
from tests.verification.spatial.test_spatial_lowering import MOMENT, frame, tube

from crumple.errors import Status
from crumple.multibody import Run, solve_multibody
from crumple.structure import Stage

SOFT = {
    "type": "table",
    "rotation": (0.0, 0.05, 0.5, 3.0),
    "moment": (MOMENT, MOMENT, 0.3 * MOMENT, 0.25 * MOMENT),
    "rate": "off",
}
"""Level until all hinges have yielded, then falling."""
ABOVE = 1.5
"""Force at the end of the stage over the limit load."""


def loaded(node, axis, force):
    return [{"node": node, "force": {axis: {"table": {"time": (0.0, 1.0), "value": (0.0, force)}}}}]


def portal(law):
    nodes = {"a": (0, 0, 0), "b": (0, 0, 1), "c": (1.5, 0, 1), "d": (1.5, 0, 0)}
    turned = {"up": (0, 1, 0), "roll": np.pi / 2, "law": law}
    members = {
        "ab": tube("a", "b", ("foot", 0.02), ("knee", 0.98), **turned),
        "bc": tube("b", "c"),
        "cd": tube("c", "d", ("far_knee", 0.02), ("far_foot", 0.98), **turned),
    }
    clamps = {f"s{node}": {"node": node, "fix": "all"} for node in "ad"}
    limit = 4.0 * MOMENT / 0.96
    return frame(nodes, members, supports=clamps, loads=loaded("b", "x", ABOVE * limit)), limit


def beam(law):
    nodes = {"a": (0, 0, 0), "m": (1, 0, 0), "b": (2, 0, 0)}
    members = {
        "am": tube("a", "m", ("left", 0.02), ("middle", 0.99), law=law),
        "mb": tube("m", "b", ("right", 0.98), law=law),
    }
    slide = {"node": "b", "fix": ("y", "z", "rx", "ry", "rz")}
    supports = {"clamp": {"node": "a", "fix": "all"}, "slide": slide}
    # the middle hinge lies 10 mm beside the force, which sinks with the right bar
    ratio, sink = (1.98 - 0.99) / (0.99 - 0.02), 1.98 - 1.0
    limit = MOMENT * (ratio + (1.0 + ratio) + 1.0) / sink
    return frame(nodes, members, supports=supports, loads=loaded("m", "z", -ABOVE * limit)), limit


def pushed(structure, every=0.05):
    stage = Stage(name="push", kind="quasi-static", duration=1.0)
    return solve_multibody(structure, Run(1.0, every, stages=(stage,)))


@pytest.mark.parametrize("form", ["set-valued", "elastic-plastic"])
def test_portal_follows_its_equilibrium_beyond_the_limit_load(form, record_figure):
    structure, limit = portal(constant_law(MOMENT, form=form))
    result = pushed(structure)
    assert result.status.ok, result.reason
    force = ABOVE * limit * result.time
    # nearer to the limit load the rotation has no bound on its rate, and drag holds it back
    beyond = force > 1.1 * limit
    expected = np.arccos(limit / force[beyond])
    worst = np.abs(result["hinge.foot.rotation"][beyond] - expected).max()
    record_figure(f"portal beyond its limit load, {form}, error of the rotation", worst, 0.0, 2e-3, "rad")
    assert worst < 2e-3
    # it stays up to the limit load; elastic hinges turn by M/k until then
    assert np.abs(result["hinge.foot.plastic_rotation"][force < 0.99 * limit]).max() < 1e-4
    assert result.energy_residual < 1e-3
    assert result.provenance.settings["steps"] < 10_000


@pytest.mark.parametrize(
    ("structure", "form"),
    [(structure, form) for structure in (portal, beam) for form in ("set-valued", "elastic-plastic")],
    ids=lambda value: value if isinstance(value, str) else value.__name__,
)
def test_loss_of_equilibrium_names_the_limit_load(structure, form, record_figure):
    whole, _ = structure({**SOFT, "form": form})
    result = pushed(whole)
    assert result.status is Status.LIMIT_LOAD
    reported = re.search(r"ended ([\d.]+) ms into stage push .* ([\d.]+) of the largest", result.reason)
    assert reported, result.reason
    found = ABOVE * float(reported[2])
    assert found == pytest.approx(ABOVE * float(reported[1]) / 1e3, rel=1e-3)
    record_figure(f"limit load that a run names, {structure.__name__}, {form}", found, 1.0, 0.01)
    assert found == pytest.approx(1.0, abs=0.01)
    assert "loss of equilibrium" in result.stages[0].ended_by
    # what it has is kept, up to where it is no snap any more
    assert result.time[-1] < 0.7
    assert max(hinge.rotation_max for hinge in result.hinges.values()) > 0.3
    assert result.provenance.settings["steps"] < 2_000
