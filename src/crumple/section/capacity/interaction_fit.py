"""Compact convex function for the plastic interaction of a section: what a solver evaluates at every step.

    g(x)^r = [sum_k |a_k . (n, m_y, m_z)|^p]^(r/p) + |t|^r,        x on the surface: g = 1

with the resultants over their largest values.  Powers of linear forms are convex and even, so g is a norm,
whatever the rows a_k.  They are picked from the normals d_k of the exact surface, least squares for sum_k w_k
|d_k . x|^p = 1 with few w_k > 0, and then moved.  Every row comes with its images under the symmetry of the
section, so a mirror image of the forces has the same g and the mirror image of its gradient, to rounding:
pure M_y of a tube turns it about y alone and does not shorten it.  Of a round tube the rows are over N and
the resultant of both moments, in their plane, so that no axis differs from another.

r = 2 is von Mises where all walls share the torque; sections whose inner walls carry none of it want a
larger r.

Limits: p = 2 is an ellipsoid, large p the polyhedron of tangent planes.  The corner at pure axial force is
rounded, and there the error is largest.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from crumple.numeric.arrays import Floats
from crumple.section.capacity.interaction import PlasticInteraction
from crumple.section.capacity.interaction_rows import moved, picked
from crumple.section.capacity.interaction_symmetry import axisymmetric, one_of_each, symmetry

POWERS = (16, 10)
"""Exponents p that are tried, the next if the error is not `GOOD`."""
GOOD = 0.05
"""Error of a fit beside which no other exponent is tried."""
TORQUE_POWERS = (2.0, 2.5, 3.0, 4.0)
"""Exponents r that are tried."""
IN_PLANE = np.array([np.eye(3), np.diag([1.0, -1.0, 1.0])])
"""Images of rows over the axial force and the resultant of the moments."""
ROUND_ROWS, ROUND_PLACES = 6, 61
"""Most rows of a round tube, whose error more of them do not reduce, and places where they are fitted."""


@dataclass(frozen=True, eq=False)
class InteractionFit:
    """Smooth convex surface g = 1 in (N, M_y, M_z, T).

    Attributes
    ----------
    scales
        Largest N, M_y, M_z and T [N, N m, N m, N m], shape (4,).
    rows
        Linear forms in N, M_y, M_z over their scales, shape (k, 3).
    power, torque_power
        Exponents p and r.
    axisymmetric
        Whether the rows are over N, the resultant of M_y and M_z, and zero: round tubes.
    error
        Largest relative distance between the two surfaces along rays through the origin, over a spread of
        points with and without torque that the fit did not see.
    mean_error
        Mean of the same.
    """

    scales: Floats
    rows: Floats
    power: float
    torque_power: float = 2.0
    error: float = 0.0
    mean_error: float = 0.0
    axisymmetric: bool = False

    def gauge(self, resultants: ArrayLike) -> Floats:
        """Value g of resultants (N, M_y, M_z, T), shapes (...) and (..., 4): 1 on the surface."""
        x = np.asarray(resultants, float) / self.scales
        direct = _direct(self._direct_loads(x), self.rows, self.power)[0]
        return _with_twist(direct, np.abs(x[..., 3]), self.torque_power)

    def gauge_and_gradient(self, resultants: ArrayLike) -> tuple[Floats, Floats]:
        """Value g and its gradient [1/N, 1/(N m), ...], shapes (...) and (..., 4); zero at the origin."""
        x = np.asarray(resultants, float) / self.scales
        loads = self._direct_loads(x)
        direct, ratio, total = _direct(loads, self.rows, self.power)
        twist, r = np.abs(x[..., 3]), self.torque_power
        g = _with_twist(direct, twist, r)
        over = np.where(g > 0.0, g, 1.0)
        weight = np.sign(ratio) * np.abs(ratio) ** (self.power - 1.0)
        scale = np.where(total > 0.0, total, 1.0) ** (1.0 / self.power - 1.0)
        slope = (weight @ self.rows) * (scale * (direct / over) ** (r - 1.0))[..., None]
        if self.axisymmetric:
            moments, resultant = x[..., 1:3], loads[..., 1:2]
            slope[..., 1:] = slope[..., 1:2] * moments / np.where(resultant > 0.0, resultant, 1.0)
        about = (np.sign(x[..., 3]) * (twist / over) ** (r - 1.0))[..., None]
        return g, np.concatenate([slope, about], axis=-1) / self.scales

    def _direct_loads(self, x: Floats) -> Floats:
        """What the rows are over, of resultants over their scales, (..., 4) to (..., 3)."""
        return _with_resultant(x) if self.axisymmetric else x[..., :3]


def fitted_interaction(interaction: PlasticInteraction, *, rows: int = 24) -> InteractionFit:
    """Compact fit of an interaction surface, the best of several exponents.

    Parameters
    ----------
    interaction
        Exact surface.
    rows
        Most linear forms to use, at least 8; those of a square section come in sets of up to eight images.

    Returns
    -------
    InteractionFit
        With its error.
    """
    scales, images = interaction.scales, symmetry(interaction)
    round_tube = axisymmetric(interaction)
    around, levels = (24, 13) if len(images) < 4 else (32, 17)
    points, normals = (
        _in_plane(interaction) if round_tube else _surface(interaction, images, around, levels, 1)
    )
    # of a section with images fewer places are needed: as many, but closer together
    finer = math.sqrt(len(images))
    seen = _surface(interaction, images, round(23 * finer), round(14 * finer), 3)[0]
    # to resultants and back, as a solver asks
    seen = seen * scales / scales
    twist, loads = np.abs(seen[:, 3]), _with_resultant(seen) if round_tube else seen[:, :3]
    own, most = (IN_PLANE, min(rows, ROUND_ROWS)) if round_tube else (images, rows)
    fits: list[InteractionFit] = []
    for power in POWERS:
        orbits = moved(picked(points[:, :3], normals[:, :3], own, power, most), points[:, :3], power)
        chosen = orbits.all_rows()
        # the exponents of the torque share it
        direct = _direct(loads, chosen, power)[0]
        for torque_power in TORQUE_POWERS:
            off = np.abs(1.0 / _with_twist(direct, twist, torque_power) - 1.0)
            found = (float(power), torque_power, float(off.max()), float(off.mean()), round_tube)
            fits.append(InteractionFit(scales, chosen, *found))
        best = min(fits, key=lambda fit: fit.error)
        if best.error <= GOOD:
            break
    return best


def _direct(x: Floats, rows: Floats, power: float) -> tuple[Floats, Floats, Floats]:
    """Value of the part without torque, (...); forms over the largest, (..., k), and their sum of powers."""
    forms = x @ rows.T
    largest = np.abs(forms).max(axis=-1, keepdims=True)
    # the largest form taken out, so that high powers neither overflow nor vanish
    ratio = np.divide(forms, largest, out=np.zeros_like(forms), where=largest > 0.0)
    total = (np.abs(ratio) ** power).sum(axis=-1)
    return np.where(total > 0.0, largest[..., 0] * total ** (1.0 / power), 0.0), ratio, total


def _with_resultant(x: Floats) -> Floats:
    """N, the resultant of M_y and M_z, and zero, (..., 4) to (..., 3)."""
    resultant = np.hypot(x[..., 1], x[..., 2])
    return np.stack([x[..., 0], resultant, np.zeros_like(resultant)], axis=-1)


def _with_twist(direct: Floats, twist: Floats, r: float) -> Floats:
    """Value g of both parts, none of them negative, all of shape (...)."""
    top = np.maximum(direct, twist)
    safe = np.where(top > 0.0, top, 1.0)
    g: Floats = top * ((direct / safe) ** r + (twist / safe) ** r) ** (1.0 / r)
    return g


def _in_plane(interaction: PlasticInteraction) -> tuple[Floats, Floats]:
    """Points over their scales and normals d with d . x = 1 of a round tube, about y alone, (n, 4)."""
    angle = np.linspace(0.0, math.pi / 2.0, ROUND_PLACES)
    rates = np.stack([np.sin(angle), np.cos(angle), np.zeros_like(angle), np.zeros_like(angle)], axis=1)
    return _scaled_points(interaction, rates)


def _surface(
    interaction: PlasticInteraction, images: Floats, around: int, levels: int, torques: int
) -> tuple[Floats, Floats]:
    """Points over their scales and normals d with d . x = 1, none an image of another, of shape (n, 4)."""
    rates = interaction.spread_rates(around, levels, torques)[: -1 if torques == 1 else None]
    # zero but for rounding: a normal of an axis of symmetry is its own image
    rates[np.abs(rates) < 1e-12] = 0.0
    return _scaled_points(interaction, rates[one_of_each(rates[:, :3], images)])


def _scaled_points(interaction: PlasticInteraction, rates: Floats) -> tuple[Floats, Floats]:
    """Points and normals at rates over the inverse scales, (n, 4) each."""
    points = interaction.point(rates / interaction.scales) / interaction.scales
    power = (rates * points).sum(axis=1)
    return points, rates / power[:, None]
