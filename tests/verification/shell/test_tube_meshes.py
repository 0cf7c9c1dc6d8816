"""The tube of example 01 as shells on other meshes: the effect of each change.

There is no outside reference: the uniform mesh of 5 mm is the reference for the others, within the 3 % that
a graded mesh is allowed.  The thickness of the walls changes the rotation by 6 to 9 %, here and in the runs
of the other code; for this reason it follows the strain unless switched off.

Kind: invariant.  Source: derived here.
"""

from types import SimpleNamespace

import numpy as np
import pytest

from crumple.analysis import load
from crumple.shell import ShellRun, solve_shell
from crumple.structure import ShellSettings

FINE = {"fine_size": 5e-3, "fine_length": 0.1, "growth": 1.1}
SETTINGS = {
    "uniform": ShellSettings(element_size=5e-3),
    "graded": ShellSettings(element_size=15e-3, **FINE),
    "thickness kept": ShellSettings(element_size=15e-3, **FINE, thickness_update=False),
}


@pytest.fixture(scope="module")
def runs():
    analysis = load("examples/01_tube_bending.yaml")
    return {
        name: solve_shell(analysis.structure, ShellRun(analysis.duration, 5e-4, shell, analysis.outputs))
        for name, shell in SETTINGS.items()
    }


def largest_rotation(result):
    return float(np.abs(result["tip_rotation"]).max())


@pytest.mark.slow
def test_meshes_are_those_named(runs):
    elements = {name: result.provenance.settings["elements"] for name, result in runs.items()}
    assert elements["uniform"] == 5600
    assert elements["graded"] < 2600


@pytest.mark.slow
def test_a_graded_mesh_gives_rotation_and_plastic_energy(runs, record_figure):
    uniform, graded = runs["uniform"], runs["graded"]
    turned = largest_rotation(graded) / largest_rotation(uniform)
    record_figure("largest rotation, graded over uniform mesh", turned, 1.0, 0.03)
    spent = graded["energy.dissipated"][-1] / uniform["energy.dissipated"][-1]
    record_figure("plastic energy, graded over uniform mesh", spent, 1.0, 0.03)


@pytest.mark.slow
def test_walls_that_keep_their_thickness_turn_further(runs, record_figure):
    further = largest_rotation(runs["thickness kept"]) / largest_rotation(runs["graded"]) - 1.0
    record_figure("rotation more without thickness update", further, 0.08, 0.03)


@pytest.mark.slow
@pytest.mark.parametrize("name", SETTINGS)
def test_runs_are_to_be_believed(name, runs, record_figure):
    result = runs[name]
    record_figure(f"energy residual, {name}", result.energy_residual, 0.0, 1e-2)
    internal = (result["energy.elastic"] + result["energy.dissipated"]).max()
    record_figure(f"hourglass share, {name}", result["energy.hourglass"].max() / internal, 0.0, 0.05)


@pytest.mark.slow
def test_the_compressed_flange_folds_inwards(runs):
    """At the root the compressed flange sinks into the tube and the webs bulge, until it rests."""
    states = runs["uniform"].states
    folded = [shape_of_fold(states, row) for row in range(len(states.times))]
    sunk = np.array([shape.sunk for shape in folded])
    bulged = np.array([shape.bulged for shape in folded])
    assert sunk[0] == pytest.approx(0.0, abs=1e-12)
    assert np.all(np.diff(sunk[:5]) > 0.0)
    # the flanges are 22.35 mm apart at the start: less than a third of it would be a dent, no fold
    assert sunk[-1] > 22.35e-3 / 3.0
    assert bulged[-1] > 1e-3


def shape_of_fold(states, row):
    """How far the flanges have come together and the webs apart [m], at the section where both are most."""
    near = np.flatnonzero((states.station > 0.0) & (states.station < 0.06))
    moved = states.points + states.displacement[row]
    sunk = bulged = 0.0
    for station in np.unique(states.station[near]):
        ring = near[states.station[near] == station]
        start, now = states.points[ring], moved[ring]
        up, across = start[:, 2], start[:, 1]
        flanges = [np.isclose(up, level) & (np.abs(across) < 3e-3) for level in (up.min(), up.max())]
        webs = [np.isclose(across, side) for side in (across.min(), across.max())]
        depth = [
            np.linalg.norm(points[flanges[1]].mean(0) - points[flanges[0]].mean(0)) for points in (start, now)
        ]
        width = [np.ptp(points[webs[0] | webs[1], 1]) for points in (start, now)]
        sunk, bulged = max(sunk, depth[0] - depth[1]), max(bulged, width[1] - width[0])
    return SimpleNamespace(sunk=sunk, bulged=bulged)
