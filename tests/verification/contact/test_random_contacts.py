"""Random falls of capsules on planes, poles, balls and each other stay finite and balance their energy.

Kind: invariant.  Source: derived here.
"""

import numpy as np
from hypothesis import example, given, settings
from hypothesis import strategies as st
from tests.support.multibody.contact_models import (
    MAX_RESIDUAL,
    all_pairs,
    plane,
    pole,
    rod,
    rod_shape,
    simulation,
)

from crumple._core.outcome import Outcome
from crumple._core.spatial.model import GROUND, ObstacleKind, SpatialObstacle


@settings(max_examples=40)
@given(
    seed=st.integers(0, 2**32 - 1),
    count=st.integers(1, 3),
    friction=st.sampled_from([0.0, 0.3, 0.8]),
    restitution=st.sampled_from([0.0, 0.3, 0.9]),
    edged=st.booleans(),
)
@example(seed=5, count=2, friction=0.8, restitution=0.3, edged=False)
@example(seed=7, count=3, friction=0.8, restitution=0.3, edged=False)
def test_falls(seed, count, friction, restitution, edged):
    random = np.random.default_rng(seed)
    bodies, capsules, motion = [], [], []
    for k in range(count):
        centre = np.array([*random.uniform(-0.5, 0.5, 2), 0.7 + 0.4 * k])
        half = random.normal(size=3)
        half *= random.uniform(0.15, 0.5) / np.linalg.norm(half)
        ends = (centre - half, centre + half)
        bodies.append(rod(*ends, mass=random.uniform(0.5, 5)))
        capsules.append(rod_shape(k, *ends))
        motion.append([*random.normal(0, 2, 3), *random.normal(0, 2, 3)])
    law = {"friction": friction, "restitution": restitution}
    ball = SpatialObstacle(ObstacleKind.SPHERE, GROUND, np.array([-0.3, 0.2, 0.1]), radius=0.2, **law)
    edge = (1, 0, 0) if edged else (0, 0, 0)
    obstacles = [plane(edge=edge, **law), pole((0.3, 0, 0.1), (0, 1, 0), 0.15, **law), ball]
    run = simulation(bodies, capsules, obstacles, motion, contact=all_pairs(count, friction, restitution))
    record = run.run(np.linspace(0.0, 1.0, 21))
    assert record.outcome is Outcome.COMPLETE
    values = [
        record.centre,
        record.rotation,
        record.velocity,
        record.obstacle_force,
        *vars(record.energy).values(),
    ]
    assert all(np.isfinite(one).all() for one in values)
    assert record.residual < MAX_RESIDUAL
    # kinetic energy less work done only falls; by rounding of the turning bodies' steps it may rise a little
    mechanical = record.energy.kinetic - record.energy.external_work
    start = mechanical[0]
    assert np.diff(mechanical).max() <= MAX_RESIDUAL * start
    if not edged:
        assert record.centre[:, :, 2].min() > 0.049
