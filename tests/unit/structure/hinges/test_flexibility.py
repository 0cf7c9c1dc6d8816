"""Lengths that hinges and elastic joints stand for: exact for linear moments, positive, few joints.

Closed forms: Simpson's and Radau's formulas, the triangle of moments of a cantilever.
"""

import numpy as np
import pytest

from crumple.structure.hinges.flexibility import (
    FEW,
    LEAST,
    MOST_JOINTS,
    PLACES,
    _Bar,
    flexibility,
    tributary_lengths,
)


def points(stations, length=1.0, rigid=(), free=(False, False)):
    """Stations and lengths of hinges and joints together, along the bar."""
    found = flexibility(tuple(stations), length, rigid, free)
    pairs = [*zip(stations, found.lengths, strict=True), *found.joints]
    return np.array(sorted(pairs)).T, len(found.joints)


def moments(length, rigid):
    """Integrals of 1, x and x^2 over what is not rigid."""
    parts = [(0.0, length, 1.0), *((a, b, -1.0) for a, b in rigid)]
    return [sum(sign * (b**k - a**k) / k for a, b, sign in parts) for k in (1, 2, 3)]


@pytest.mark.parametrize(
    ("stations", "expected"),
    [
        ((0.0, 2.0), [(0.0, 1 / 3), (1.0, 4 / 3), (2.0, 1 / 3)]),
        ((0.0, 1.0, 2.0), [(0.0, 1 / 3), (1.0, 4 / 3), (2.0, 1 / 3)]),
        ((0.0,), [(0.0, 0.5), (4 / 3, 1.5)]),
        ((1.0,), [(0.25, 16 / 27), (1.0, 22 / 27), (1.75, 16 / 27)]),
    ],
    ids=["Simpson", "without joint", "Radau", "middle"],
)
def test_known_formulas(stations, expected):
    found, _ = points(stations, 2.0)
    np.testing.assert_allclose(found.T, expected, rtol=1e-12, atol=1e-12)


@pytest.mark.parametrize("seed", range(60))
def test_hinges_anywhere_are_exact_for_linear_moments(seed):
    """Both squares and products of linear moments; every length positive; at most two joints, apart."""
    rng = np.random.default_rng(seed)
    length, rigid = rng.uniform(0.1, 5.0), ()
    if seed % 2:
        a, b = np.sort(rng.uniform(0.1, 0.9, 2)) * length
        rigid = ((float(a), float(b)),)
    bends = [(0.0, length)] if not rigid else [(0.0, rigid[0][0]), (rigid[0][1], length)]
    stations = []
    while len(stations) < 1 + seed % 6:
        a, b = bends[rng.integers(len(bends))]
        stations.append(float(rng.uniform(a, b)))
    stations = sorted(stations)
    (at, lengths), joints = points(stations, length, rigid)
    found = [np.sum(lengths * at**k) for k in range(3)]
    np.testing.assert_allclose(found, moments(length, rigid), rtol=1e-8)
    near = tributary_lengths(at, length, rigid)
    assert (lengths >= LEAST * np.array(near) * (1.0 - 1e-9)).all()
    assert joints <= MOST_JOINTS
    total = moments(length, rigid)[0]
    for station, _ in flexibility(tuple(stations), length, rigid).joints:
        others = [0.0, length, *(other for other in at if other != station)]
        assert np.abs(np.array(others) - station).min() > 0.99 * total / PLACES
        assert any(a <= station <= b for a, b in bends)


def test_many_hinges_tend_to_their_tributary_lengths():
    """The sum misses int x^2 by 1/(12 n^2); a quadratic that makes up for it is 2.5/n^2 at the ends."""
    for number in (10, 40, 160):
        stations = tuple((np.arange(number) + 0.5) / number)
        found = flexibility(stations, 1.0)
        assert not found.joints
        assert np.abs(np.array(found.lengths) * number - 1.0).max() < 2.51 / number**2


@pytest.mark.parametrize("free", [(False, True), (True, False)])
@pytest.mark.parametrize("stations", [(0.0,), (0.1,), (0.05, 0.3), (0.0, 0.6)])
def test_a_free_end_needs_no_joint(stations, free):
    """The tip of a cantilever moves as that of the beam: sum l_i (L - x_i)^2 = L^3/3."""
    if free[0]:
        stations = tuple(sorted(1.0 - x for x in stations))
    found = flexibility(stations, 1.0, (), free)
    end = 0.0 if free[0] else 1.0
    assert not found.joints
    arms = np.array(stations) - end
    assert np.sum(np.array(found.lengths) * arms**2) == pytest.approx(1.0 / 3.0)


def test_a_hinge_near_the_free_end_gets_joints():
    assert flexibility((0.9,), 1.0, (), (False, True)) == flexibility((0.9,), 1.0)
    assert flexibility((0.9,), 1.0).joints


def test_both_ends_free():
    assert flexibility((0.4,), 1.0, (), (True, True)).lengths == pytest.approx([1.0 / 3.0])
    assert flexibility((0.2, 0.7), 1.0, (), (True, True)).lengths == pytest.approx([0.45, 0.55])


@pytest.mark.parametrize("number", [3, 5, 11])
def test_half_waves_between_free_ends_are_exact(number):
    """Borders of segments, and their middles: half of all lengths times the largest moment squared."""
    for places in (np.arange(1, number) / number, (np.arange(number) + 0.5) / number):
        if len(places) < FEW:
            continue
        (stations, lengths), joints = points(places, free=(True, True))
        assert joints == 0
        assert lengths @ np.sin(np.pi * stations) ** 2 == pytest.approx(0.5)
        np.testing.assert_allclose(lengths, lengths[0])


@pytest.mark.parametrize("first", [0.0, 0.05, 0.1])
def test_beside_one_free_end_lengths_are_even_and_exact_for_the_moment_that_vanishes_there(first):
    (stations, lengths), joints = points([first, *np.arange(1, 6) / 6.0], free=(False, True))
    assert joints == 0
    assert lengths @ (1.0 - stations) ** 2 == pytest.approx(1.0 / 3.0)
    # exact for all linear moments, the last had 0.30
    assert lengths[2:].max() < 1.05 * lengths[2:].min()
    (turned, mirrored), _ = points(np.sort(1.0 - stations), free=(True, False))
    np.testing.assert_allclose(mirrored[::-1], lengths)
    np.testing.assert_allclose(turned[::-1], 1.0 - stations)


def test_tributary_lengths_leave_out_what_is_rigid_and_are_never_nothing():
    assert tributary_lengths([0.1], 0.9, ((0.3, 0.6),)) == pytest.approx([0.6])
    assert tributary_lengths([0.1, 0.7], 0.9, ((0.3, 0.6),)) == pytest.approx([0.3, 0.3])
    between = tributary_lengths([0.2, 0.5, 0.8], 1.0, ((0.21, 0.49), (0.51, 0.79)))
    assert min(between) > 0.0
    assert sum(between) == pytest.approx(0.44)


@pytest.mark.parametrize("stretches", [((0.0, 2.0),), ((0.0, 0.5), (0.8, 2.0))])
def test_many_sets_of_points_have_the_least_weights_of_each(stretches):
    """The search of joints takes all sets at once; among them some without exact weights."""
    bar = _Bar(2.0, stretches)
    rng = np.random.default_rng(2)
    for count in (1, 2, 3, 5):
        sets = np.sort(2.0 * rng.random((40, count)), axis=1)
        alone = [bar.exact(points)[1] for points in sets]
        np.testing.assert_allclose(bar._least(sets), alone, rtol=1e-6, atol=1e-9)
        assert count > 2 or -1.0 in alone
