"""Kecman-type folding mechanism of a rectangular tube in bending: geometry, plastic work, moment.

Unknown: the moment that turns a folded section by theta = 2 rho.  Two rigid tube ends turn about the
tension flange; every plate between them keeps its lengths, so all work is done in hinge lines and in two
pairs of rolling lines.  With flange width a, depth b, half fold length h, s = sin rho, c = cos rho:

    x_E = h - b s                  half distance of the flange's fold ends
    d   = sqrt(b s (2h - b s))     drop of the fold below them: the flange plate keeps its length h
    y_B = b c - d                  height of the fold above the tension flange
    z_A = b s^2 - h s + d c        bulge of the web: the web plate keeps its height b
    phi = asin(1 - (b/h) s)        angle of the flange plate to the vertical; tilt = pi/2 - phi

Each line works length x turn x m_p, m_p = flow_stress t^2/4; each rolling line of radius r works 2 m_p/r on
the area that it sweeps.  M = dW/dtheta is the sum of the derivatives of these terms.
Limits: theta -> 0: z_A -> sqrt(b h theta), so W ~ theta^(1/2) and M ~ theta^(-1/2): a law must cap it;
flange halves touch (x_E = t/2) at theta_J = 2 asin((h - t/2)/b).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from crumple.numeric.arrays import Floats

# Relative step of the central difference of M: truncation and rounding both stay near 1e-10.
DIFFERENCE_STEP = 1e-5
# Below this rotation [rad] the singular moment keeps its value there; every law is capped well before.
SMALLEST_ROTATION = 1e-12


@dataclass(frozen=True)
class FoldMechanism:
    """Folded zone of a rectangular tube.

    Attributes
    ----------
    width, depth, thickness
        Flange width a, depth b and wall t [m], outer dimensions.
    flow_stress
        Stress in the hinge lines [Pa].
    rolling_weight
        Weight [-] of the second rolling line (web diagonal), 0 to 1: its curvature falls linearly along it.

    References
    ----------
    Concept, h = min(a, b)/2, r(theta), line terms after D. Kecman, Int. J. Mech. Sci. 25 (1983) 623-636;
    the geometry and its energies are derived here.  docs/theory/kecman.md.
    Verified in tests/verification/hinge/test_kecman_mechanism.py.
    """

    width: float
    depth: float
    thickness: float
    flow_stress: float
    rolling_weight: float = 1.0

    @cached_property
    def half_length(self) -> float:
        """Half the length of the folded zone, h = min(a, b)/2 [m]."""
        return min(self.width, self.depth) / 2.0

    @property
    def kinks(self) -> tuple[float, ...]:
        """None: its lines turn smoothly."""
        return ()

    @cached_property
    def jamming_angle(self) -> float:
        """Rotation at which the flange halves touch, 2 asin((h - t/2)/b) [rad]."""
        return 2.0 * math.asin((self.half_length - self.thickness / 2.0) / self.depth)

    def rolling_radius(self, rotation: ArrayLike) -> NDArray[Any]:
        """Radius of the rolling lines, (0.07 - theta/70) h [m], theta in rad."""
        return np.asarray((0.07 - np.asarray(rotation) / 70.0) * self.half_length)

    def corners(self, rotation: ArrayLike) -> dict[str, NDArray[Any]]:
        """Lengths x_E, y_B, z_A [m] and the tilt of the flange plate [rad] at a rotation [rad]."""
        b, h = self.depth, self.half_length
        s, c = np.sin(np.asarray(rotation) / 2.0), np.cos(np.asarray(rotation) / 2.0)
        drop = np.sqrt(b * s * (2.0 * h - b * s))
        # 2 asin(sqrt(u/2)) = acos(1 - u) without its cancellation at small u
        tilt = 2.0 * np.arcsin(np.sqrt(b * s / (2.0 * h)))
        return {"x_E": h - b * s, "y_B": b * c - drop, "z_A": b * s**2 - h * s + drop * c, "tilt": tilt}

    def energy_terms(self, rotation: ArrayLike) -> dict[str, NDArray[Any]]:
        """Plastic work of each line over m_p [m] at a rotation [rad]; names as in docs/theory/kecman.md."""
        a, b, h = self.width, self.depth, self.half_length
        rotation = np.asarray(rotation)
        corners = self.corners(rotation)
        y_B, z_A, tilt = corners["y_B"], corners["z_A"], corners["tilt"]
        at_web_end, at_diagonal = _web_angles(b, h, rotation, corners)
        rolled = h * z_A / self.rolling_radius(rotation)
        return {
            "W1": 2.0 * a * (tilt - rotation / 2.0),
            "W2": 2.0 * a * tilt,
            "W3": a * rotation,
            "W4": 4.0 * z_A * tilt,
            "W5": 4.0 * b * at_web_end,
            "W6": 4.0 * h * np.arctan(z_A / y_B),
            "W7": 4.0 * np.sqrt(h**2 + (b - z_A) ** 2) * at_diagonal,
            "W8": 4.0 * rolled,
            "W8b": self.rolling_weight * (8.0 / 3.0) * rolled,
        }

    def energy(self, rotation: ArrayLike) -> NDArray[Any]:
        """Plastic work of the mechanism from flat walls [J]."""
        line_moment = self.flow_stress * self.thickness**2 / 4.0
        return np.asarray(line_moment * sum(self.energy_terms(rotation).values()))

    def energy_rates(self, rotation: ArrayLike) -> dict[str, Floats]:
        """Derivatives of `energy_terms` [m] by the rotation [rad], which must not be zero."""
        a, b, h = self.width, self.depth, self.half_length
        rotation = np.asarray(rotation, np.float64)
        half = rotation / 2.0
        s, c = np.sin(half), np.cos(half)
        # the corners, and the tilt by its sine and cosine times h
        reach = b * s
        x = h - reach
        drop = np.sqrt(reach * (h + x))
        tilt, tilt_rate = np.arctan2(drop, x), (b / 2.0) * c / drop
        drop_rate = x * tilt_rate
        y, y_rate = b * c - drop, reach / -2.0 - drop_rate
        z, z_rate = drop * c - s * x, c * (h / 2.0 - x + drop_rate) - s * drop / 2.0
        out, out_rate = c * h - s * y, -(s * h + c * y) / 2.0 - s * y_rate
        at_web_end_rate = (z_rate * out - z * out_rate) / (out**2 + z**2)
        # the lower plate's y and z are the legs of a triangle whose third side is b - z
        side = b - z
        length = np.sqrt(h**2 + side**2)
        length_rate = -side * z_rate / length
        sine, cosine = c * z * length, c * h * y - s * side**2
        sine_rate = (c * z_rate - s * z / 2.0) * length + c * z * length_rate
        cosine_rate = h * (c * y_rate - s * y / 2.0) - side * (c * side / 2.0 - 2.0 * s * z_rate)
        at_diagonal_rate = (sine_rate * cosine - sine * cosine_rate) / (sine**2 + cosine**2)
        radius = self.rolling_radius(rotation)
        rolled_rate = (z_rate * h + z * (h * h / 70.0) / radius) / radius
        return {
            "W1": 2.0 * a * (tilt_rate - 0.5),
            "W2": 2.0 * a * tilt_rate,
            "W3": np.full_like(rotation, a),
            "W4": 4.0 * (z_rate * tilt + z * tilt_rate),
            "W5": 4.0 * b * at_web_end_rate,
            "W6": 4.0 * h * (z_rate * y - z * y_rate) / side**2,
            "W7": 4.0 * (length_rate * np.arctan2(sine, cosine) + length * at_diagonal_rate),
            "W8": 4.0 * rolled_rate,
            "W8b": self.rolling_weight * (8.0 / 3.0) * rolled_rate,
        }

    def moment(self, rotation: ArrayLike) -> Floats:
        """Moment dW/dtheta [N m]; grows without bound as the rotation [rad] goes to zero."""
        rotation = np.maximum(np.asarray(rotation, np.float64), SMALLEST_ROTATION)
        line_moment = self.flow_stress * self.thickness**2 / 4.0
        return np.asarray(line_moment * sum(self.energy_rates(rotation).values()), np.float64)

    def slope(self, rotation: ArrayLike) -> Floats:
        """dM/dtheta [N m/rad]."""
        rotation = np.maximum(np.asarray(rotation, np.float64), SMALLEST_ROTATION)
        step = DIFFERENCE_STEP * rotation
        return np.asarray(
            (self.moment(rotation + step) - self.moment(rotation - step)) / (2.0 * step), np.float64
        )


def _web_angles(
    b: float, h: float, rotation: NDArray[Any], corners: dict[str, NDArray[Any]]
) -> tuple[NDArray[Any], NDArray[Any]]:
    """Turns [rad] of the web plates at the rigid web (line KE) and at the diagonal (line AK).

    Corners in the middle plane of the fold, x along the beam, y up, z out of the web: K = (h, 0, 0),
    E = (h - b s, b c, 0), A = (0, y_B, z_A).  Over b, the plate K E A has the normal (c z, s z, c h - s y);
    the lower plate, which holds the bottom corner and A, has (0, -z, y), and y^2 + z^2 = (b - z)^2.

    Angles by the tangents of their halves: an arc cosine loses half the digits at small rotations, and the
    diagonal of a square tube turns past a right angle just before its flange closes.
    """
    y, z = corners["y_B"], corners["z_A"]
    s, c = np.sin(rotation / 2.0), np.cos(rotation / 2.0)
    out = c * h - s * y
    at_web_end = 2.0 * np.arctan(z / (out + np.sqrt(out**2 + z**2)))
    # sine and cosine of the turn, times the lengths of both normals
    sine, cosine = c * z * np.sqrt(h**2 + (b - z) ** 2), c * h * y - s * (b - z) ** 2
    at_diagonal = 2.0 * np.arctan(sine / (cosine + np.sqrt(sine**2 + cosine**2)))
    return at_web_end, at_diagonal
