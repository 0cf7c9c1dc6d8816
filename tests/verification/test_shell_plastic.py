"""Shell engine against limit loads, and against another explicit code.

- Cantilever strip of an elastic-perfectly plastic metal, tip moved slowly: limit load M_p / L with
  M_p = yield b t^2/4 as the points see it: five Gauss points have 94.5 % of it, ten 100.8 %.
- The tube of ../shared/reference (OpenRadioss, Belytschko-Tsay, same mesh); skipped where that
  folder is not beside the checkout.
"""

from pathlib import Path

import numpy as np
import pytest
from sheets import grid, model
from shell_reference import compared, run, tube

from crumple._core.shell import Cut, PrescribedVelocity, ShellMaterial, ShellState, thickness_rule

REFERENCE = Path(__file__).parents[3] / "shared" / "reference"


@pytest.mark.parametrize("points", [5, 10])
def test_limit_load_of_a_cantilever(points):
    length, width, t, yield_stress = 0.1, 0.01, 4e-3, 300e6
    x, quads = grid(20, 2, length, width)
    fixed = np.zeros((len(x), 6), dtype=bool)
    fixed[x[:, 0] == 0] = True
    motions = [PrescribedVelocity(n, "z", [0, 0.01, 0.012], [0, 1.0, 0.01]) for n in (60, 61, 62)]
    cut = Cut(np.arange(2), np.arange(3))
    material = ShellMaterial(7850.0, 210e9, 0.3, yield_stress=yield_stress)
    settings = {"damping": 2000.0}
    state = ShellState(
        model(x, quads, t, material, points, settings, fixed=fixed, motions=motions, cuts=[cut])
    )
    forces = []
    for time in np.linspace(0.014, 0.018, 20):
        state.advance(time)
        forces.append(state.cut(0)[0][2])
    z, weight = thickness_rule(points)
    limit = yield_stress * width * t**2 * (weight @ abs(z)) / length
    # the hinge forms in the first element, half an element outside the clamp: L - 2.5 mm
    assert np.mean(forces) == pytest.approx(limit / (1 - 0.025), rel=0.04)
    e = state.energies
    assert e["hourglass"] < 0.05 * e["plastic"]
    assert abs(e["residual"]) < 1e-3 * e["external_work"]


@pytest.mark.slow
@pytest.mark.skipif(not REFERENCE.exists(), reason="the reference runs are not here")
def test_tube_like_the_other_code():
    """Same mesh and element (no warping terms): rotations, time, root moment, absorbed energy within 3 %."""
    r = np.genfromtxt(REFERENCE / "tube_weak_axis_bt_5mm.csv", delimiter=",", names=True)
    h = run(tube(REFERENCE / "tube_weak_axis_bt_5mm_0000.rad", warping_correction=False), threads=2)
    for name, ours, theirs in compared(h, r):
        assert ours == pytest.approx(theirs, rel=0.03), name
    assert h["hourglass"].max() < 0.05 * h["kinetic"][0]
    assert abs(h["residual"]).max() < 1e-4 * h["kinetic"][0]
