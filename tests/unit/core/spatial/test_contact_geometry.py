"""Contact of capsules with convex solids: gaps, normals, and how many points hold a capsule."""

import math

import numpy as np
import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

from crumple._core import _kernels

PLANE, CYLINDER, SPHERE, CAPSULE = range(4)
Z = (0.0, 0.0, 1.0)


def solid(shape, *, point=(0.0, 0.0, 0.0), direction=Z, edge=(0.0, 0.0, 0.0), radius=0.0, length=0.0):
    """As the kernel takes it."""
    return {
        "kind": shape,
        "point": list(point),
        "direction": list(direction),
        "edge": list(edge),
        "radius": radius,
        "length": length,
    }


def touches(body, first, second, radius):
    """Points of contact by slot: (gap, normal, point)."""
    found = _kernels.spatial.touches(body, list(map(float, first)), list(map(float, second)), radius)
    return {slot: (gap, np.array(normal), np.array(point)) for gap, normal, point, slot in found}


WEDGE = solid(PLANE, edge=(1.0, 0.0, 0.0))
POST = solid(CYLINDER, radius=0.3, length=1.0)
POLE = solid(CYLINDER, direction=(0.0, 1.0, 0.0), radius=0.3)
SOLIDS = {
    "plane": solid(PLANE),
    "wedge": WEDGE,
    "pole": POLE,
    "post": POST,
    "sphere": solid(SPHERE, radius=0.4),
    "capsule": solid(CAPSULE, point=(0.0, -0.5, 0.0), direction=(0.0, 1.0, 0.0), radius=0.2, length=1.0),
}


def outside(name, x):
    """Distance of points (n, 3) that lie outside, each solid by its own formula."""
    x, y, z = np.asarray(x).T
    if name == "plane":
        return z
    if name == "wedge":
        return np.hypot(np.maximum(x, 0), np.maximum(z, 0))
    if name == "pole":
        return np.hypot(x, z) - 0.3
    if name == "post":
        return np.hypot(np.maximum(np.hypot(x, y) - 0.3, 0), np.maximum(np.abs(z - 0.5) - 0.5, 0))
    if name == "sphere":
        return np.sqrt(x**2 + y**2 + z**2) - 0.4
    return np.sqrt(x**2 + (y - np.clip(y, -0.5, 0.5)) ** 2 + z**2) - 0.2


POINT = st.tuples(*[st.floats(-1.0, 1.0)] * 3)


# most segments pass through the solid and are drawn again
@pytest.mark.parametrize("name", SOLIDS)
@settings(suppress_health_check=[HealthCheck.filter_too_much])
@given(first=POINT, second=POINT)
def test_least_gap_is_that_of_the_nearest_point_of_the_segment(name, first, second):
    """Against 2001 points along the segment, where all of it lies outside."""
    along = np.linspace(first, second, 2001)
    nearest = outside(name, along).min()
    assume(nearest > 0.01)
    found = touches(SOLIDS[name], first, second, 0.05)
    gap = min(gap for gap, _, _ in found.values())
    # the sampled minimum lies above the true one by at most (spacing/2)^2/(2 x distance); the valley by its
    # flatness
    spacing = np.linalg.norm(np.subtract(second, first)) / 2000
    assert gap <= nearest - 0.05 + 2e-7
    assert gap >= nearest - 0.05 - spacing**2 / (8 * nearest) - 1e-12


@pytest.mark.parametrize("name", SOLIDS)
@given(first=POINT, second=POINT)
def test_points_lie_midway_between_the_surfaces_along_the_normal(name, first, second):
    for gap, normal, point in touches(SOLIDS[name], first, second, 0.05).values():
        assert np.linalg.norm(normal) == pytest.approx(1.0, abs=1e-12)
        centre = point + (0.05 + gap / 2) * normal
        if gap > -0.04 and outside(name, [centre])[0] > 0.01:
            assert outside(name, [centre])[0] == pytest.approx(gap + 0.05, abs=1e-7)
            assert outside(name, [point])[0] == pytest.approx(gap / 2, abs=1e-7) or gap < 0


def test_capsule_on_a_plane_is_held_by_its_ends():
    found = touches(SOLIDS["plane"], (0, 0, 0.2), (2, 0, 0.3), 0.1)
    assert set(found) == {0, 1}
    assert [found[k][0] for k in (0, 1)] == pytest.approx([0.1, 0.2])
    np.testing.assert_allclose(found[1][2], (2, 0, 0.1))


@pytest.mark.parametrize(
    ("name", "first", "second", "places"),
    [
        # along the pole: both ends
        ("pole", (0.0, -1.0, 0.35), (0.0, 1.0, 0.35), [-1.0, 1.0]),
        # along a shorter capsule: where its cylinder ends; sqrt(2 r flatness length) further by the flatness
        ("capsule", (0.0, -1.0, 0.25), (0.0, 1.0, 0.25), [-0.5, 0.5]),
        # partly beside it: one end of each
        ("capsule", (0.0, 0.0, 0.25), (0.0, 2.0, 0.25), [0.0, 0.5]),
        # across the post's top
        ("post", (0.0, -1.0, 1.05), (0.0, 1.0, 1.05), [-0.3, 0.3]),
    ],
)
def test_capsule_that_lies_along_a_solid_is_held_at_two_places(name, first, second, places):
    found = [
        (gap, point) for gap, _, point in touches(SOLIDS[name], first, second, 0.05).values() if gap < 1e-6
    ]
    assert len(found) == 2
    assert sorted(point[1] for _, point in found) == pytest.approx(places, abs=1e-3)


def test_capsule_across_a_pole_touches_at_one_point():
    found = touches(POLE, (-1, 0.2, 0.4), (1, 0.2, 0.4), 0.05)
    gap, normal, point = found[2]
    assert set(found) == {0, 1, 2}
    assert gap == pytest.approx(0.05)
    np.testing.assert_allclose(normal, Z, atol=1e-12)
    np.testing.assert_allclose(point, (0, 0.2, 0.325), atol=1e-9)


def test_capsule_over_the_edge_is_held_at_its_end_and_at_the_edge():
    found = touches(WEDGE, (-0.5, 0, 0.05), (0.5, 0, 0.05), 0.05)
    held = [point[0] for gap, _, point in found.values() if gap < 1e-6]
    assert sorted(held) == pytest.approx([-0.5, 0.0], abs=1e-3)


def test_capsule_tipping_over_the_edge_touches_the_corner_at_right_angles():
    slope = math.radians(30)
    along, normal = (
        np.array([math.cos(slope), 0, -math.sin(slope)]),
        np.array([math.sin(slope), 0, math.cos(slope)]),
    )
    middle = 0.06 * normal
    found = touches(WEDGE, middle - 0.4 * along, middle + 0.6 * along, 0.05)
    gap, direction, _ = min(found.values(), key=lambda touch: touch[0])
    assert gap == pytest.approx(0.01, abs=1e-9)
    np.testing.assert_allclose(direction, normal, atol=1e-6)


@pytest.mark.parametrize("tilt", [1e-4, 5e-3, 0.1, 0.7])
@pytest.mark.parametrize("oblique", [0.0, 0.4])
def test_gaps_at_the_edge_change_at_the_rate_of_the_capsule_that_slides_and_lifts(tilt, oblique):
    """Moved by a step: the change of each gap is the step along its normal, to second order."""
    along = np.array([math.cos(tilt), oblique, -math.sin(tilt)])
    middle, step = np.array([0.01, 0.0, 0.0502]), 1e-6 * (3 * along + (0.2, 0.1, 0.5))
    before = touches(WEDGE, middle - 0.4 * along, middle + 0.6 * along, 0.05)
    after = touches(WEDGE, middle - 0.4 * along + step, middle + 0.6 * along + step, 0.05)
    assert set(before) == set(after) >= {0, 1, 3}
    for slot in set(before) - {1}:
        normal = before[slot][1]
        assert after[slot][0] - before[slot][0] == pytest.approx(normal @ step, abs=1e-10)


def test_capsule_without_a_radius_has_a_normal_on_the_edge():
    """Sunk into the corner by 1e-4: between both faces' normals, at right angles to the segment."""
    along, normal = np.array([1, 0, -1]) / math.sqrt(2), np.array([1, 0, 1]) / math.sqrt(2)
    middle = -1e-4 * normal
    gap, direction, _ = touches(WEDGE, middle - 0.5 * along, middle + 0.5 * along, 0.0)[2]
    assert -1.5e-4 < gap < 0
    np.testing.assert_allclose(direction, normal, atol=1e-9)


def test_sphere_has_one_point():
    found = touches(SOLIDS["sphere"], (0, 0, 0.6), (0, 0, 0.6), 0.1)
    assert set(found) == {0}
    assert found[0][0] == pytest.approx(0.1)
