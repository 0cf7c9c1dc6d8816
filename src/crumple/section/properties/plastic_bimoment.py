"""Largest bimoment of thin walls without cells, beside no axial force and no bending moment.

A twist whose rate varies along the member stretches a wall by its warping.  With the bimoment B = int s w dA
of axial stresses |s| <= s_y that have no resultant and no moment,

    B_p = min over c, y_P, z_P of  int s_y |w + y_P z - z_P y - c| dA,

the work of a bimoment hinge about the axis y_P, z_P that takes least of it.  w is the warping of the
mid-line, and n r_t more at the distance n from it, with the lever arm r_t along the wall.  Across a wall

    int |w + n r| dn = t |w|  if |w| >= |r| t/2,  else  w^2/|r| + |r| t^2/4.

Limits: two equal flanges in sway, each with the plastic moment s_y t b^2/4 at the distance h, have B_p =
s_y t b^2 h/4 (I); the web of a channel adds to it, B_p = s_y t h (b^2/2 - x^2) with x = b/2 - h/8 > 0; an
angle warps across its walls alone, B_p = s_y t^2 a^2/4 for equal legs a.
"""

from __future__ import annotations

import numpy as np

from crumple.numeric.arrays import Floats
from crumple.section.geometry.skeleton import Skeleton
from crumple.section.properties.torsion import warping_of

STRIPS = 24
"""Strips of each edge: the work of one is that of its middle, exact but where the warping changes sign."""
ROUNDS = 60
"""Of weighted least squares; the work is flat at its least, and any axis gives an upper bound."""
SMALLEST = 1e-6
"""Least distance from zero in the weights, over the largest warping."""


def plastic_bimoment(skeleton: Skeleton, yields: Floats) -> float:
    """Largest bimoment [N m^2] of walls without cells.

    Parameters
    ----------
    skeleton
        Graph of the section.
    yields
        Yield stress of each edge [Pa], shape (m,).
    """
    share = (np.arange(STRIPS) + 0.5) / STRIPS
    start, end = skeleton.ends.T
    local, warping = skeleton.nodes - skeleton.middle, warping_of(skeleton)

    points = local[start, None] * (1.0 - share) + local[end, None] * share
    warped = warping[start, None] * (1.0 - share) + warping[end, None] * share
    width = np.broadcast_to((skeleton.length / STRIPS)[:, None], points.shape)
    thickness = np.broadcast_to(skeleton.thickness[:, None], points.shape)
    strength = width * thickness * yields[:, None]
    linear = np.stack([np.ones(points.shape), points.real, points.imag], axis=-1).reshape(-1, 3)
    weight, u = strength.ravel(), warped.ravel()
    size = float(np.ptp(np.abs(points))) * float(np.abs(points).max())
    left = u - linear @ np.linalg.lstsq(linear * weight[:, None], u * weight, rcond=1e-12)[0]
    for _ in range(ROUNDS):
        each = np.sqrt(weight / np.maximum(np.abs(left), SMALLEST * size))
        fit = np.linalg.lstsq(linear * each[:, None], u * each, rcond=1e-12)[0]
        left = u - linear @ fit
    # w - fit . (1, y, z) is the warping about the pole y_P = -fit_z, z_P = fit_y
    pole = complex(-fit[2], fit[1])
    direction = (local[end] - local[start]) / np.abs(local[end] - local[start])
    lever = np.abs(((points - pole) * direction[:, None].conj()).real)
    return float(
        (yields[:, None] * width * _across(np.abs(left).reshape(points.shape), lever, thickness)).sum()
    )


def _across(warping: Floats, lever: Floats, thickness: Floats) -> Floats:
    """Integral over the thickness of the absolute warping [m^3]."""
    held = np.maximum(lever, 1e-300)
    mixed = warping * warping / held + held * thickness**2 / 4.0
    return np.asarray(np.where(warping >= lever * thickness / 2.0, warping * thickness, mixed))
