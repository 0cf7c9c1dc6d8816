"""Fit of the library of bending laws of tubes: kriging of two meshes, chosen by leaving one tube out.

A tube x on a mesh has the logarithms of M/M_p (a column for each rotation)

    y(x, s) = f(x) + s d(x) + noise,    s = (h - h_n)/(h_c - h_n): 0 on the nominal mesh, 1 on the coarse one

with h the length of an element over half a fold.  f is a polynomial trend F c and a Gaussian process of the
covariance k(x, x') = exp(-1/2 sum ((x_d - x_d')/l_d)^2); the step d is a trend G e of low order and another
process, of the covariance q k.  With

    K = k + q s s' k + noise (on the diagonal),    H = [F, s G]

the best linear unbiased estimate has, from K w + H (c, e) = y and H' w = 0,

    P = K^-1 - K^-1 H (H' K^-1 H)^-1 H' K^-1,    w = P y,    f(x) = F(x) c + k(x, x_i) w_i

so every mesh serves f, and d is needed only while fitting.  The errors at the points B of a tube of a fit
without this tube, lengths and noise unchanged, are P_BB^-1 (P y)_B.  Lengths, noise, q and both trends are
those of the smallest errors of the energies that follow.  Two fidelities in one process are widely known from
M. C. Kennedy and A. O'Hagan, Biometrika 87 (2000) 1-13 (not seen); the form with a share s is derived here.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.optimize import minimize

from crumple.hinge.tube_library.table import Coordinate
from crumple.numeric.arrays import Floats

KNOTS = np.array([0, 0.5, 1, 2, 3, 4, 5, 6.5, 8, 10, 12.5, 15, 17.5, 20, 25, 30, 35, 40.0])
"""Rotations of the table [deg]."""
AT = np.array([5.0, 10.0, 20.0, 30.0])
"""Rotations at which energies are compared [deg]."""
FIGURES = 5
"""Significant digits of what is written."""
LEAST_NOISE, MOST_NOISE = 1e-3, 1.0
"""Variance of the noise over that of the process f: the floor is about 1 % of the moment, the scatter between
a tube and a neighbour that folds half an element further on."""
LENGTHS = (0.3, 20.0)
"""Of the processes; the range of a coordinate is 2."""
STEP = (1e-3, 1.0)
"""Variance of the process of the step over that of f."""


_WORK = np.tril(np.ones((KNOTS.size - 1,) * 2)) @ (
    0.5 * np.diff(np.radians(KNOTS))[:, None] * (np.eye(KNOTS.size)[1:] + np.eye(KNOTS.size)[:-1])
)
"""Energies up to the knots from the second on, from the moments at the knots, (k - 1, k)."""


@dataclass(frozen=True)
class Solved:
    """A solved point: the measured curve, and its values on the knots.

    Attributes
    ----------
    point
        Entries of `law_design.Point`.
    rotation, moment
        Measured curve: plastic rotation [rad] and M/M_p.
    """

    point: dict[str, Any]
    rotation: Floats
    moment: Floats

    @property
    def energy(self) -> Floats:
        """Integral of M/M_p up to the rotations compared [rad]."""
        return energy_of(self.rotation, self.moment)

    @property
    def on_knots(self) -> Floats:
        """M/M_p at the knots: the least-squares fit of straight pieces, which keeps the work."""
        fine = np.linspace(0.0, np.radians(KNOTS[-1]), 4001)
        curve = np.interp(fine, self.rotation, self.moment)
        hats = np.stack([np.interp(fine, np.radians(KNOTS), row) for row in np.eye(KNOTS.size)], axis=1)
        return np.linalg.lstsq(hats, curve, rcond=None)[0]


def energy_of(rotation: Floats, moment: Floats) -> Floats:
    """Integral of a piecewise linear moment up to the rotations compared."""
    fine = np.unique(np.concatenate([rotation, np.radians(AT)]))
    values = np.interp(fine, rotation, moment)
    done = np.concatenate([[0.0], np.cumsum(0.5 * (values[1:] + values[:-1]) * np.diff(fine))])
    return np.interp(np.radians(AT), fine, done)


@dataclass(frozen=True, eq=False)
class Points:
    """Solved points in the order of the fit.

    Attributes
    ----------
    places
        Scaled coordinates, (n, d).
    share
        s: 0 on the nominal mesh, 1 on the coarse one, (n,).
    tubes
        Number of the tube of each point, (n,): the points of one tube are left out together.
    counted
        Whether its error counts, (n,): the tube is in the range of the laws.
    logarithm
        Logarithms of M/M_p at the knots, (n, k).
    """

    places: Floats
    share: Floats
    tubes: Floats
    counted: Floats
    logarithm: Floats


@dataclass(frozen=True, eq=False)
class Fit:
    """Coefficients of the table (`crumple.hinge.tube_library.table`), and errors of leaving one out.

    Attributes
    ----------
    degree, step
        Of the trend of f, and numbers of the coordinates in the trend of d (besides its constant).
    noise, step_variance
        Variances over that of f.
    left_out
        Errors of the logarithm at every point without its tube, (n, k).
    score
        See `score_of`.
    """

    coordinates: tuple[Coordinate, ...]
    degree: int
    step: tuple[int, ...]
    noise: float
    step_variance: float
    lengths: Floats
    exponents: Floats
    centres: Floats
    trend: Floats
    weights: Floats
    left_out: Floats
    score: float

    def entries(self, columns: int) -> dict[str, Any]:
        """As in the file of the table, with the coefficients of the first knots."""
        found = {name: rounded(getattr(self, name)) for name in ("lengths", "exponents", "centres")}
        return found | {name: rounded(getattr(self, name)[:, :columns]) for name in ("trend", "weights")}


def rounded(values: Floats) -> list[Any]:
    """Nested lists of numbers with a few more digits than matter."""
    return [rounded(row) if np.ndim(row) else float(f"{row:.{FIGURES}g}") for row in values]


def best_fit(coordinates: tuple[Coordinate, ...], points: Points) -> Fit:
    """Fit whose errors of leaving one tube out are smallest, over degrees and terms of the step."""
    return min(fits_of(coordinates, points), key=lambda fit: fit.score)


def fits_of(coordinates: tuple[Coordinate, ...], points: Points) -> Iterator[Fit]:
    """Best fit of every degree of the trend and every set of terms of the step."""
    count = len(coordinates)
    nominal = len(set(points.tubes[points.share < 1e-9].tolist()))
    for degree in (0, 1, 2):
        # with fewer points than this a trend is no better than chance
        if 2 * math.comb(count + degree, degree) > len(points.share):
            continue
        for number in range(count + 1 if points.share.any() else 1):
            for step in itertools.combinations(range(count), number):
                if not step or 4 * (1 + len(step)) <= nominal:
                    yield _fitted(coordinates, points, degree, step)


def _fitted(coordinates: tuple[Coordinate, ...], points: Points, degree: int, step: tuple[int, ...]) -> Fit:
    """Fit with the best lengths, noise and variance of the step."""
    places, share, y = points.places, points.share, points.logarithm
    count = places.shape[1]
    exponents = np.array(
        [e for e in itertools.product(range(degree + 1), repeat=count) if sum(e) <= degree], np.float64
    )
    trend_terms = np.prod(places[:, None, :] ** exponents[None], axis=2)
    # on one mesh alone there is no step
    step_terms = share[:, None] * np.hstack([np.ones((len(share), 1)), places[:, list(step)]])
    step_terms = step_terms[:, step_terms.any(axis=0)]
    terms = np.hstack([trend_terms, step_terms])
    groups = [np.flatnonzero(points.tubes == tube) for tube in np.unique(points.tubes)]

    def solved(parameters: Floats) -> tuple[Floats, Floats, Floats]:
        lengths, (noise, variance) = _unpacked(parameters)
        apart = (places[:, None] - places[None]) / lengths
        near = np.exp(-0.5 * (apart**2).sum(axis=2))
        covariance = near * (1.0 + variance * np.outer(share, share)) + noise * np.eye(len(share))
        inverse = np.linalg.inv(covariance)
        inner = np.linalg.inv(terms.T @ inverse @ terms)
        projected = inverse - inverse @ terms @ inner @ terms.T @ inverse
        weights = projected @ y
        left_out = np.empty_like(y)
        for group in groups:
            left_out[group] = np.linalg.solve(projected[np.ix_(group, group)], weights[group])
        return inner @ terms.T @ inverse @ y, weights, left_out

    def score(parameters: Floats) -> float:
        return score_of(points, solved(parameters)[2])

    starts = [[math.log(length)] * count + [-5.0, -3.0] for length in (1.0, 4.0)]
    options = {"maxiter": 400, "xatol": 2e-2, "fatol": 1e-7}
    best = min(
        (minimize(score, start, method="Nelder-Mead", options=options) for start in starts),
        key=lambda found: float(found.fun),
    )
    trend, weights, left_out = solved(best.x)
    lengths, (noise, variance) = _unpacked(best.x)
    return Fit(
        coordinates, degree, step, noise, variance, lengths, exponents, places, trend[: len(exponents)],
        weights, left_out, float(best.fun),
    )  # fmt: skip


def score_of(points: Points, left_out: Floats) -> float:
    """Mean of squared errors of energies up to every knot, at points that count.

    Points on the nominal mesh make up half of it: laws are for this mesh, but few points have it.
    """
    moment = np.exp(points.logarithm)
    true, found = (values @ _WORK.T for values in (moment, moment * np.exp(-left_out)))
    square = ((found / true - 1.0) ** 2).mean(axis=1)
    nominal = points.share < 1e-9
    parts = [square[points.counted.astype(bool) & which] for which in (nominal, ~nominal)]
    return float(np.mean([part.mean() for part in parts if part.size]))


def _unpacked(parameters: Floats) -> tuple[Floats, tuple[float, float]]:
    """Lengths, and noise and variance of the step, kept between their limits."""
    lengths = np.exp(np.clip(parameters[:-2], math.log(LENGTHS[0]), math.log(LENGTHS[1])))
    noise = math.exp(float(np.clip(parameters[-2], math.log(LEAST_NOISE), math.log(MOST_NOISE))))
    variance = math.exp(float(np.clip(parameters[-1], math.log(STEP[0]), math.log(STEP[1]))))
    return lengths, (noise, variance)
