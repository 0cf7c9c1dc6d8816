"""Shipped table of one shape of tube: M/M_p over plastic rotation as a smooth function of a few coordinates.

With the coordinates x scaled to -1..1 over their ranges, the logarithm of M/M_p at every rotation is

    y(x) = sum_j c_j x^(e_j)  +  sum_i w_i exp(-1/2 sum_d ((x_d - x_id)/l_d)^2)

a polynomial trend and a Gaussian process about the solved points x_i (kriging).  The coefficients come from
tools/law_library.py, with lengths l_d and the degree of the trend chosen by leaving out one training point at
a time; points held out were not used.  y is smooth, so derivatives over thickness or yield stress exist.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from functools import cache
from importlib import resources
from typing import Any

import numpy as np

from crumple.numeric.arrays import Floats


@dataclass(frozen=True, eq=False)
class Coordinate:
    """One coordinate of a table.

    Attributes
    ----------
    key
        What it is.
    low, high
        Range in which points were solved.
    logarithmic
        Whether its logarithm is interpolated.
    """

    key: str
    low: float
    high: float
    logarithmic: bool

    def scaled(self, value: float) -> float:
        """-1 at the low end of the range, +1 at the high one."""
        if self.logarithmic:
            share = np.log(value / self.low) / np.log(self.high / self.low)
        else:
            share = (value - self.low) / (self.high - self.low)
        return float(2.0 * share - 1.0)


@dataclass(frozen=True, eq=False)
class TubeTable:
    """Table of one shape.

    Attributes
    ----------
    coordinates
        In the order of the columns, d of them.
    rotation
        Plastic rotation [rad] from 0, (k,).
    exponents, trend
        Exponents e_j, (j, d), and their coefficients c_j, (j, k).
    centres, lengths, weights
        Solved points x_i, (n, d), lengths l_d, (d,), and weights w_i, (n, k).
    ranges
        Lowest and highest value by name, in which the table holds.
    band
        Relative half-width of the band of the moment [-].
    facts
        Further entries of the file: provenance, points, errors.
    """

    coordinates: tuple[Coordinate, ...]
    rotation: Floats
    exponents: Floats
    trend: Floats
    centres: Floats
    lengths: Floats
    weights: Floats
    ranges: dict[str, tuple[float, float]]
    band: float
    facts: dict[str, Any]

    def moment(self, place: tuple[float, ...]) -> Floats:
        """M/M_p [-] at the rotations of the table, (k,).

        Parameters
        ----------
        place
            Value of each coordinate.
        """
        scaled = np.array(
            [one.scaled(value) for one, value in zip(self.coordinates, place, strict=True)], np.float64
        )
        powers = np.prod(scaled**self.exponents, axis=1)
        apart = (scaled - self.centres) / self.lengths
        near = np.exp(-0.5 * np.einsum("nd,nd->n", apart, apart))
        return np.asarray(np.exp(powers @ self.trend + near @ self.weights), np.float64)


@cache
def tube_table(kind: str) -> TubeTable:
    """Table of a shape, by the kind of its section; read once."""
    text = resources.files(__package__).joinpath(f"{kind}.json").read_text(encoding="utf-8")
    return table_of(json.loads(text))


def table_of(found: dict[str, Any]) -> TubeTable:
    """Table from the entries of its file."""
    fit = found["fit"]
    arrays = {name: np.array(fit[name], np.float64) for name in ("trend", "lengths", "centres", "weights")}
    own = {"fit", "rotation_deg", "coordinates", "ranges", "band"}
    facts = {key: value for key, value in found.items() if key not in own}
    return TubeTable(
        tuple(Coordinate(**one) for one in found["coordinates"]),
        np.radians(np.array(found["rotation_deg"], np.float64)),
        np.array(fit["exponents"], np.float64),
        ranges={key: (float(low), float(high)) for key, (low, high) in found["ranges"].items()},
        band=float(found["band"]),
        facts=facts,
        **arrays,
    )
