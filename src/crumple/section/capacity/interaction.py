"""Axial force, both moments and torque that a section of walls carries at once when it is plastic.

Limit analysis of the section's own metal.  A rate of stretch e + k_y z - k_z y at every point and a twist
rate w dissipate at least

    D(e, k_y, k_z, w) = max over T of  w T + sum over the walls of  f(T) int sigma_y |e + k_y z - k_z y| dA
    f(T) = sqrt(1 - (s T/T_p)^2)

where s is the part of its shear yield stress that a wall gives to the fully plastic torque T_p (von Mises).
All resultants with D >= N e + M_y k_y + M_z k_z + T w for every rate form the convex body; its surface
points are the resultants of the stress sigma_y f sign(e + k_y z - k_z y), exact as a line cuts the polygons
exactly.

The body is symmetric about the origin.  With one cell of equal walls it is exact within plane sections and
constant shear flow: T multiplies all direct resultants by sqrt(1 - (T/T_p)^2).  Elsewhere the shear keeps
the pattern of T_p, which is a safe bound.  No buckling, no transverse shear, no warping stress.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from crumple.material import Material
from crumple.numeric.arrays import Floats
from crumple.section.properties.plastic_torsion import plastic_torsion, torque_lost_to_shear
from crumple.section.properties.polygons import above, moments
from crumple.section.section import Axis, Section
from crumple.section.wall_section import walls_of
from crumple.section.walled import WalledSection, angle_of


@dataclass(frozen=True)
class PlasticInteraction:
    """Convex body of (N, M_y, M_z, T), about the centroid; N positive in tension, M_y stretches +z, M_z -y.

    Attributes
    ----------
    section
        Walls; see `plastic_interaction`.
    material
        Metal of the walls that name none; only yield stresses matter.

    References
    ----------
    docs/theory/interaction.md.  Verified in tests/verification/section/test_section_interaction.py.
    """

    section: WalledSection
    material: Material

    @cached_property
    def yields(self) -> Floats:
        """Yield stress of each edge [Pa], shape (m,)."""
        return np.array([metal.yield_stress for metal in self.section.metals(self.material)])

    @cached_property
    def squash_force(self) -> float:
        """Largest axial force [N]."""
        return float(self.yields @ self.section.skeleton_areas)

    @property
    def plastic_torque(self) -> float:
        """Largest torque T_p [N m]."""
        return self._torsion[0]

    @property
    def yielding_shear_force(self) -> float:
        """Sum of the shear forces of walls that yield in pure torsion [N]: t L sigma_y/sqrt(3) of each."""
        return float((self.shear_use * self.yields) @ self.section.skeleton_areas) / math.sqrt(3.0)

    @property
    def shear_use(self) -> Floats:
        """Part of its shear yield stress that each edge gives to the plastic torque, shape (m,)."""
        return self._torsion[1]

    @cached_property
    def _torsion(self) -> tuple[float, Floats]:
        return plastic_torsion(self.section.skeleton, self.yields)

    @cached_property
    def torque_lost_to_shear(self) -> tuple[float, float]:
        """Share of the torque that a shear force along y, and one along z, takes from the walls [1/N]."""
        skeleton, centre = self.section.skeleton, complex(*self.section.properties.centroid)
        lost = [torque_lost_to_shear(skeleton, self.yields, centre, angle) for angle in (0.0, math.pi / 2.0)]
        return lost[0], lost[1]

    @cached_property
    def scales(self) -> Floats:
        """Largest N, M_y, M_z and T that the body reaches [N, N m, N m, N m], shape (4,)."""
        unit = np.array([[0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]])
        about_y, about_z = self.support(unit).tolist()
        return np.array([self.squash_force, about_y, about_z, self.plastic_torque])

    def support(self, rates: ArrayLike) -> Floats:
        """Dissipation D [W/m] of rates (e [1/s], k_y, k_z, w [1/(m s)]), shapes (...) and (..., 4)."""
        rates = np.asarray(rates, float)
        return np.asarray((rates * self.point(rates)).sum(axis=-1))

    def point(self, rates: ArrayLike) -> Floats:
        """Resultants (N, M_y, M_z, T) of the surface at which rates are normal, both of shape (..., 4)."""
        given = np.asarray(rates, float)
        flat = given.reshape(-1, 4)
        parts = self._edge_resultants(flat[:, :3])
        dissipated = np.einsum("dmk,dk->dm", parts, flat[:, :3])
        torque = self._torque_share(dissipated, flat[:, 3])
        left = np.sqrt(np.maximum(1.0 - (self.shear_use[None, :] * torque[:, None]) ** 2, 0.0))
        direct = np.einsum("dm,dmk->dk", left, parts)
        return np.column_stack([direct, torque * self.plastic_torque]).reshape(given.shape)

    def _edge_resultants(self, rates: Floats) -> Floats:
        """N, M_y, M_z of each edge with its metal at yield in the sense of the stretch, shape (d, m, 3)."""
        stretch, ky, kz = rates.T
        polygons = self.section.centred_polygons
        size = float(np.abs(polygons).max())
        curvature = np.hypot(ky, kz)
        angle = np.arctan2(kz, ky)
        # no curvature: the line lies far outside
        far = 10.0 * size * np.sign(stretch)
        small = curvature * size <= 1e-12 * np.abs(stretch)
        level = -np.where(small, far, stretch / np.where(small, 1.0, curvature))
        level = np.clip(level, -10.0 * size, 10.0 * size)
        part, whole = above(polygons, angle, level), moments(polygons)
        c, s = np.cos(angle)[:, None], np.sin(angle)[:, None]
        force = 2.0 * part.area - whole.area
        height = 2.0 * part.height - (c * whole.z - s * whole.y)
        along = 2.0 * part.along - (c * whole.y + s * whole.z)
        return (
            np.stack([force, s * along + c * height, s * height - c * along], axis=2) * self.yields[:, None]
        )

    def _torque_share(self, dissipated: Floats, twist: Floats) -> Floats:
        """T/T_p that maximises the dissipation of each rate, shape (d,)."""
        use, drive = self.shear_use, np.abs(twist) * self.plastic_torque
        if np.all((use == 1.0) | (self.section.skeleton_areas <= 0.0)):
            total = np.hypot(drive, dissipated.sum(axis=1))
            share = np.divide(drive, total, out=np.zeros_like(drive), where=total > 0.0)
            return np.asarray(np.sign(twist) * share)
        # slope of the dissipation over T falls from w to minus infinity or stays positive up to T_p
        found, driven = np.zeros_like(drive), drive > 0.0
        drive, slope = drive[driven], use**2 * dissipated[driven]
        low, high = np.zeros_like(drive), np.ones_like(drive)
        for _ in range(50 if driven.any() else 0):
            share = (low + high) / 2.0
            left = np.sqrt(np.maximum(1.0 - (use * share[:, None]) ** 2, 1e-300))
            rising = drive > share * (slope / left).sum(axis=1)
            low, high = np.where(rising, share, low), np.where(rising, high, share)
        found[driven] = (low + high) / 2.0
        return np.asarray(np.sign(twist) * found)

    def multiplier(self, load: ArrayLike) -> float:
        """Largest factor on a load (N, M_y, M_z, T) that the body carries, shape (4,).

        Minimum of D over the power of the load, from a spread of rates, then ever closer around the best.
        """
        goal = np.asarray(load, float) / self.scales
        rates = self.spread_rates(12, 9, 3)
        width = 0.5
        best = math.inf
        generator = np.random.default_rng(0)
        for _ in range(14):
            power = rates @ goal
            value = np.divide(
                self.support(rates / self.scales), power, out=np.full(len(rates), np.inf), where=power > 1e-12
            )
            k = int(value.argmin())
            if value[k] < best:
                best, centre = float(value[k]), rates[k] / np.linalg.norm(rates[k])
            step = generator.normal(size=(96, 4)) * width * generator.random((96, 1)) ** 2
            rates = centre + step
            width *= 0.55
        return best

    def spread_rates(self, around: int, levels: int, torques: int) -> Floats:
        """Rates whose points cover the surface, times `scales` and of length 1, shape (n, 4).

        ``around`` directions of the neutral axis, ``levels`` of its places in the section (denser towards its
        ends), ``torques`` shares of the torque; the pure torque comes last.
        """
        turn = 2.0 * np.pi * np.arange(around) / around
        twist = np.linspace(0.0, np.pi / 2.0, torques + 1)[:-1]
        heights = (self.section.centred_polygons.ravel() * np.exp(-1j * turn)[:, None]).imag
        top, bottom = heights.max(axis=1), -heights.min(axis=1)
        share = (1.0 - np.cos(np.pi * (np.arange(levels) + 0.5) / levels)) / 2.0
        level = share[None, :] * (top + bottom)[:, None] - bottom[:, None]
        bend = np.broadcast_to(turn[:, None], level.shape)
        direct = np.stack([-level, np.cos(bend), np.sin(bend)], axis=-1).reshape(-1, 3) * self.scales[:3]
        # all at yield in one sense: the line lies outside
        direct = np.concatenate([direct / np.linalg.norm(direct, axis=1)[:, None], [[1, 0, 0], [-1, 0, 0]]])
        whole = [np.column_stack([direct * np.cos(t), np.full(len(direct), np.sin(t))]) for t in twist]
        return np.concatenate([*whole, [[0.0, 0.0, 0.0, 1.0]]])

    def force_moment_curve(
        self, axis: Axis | float = "y", *, torque: float = 0.0, points: int = 121
    ) -> Floats:
        """Outline of N and the moment about an axis with curvature about that axis alone, at a torque.

        Parameters
        ----------
        axis
            "y", "z" or an angle from y towards z [rad].
        torque
            T [N m], at most the plastic torque.
        points
            Places of the neutral axis per sense of bending.

        Returns
        -------
        NDArray
            (N, M) [N, N m], closed curve, shape (n, 2).
        """
        angle = angle_of(axis)
        top, bottom = self.section.extent(angle)
        level = np.linspace(-bottom, top, points)
        rates = np.column_stack([-level, np.full(points, np.cos(angle)), np.full(points, np.sin(angle))])
        share = np.clip(torque / self.plastic_torque, -1.0, 1.0)
        left = np.sqrt(np.maximum(1.0 - (self.shear_use * share) ** 2, 0.0))
        force, about_y, about_z = np.einsum("m,dmk->kd", left, self._edge_resultants(rates))
        half = np.column_stack([force, np.cos(angle) * about_y + np.sin(angle) * about_z])
        return np.concatenate([half, -half])

    def moment_curve(self, axial_force: float = 0.0, *, points: int = 180) -> Floats:
        """Outline of (M_y, M_z) [N m] at an axial force [N] and no torque, closed, shape (points, 2)."""
        angle = 2.0 * np.pi * np.arange(points) / points
        polygons = self.section.centred_polygons
        low, high = np.full(points, -1.0), np.full(points, 1.0)
        low, high = low * 2.0 * np.abs(polygons).max(), high * 2.0 * np.abs(polygons).max()
        wanted = (self.squash_force + axial_force) / 2.0
        for _ in range(45):
            level = (low + high) / 2.0
            too_much = above(polygons, angle, level).area @ self.yields > wanted
            low, high = np.where(too_much, level, low), np.where(too_much, high, level)
        rates = np.column_stack([-level, np.cos(angle), np.sin(angle)])
        return np.asarray(self._edge_resultants(rates).sum(axis=1)[:, 1:])


def plastic_interaction(section: Section, material: Material) -> PlasticInteraction:
    """Interaction of axial force, moments and torque of a tube or a section of walls."""
    return PlasticInteraction(walls_of(section), material)
