"""Linear forms whose sum of powers is one on a surface: picked from its normals, then moved.

The forms come with all their images under the symmetry of the section, so the sum has that symmetry to
rounding.  First non-negative least squares (Lawson and Hanson's active set) pick few normals.  Then one form
of each set of images is moved to the least squares of the relative error along rays, by Levenberg and
Marquardt's method.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from crumple.numeric.arrays import Floats
from crumple.section.capacity.interaction_symmetry import multiplicity, with_images

STEPS = 10
"""Most steps that move the rows."""
SETTLED = 2e-3
"""Part of the sum of squares whose loss in a step is too little for another one."""


@dataclass(frozen=True, eq=False)
class Orbits:
    """Rows of which each stands for all its images.

    Attributes
    ----------
    rows
        Shape (k, 3).
    images
        Symmetry of the section, shape (g, 3, 3).
    count, projection
        See `multiplicity`.
    """

    rows: Floats
    images: Floats
    count: Floats
    projection: Floats

    def all_rows(self) -> Floats:
        """Rows with their images."""
        return with_images(self.rows, self.images)


def picked(points: Floats, normals: Floats, images: Floats, power: int, most: int) -> Orbits:
    """Normals d with weights w >= 0 for the least squares of sum w |d . x|^p = 1, at most so many images.

    Parameters
    ----------
    points, normals
        Points x and normals with d . x = 1, none the image of another, shapes (n, 3) and (m, 3).
    images
        Symmetry of the section, shape (g, 3, 3).
    power, most
        Exponent p and most rows, images counted.
    """
    count, projection = multiplicity(normals, images)
    forms = _forms(normals, _turned(points, images))
    columns = whole_power(np.abs(forms), power).sum(axis=1) * (count / len(images))
    weights = nonnegative_least_squares(columns, np.ones(len(points)), most, count)
    used = weights > 0.0
    rows = normals[used] * weights[used, None] ** (1.0 / power)
    rows = np.einsum("kij,kj->ki", projection[used], rows)
    return Orbits(rows, images, count[used], projection[used])


def moved(orbits: Orbits, points: Floats, power: int) -> Orbits:
    """Orbits whose rows have moved to the least squares of 1/g - 1 at points of the surface."""
    turned, shares = _turned(points, orbits.images), orbits.count / len(orbits.images)
    rows, damping = orbits.rows, 1e-2
    value, slope = _value_and_slope(rows, shares, turned, power)
    for _ in range(STEPS):
        off = 1.0 / value - 1.0
        cost = float(off @ off)
        # within what the own images of a row leave free
        free = (slope.transpose(1, 0, 2) @ orbits.projection).transpose(1, 0, 2).reshape(len(off), -1)
        free *= (-1.0 / value**2)[:, None]
        square, fall = free.T @ free, free.T @ off
        mean = square.trace() / len(fall)
        for _ in range(8):
            step = np.linalg.solve(square + damping * mean * np.eye(len(fall)), -fall)
            step = np.einsum("kij,kj->ki", orbits.projection, step.reshape(rows.shape))
            trial, trial_slope = _value_and_slope(rows + step, shares, turned, power)
            left = float(((1.0 / trial - 1.0) ** 2).sum())
            if left < cost:
                break
            damping *= 10.0
        else:
            break
        rows, value, slope = rows + step, trial, trial_slope
        damping /= 10.0
        if left > (1.0 - SETTLED) * cost:
            break
    return Orbits(rows, orbits.images, orbits.count, orbits.projection)


def whole_power(values: Floats, power: int) -> Floats:
    """Values to a whole power from 1 on, by squaring."""
    result, square = None, values
    while True:
        if power & 1:
            result = square if result is None else result * square
        power >>= 1
        if not power:
            assert result is not None
            return result
        square = square * square


def _turned(points: Floats, images: Floats) -> Floats:
    """Places at which a row has the values of its images at points, shape (n, g, 3)."""
    return np.ascontiguousarray((points @ images).transpose(1, 0, 2))


def _forms(rows: Floats, turned: Floats) -> Floats:
    return np.asarray((turned.reshape(-1, 3) @ rows.T).reshape(*turned.shape[:2], len(rows)))


def _value_and_slope(rows: Floats, shares: Floats, turned: Floats, power: int) -> tuple[Floats, Floats]:
    """Value g at points, (n,), and its derivatives by the rows, (n, k, 3)."""
    forms = _forms(rows, turned)
    largest = np.abs(forms).max(axis=(1, 2))
    ratio = forms / largest[:, None, None]
    low = whole_power(np.abs(ratio), power - 2) * ratio * shares
    total = (low * ratio).sum(axis=(1, 2))
    root = total ** (1.0 / power)
    slope = low.transpose(0, 2, 1) @ turned * (root / total)[:, None, None]
    return largest * root, slope


def nonnegative_least_squares(
    matrix: Floats, right: Floats, most: float, costs: Floats | None = None
) -> Floats:
    """Find x >= 0 with the smallest |matrix x - right| whose entries other than zero cost at most ``most``.

    Active set of Lawson and Hanson (Solving Least Squares Problems, 1974), stopped early by ``most``.

    Parameters
    ----------
    matrix, right
        Shapes (n, k) and (n,).
    most
        Sum of the costs of the entries of the solution that may differ from zero.
    costs
        Cost of each entry, shape (k,); one if not given.
    """
    product, goal = matrix.T @ matrix, matrix.T @ right
    x = np.zeros(matrix.shape[1])
    price = np.ones(len(x)) if costs is None else costs
    free = np.zeros(len(x), bool)
    small = 1e-10 * float(np.abs(goal).max())
    for _ in range(3 * int(most)):
        gain = goal - product @ x
        gain[free | (price > most - price[free].sum())] = -np.inf
        # the first of those that are alike but for rounding: the choice must not jump with the last digit of
        # the matrix
        enter = int((gain >= gain.max() - small).argmax())
        if gain[enter] <= small:
            break
        free[enter] = True
        while True:
            at, trial = np.flatnonzero(free), np.zeros_like(x)
            block = product[at[:, None], at]
            block.flat[:: len(at) + 1] += 1e-12 * block.trace()
            trial[at] = np.linalg.solve(block, goal[at])
            if (trial[at] > 0.0).all():
                break
            # as far towards the trial as all stay positive; entries that reach zero leave the active set
            falling = free & (trial <= 0.0)
            step = float((x[falling] / np.maximum(x[falling] - trial[falling], 1e-300)).min())
            x = x + step * (trial - x)
            free &= x > 1e-14
            x[~free] = 0.0
            if not free.any():
                return x
        x = trial
    return x
