"""Mitred corner of two round tubes, bent in its plane: an estimate, with constants fitted to shells.

At the mitre the stress sigma along the wall turns by the angle alpha, and pushes the ring of the section
with 2 sigma t s per length in the corner's plane, s = sin(alpha/2).  The ring of mean radius R flattens: four
hinges of m_p = sigma_y t^2/4 divide it, the quarters turn by psi, and the wall at an angle phi from the top
moves by psi R (1 - sin phi).  Rings over a length l take part.  Both works are equal at

    4 int_0^(pi/2) 2 sigma t s (1 - sin phi) R^2 dphi = 8 m_p l
    =>  int_0^(pi/2) sigma/sigma_y (1 - sin phi) dphi = x,    x = l t/(4 R^2 s)

Under this limit the moment is largest if the wall yields within an angle beta of the neutral axis alone:
then beta - sin beta = x, M/M_p = 1 - cos beta, for small x (6 x)^(2/3)/2.  The ovality of a thin tube spreads
over l = 4 k R sqrt(R/t), and the mitre is longer than the section by 1/cos(alpha/2):

    y = (6 x)^(2/3)/2,    x = 2 k sqrt(t/R)/sin(alpha),    M(y) = M_p y/(1 + y^p)^(1/p)

where p = 3 rounds the transition to the plastic moment M_p of small angles.  A closed corner flattens its
rings as it turns, by psi = theta/(2 s) if the wall at the top is not strained.  The limit is then
(beta - sin beta) cos psi + (1 - cos beta) sin psi = x, and y is divided by up to 1 + 3 psi/sqrt(2 y):

    closing   y_c = y/(1 + (a theta/s + c sigma_y R/(E t))/sqrt(y))
              M = (M(y_c)^-p + M_F^-p)^(-1/p) (1 - r exp(-theta/theta_r))
    opening   M = (M_o^-n + (f M_F)^-n)^(-1/n),    M_o = M_p - (M_p - M(y)) exp(-theta/(u s))
              f = (g + d s) R/(12 t)

with the moment M_F(theta) of the straight member's mechanism before it is capped.  Rings flatten elastically
too, by a multiple of sigma_y R/(E t), and yield little by little, within theta_r.  An opened corner stretches
its rings, so that the wall comes into line; it has a k of its own, and folds beside the mitre at last, n = 6.
In line f = 1 and r = 0.  Hardening acts as in rectangular tubes.  Elastic stiffness of the corner's own:
K = r_K E t^2 R/(s^2 c^3), c = cos(alpha/2).  Limits: alpha -> 0 gives the straight member, rounded.
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
CLOSED, OPENED = 0.385, 0.245
"""k of the moment at the start of both senses [-]: rings over 1.5 and 1.0 R sqrt(R/t)."""
FLATTENS = 1.23
"""a of the flattening by the rotation [-]; 1.06 if the wall at the top is not strained."""
ELASTIC = 16.3
"""c of the flattening before the rings yield [-]."""
SPREAD, SPREADS = 0.27, math.radians(1.0)
"""r, share of the moment of a closed corner that comes as yielding spreads [-]; theta_r of that [rad]."""
FOLD, OPENING, SHARP = 0.75, 1.09, 6.0
"""g and d of the fold of an opened corner [-], and n of the transition to it [-]."""
WHOLE = math.radians(15.0)
"""Angle from which corners have the shares f and r [rad]; 1 and 0 in line.  None below 25 deg was solved."""
STRETCH = 0.24
"""u, rotation over which an opened corner becomes as strong as its members, over s [rad]."""
STIFFNESS = 0.48
"""r_K of the elastic stiffness [-]."""
SLENDER = (14.0, 45.0)
"""Diameter over thickness of the corners that were solved by shells, 15 to 42, with some room [-]."""
STRAIN = 0.045
"""Largest yield strain times mean radius over thickness of the corners that were solved, 0.0405 [-]."""
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
    ring
        y of the closed corner as it begins to turn [-].
    elastic
        What elastic flattening adds to the rotation's, c sigma_y R/(E t) [-].
    opened
        Moment at which it begins to turn when it is opened [N m].
    share
        f, of the fold of an opened corner in that of the straight member [-].
    spread
        r, share of the moment of a closed corner that comes as yielding spreads [-].

    References
    ----------
    docs/theory/mitred_corner.md.  Verified in tests/verification/hinge/test_mitred_corners.py.
    """

    source: ClassVar[Source] = SOURCE

    tube: CircularLaw
    ring: float
    elastic: float
    opened: float
    share: float
    spread: float

    @classmethod
    def of(
        cls, section: CircularTube, material: Material, *, angle: float, closing: Closing
    ) -> RoundCornerLaw:
        """Law of a corner; as `MitredCornerLaw.of`."""
        s = slope_of(angle)
        wall, radius = section.thickness, (section.diameter - section.thickness) / 2.0
        tube = CircularLaw.of(section, at_yield(material), after_jamming="hold")
        strain = material.yield_stress * radius / (material.youngs_modulus * wall)
        closed, opened = (
            (12.0 * k * math.sqrt(wall / radius) / math.sin(angle)) ** (2 / 3) / 2 for k in (CLOSED, OPENED)
        )
        elastic = ELASTIC * strain
        bent = min(1.0, angle / WHOLE)
        fold = (FOLD + OPENING * s) * radius / (12.0 * wall)
        plastic = tube.fold.peak
        return cls(
            (1.0 - SPREAD * bent) * float(_moment(plastic, _flattened(closed, elastic))),
            plastic,
            s,
            tube,
            closing,
            STIFFNESS * material.youngs_modulus * wall**2 * radius / (s**2 * (1.0 - s**2) ** 1.5),
            Validity(
                REACH, "corners of other tubes were solved by shells that far", *_trust(section, strain)
            ),
            closed,
            elastic,
            float(_moment(plastic, opened)),
            1.0 + (fold - 1.0) * bent,
            SPREAD * bent,
            effect=HardeningEffect.of(section, material),
        )

    def kinks(self, sense: int = 1) -> tuple[float, ...]:
        """Rotations where the slope jumps [rad]: where the fold jams, and those of the hardening."""
        return tuple(sorted({self.tube.jamming_angle, *self.effect.rotation[1:]}))

    def at_yield(self, rotation: ArrayLike, sense: int = 1) -> Floats:
        """Capacity [N m] at a rotation [rad] of a metal that stays at its yield stress."""
        upto = np.minimum(np.asarray(rotation, np.float64), self.tube.jamming_angle)
        fold = self.tube.fold.mechanism.moment(upto)
        if self.closes(sense):
            flat = _flattened(self.ring, self.elastic + FLATTENS * upto / self.slope)
            spread = 1.0 - self.spread * np.exp(-upto / SPREADS)
            return rounded(_moment(self.plastic, flat), fold) * spread
        opened = self.opened - (self.plastic - self.opened) * np.expm1(-upto / (STRETCH * self.slope))
        return rounded(opened, self.share * fold, SHARP)


def _flattened(ring: float, flattening: Floats | float) -> Floats:
    """Share y of a ring that has flattened [-]."""
    return np.asarray(ring / (1.0 + flattening / math.sqrt(ring)), np.float64)


def _moment(plastic: float, ring: Floats | float) -> Floats:
    """Moment [N m] that rings carry, at most the plastic one."""
    return np.asarray(plastic * ring * (1.0 + ring**ROUNDING) ** (-1.0 / ROUNDING), np.float64)


def _trust(section: CircularTube, strain: float) -> tuple[tuple[str, ...], float | None]:
    """Warnings on tubes of other slenderness than those that were solved by shells, and the band."""
    warnings, band = slender_trust(section, UNCERTAINTY)
    if strain <= STRAIN:
        return warnings, band
    text = (
        f"yield strain times radius over thickness is {strain:.3g}, corners of up to {STRAIN:g} were solved"
    )
    return (*warnings, text), None


def slender_trust(section: CircularTube, band: float) -> tuple[tuple[str, ...], float | None]:
    """Warnings on walls of other proportions than those that were solved by shells, and the band."""
    slender, (least, most) = section.diameter / section.thickness, SLENDER
    if least <= slender <= most:
        return (), band
    return (f"diameter over thickness is {slender:.3g}, corners of {least:g} to {most:g} were solved",), None
