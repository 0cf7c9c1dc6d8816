"""Mitred corner of two round tubes, bent in its plane: an estimate, with constants fitted to shells.

At the mitre the stress sigma along the wall turns by the angle alpha, and pushes the ring of the section
with 2 sigma t s per length in the corner's plane, s = sin(alpha/2).  The ring of mean radius R flattens: four
hinges of m_p = sigma_y t^2/4 divide it, the quarters turn by psi, and the wall at an angle phi from the top
moves by psi R (1 - sin phi).  Rings over a length l, proportional to R, take part.  Both works are equal at

    4 int_0^(pi/2) 2 sigma t s (1 - sin phi) R^2 dphi = 8 m_p l
    =>  int_0^(pi/2) sigma/sigma_y (1 - sin phi) dphi = x,    x = l t/(4 R^2 s)

Under this limit the moment is largest if the wall yields within an angle beta of the neutral axis alone: then
beta - sin beta = x, M/M_p = 1 - cos beta, for small x (6 x)^(2/3)/2.  The mitre is longer than the section by
1/cos(alpha/2), and p = 3 rounds the transition to the plastic moment M_p = M_0 of small angles:

    y = (6 x)^(2/3)/2,    x = 2 k t/(R sin(alpha)),    M_0 = M_p y/(1 + y^p)^(1/p)
    closing   M = (M_0^-p + (q M_F)^-p)^(-1/p)
    opening   M = (M_o^-p + ((1 + d s) M_F)^-p)^(-1/p),    M_o = M_p - (M_p - M_0) exp(-theta/(u s))

with the moment M_F(theta) of the straight member's mechanism before it is capped.  An opened corner stretches
its rings, so that the wall comes into line.  Elastic stiffness of the corner's own: K = r E t^2 R/(s^2 c^3),
c = cos(alpha/2).  Limits: alpha -> 0 (where q -> 1) or a thick wall gives the straight member, rounded.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from crumple.hinge.bending.circular import CircularLaw
from crumple.hinge.corner.in_plane import ROUNDING, Closing, InPlaneLaw, rounded, slope_of
from crumple.hinge.law import Source, Trust, Validity
from crumple.hinge.tube_library.hardening import HardeningEffect, at_yield
from crumple.material import Material
from crumple.numeric.arrays import Floats
from crumple.section import CircularTube

SOURCE = Source(
    "mitred corner of round tubes: flattening of the rings at the mitre, softening of the straight tube",
    Trust.FITTED,
    "derived here, with constants fitted to corners solved by shells; a law from shells "
    "(crumple characterise) replaces it",
)
RING = 0.63
"""k of the moment at the start [-]: rings over a length of 2.5 radii."""
CLOSING, OPENING = 0.68, 1.85
"""q and d of the fold of both senses [-]."""
WHOLE = math.radians(15.0)
"""Angle from which a closed corner has the share q [rad]; 1 in line.  None below 25 deg was solved."""
STRETCH = 0.15
"""u, rotation over which an opened corner becomes as strong as its members, over s [rad]."""
STIFFNESS = 0.48
"""r of the elastic stiffness [-]."""
SLENDER = (14.0, 45.0)
"""Diameter over thickness of the corners that were solved by shells, 15.6 to 38.9, with some room [-]."""
REACH = math.radians(30.0)
"""Rotation up to which the corners were solved by shells."""
UNCERTAINTY = 0.20
"""Half-width of the band [-]; see the table in the theory page."""


@dataclass(frozen=True)
class RoundCornerLaw(InPlaneLaw):
    """Corner of two round tubes that meet in a mitre, bent in its plane: an estimate fitted to shells.

    Attributes
    ----------
    start, plastic, slope, tube, closing, elastic_stiffness, validity
        See `InPlaneLaw`.
    share
        Of the fold of a closed corner in that of the straight member [-].

    References
    ----------
    docs/theory/mitred_corner.md.  Verified in tests/verification/hinge/test_mitred_corners.py.
    """

    source: ClassVar[Source] = SOURCE

    tube: CircularLaw
    share: float

    @classmethod
    def of(
        cls, section: CircularTube, material: Material, *, angle: float, closing: Closing
    ) -> RoundCornerLaw:
        """Law of a corner; as `MitredCornerLaw.of`."""
        s = slope_of(angle)
        wall, radius = section.thickness, (section.diameter - section.thickness) / 2.0
        tube = CircularLaw.of(section, at_yield(material), after_jamming="hold")
        resistance = 2.0 * RING * wall / (radius * math.sin(angle))
        thin = (
            material.yield_stress * section.plastic_section_modulus("y") * (6.0 * resistance) ** (2 / 3) / 2
        )
        return cls(
            thin * (1.0 + (thin / tube.fold.peak) ** ROUNDING) ** (-1.0 / ROUNDING),
            tube.fold.peak,
            s,
            tube,
            closing,
            STIFFNESS * material.youngs_modulus * wall**2 * radius / (s**2 * (1.0 - s**2) ** 1.5),
            Validity(
                REACH,
                "corners of other tubes were solved by shells that far",
                *slender_trust(section, UNCERTAINTY),
            ),
            1.0 - (1.0 - CLOSING) * min(1.0, angle / WHOLE),
            effect=HardeningEffect.of(section, material),
        )

    def kinks(self, sense: int = 1) -> tuple[float, ...]:
        """Rotations where the slope jumps [rad]: where the fold jams, and those of the hardening."""
        return tuple(sorted({self.tube.jamming_angle, *self.effect.rotation[1:]}))

    def hardening(self, rotation: ArrayLike, sense: int = 1) -> Floats:
        """Factor of hardening on the capacity at a rotation [rad] [-]."""
        return self.effect.at(rotation)

    def at_yield(self, rotation: ArrayLike, sense: int = 1) -> Floats:
        """Capacity [N m] at a rotation [rad] of a metal that stays at its yield stress."""
        upto = np.minimum(np.asarray(rotation, np.float64), self.tube.jamming_angle)
        fold = self.tube.fold.mechanism.moment(upto)
        if self.closes(sense):
            return rounded(self.start, self.share * fold)
        opened = self.start - (self.plastic - self.start) * np.expm1(-upto / (STRETCH * self.slope))
        return rounded(opened, (1.0 + OPENING * self.slope) * fold)


def slender_trust(section: CircularTube, band: float) -> tuple[tuple[str, ...], float | None]:
    """Warnings on walls of other proportions than those that were solved by shells, and the band."""
    slender, (least, most) = section.diameter / section.thickness, SLENDER
    if least <= slender <= most:
        return (), band
    return (f"diameter over thickness is {slender:.3g}, corners of {least:g} to {most:g} were solved",), None
