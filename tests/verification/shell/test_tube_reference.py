"""The tube of example 01 as shells agrees with another explicit code on the same mesh.

Reference: OpenRadioss (source of August 2026, double precision), Belytschko-Tsay element, 5 mm to 200 mm
and then growing to 15.7 mm, 10 x 4 elements per flange and web, 5 thickness points, thickness update on,
wall on its mid-line with sharp corners, 6 kg at the centroid of a rigid end section.  Figures, read from
its histories: largest rotation of the tip 0.6075 rad at 87.8 ms, internal energy against the rotation of
the tip and root moment against time as in the tables below.

Tolerance: 6 % throughout.  The product reduces hourglass forces with the plastic stress and spaces the
elements between 200 and 300 mm a little differently, and softening is sensitive to such choices: the second
element of the other code gives 0.576 rad with 5 mm.  Moments are means over 4 ms, because bending vibration
of the tube passes through the root section.

Kind: other code.  Source: run here.
"""

import numpy as np
import pytest

from crumple.analysis import load
from crumple.shell import ShellRun, solve_shell
from crumple.structure import ShellSettings

# 200 mm less the hinge's 23.1 mm, so that the fine mesh ends where the reference's does
LIKE_FOR_LIKE = ShellSettings(element_size=15.7e-3, fine_size=5e-3, fine_length=0.1769, growth=1.1)

ENERGY = {0.1: 114.6, 0.2: 283.5, 0.3: 430.5, 0.4: 554.6, 0.5: 668.4}
"""Internal energy [J] at rotations of the tip [rad]."""
MOMENT = {20: 1426.6, 40: 1160.5, 60: 1060.6}
"""Root moment [N m] at times [ms], means over 4 ms."""


@pytest.fixture(scope="module")
def result():
    analysis = load("examples/01_tube_bending.yaml")
    run = ShellRun(analysis.duration, 5e-4, LIKE_FOR_LIKE, analysis.outputs)
    return solve_shell(analysis.structure, run)


@pytest.fixture(scope="module")
def tip_rotation(result):
    return np.arctan2(result["node.tip.displacement.z"], 1.0 + result["node.tip.displacement.x"])


@pytest.mark.slow
def test_mesh_is_that_of_the_reference(result):
    assert result.provenance.settings["elements"] == pytest.approx(2660, rel=0.02)


@pytest.mark.slow
def test_initial_energy(result, record_figure):
    record_figure("initial energy", result["energy.kinetic"][0], 783.79, 1e-4, "J", relative=True)


@pytest.mark.slow
def test_largest_tip_rotation_and_its_time(result, tip_rotation, record_figure):
    at = int(tip_rotation.argmax())
    record_figure("largest tip rotation", tip_rotation[at], 0.6075, 0.06, "rad", relative=True)
    record_figure("time of it", 1e3 * result.time[at], 87.8, 0.06, "ms", relative=True)


@pytest.mark.slow
@pytest.mark.parametrize("rotation", ENERGY)
def test_energy_against_rotation(rotation, result, tip_rotation, record_figure):
    rising = slice(0, int(tip_rotation.argmax()))
    internal = (result["energy.elastic"] + result["energy.dissipated"])[rising]
    value = float(np.interp(rotation, tip_rotation[rising], internal))
    record_figure(f"internal energy at {rotation} rad", value, ENERGY[rotation], 0.06, "J", relative=True)


@pytest.mark.slow
def test_peak_of_the_root_moment(result, record_figure):
    peak = float(np.abs(result["support.clamp.moment.y"]).max())
    record_figure("peak root moment", peak, 1744.1, 0.06, "N m", relative=True)


@pytest.mark.slow
@pytest.mark.parametrize("ms", MOMENT)
def test_root_moment(ms, result, record_figure):
    near = np.abs(result.time - 1e-3 * ms) < 2e-3
    mean = float(np.abs(result["support.clamp.moment.y"][near]).mean())
    record_figure(f"root moment at {ms} ms", mean, MOMENT[ms], 0.06, "N m", relative=True)


@pytest.mark.slow
def test_run_is_to_be_believed(result, record_figure):
    record_figure("energy residual", result.energy_residual, 0.0, 1e-2)
    internal = (result["energy.elastic"] + result["energy.dissipated"]).max()
    record_figure("hourglass share", result["energy.hourglass"].max() / internal, 0.0, 0.05)
    assert not result.warnings
    assert result.provenance.settings["deepest_penetration"] == 0.0


@pytest.mark.slow
def test_plastic_work_lies_in_the_hinge(result, record_figure):
    """The reference has 90 % of its plastic strain within 45 mm of the root; the zone has 90 mm."""
    share = result["hinge.root.energy"][-1] / result["energy.dissipated"][-1]
    record_figure("plastic work within the hinge's zone", share, 0.95, 0.05)
