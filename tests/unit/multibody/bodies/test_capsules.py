"""Capsules of members that touch obstacles."""

import numpy as np
import pytest
from tests.support.multibody.frames import member, structure

from crumple.multibody.bodies.linkage import link
from crumple.multibody.bodies.obstacle_bodies import member_capsules


@pytest.mark.parametrize("segments", [None, 4, 32])
def test_capsules_of_a_free_member_end_at_its_ends_however_it_is_cut(segments):
    keys = {} if segments is None else {"elastic": segments}
    nodes = {"a": (0.0, 0.0, 0.0), "b": (0.2, 0.0, 0.0)}
    whole = structure(nodes=nodes, members={"ab": member("a", "b", ("h", 0.1), **keys)}, supports={})
    frame = whole.frame_of("ab")
    capsules, owner = member_capsules(whole, link(whole).pieces)
    along = np.array(
        [[(end - frame.origin) @ frame.axes[0] for end in (c.first, c.second)] for c in capsules]
    )
    radius = capsules[0].radius
    assert set(owner) == {"ab"}
    assert along.min() == pytest.approx(1.001 * radius)
    assert along.max() == pytest.approx(frame.length - 1.001 * radius)
    assert np.all(np.diff(along, axis=1) >= 0.0)
    rows = 2  # beside each other in a flat section
    assert np.sum(np.diff(along, axis=1)) == pytest.approx(rows * (frame.length - 2.002 * radius))
