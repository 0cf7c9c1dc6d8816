"""Energy-equivalent flow stress: one constant stress that does the work of a hardening curve.

Unknown: the stress s_0 of a perfectly plastic metal that absorbs the same energy up to a final strain e_f.
With the curve s(e):

    membrane (all of the wall at the same strain)   s_0 = 1/e_f  integral_0^e_f s(e) de
    bending (strain grows linearly from mid-wall; e_f at the surface)
        moment per width at surface strain x:  t^2/2 x^-2 integral_0^x s(e) e de
        work to x = e_f over that of s_0 t^2/4, order of integration exchanged:
                                                    s_0 = 2/e_f  integral_0^e_f s(e) (1 - e/e_f) de

Limits: perfectly plastic gives s_y in both; for s = s_u (e/e_u)^n they are s_u (e_f/e_u)^n/(n + 1) and
2 s_u (e_f/e_u)^n/((n + 1)(n + 2)); bending is never above membrane, since less of the wall strains far.
"""

from __future__ import annotations

import math

import numpy as np

from crumple.errors import InputError, Problem
from crumple.material.hardening.curve import HardeningCurve
from crumple.numeric.arrays import Floats

GAUSS_POINTS = 16
"""Per interval; a smooth hardening curve is integrated to rounding."""
HALVINGS = 40
"""Intervals halve towards zero strain, where power laws are steep."""


def membrane_flow_stress(curve: HardeningCurve, final_strain: float) -> float:
    """Constant stress [Pa] that does the work of a curve in a wall stretched to a plastic strain [-].

    References
    ----------
    Derived above.
    Verified in tests/unit/material/test_flow_stress.py.
    """
    strain, weight = _points(final_strain)
    return float(weight @ curve.stress(strain)) / final_strain


def bending_flow_stress(curve: HardeningCurve, final_strain: float) -> float:
    """Constant stress [Pa] that does the work of a curve in a wall bent to a plastic surface strain [-].

    Notes
    -----
    A fold that closes on a radius r has the surface strain t/(2 r + t).
    """
    strain, weight = _points(final_strain)
    return 2.0 * float(weight @ (curve.stress(strain) * (1.0 - strain / final_strain))) / final_strain


def mean_flow_stress(yield_stress: float, ultimate_stress: float) -> float:
    """(s_y + s_u)/2 [Pa]: a rule in common use; no source of it was read."""
    return (yield_stress + ultimate_stress) / 2.0


def power_law_flow_stress(yield_stress: float, ultimate_stress: float, exponent: float) -> float:
    """sqrt(s_y s_u/(1 + n)) [Pa]: a rule in common use; no source of it was read."""
    return math.sqrt(yield_stress * ultimate_stress / (1.0 + exponent))


def _points(final_strain: float) -> tuple[Floats, Floats]:
    """Strains and weights of an integral from 0 to a strain."""
    if not (math.isfinite(final_strain) and final_strain > 0.0):
        what, todo = "the final strain must be positive", "a fold reaches 0.1 to 0.5"
        raise InputError(Problem(what, f"{final_strain:g}", "> 0", todo, "final_strain"))
    place, weight = np.polynomial.legendre.leggauss(GAUSS_POINTS)
    ends = final_strain * np.concatenate([[0.0], 0.5 ** np.arange(HALVINGS, -1.0, -1.0)])
    lengths = np.diff(ends)
    strain = ends[:-1, None] + lengths[:, None] * (place + 1.0) / 2.0
    return strain.ravel(), np.outer(lengths, weight / 2.0).ravel()
