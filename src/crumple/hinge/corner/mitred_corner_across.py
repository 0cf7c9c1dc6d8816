"""Right-angled mitred corner of two rectangular tubes, loaded out of its plane: an estimate fitted to shells.

The moment lies along the axis of one member, twists this one and bends the other. At the mitre the side walls
pass forces on along the axes of the members, and so half of Bredt's torque; the other half needs shear in
the flanges, which the other member does not have, so the section is distorted there and its walls bend. With
the distances b and h of the mid-lines, the wall t and x = t/sqrt(b h),

    M(theta) = T_p x/(p + q x) exp(-theta/theta_c) <= M_p    T_p = 2 b h t sigma_y/sqrt(3) (Bredt)
    theta_c = theta_0 (1 + r x^2)    elastic stiffness of the corner's own: K = 1.58 E t^2 sqrt(b h)

p, q, theta_0, r were fitted to four corners solved by shells. Limits: thin walls carry nothing, x/p of T_p;
of thick ones the torque is nearly that of the straight member.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from crumple.errors import InputError, Problem
from crumple.hinge.bending.kecman import KecmanLaw
from crumple.hinge.corner.mitred_corner import REACH
from crumple.hinge.law import SofteningVariable, Source, Trust, Validity
from crumple.hinge.rate import HingeRate, rate_factor
from crumple.hinge.stop import Stop
from crumple.material import Material
from crumple.numeric.arrays import Floats
from crumple.section import Axis, RectangularTube, Section

SOURCE = Source(
    "corner out of its plane: part of Bredt's torque, by the distortion of the section at the mitre",
    Trust.FITTED,
    "derived here, with four constants fitted to four corners solved by shells; a law from shells "
    "(crumple characterise --load out-of-plane) replaces it",
)
THIN, THICK = 0.0356, 0.942
"""p and q of the share of Bredt's torque [-]."""
DECAY, DECAY_RISE = 0.797, 296.0
"""theta_0 [rad] and r [-]."""
STIFFNESS = 1.58
"""Factor of the elastic stiffness, K = 1.58 E t^2 sqrt(b h) [-]."""
UNCERTAINTY = 0.15
"""Half-width of the band [-]; see the table in the theory page."""


@dataclass(frozen=True)
class MitredCornerAcrossLaw:
    """Right-angled corner of two rectangular tubes out of its plane: an estimate fitted to shells.

    Attributes
    ----------
    start
        Moment at which it begins to fold [N m].
    decay
        Rotation in which the moment falls to 1/e of that [rad].
    elastic_stiffness
        Of the corner's own walls [N m/rad].
    rate
        That of the straight member.

    References
    ----------
    docs/theory/mitred_corner.md.  Verified in tests/verification/hinge/test_mitred_corners.py.
    """

    name: ClassVar[str] = "mitred_corner_across"
    source: ClassVar[Source] = SOURCE
    softening_variable: ClassVar[SofteningVariable] = SofteningVariable.PEAK
    stop: ClassVar[Stop | None] = None
    jamming_angle: ClassVar[float | None] = None
    symmetric: ClassVar[bool] = True

    start: float
    decay: float
    elastic_stiffness: float | None
    rate: HingeRate | None
    validity: Validity

    @classmethod
    def of(cls, section: Section, material: Material, axis: Axis = "y") -> MitredCornerAcrossLaw:
        """Law of a corner.

        Parameters
        ----------
        section
            Rectangular tube, of both members.
        material
            Yield stress and elastic modulus.
        axis
            Bending axis of the section in the corner's plane; its plastic moment is the largest.

        Raises
        ------
        InputError
            If the section is not a rectangular tube.
        """
        if not isinstance(section, RectangularTube):
            what, allowed = "no estimate of a corner out of its plane", "a rectangular tube"
            todo = "use the law of the member, or one from shells"
            raise InputError(Problem(what, section.title, allowed, todo, "section"))
        wall = section.thickness
        width, depth = section.width - wall, section.depth - wall
        mean = math.sqrt(width * depth)
        slenderness = wall / mean
        torque = 2.0 * width * depth * wall * material.yield_stress / math.sqrt(3.0)
        plastic = material.yield_stress * section.plastic_section_modulus(axis)
        return cls(
            min(torque * slenderness / (THIN + THICK * slenderness), plastic),
            DECAY * (1.0 + DECAY_RISE * slenderness**2),
            STIFFNESS * material.youngs_modulus * wall**2 * mean,
            KecmanLaw.of(section, material, axis, after_jamming="hold").rate,
            Validity(REACH, "corners of other proportions were solved by shells that far", (), UNCERTAINTY),
        )

    @property
    def title(self) -> str:
        """One line for people."""
        return f"right-angled mitred corner out of its plane, {self.start / 1e3:.4g} kN m at the start"

    def kinks(self, sense: int = 1) -> tuple[float, ...]:
        """It has none."""
        return ()

    def moment_capacity(self, rotation: ArrayLike, sense: int = 1) -> Floats:
        """Capacity [N m] at a rotation [rad]; see `HingeLaw`."""
        return np.asarray(self.start * np.exp(-np.asarray(rotation, float) / self.decay), np.float64)

    def rate_factor(self, rotation_rate: ArrayLike) -> Floats:
        """Factor on the capacity at a rotation rate [rad/s]."""
        return rate_factor(self.rate, rotation_rate)
