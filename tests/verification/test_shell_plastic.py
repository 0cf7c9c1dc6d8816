"""Shell engine against limit loads, and against another explicit code.

- Strip of an elastic-perfectly plastic metal: plastic moment M_p = yield b t^2/4 as the points see it (five
  Gauss points have 94.5 % of it, ten 100.8 %); limit load of a cantilever between M_p/L and 1.155 M_p/L.
- A tube on the same mesh in OpenRadioss (Belytschko-Tsay); skipped unless the environment variable
  CRUMPLE_REFERENCE names the folder of its deck and histories.
"""

import os
from pathlib import Path

import numpy as np
import pytest
from sheets import grid, model
from shell_reference import compared, run, tube

from crumple._core.shell import Cut, PrescribedVelocity, RigidSet, ShellMaterial, ShellState, thickness_rule

LENGTH, WIDTH, WALL, YIELD = 0.1, 0.01, 4e-3, 300e6
REFERENCE = Path(os.environ.get("CRUMPLE_REFERENCE", "reference"))


def strip(points, motions, damping=2000.0, **more):
    """Strip 100 x 10 x 4 mm, clamped at x = 0 but free to contract in width there; cut 0 is the clamp."""
    x, quads = grid(40, 4, LENGTH, WIDTH)
    fixed = np.zeros((len(x), 6), dtype=bool)
    fixed[x[:, 0] == 0] = [True, False, True, False, True, True]
    fixed[2, 1] = True
    cut = Cut(np.arange(4), np.arange(5))
    material = ShellMaterial(7850.0, 210e9, 0.3, yield_stress=YIELD)
    settings = {"damping": damping}
    return ShellState(
        model(x, quads, WALL, material, points, settings, fixed=fixed, motions=motions, cuts=[cut], **more)
    )


def plastic_moment(points):
    """Moment with every thickness point at yield [N m]."""
    z, weight = thickness_rule(points)
    return YIELD * WIDTH * WALL**2 * (weight @ abs(z))


def late(state, kind, axis, times):
    """Mean of a component of the clamp's force (0) or moment (1)."""
    values = []
    for time in times:
        state.advance(time)
        values.append(state.cut(0)[kind][axis])
    return abs(np.mean(values))


@pytest.mark.parametrize("points", [5, 10])
def test_plastic_moment_of_a_strip(points):
    """End turned without a force: every section yields, and the moment is the plastic one."""
    turn = PrescribedVelocity(0, "ry", [0, 0.01], [0, -30.0], rigid_set=True)
    state = strip(points, [turn], 200.0, rigid_sets=[RigidSet(range(200, 205), mass=1e-3)])
    moment = late(state, 1, 1, np.linspace(0.014, 0.022, 60))
    # of ten points the two nearest the middle, which carry 2 %, are just about to yield
    assert moment == pytest.approx(plastic_moment(points), rel=0.03)


@pytest.mark.parametrize("points", [5, 10])
def test_limit_load_of_a_cantilever(points):
    """End pushed aside: a hinge as short as one element, held in width by what stays elastic.

    So the load lies between those of plane stress and plane strain (factor 1.155); the arm ends in the
    middle of the first element.
    """
    motions = [PrescribedVelocity(n, "z", [0, 0.01, 0.012], [0, 1.0, 0.01]) for n in range(200, 205)]
    state = strip(points, motions)
    force = late(state, 0, 2, np.linspace(0.014, 0.018, 20))
    limit = plastic_moment(points) / (LENGTH - 0.5 * LENGTH / 40)
    assert limit < force < 1.155 * limit
    e = state.energies
    assert e["hourglass"] < 0.05 * e["plastic"]
    assert abs(e["residual"]) < 1e-3 * e["external_work"]


@pytest.mark.slow
@pytest.mark.skipif(not REFERENCE.exists(), reason="the reference runs are not here")
def test_tube_like_the_other_code():
    """Same mesh and element: rotations, time, root moment, absorbed energy within 3 %."""
    r = np.genfromtxt(REFERENCE / "tube_weak_axis_bt_5mm.csv", delimiter=",", names=True)
    h = run(tube(REFERENCE / "tube_weak_axis_bt_5mm_0000.rad", warping_correction=False), threads=2)
    for name, ours, theirs in compared(h, r):
        assert ours == pytest.approx(theirs, rel=0.03), name
    assert h["hourglass"].max() < 0.05 * h["kinetic"][0]
    assert abs(h["residual"]).max() < 1e-4 * h["kinetic"][0]
