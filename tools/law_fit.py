"""Fit of the library of bending laws of tubes: kriging with a polynomial trend, chosen by leaving one out.

With K the covariance exp(-1/2 sum ((x_d - x_d')/l_d)^2) + noise (on the diagonal), F the trend's terms at the
solved points and y the logarithms of M/M_p there (a column for each rotation), the best linear unbiased
estimate has trend coefficients c and weights w from

    K w + F c = y,   F' w = 0,        P = K^-1 - K^-1 F (F' K^-1 F)^-1 F' K^-1,   w = P y

and the error at point i of a fit without it, lengths and noise unchanged, is (P y)_i / P_ii.
Lengths, noise and degree are those of the smallest sum of squares of these errors, over training points.
"""

from __future__ import annotations

import itertools
import math
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


@dataclass(frozen=True)
class Fit:
    """Coefficients of the table (`crumple.hinge.tube_library.table`), and errors of leaving one out."""

    coordinates: tuple[Coordinate, ...]
    degree: int
    noise: float
    lengths: Floats
    exponents: Floats
    centres: Floats
    trend: Floats
    weights: Floats
    left_out: Floats

    @property
    def entries(self) -> dict[str, Any]:
        """As in the file of the table."""
        named = ("lengths", "exponents", "centres", "trend", "weights")
        return {name: rounded(getattr(self, name)) for name in named}


def rounded(values: Floats) -> list[Any]:
    """Nested lists of numbers with a few more digits than matter."""
    return [rounded(row) if np.ndim(row) else float(f"{row:.{FIGURES}g}") for row in values]


def best_fit(coordinates: tuple[Coordinate, ...], places: Floats, moments: Floats) -> Fit:
    """Fit whose errors of leaving one out are smallest.

    Parameters
    ----------
    coordinates
        Of the columns of places.
    places
        Values of the coordinates, (n, d).
    moments
        M/M_p at the knots, (n, k).
    """
    scaled = np.array(
        [[one.scaled(value) for one, value in zip(coordinates, row, strict=True)] for row in places]
    )
    y = np.log(moments)
    terms = {degree: math.comb(len(coordinates) + degree, degree) for degree in (0, 1, 2)}
    # with fewer points than this a trend is no better than chance
    degrees = [degree for degree, count in terms.items() if 2 * count <= len(y)]
    fits = [_fit_of_degree(coordinates, scaled, y, degree) for degree in degrees]
    return min(fits, key=lambda fit: float((fit.left_out**2).sum()))


def _fit_of_degree(coordinates: tuple[Coordinate, ...], scaled: Floats, y: Floats, degree: int) -> Fit:
    """Fit with the best lengths and noise for a trend of a degree."""
    count = scaled.shape[1]
    exponents = np.array(
        [e for e in itertools.product(range(degree + 1), repeat=count) if sum(e) <= degree], np.float64
    )
    terms = np.prod(scaled[:, None, :] ** exponents[None], axis=2)

    def solved(parameters: Floats) -> tuple[Floats, Floats, Floats, Floats]:
        lengths, noise = (
            np.exp(np.clip(parameters[:-1], -2.0, 3.0)),
            np.exp(np.clip(parameters[-1], -12.0, 0.0)),
        )
        apart = (scaled[:, None] - scaled[None]) / lengths
        covariance = np.exp(-0.5 * (apart**2).sum(axis=2)) + noise * np.eye(len(scaled))
        inverse = np.linalg.inv(covariance)
        inner = np.linalg.inv(terms.T @ inverse @ terms)
        projected = inverse - inverse @ terms @ inner @ terms.T @ inverse
        weights = projected @ y
        trend = inner @ terms.T @ inverse @ y
        return lengths, trend, weights, weights / np.diag(projected)[:, None]

    def size(parameters: Floats) -> float:
        return float((solved(parameters)[3] ** 2).sum())

    starts = [[length] * count + [noise] for length in (0.0, 0.7, 1.4) for noise in (-7.0, -4.0)]
    options = {"maxiter": 600, "xatol": 1e-2, "fatol": 1e-5}
    best = min(
        (minimize(size, start, method="Nelder-Mead", options=options) for start in starts),
        key=lambda found: float(found.fun),
    )
    lengths, trend, weights, left_out = solved(best.x)
    return Fit(
        coordinates, degree, float(np.exp(best.x[-1])), lengths, exponents, scaled, trend, weights, left_out
    )
