"""Measured curves of several specimens: smoothing, elastic part removed, mean, scatter, static to dynamic.

The same steps serve a bending test (moment against rotation) and a crush test (force against shortening);
"abscissa" and "ordinate" below are either pair.

    smoothing   least-squares parabola over a moving window, at its middle; ends by the first and last window
    elastic     crumple.hinge.measured.table.plastic_part on each specimen
    mean        of all specimens on one grid that ends with the shortest of them
    band        mean +- coverage x standard deviation (n - 1), at every point
    dynamic     a constant factor on mean and band, where the tests were slow and no rate law is used

Limits: one specimen has no scatter, so its band must be given; identical specimens have a band of zero width.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from crumple.errors import InputError, Problem
from crumple.hinge.axial.axial_law import CrushRate, CrushValidity
from crumple.hinge.band import Band
from crumple.hinge.law import Source, Trust
from crumple.hinge.measured.table import BENDING, CRUSHING, Curve, plastic_part, read_table
from crumple.hinge.measured.tabulated import TabulatedLaw
from crumple.hinge.rate import HingeRate
from crumple.numeric.arrays import Floats

GRID = 200
"""Points of the common grid; more than any hinge curve needs."""
COVERAGE = 2.0
"""Standard deviations in the half-width of the band; 2 holds about 95 % of normally scattered curves."""
SMALLEST_SHARE = 0.05
"""Smallest ratio of the lower law to the mean: a capacity must stay positive."""


@dataclass(frozen=True)
class MeasuredBand:
    """Mean and scatter of specimens of one kind, without their elastic part.

    Attributes
    ----------
    abscissa
        Plastic rotation [rad] or shortening [m] from 0, shape (n,).
    mean, deviation
        Mean and standard deviation of moment [N m] or force [N], shape (n,).
    names
        Of the specimens.
    elastic_stiffness
        Mean stiffness of the elastic rises [N m/rad or N/m].
    coverage
        Standard deviations in the half-width of the band.
    dynamic_factor
        Already in mean and deviation.
    """

    abscissa: Floats
    mean: Floats
    deviation: Floats
    names: tuple[str, ...]
    elastic_stiffness: float
    coverage: float = COVERAGE
    dynamic_factor: float = 1.0

    @property
    def lower(self) -> Floats:
        """Lower edge, kept above a twentieth of the mean."""
        return np.maximum(self.mean - self.coverage * self.deviation, SMALLEST_SHARE * self.mean)

    @property
    def upper(self) -> Floats:
        """Upper edge."""
        return np.asarray(self.mean + self.coverage * self.deviation, np.float64)

    @property
    def scatter(self) -> float:
        """Largest relative half-width of the band [-]."""
        return float(np.max(self.coverage * self.deviation / self.mean))


SHORTEST_WINDOW = 1e-3
"""Shortest window of smoothing over the length of the curve: the grid has ten points for each window."""


def smoothed(abscissa: Curve, ordinate: Curve, window: float) -> tuple[Floats, Floats]:
    """Curve smoothed over a window.

    Parameters
    ----------
    abscissa
        Increasing; points at which it decreases are left out.
    ordinate
        Ordinates, same number.
    window
        Length of the moving parabola, in the unit of the abscissa.

    Returns
    -------
    tuple
        Uniform grid of a tenth of the window, and the smoothed ordinate on it.

    Raises
    ------
    InputError
        If the window is longer than the curve or below a thousandth of it.

    Notes
    -----
    Parabolas and straight lines pass unchanged; a kink is rounded over half a window.
    """
    x, y = _forward(abscissa, ordinate)
    length = float(x[-1] - x[0])
    if not SHORTEST_WINDOW * length <= window <= length:
        allowed = f"{SHORTEST_WINDOW * length:g} to {length:g}"
        todo = "start with a tenth of the curve"
        what = "the window is out of range"
        raise InputError(Problem(what, f"{window:g}", allowed, todo, "window"))
    half = 5
    count = max(math.ceil(length / window * 2.0 * half) + 1, 2 * half + 1)
    grid = np.linspace(x[0], x[-1], count)
    raw = np.interp(grid, x, y)
    places = np.arange(-half, half + 1.0)
    fit = np.linalg.pinv(np.vander(places, 3, increasing=True))
    middle = np.convolve(raw, fit[0][::-1], mode="valid")
    powers = np.vander(places, 3, increasing=True)
    first, last = powers @ fit @ raw[: 2 * half + 1], powers @ fit @ raw[-2 * half - 1 :]
    return grid, np.concatenate([first[:half], middle, last[-half:]])


def measured_band(
    curves: Sequence[tuple[Curve, Curve]],
    *,
    names: Sequence[str] = (),
    window: float | None = None,
    elastic_stiffness: float | None = None,
    coverage: float = COVERAGE,
    dynamic_factor: float = 1.0,
) -> MeasuredBand:
    """Mean and scatter of specimens of one kind.

    Parameters
    ----------
    curves
        Total rotation [rad] and moment [N m], or shortening [m] and force [N], of each specimen.
    names
        Of the specimens; numbers where left out.
    window
        Of the smoothing, in the unit of the abscissa; None: none.
    elastic_stiffness
        Of the rise; None: found from each curve.
    coverage
        Standard deviations in the half-width of the band.
    dynamic_factor
        Dynamic over static ordinate [-], at least 1.

    Returns
    -------
    MeasuredBand
        On a grid that ends with the shortest specimen.

    Raises
    ------
    InputError
        If there is no curve, or one cannot be used; the message names it.
    """
    if not curves:
        raise InputError(Problem("no curve was given", todo="give at least one specimen", where="curves"))
    for name, value, least in (("coverage", coverage, 0.0), ("dynamic factor", dynamic_factor, 1.0)):
        if not (math.isfinite(value) and value >= least):
            raise InputError(Problem(f"the {name} is too small", f"{value:g}", f">= {least:g}", "", name))
    labels = tuple(names) or tuple(str(number) for number in range(1, len(curves) + 1))
    plastic = [
        _plastic(label, curve, window, elastic_stiffness) for label, curve in zip(labels, curves, strict=True)
    ]
    grid = np.linspace(0.0, min(float(part[0][-1]) for part in plastic), GRID)
    ordinates = np.array([np.interp(grid, x, y) for x, y, _ in plastic])
    deviation = ordinates.std(axis=0, ddof=1) if len(plastic) > 1 else np.zeros(GRID)
    return MeasuredBand(
        grid,
        dynamic_factor * ordinates.mean(axis=0),
        dynamic_factor * deviation,
        labels,
        float(np.mean([part[2] for part in plastic])),
        coverage,
        dynamic_factor,
    )


def bending_band(band: MeasuredBand, *, rate: HingeRate | None = None) -> Band:
    """Nominal, lower and upper law of measured bending curves.

    Parameters
    ----------
    band
        Of moment against rotation; of one specimen it has no width: use `crumple.hinge.band.band_of` then.
    rate
        Strain-rate law of slow tests; not together with a dynamic factor.

    Raises
    ------
    InputError
        If both a rate law and a dynamic factor are given.
    """
    if rate is not None and band.dynamic_factor != 1.0:
        what, todo = "the rate effect is given twice", "give the dynamic factor or the rate law"
        raise InputError(Problem(what, f"factor {band.dynamic_factor:g} and a rate law", "", todo, "rate"))
    count = len(band.names)
    known = band.scatter if count > 1 else None
    laws = [
        TabulatedLaw(
            band.abscissa,
            moment,
            elastic_stiffness=band.elastic_stiffness,
            rate=rate,
            source=Source(f"{_specimens(count)}: {', '.join(band.names)}", Trust.MEASURED, note),
            scatter=scatter,
        )
        for moment, note, scatter in (
            (band.mean, "mean of the specimens", known),
            (band.lower, f"mean less {band.coverage:g} standard deviations", None),
            (band.upper, f"mean plus {band.coverage:g} standard deviations", None),
        )
    ]
    return Band(*laws)


@dataclass(frozen=True)
class MeasuredCrushing:
    """Axial law from crush tests.

    Attributes
    ----------
    As `crumple.hinge.axial.axial_law.AxialLaw`.
    """

    peak_force: float
    mean_crushing_force: float
    effective_stroke: float
    validity: CrushValidity
    source: Source
    name: str = "measured"
    title: str = "measured crushing"
    half_fold_length: float | None = None
    peak_strain: float = 0.0
    rate: CrushRate | None = None


def crushing_of(band: MeasuredBand, length: float) -> MeasuredCrushing:
    """Axial law of measured force against shortening of columns of a length [m].

    Notes
    -----
    The mean force is taken over the whole measured shortening: end the curves at the closure of the folds.
    """
    stroke = float(band.abscissa[-1])
    if not stroke < length:
        what, todo = "the column is shorter than its measured shortening", "give the length of the specimens"
        raise InputError(Problem(what, f"{length:g} m", f"> {stroke:g} m", todo, "length"))
    means = [_area(band.abscissa, force) / stroke for force in (band.mean, band.upper)]
    known = means[1] / means[0] - 1.0 if len(band.names) > 1 else None
    basis = f"{_specimens(len(band.names))}, mean over {1e3 * stroke:.4g} mm"
    source = Source(f"{_specimens(len(band.names))}: {', '.join(band.names)}", Trust.MEASURED)
    return MeasuredCrushing(
        float(band.mean.max()), means[0], stroke / length, CrushValidity(basis, (), known), source
    )


def read_specimens(texts: dict[str, str], *, crush: bool = False) -> list[tuple[Floats, Floats]]:
    """Curves of CSV texts by file name; every mistake in every file at once, as reported by `read_table`."""
    curves, problems = [], []
    for name, text in texts.items():
        try:
            curves.append(read_table(text, name, CRUSHING if crush else BENDING))
        except InputError as error:
            problems += error.problems
    if problems:
        raise InputError(problems)
    return curves


def _plastic(
    name: str, curve: tuple[Curve, Curve], window: float | None, stiffness: float | None
) -> tuple[Floats, Floats, float]:
    """Curve without its elastic part, smoothed; errors name the specimen."""
    try:
        abscissa, ordinate = _forward(*curve)
        if window is not None:
            abscissa, ordinate = smoothed(abscissa, ordinate, window)
        plastic, capacity, slope = plastic_part(abscissa, ordinate, stiffness)
        if np.any(capacity <= 0.0):
            what = "the moment or force falls to 0 behind the elastic rise"
            todo = "end the curve before, keep a small residual capacity, or let the hinge break: fracture"
            raise InputError(Problem(what, f"{float(capacity.min()):g}", "> 0", todo))
        if len(plastic) < 2:
            what = "the curve has no plastic part: it lies on the elastic line to its end"
            todo = "measure further, check units and sign, or give a larger elastic_stiffness"
            raise InputError(Problem(what, f"{slope:g} per unit of the abscissa", "", todo))
    except InputError as error:
        named = [
            Problem(one.what, one.came, one.allowed, one.todo, f"specimen {name}") for one in error.problems
        ]
        raise InputError(named) from None
    return plastic, capacity, slope


def _forward(abscissa: Curve, ordinate: Curve) -> tuple[Floats, Floats]:
    """Points at which the abscissa exceeds all values before."""
    x, y = np.asarray(abscissa, np.float64), np.asarray(ordinate, np.float64)
    if x.size != y.size or x.size < 3 or not (np.all(np.isfinite(x)) and np.all(np.isfinite(y))):
        raise InputError(Problem("the curve needs three finite points at least", f"{x.size} points"))
    further = np.concatenate([[True], x[1:] > np.maximum.accumulate(x)[:-1]])
    return x[further], y[further]


def _area(x: Floats, y: Floats) -> float:
    """Integral of straight lines between points."""
    return float(np.diff(x) @ (y[1:] + y[:-1])) / 2.0


def _specimens(count: int) -> str:
    return "1 measured specimen" if count == 1 else f"{count} measured specimens"
