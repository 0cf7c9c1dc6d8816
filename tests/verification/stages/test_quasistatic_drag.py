"""Motion out of equilibrium in a quasi-static stage: a body of three inertias under an inclined moment.

Nothing but drag resists, 0.1/s times the inertia times the rate (docs/theory/spatial_kernel.md): with I
rotating with the body, 0.1/s I w = M, so w = I^-1 M/(0.1/s), integrated here by SciPy.  A body has no
momentum in such a stage: its rate does not depend on how its inertia rotates.

Kind: independent calculation.  Source: derived here.
"""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

from crumple._core.spatial.model import SpatialBody, SpatialJoint, SpatialLoad, SpatialModel
from crumple._core.spatial.simulation import SpatialSimulation

DRAG = 0.1
INERTIA = np.array([0.01, 0.02, 0.04])
MOMENT = np.array([1.0, -2.0, 3.0])
ACCURACY = 1e-4


def turned(times):
    """Orientations from the law of drag, (n, 4), scalar last."""

    def rate(_, q):
        place = Rotation.from_quat(q)
        wx, wy, wz = place.apply(place.inv().apply(MOMENT) / INERTIA) / DRAG
        x, y, z, w = q
        return 0.5 * np.array(
            [
                wx * w + wy * z - wz * y,
                wy * w + wz * x - wx * z,
                wz * w + wx * y - wy * x,
                -wx * x - wy * y - wz * z,
            ]
        )

    return solve_ivp(rate, (0.0, times[-1]), [0, 0, 0, 1.0], t_eval=times, rtol=1e-10, atol=1e-12).y.T


def test_drag_alone_turns_a_body(record_figure):
    # rates of 1000 rad/s: a snap
    times = np.linspace(0.0, 3e-4, 7)
    body = SpatialBody(1.0, np.diag(INERTIA), np.zeros(3))
    ball = SpatialJoint(-1, 0, np.zeros(3), np.eye(3), (True, True, True, False, False, False))
    load = SpatialLoad(0, np.zeros(3), np.zeros(3), MOMENT, np.array([0.0, 1.0]), np.ones(2))
    run = SpatialSimulation(SpatialModel((body,), (ball,), loads=(load,)), ACCURACY)
    run.stage(quasi_static=True)
    record = run.run(times)
    got = Rotation.from_quat(np.roll(record.rotation[:, 0], -1, axis=-1))
    expected = Rotation.from_quat(turned(times))[: len(record.time)]
    np.testing.assert_allclose(record.time, times[: len(record.time)], rtol=1e-12)
    largest = expected.magnitude().max()
    assert len(record.time) > 3
    worst = (got * expected.inv()).magnitude().max() / largest
    # steps out of equilibrium err by up to 2 % each
    record_figure("turn of a body that drag alone resists, error over the largest", worst, 0.0, 2e-2)
    assert worst == pytest.approx(0.0, abs=2e-2)
