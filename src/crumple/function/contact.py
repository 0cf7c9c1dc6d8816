"""IMPACT and BISTOP: one-sided springs with dampers, with ADAMS's argument order and meaning.

A spring k g^e acts while the gap is closed by the penetration g > 0; a damper acts with it, its
coefficient rising from 0 at touch to cmax at the penetration d by STEP, so that the force starts
without a jump.  The force never pulls.

    impact = max(0, k (x1 - x)^e - cmax v STEP(x, x1 - d, 1, x1, 0))       x < x1, else 0

`bistop` is impact at x1 and its mirror image, with the opposite sign, at x2 > x1.  d = 0 is allowed:
the damper then acts fully from first touch.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from crumple.errors import InputError, Problem
from crumple.function.transition import step
from crumple.numeric.arrays import Floats


def impact(x: ArrayLike, v: ArrayLike, x1: float, k: float, e: float, cmax: float, d: float) -> Floats:
    """One-sided spring and damper that pushes towards larger x while x < x1.

    Parameters
    ----------
    x, v
        Distance [m] or angle [rad] and its rate, shapes that broadcast.
    x1
        Distance at which the bodies touch.
    k
        Stiffness [N/m^e] or [N m/rad^e], >= 0.
    e
        Exponent of the spring, >= 1.
    cmax
        Largest damping coefficient [N s/m] or [N m s/rad], >= 0.
    d
        Penetration at which the damper acts fully, >= 0.

    Returns
    -------
    NDArray
        Force [N] or moment [N m], >= 0.

    Raises
    ------
    InputError
        If k, cmax or d is negative, e is below 1, or one of them is not finite.

    References
    ----------
    IMPACT as documented for ADAMS and MotionSolve.
    """
    if not (0.0 <= k < math.inf and 1.0 <= e < math.inf and 0.0 <= cmax < math.inf and 0.0 <= d < math.inf):
        came = f"k = {k:g}, e = {e:g}, cmax = {cmax:g}, d = {d:g}"
        what, allowed = (
            "impact and bistop need finite k, cmax and d >= 0 and e >= 1",
            "k, cmax, d >= 0; e >= 1",
        )
        raise InputError(Problem(what, came, allowed, "correct the sign, or the exponent"))
    position, rate = np.broadcast_arrays(np.asarray(x, np.float64), np.asarray(v, np.float64))
    penetration = np.maximum(x1 - position, 0.0)
    damper = step(position, x1 - d, 1.0, x1, 0.0) if x1 - d < x1 else np.ones_like(position)
    force = k * penetration**e - cmax * rate * damper
    return np.where(penetration > 0.0, np.maximum(force, 0.0), 0.0)


def bistop(
    x: ArrayLike, v: ArrayLike, x1: float, x2: float, k: float, e: float, cmax: float, d: float
) -> Floats:
    """Stops on both sides: free between x1 and x2, pushed back beyond them.

    Parameters
    ----------
    x, v
        Distance [m] or angle [rad] and its rate, shapes that broadcast.
    x1, x2
        Lower and upper end of the free travel, x1 < x2.
    k, e, cmax, d
        As for `impact`, the same at both ends.

    Returns
    -------
    NDArray
        Force [N] or moment [N m]: >= 0 below x1, <= 0 above x2, 0 between.

    Raises
    ------
    InputError
        If x1 >= x2, or as for `impact`.

    References
    ----------
    BISTOP as documented for ADAMS and MotionSolve.
    """
    if not x1 < x2:
        came, todo = f"x1 = {x1:g}, x2 = {x2:g} (SI)", "exchange them, or correct the places"
        raise InputError(Problem("bistop needs x1 < x2", came, "x1 < x2", todo))
    position, rate = np.asarray(x, np.float64), np.asarray(v, np.float64)
    lower = impact(position, rate, x1, k, e, cmax, d)
    upper = impact(-position, -rate, -x2, k, e, cmax, d)
    return np.asarray(lower - upper)
