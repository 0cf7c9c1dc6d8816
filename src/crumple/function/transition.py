"""STEP, STEP5 and HAVSIN: smooth passages from one level to another, with ADAMS's argument order.

With d = (x - x0)/(x1 - x0) between the ends and f = h0 + (h1 - h0) s(d):

    step     s = d^2 (3 - 2 d)                 the cubic with s' = 0 at both ends: C1
    step5    s = d^3 (10 - 15 d + 6 d^2)       the quintic with s' = s'' = 0 at both ends: C2
    havsin   s = (1 + sin(pi d - pi/2)) / 2    C1

Left of x0 the value is h0, right of x1 it is h1.  s' = 6 d (1 - d), 30 d^2 (1 - d)^2 and
(pi/2) sin(pi d): never negative, so f is monotonic.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from crumple.errors import InputError
from crumple.numeric.arrays import Floats


def step(x: ArrayLike, x0: float, h0: float, x1: float, h1: float) -> Floats:
    """Cubic passage from `h0` at `x0` to `h1` at `x1`.

    Parameters
    ----------
    x
        Independent variable, any shape.
    x0, x1
        Ends of the passage, in the unit of `x`; x0 < x1.
    h0, h1
        Levels left and right.

    Returns
    -------
    NDArray
        Values in the unit of the levels, shape of `x`.

    Raises
    ------
    InputError
        If x0 >= x1.
    """
    d = _place(x, x0, x1)
    return _blend(d * d * (3.0 - 2.0 * d), h0, h1)


def step5(x: ArrayLike, x0: float, h0: float, x1: float, h1: float) -> Floats:
    """Quintic passage from `h0` at `x0` to `h1` at `x1`; parameters as for `step`."""
    d = _place(x, x0, x1)
    return _blend(d**3 * (10.0 + d * (6.0 * d - 15.0)), h0, h1)


def havsin(x: ArrayLike, x0: float, h0: float, x1: float, h1: float) -> Floats:
    """Haversine passage from `h0` at `x0` to `h1` at `x1`; parameters as for `step`."""
    d = _place(x, x0, x1)
    return _blend(0.5 * (1.0 + np.sin(np.pi * d - 0.5 * np.pi)), h0, h1)


def step_slope(x: ArrayLike, x0: float, h0: float, x1: float, h1: float) -> Floats:
    """Derivative of `step` with respect to `x`."""
    d = _place(x, x0, x1)
    return np.asarray((h1 - h0) / (x1 - x0) * 6.0 * d * (1.0 - d))


def step5_slope(x: ArrayLike, x0: float, h0: float, x1: float, h1: float) -> Floats:
    """Derivative of `step5` with respect to `x`."""
    d = _place(x, x0, x1)
    return np.asarray((h1 - h0) / (x1 - x0) * 30.0 * (d * (1.0 - d)) ** 2)


def havsin_slope(x: ArrayLike, x0: float, h0: float, x1: float, h1: float) -> Floats:
    """Derivative of `havsin` with respect to `x`."""
    d = _place(x, x0, x1)
    # sin(pi) is not exactly zero in floating point, and the slope outside must be
    inside = (d > 0.0) & (d < 1.0)
    return np.asarray(np.where(inside, (h1 - h0) / (x1 - x0) * 0.5 * np.pi * np.sin(np.pi * d), 0.0))


Passage = Callable[[ArrayLike, float, float, float, float], Floats]

PASSAGES: dict[str, tuple[Passage, Passage, float]] = {
    "step": (step, step_slope, 6.0),
    "step5": (step5, step5_slope, 10.0 / 3.0**0.5),
    "havsin": (havsin, havsin_slope, np.pi**2 / 2.0),
}
"""By name: value, slope, and the largest |s''|, which bounds the error of linear interpolation."""


def _place(x: ArrayLike, x0: float, x1: float) -> Floats:
    """Relative place d between the ends, held to 0..1."""
    if not x0 < x1:
        raise InputError(f"a transition needs x0 < x1, not x0 = {x0:g} and x1 = {x1:g}")
    return np.clip((np.asarray(x, dtype=np.float64) - x0) / (x1 - x0), 0.0, 1.0)


def _blend(s: Floats, h0: float, h1: float) -> Floats:
    # this form gives exactly h0 at s = 0 and exactly h1 at s = 1
    return np.asarray((1.0 - s) * h0 + s * h1)
