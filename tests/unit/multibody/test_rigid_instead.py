"""Where members that bend by default end a run early, the answer is that of rigid bars, and says so."""

import os
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest
from tests.unit.multibody.checks.test_overloaded import rails

from crumple._core.outcome import Outcome
from crumple.analysis import loads, with_law_range, with_modes
from crumple.analysis import solve as solve_analysis
from crumple.analysis.solve import run_of
from crumple.multibody import Run, solve, solve_multibody
from crumple.multibody.checks import crushing, overloaded, trust
from crumple.structure import MultibodySettings

FRAME = Path("examples/12_l_frame.yaml").read_text(encoding="utf-8")


@pytest.fixture(name="ended")
def _ended(monkeypatch):
    """Every run that would complete counts as one that ended early."""
    monkeypatch.setattr(solve, "CANNOT_GO_ON", frozenset({Outcome.COMPLETE}))


def with_members(members):
    analysis = loads(FRAME)
    settings = analysis.multibody.model_copy(update={"members": members})
    return analysis.model_copy(update={"multibody": settings})


def test_the_answer_is_that_of_rigid_bars(ended):
    found, rigid = solve_analysis(with_members("auto")), solve_analysis(with_members("rigid"))
    assert found.status.ok
    assert {name: hinge.rotation_max for name, hinge in found.hinges.items()} == {
        name: hinge.rotation_max for name, hinge in rigid.hinges.items()
    }
    assert found.warnings[0].startswith("Members are rigid bars here")
    # but for the advice to let members bend
    assert found.warnings[1:] == tuple(warning.replace(trust.BEND, "") for warning in rigid.warnings)


def crushed():
    text = Path("examples/07_axial_crush.yaml").read_text(encoding="utf-8")
    analysis = loads(text.replace("shell:", "multibody: {members: rigid}\n  shell:"))
    return analysis.structure, run_of(analysis)


def overloaded_rails():
    return rails(), Run(0.02, 5e-4, MultibodySettings(kernel="spatial", members="rigid"))


@pytest.mark.parametrize(("given", "advice"), [(crushed, crushing.BEND), (overloaded_rails, overloaded.BEND)])
def test_the_answer_does_not_advise_what_was_tried(given, advice):
    """Each check leaves the advice out; nothing is cut out of finished sentences."""
    structure, run = given()
    run = replace(run, checks=False)
    plain, tried = (
        [one.text for one in solve_multibody(structure, replace(run, bending_tried=known)).cautions]
        for known in (False, True)
    )
    assert any(advice in text for text in plain)
    assert tried == [text.replace(advice, "") for text in plain]


def test_members_that_were_asked_to_bend_do(ended):
    found = solve_analysis(with_members("elastic"))
    assert not any(warning.startswith("Members are rigid bars here") for warning in found.warnings)
    assert (
        found.hinges["corner-corner"].rotation_max
        != solve_analysis(with_members("rigid")).hinges["corner-corner"].rotation_max
    )


def test_ranges_and_modes_of_such_an_answer_are_found(ended):
    analysis = with_members("auto")
    result = with_modes(with_law_range(solve_analysis(analysis), analysis), analysis)
    assert result.provenance.settings["members"] == "rigid"
    assert result.law_range is not None
    assert result.law_range.failed == ()
    hinge = result.hinges["corner-corner"]
    assert result.law_range.cases["nominal"]["hinge.corner-corner.energy"] == hinge.energy
    assert result.modes is not None


CRAMPED = """
import resource
import crumple
from tests.support import random_frames
resource.setrlimit(resource.RLIMIT_AS, (2 << 30, resource.RLIM_INFINITY))
whole = random_frames.frame(1, 222)
structure = whole.structure.model_copy(update={"obstacles": {}})
short = whole.model_copy(update={"structure": structure, "duration": 5e-4})
result = crumple.solve(short)
assert result.status.ok
assert not any("rigid bars" in warning for warning in result.warnings)
"""


@pytest.mark.skipif(sys.platform != "linux", reason="limits the address space")
@pytest.mark.skipif("san.so" in os.environ.get("LD_PRELOAD", ""), reason="sanitizers need address space")
def test_joints_at_one_place_leave_no_bar_without_length():
    """Rounding left 1e34 m/s of a step of such bars; with them 1175 pairs of bars touched, in all memory."""
    root = Path(__file__).parents[3]
    environment = {"PYTHONPATH": str(root), "OPENBLAS_NUM_THREADS": "1"}
    script = [sys.executable, "-c", CRAMPED]
    done = subprocess.run(script, cwd=root, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
