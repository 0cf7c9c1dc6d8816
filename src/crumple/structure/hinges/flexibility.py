"""How hinges on a bar share its flexibility, so that bending moments store the energy of the whole bar.

Between its ends a bar carries a bending moment m(x) that is linear, and stores the energy

    1/2 int m(x)^2 / (E I) dx        over the parts of the bar that bend.

Hinges at x_i with springs E I / w_i store 1/2 sum w_i m(x_i)^2 / (E I): a quadrature of the integral with the
lengths w_i as weights.  It is exact for every linear moment if

    sum w_i x_i^k = int x^k dx       for k = 0, 1, 2,

and so are all deflections of the ends (Castigliano).  Of all weights that fulfil this, those nearest to the
tributary lengths t_i are taken, w_i = t_i p(x_i) with a quadratic p.  Where one would be negative or very
small, elastic joints are added as further points.  A bar that shears stores 1/2 int m'(x)^2/(G A_s) dx more,
which with c = E I/(G A_s) adds int c dx to the third condition.  Limits and proof:
docs/theory/member_stiffness.md.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from crumple.numeric.arrays import Floats
from crumple.structure.remembered import remembered

Stretches = tuple[tuple[float, float], ...]

LEAST = 0.1
"""Smallest share of its tributary length that a hinge gets: below it, the spring would be ten times as stiff
as its surroundings and its vibration would determine the time steps."""
MOST = 1.4
"""Largest length of a hinge over its tributary one where a free end leaves one condition: a bar cut in two
equal parts needs 4/3."""
FEW = 3
"""Number of points below which a bar with a free end has the weights of one without, or a single one."""
MIDPOINT = 0.75
"""Distance of the last point from a free end, over that from the next, up to which it is in a middle."""
ALMOST = 0.1
"""Change of the weights of the trapezoidal rule up to which they stand for a bar with a free end."""
EXACT = 1e-9
"""Error of the three moments, over the flexible length, that is rounding."""
PLACES = 24
"""Joints are sought at multiples of the flexible length over this, and no nearer to
hinges and ends."""
MOST_JOINTS = 2
"""Number of joints that is sufficient with at least one hinge, wherever it is."""
FLOOR = 0.05
"""Least tributary length over the mean: a hinge between rigid parts gets at least this."""
KEPT = 4096
"""Bars whose shares are cached; equal members of a frame, and the runs of a study, share one answer."""


@dataclass(frozen=True)
class Flexibility:
    """Lengths of a bar that its hinges stand for.

    Attributes
    ----------
    lengths
        One for each hinge [m].
    joints
        Station and length [m] of the elastic joints that are needed in addition to the hinges.
    """

    lengths: tuple[float, ...]
    joints: Stretches = ()


@remembered(KEPT)
def flexibility(
    stations: tuple[float, ...],
    length: float,
    rigid: Stretches = (),
    free: tuple[bool, bool] = (False, False),
    shear: float = 0.0,
) -> Flexibility:
    """Share the flexibility of a bar among its hinges.

    Parameters
    ----------
    stations
        Hinges' distances from the first end [m], increasing; at least one.
    length
        Of the bar [m].
    rigid
        Stretches that do not bend [m], increasing.
    free
        Whether the first and the last end carry no moment.  With a free end fewer conditions remain, so that
        joints are not needed.
    shear
        E I/(G A_s) [m^2]; 0: it does not shear.  A bar too short to be represented so shears less.

    References
    ----------
    docs/theory/member_stiffness.md.  Verified in tests/unit/structure/hinges/test_flexibility.py and
    tests/verification/hinge/test_member_stiffness.py.
    """
    bar = _Bar(length, _complement(length, rigid), shear)
    points = np.asarray(stations, float)
    if (beside := bar.beside_free_ends(points, free)) is not None:
        return Flexibility(_numbers(beside))
    lengths, least = bar.exact(points)
    if least >= LEAST:
        return Flexibility(_numbers(lengths))
    eased = bar.with_free_end(points, free)
    if eased is not None:
        return Flexibility(_numbers(eased))
    joints = bar.joints_beside(points)
    together = np.sort(np.concatenate([points, joints]))
    lengths, least = bar.exact(together)
    if not least > 0.0 and shear:
        return flexibility(stations, length, rigid, free, 0.8 * shear if shear > 1e-3 * length**2 else 0.0)
    if not least > 0.0:
        return Flexibility(_numbers(bar.tributary(points)))
    added = np.isin(together, joints)
    found = tuple(zip(_numbers(together[added]), _numbers(lengths[added]), strict=True))
    return Flexibility(_numbers(lengths[~added]), found)


def tributary_lengths(stations: Sequence[float], length: float, rigid: Stretches = ()) -> list[float]:
    """Flexible length of a bar [m] that is nearest to each of its hinges; together all of it.

    Parameters
    ----------
    stations
        Hinges' distances from the first end [m], increasing.
    length
        Of the bar [m].
    rigid
        Stretches that do not count [m].
    """
    return list(_numbers(_Bar(length, _complement(length, rigid)).tributary(np.asarray(stations, float))))


@dataclass(frozen=True)
class _Bar:
    """A bar and the stretches of it that bend, increasing [m]."""

    length: float
    flexible: Stretches
    shear: float = 0.0

    @property
    def total(self) -> float:
        return sum(b - a for a, b in self.flexible)

    def tributary(self, points: Floats) -> Floats:
        """Flexible length that is nearest to each point, more than nothing."""
        borders = np.concatenate([[0.0], (points[1:] + points[:-1]) / 2.0, [self.length]])
        below = sum((np.clip(borders, a, b) - a for a, b in self.flexible), np.zeros(len(borders)))
        near, least = np.diff(below), FLOOR * self.total / len(points)
        if (near >= least).all():
            return near
        near = np.maximum(near, least)
        return np.asarray(near * (self.total / near.sum()))

    def exact(self, points: Floats) -> tuple[Floats, float]:
        """Weights exact for quadratics, and the least over its tributary length; -1: there are none."""
        near = self.tributary(points)
        powers = np.vander(self._scaled(points), 3, increasing=True).T
        integrals = self._integrals
        change = np.linalg.lstsq((powers * near) @ powers.T, integrals - powers @ near, rcond=1e-10)[0]
        weights = near * (1.0 + change @ powers)
        exact = np.abs(powers @ weights - integrals).max() <= EXACT * self.total
        return weights, float((weights / near).min()) if exact else -1.0

    @property
    def _integrals(self) -> Floats:
        """Of 1, s and s^2 over what bends, (3,), for the place s from -1 to 1 along the bar."""
        ends = self._scaled(np.array(self.flexible))
        order = np.arange(1, 4)[:, None]
        powers: Floats = (ends[:, 1] ** order - ends[:, 0] ** order).sum(axis=1)
        integrals: Floats = powers / order[:, 0] * self.length / 2.0
        integrals[2] += 4.0 * self.shear / self.length**2 * self.total
        return integrals

    def beside_free_ends(self, points: Floats, free: tuple[bool, bool]) -> Floats | None:
        """Weights beside free ends, where no moment is: a part of the bar there bends with nothing.

        Those of the trapezoidal rule, with points at free ends, or of the midpoint rule where the last point
        is half as far from the end as from the next.  Both are exact for half waves between free ends; with
        one, times what makes them exact for linear moments that vanish there.  None where points are few.
        """
        if not any(free) or len(points) < FEW:
            return None
        sides = zip((0.0, self.length), (points[:2], points[:-3:-1]), free, strict=True)
        gaps = [(end, abs(near - end), abs(next_ - near)) for end, (near, next_), is_free in sides if is_free]
        ends = [end for end, _, _ in gaps]
        together = np.union1d(points, [end for end, gap, apart in gaps if gap > MIDPOINT * apart])
        near = self.tributary(together)[np.isin(together, points)]
        if all(free):
            return near
        arms = (points - ends[0]) ** 2
        integral = sum(((b - ends[0]) ** 3 - (a - ends[0]) ** 3) / 3.0 for a, b in self.flexible)
        factor = (integral + self.shear * self.total) / float(near @ arms)
        return near * factor if abs(factor - 1.0) <= ALMOST else None

    def with_free_end(self, points: Floats, free: tuple[bool, bool]) -> Floats | None:
        """Weights where moments vanish at free ends: exact for the one linear field that is left."""
        near = self.tributary(points)
        if all(free):
            # nothing but a force on the bar bends it: the triangle under one, where there is a single hinge
            return near / 3.0 if len(points) == 1 else near
        if not any(free):
            return None
        end = 0.0 if free[0] else self.length
        integral = sum(((b - end) ** 3 - (a - end) ** 3) / 3.0 for a, b in self.flexible)
        integral += self.shear * self.total
        sampled = float(near @ (points - end) ** 2)
        # a hinge near the free end would have to be softer than the whole bar
        return near * (integral / sampled) if integral <= MOST * sampled else None

    def joints_beside(self, points: Floats) -> Floats:
        """Fewest further points that give all weights at least their least share, the most even ones."""
        best, stations = LEAST, np.zeros(0)
        for number in range(1, MOST_JOINTS + 1):
            chosen = np.array(list(combinations(self._candidates(points, number), number))).reshape(
                -1, number
            )
            apart = (np.diff(np.sort(chosen, axis=1), axis=1) >= self._clearance).all(axis=1)
            chosen = chosen[apart]
            if not len(chosen):
                continue
            together = np.sort(np.hstack([np.tile(points, (len(chosen), 1)), chosen]), axis=1)
            for i, least in enumerate(self._least(together).tolist()):
                if least > best * (1.0 + EXACT):
                    best, stations = least, chosen[i]
            if len(stations):
                break
        return stations

    def _least(self, points: Floats) -> Floats:
        """What `exact` gives as the least weight, of many sets of points, (sets, points), at once."""
        near = self._tributaries(points)
        powers = self._scaled(points)[:, None, :] ** np.arange(3)[:, None]
        weighted = powers * near[:, None, :]
        needed = self._integrals - weighted.sum(axis=2)
        inverse = np.linalg.pinv(weighted @ powers.transpose(0, 2, 1), rcond=1e-10, hermitian=True)
        weights = near * (1.0 + ((inverse @ needed[:, :, None]) * powers).sum(axis=1))
        moments = (powers * weights[:, None, :]).sum(axis=2)
        exact = np.abs(moments - self._integrals).max(axis=1) <= EXACT * self.total
        return np.where(exact, (weights / near).min(axis=1), -1.0)

    def _tributaries(self, points: Floats) -> Floats:
        """`tributary` of many sets of points, (sets, points)."""
        ends = np.zeros((len(points), 1))
        borders = np.hstack([ends, (points[:, 1:] + points[:, :-1]) / 2.0, ends + self.length])
        below = sum((np.clip(borders, a, b) - a for a, b in self.flexible), np.zeros(borders.shape))
        near, least = np.diff(below, axis=1), FLOOR * self.total / points.shape[1]
        raised = np.maximum(near, least)
        scaled = raised * (self.total / raised.sum(axis=1, keepdims=True))
        return np.where((near >= least).all(axis=1, keepdims=True), near, scaled)

    @property
    def _clearance(self) -> float:
        return self.total / PLACES * (1.0 - 1e-6)

    def _candidates(self, points: Floats, number: int) -> list[float]:
        """Places for joints, away from hinges and ends; for one joint and one hinge also the exact one."""
        found, gone, total = [], 0.0, self.total
        for a, b in self.flexible:
            steps = np.arange(PLACES + 1) * total / PLACES - gone + a
            found.append(steps[(a <= steps) & (steps <= b)])
            gone += b - a
        places: list[float] = np.concatenate(found).tolist()
        if len(points) == number == 1:
            first, second, third = (sum((b**k - a**k) / k for a, b in self.flexible) for k in (1, 2, 3))
            arm = second - points[0] * first
            partner = (third - points[0] * second) / arm if arm else np.inf
            places += [partner] if any(a <= partner <= b for a, b in self.flexible) else []
        taken = np.concatenate([points, [0.0, self.length]])
        away = np.abs(taken[:, None] - np.array(places)).min(axis=0) >= self._clearance
        return [place for place, good in zip(places, away.tolist(), strict=True) if good]

    def _scaled(self, stations: Floats) -> Floats:
        return np.asarray(2.0 * stations / self.length - 1.0)


def _complement(length: float, rigid: Stretches) -> Stretches:
    """What lies between stretches of a bar."""
    borders = [0.0, *(end for part in rigid for end in part), length]
    pairs = zip(borders[::2], borders[1::2], strict=True)
    return tuple((a, min(b, length)) for a, b in pairs if min(b, length) > a)


def _numbers(values: Floats) -> tuple[float, ...]:
    return tuple(float(value) for value in values)
