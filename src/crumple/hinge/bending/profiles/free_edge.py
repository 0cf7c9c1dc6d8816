"""Folding of walls whose free edge is compressed: a channel bent with its open side in compression.

Unknown: the work of a wall of depth b that stands on the stretched face and folds sideways.  The two rigid
halves turn by rho = theta/2 about the root line O; the free edge buckles between the points P, h away on
either side; A is the edge's middle.  With s = sin rho, c = cos rho and O the origin, x along the beam, y up,
z sideways:

    P = (h c - b s, h s + b c, 0)      |OP| = L = sqrt(h^2 + b^2)
    A = (0, y_A, z_A),  |OA| = b and |PA| = h  give  y_A = b^2/y_P,  z_A = sqrt(b^2 - y_A^2)
    fold along OA        w_c = 2 atan(z_A y_P/(b x_P))
    folds along OP       w_i = atan(z_A L/(y_A x_P))

Every length is kept, so all work is in folds:  W = m_p (n (b w_c + 2 L w_i) + w_t theta),  n walls, w_t the
stretched face, one line.  A lip or flange of width l at the edge bends in its own plane, at A by 2 beta and
at both P by beta, sin beta = z_A/h:  n s_0 t l^2 beta (its twist is left out).
h = b sqrt(2/3) makes W least for small rotations, where W ~ sqrt(b h theta) (4 b/h + 2 h/b).
Limits: theta -> 0: M ~ theta^(-1/2), to be capped; the edge closes on itself at x_P = t/2.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from crumple.hinge.bending.kecman_mechanism import SMALLEST_ROTATION
from crumple.numeric.arrays import Floats

# Far below the rounding of any rotation, so that a complex step has no truncation error.
COMPLEX_STEP = 1e-30
WALLS = 2


@dataclass(frozen=True)
class FreeEdgeMechanism:
    """Folded zone of two walls with free edges in compression.

    Attributes
    ----------
    depth
        b: outer depth of the walls [m].
    thickness
        [m]
    flow_stress
        [Pa]
    stretched_face
        w_t [m].
    lip
        Width of a sheet along each free edge, across the wall [m].
    weight
        Factor on the work [-].

    References
    ----------
    Derived here.  docs/theory/folded_profile.md.
    Verified in tests/verification/profiles/test_folded_profiles.py.
    """

    depth: float
    thickness: float
    flow_stress: float
    stretched_face: float
    lip: float = 0.0
    weight: float = 1.0

    @property
    def half_length(self) -> float:
        """Half the length of the folded zone at the free edge, b sqrt(2/3) [m]."""
        return self.depth * math.sqrt(2.0 / 3.0)

    @property
    def kinks(self) -> tuple[float, ...]:
        """None: its lines turn smoothly."""
        return ()

    @property
    def jamming_angle(self) -> float:
        """Rotation at which the halves of the edge touch, x_P = t/2 [rad]."""
        b, h = self.depth, self.half_length
        return 2.0 * (math.acos(self.thickness / 2.0 / math.hypot(b, h)) - math.atan2(b, h))

    def corners(self, rotation: ArrayLike) -> dict[str, NDArray[Any]]:
        """Coordinates x_P, y_P, y_A, z_A [m] at a rotation [rad]."""
        b, h = self.depth, self.half_length
        half = np.asarray(rotation) / 2.0
        s, c = np.sin(half), np.cos(half)
        x_P, y_P = h * c - b * s, h * s + b * c
        # y_P - b without the cancellation of 1 - cos
        rise = h * s - 2.0 * b * np.sin(half / 2.0) ** 2
        y_A = b**2 / y_P
        return {"x_P": x_P, "y_P": y_P, "y_A": y_A, "z_A": b / y_P * np.sqrt(rise * (y_P + b))}

    def energy(self, rotation: ArrayLike) -> NDArray[Any]:
        """Plastic work from flat walls [J]."""
        b, h, t = self.depth, self.half_length, self.thickness
        line_moment = self.flow_stress * t**2 / 4.0
        at = self.corners(rotation)
        length = math.hypot(b, h)
        middle = 2.0 * np.arctan(at["z_A"] * at["y_P"] / (b * at["x_P"]))
        inclined = np.arctan(at["z_A"] * length / (at["y_A"] * at["x_P"]))
        folds = WALLS * (b * middle + 2.0 * length * inclined) + self.stretched_face * np.asarray(rotation)
        edge = WALLS * self.flow_stress * t * self.lip**2 * np.arcsin(at["z_A"] / h)
        return np.asarray(self.weight * (line_moment * folds + edge))

    def moment(self, rotation: ArrayLike) -> Floats:
        """Moment dW/dtheta [N m]; grows without bound as the rotation [rad] goes to zero."""
        rotation = np.maximum(np.asarray(rotation, np.float64), SMALLEST_ROTATION)
        return np.asarray(self.energy(rotation + 1j * COMPLEX_STEP).imag / COMPLEX_STEP, np.float64)
