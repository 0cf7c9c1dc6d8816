"""Mitred corner of two rectangular or round tubes out of its plane: an estimate, fitted to shells.

By mirror symmetry about the plane of the mitre the principal directions of a corner are its bisector and the
tangent across it. With the angle alpha between the members, s = sin(alpha/2) and c = cos(alpha/2), a moment M
along the bisector bends each member by c M and twists it by s M, one along the tangent by s M and c M. The
members carry this up to a quadratic interaction of their torque T and bending moment B. At the mitre a torque
about the bisector cannot be carried by the flanges, whose shear there is zero by symmetry.  So half of it
distorts the section: frames of the walls bend (sigma_y t^2 a length and angle of distortion), and over the
length that this takes the walls bend in their planes (sigma_y t a^2/4 each). The length l = a sqrt(a/t) that
makes the work smallest gives a torque of 2 sigma_y (a t)^(3/2), with the mean a = sqrt(b h) of the mid-lines;
shells say k (20 t/a)^e in place of 2, and less at first:

    bisector   1/M^2 = (s/D)^2 + (s/T)^2 + (c/B)^2,   T = 2 b h t sigma_y/sqrt(3)
               D = k (20 t/a)^e sigma_y (a t)^(3/2) (1 - (1 - g) exp(-theta/theta_2))
    tangent    1/M_0^2 = (c/T)^2 + (s/B_0)^2
               M = M_0 (f + (1 - f) min(1, theta_c/theta)),    theta_c = q_t (t/a)^2 (1 + w (s_f/sigma_y - 1))

B is the straight tube's moment (Kecman), B_0 that at the start. About the tangent walls fold from the
rotation theta_c on, as if the work of a fold were spent; metals that harden, with the flow stress s_f, spread
the twist over a longer piece and fold later. Elastic stiffness of the corner's own about the bisector:
K = q E t^(5/2) a^(1/2) cot(alpha/2)^p. Limits: alpha -> 0 gives the member in bending and in torsion; thin
walls give s M = D about the bisector.

Round tubes of the mean radius R distort like a square tube of the same mid-line, a = pi R/2 (quarters of the
ring in place of walls), with the same w. Their torque is T = 2 pi R^2 t sigma_y/sqrt(3), f = 0, B is the law
of their free fold, and

    D = k sigma_y (a t)^(3/2) (1 - (1 - g (t/R)^(1/3)) exp(-theta/theta_2)),    K = q E t^2 R/(s^2 c)
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from crumple.errors import InputError, Problem
from crumple.hinge.bending.estimate import automatic_type
from crumple.hinge.bending.kecman import KecmanLaw
from crumple.hinge.corner.in_plane import LARGEST, SMALLEST
from crumple.hinge.corner.round_corner import slender_trust
from crumple.hinge.law import HingeLaw, SofteningVariable, Source, Trust, Validity
from crumple.hinge.options import choice
from crumple.hinge.rate import HingeRate, rate_factor
from crumple.hinge.registry import build_law
from crumple.hinge.stop import Stop
from crumple.hinge.torsion.plastic import PlasticTorsion
from crumple.hinge.tube_library.hardening import at_yield, hardens
from crumple.hinge.tube_library.tube import hardening_ratio
from crumple.material import Material
from crumple.numeric.arrays import Floats
from crumple.registry.quantity import PositiveAngle
from crumple.section import Axis, CircularTube, RectangularTube, Section

SOURCE = Source(
    "corner out of its plane: torsion and bending of its members, distortion of the section at the mitre",
    Trust.FITTED,
    "derived here, with constants fitted to corners solved by shells; a law from shells "
    "(crumple characterise --load out-of-plane) replaces it",
)
DISTORTION, ROUND_DISTORTION = 1.54, 1.75
"""k of the torque that distorts the section at the mitre, of rectangular and of round tubes [-]."""
SLENDER = 0.22
"""e, how the torque of rectangular tubes depends on their slenderness [-]."""
USUAL = 20.0
"""Slenderness a/t at which e has no effect [-]."""
FOLDS, ROUND_FOLDS = 62.0, 85.0
"""q_t of the rotation from which walls fold about the tangent, of rectangular and of round tubes [rad]."""
REST = 0.12
"""f, share of the moment about the tangent that folded walls of rectangular tubes keep [-]."""
ANGLE = 1.4
"""p of the cotangent in the stiffness of rectangular tubes [-]."""
LATER = 1.5
"""w, how much later walls that harden fold [-]."""
STIFFNESS, ROUND_STIFFNESS = 2.4, 0.51
"""q of the elastic stiffness of rectangular and of round tubes [-]."""
HARDENING = 4.0
"""Length of the piece that hardens as a corner about its tangent over the largest side of the section [-]."""
EARLY, ROUND_EARLY = 0.55, 1.30
"""g, how tubes begin to distort about the bisector [-]."""
SETTLED, ROUND_SETTLED = 0.011, 0.039
"""theta_2, rotation over which they begin to [rad]."""
REACH = math.radians(30.0)
"""Rotation up to which the corners were solved by shells."""
UNCERTAINTY, ROUND_UNCERTAINTY = 0.25, 0.20
"""Half-width of the band of rectangular and of round tubes [-]; see the tables in the theory page."""


class About(Enum):
    """Direction of the moment in the corner's plane."""

    BISECTOR = "bisector"
    TANGENT = "tangent"


@dataclass(frozen=True)
class MitredCornerAcrossLaw:
    """Corner of two rectangular or round tubes out of its plane, about a principal direction: an estimate.

    Attributes
    ----------
    about
        Direction of the moment.
    slope
        s, sine of half the angle between the members [-].
    torque
        Plastic torque of the members [N m].
    folding, rest
        About the tangent the rotation from which walls fold [rad], and the share of the moment that
        stays [-].
    distortion, early, settled
        D, torque that distorts the section at the mitre [N m], the share of it at the start [-], and the
        rotation over which it grows [rad].
    tube
        Law of the straight member in bending about its axis in the corner's plane.
    elastic_stiffness
        Of the corner's own walls [N m/rad]; None about the tangent, where they are stiff.
    twisted
        Torque of a piece of the member over its twist, which hardens as the corner does.

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

    about: About
    slope: float
    torque: float
    folding: float
    rest: float
    distortion: float
    early: float
    settled: float
    tube: HingeLaw
    elastic_stiffness: float | None
    validity: Validity
    twisted: PlasticTorsion

    @classmethod
    def of(
        cls,
        section: Section,
        material: Material,
        axis: Axis = "y",
        *,
        angle: PositiveAngle,
        about: About | str = About.BISECTOR,
    ) -> MitredCornerAcrossLaw:
        """Law of a corner.

        Parameters
        ----------
        section
            Rectangular or circular tube, of both members.
        material
            Yield stress and elastic modulus.
        axis
            Axis of the section in the corner's plane, in which the bisector lies at a small angle.
        angle
            Angle between the members' axes, 0 in line [rad].
        about
            Direction of the moment: the corner's bisector, or the tangent across it in its plane.

        Raises
        ------
        InputError
            If the section is no such tube, or the angle is outside 5 to 100 degrees.
        """
        if not isinstance(section, RectangularTube | CircularTube):
            what, allowed = "no estimate of a corner out of its plane", "a rectangular or circular tube"
            todo = "use the law of the member, or one from shells"
            raise InputError(Problem(what, section.title, allowed, todo, "section"))
        if not SMALLEST <= angle <= LARGEST:
            what, came = "no estimate of a corner of this angle out of its plane", math.degrees(angle)
            todo = "use the law of the member, or one from shells"
            raise InputError(Problem(what, f"{came:.4g} deg", "5 to 100 deg", todo, "angle"))
        direction = choice("about", about, About)
        bends = direction is About.BISECTOR
        s, wall, stress = math.sin(angle / 2.0), section.thickness, material.yield_stress
        yielding = at_yield(material)
        if isinstance(section, CircularTube):
            radius = (section.diameter - wall) / 2.0
            enclosed, mean, factor = math.pi * radius**2, math.pi * radius / 2.0, ROUND_DISTORTION
            folds, rest = ROUND_FOLDS, 0.0
            early, settled = min(1.0, ROUND_EARLY * (wall / radius) ** (1.0 / 3.0)), ROUND_SETTLED
            tube = build_law(automatic_type(section, yielding, axis, "free"), section, yielding, axis)
            stiffness = ROUND_STIFFNESS * wall**2 * radius / (s**2 * math.sqrt(1.0 - s**2))
            warnings, band = slender_trust(section, ROUND_UNCERTAINTY)
        else:
            width, depth = section.width - wall, section.depth - wall
            enclosed, mean = width * depth, math.sqrt(width * depth)
            factor = DISTORTION * (USUAL * wall / mean) ** SLENDER
            folds, rest = FOLDS, REST
            early, settled = EARLY, SETTLED
            tube = KecmanLaw.of(section, yielding, axis, after_jamming="hold")
            stiffness = STIFFNESS * wall**2.5 * math.sqrt(mean) / math.tan(angle / 2.0) ** ANGLE
            warnings, band = (), UNCERTAINTY
        return cls(
            direction,
            s,
            2.0 * enclosed * wall * stress / math.sqrt(3.0),
            folds * (wall / mean) ** 2 * _later(material),
            rest,
            factor * stress * (mean * wall) ** 1.5,
            early,
            settled,
            tube,
            material.youngs_modulus * stiffness if bends else None,
            Validity(REACH, "corners of other proportions were solved by shells that far", warnings, band),
            _twisted(section, material, distorted_length(section) if bends else None),
        )

    @property
    def title(self) -> str:
        """One line for people."""
        angle, start = math.degrees(2.0 * math.asin(self.slope)), float(self.moment_capacity(0.0))
        where = f"mitred corner of {angle:.4g} deg out of its plane about its {self.about.value}"
        return f"{where}, {start / 1e3:.4g} kN m at the start"

    @property
    def rate(self) -> HingeRate | None:
        """That of the straight member."""
        return self.tube.rate

    def kinks(self, sense: int = 1) -> tuple[float, ...]:
        """Rotations where the slope jumps [rad]."""
        own = self.tube.kinks(sense) if self.about is About.BISECTOR else (self.folding,)
        return tuple(sorted({*own, *self.twisted.kinks(sense)}))

    def moment_capacity(self, rotation: ArrayLike, sense: int = 1) -> Floats:
        """Capacity [N m] at a rotation [rad]; see `HingeLaw`."""
        turned, s = np.asarray(rotation, float), self.slope
        along = math.sqrt(1.0 - s**2)
        hardened = self.twisted.moment_capacity(turned) / self.twisted.initial_torque
        if self.about is About.TANGENT:
            whole = ((along / self.torque) ** 2 + (s / float(self.tube.moment_capacity(0.0))) ** 2) ** -0.5
            left = np.minimum(1.0, self.folding / np.maximum(turned, 1e-300))
            return np.asarray(whole * (self.rest + (1.0 - self.rest) * left) * hardened, np.float64)
        bending = self.tube.moment_capacity(turned, 1)
        distortion = self.distortion * (1.0 - (1.0 - self.early) * np.exp(-turned / self.settled))
        uses = (s / distortion) ** 2 + (s / self.torque) ** 2 + (along / bending) ** 2
        return np.asarray(uses**-0.5 * hardened, np.float64)

    def rate_factor(self, rotation_rate: ArrayLike) -> Floats:
        """Factor on the capacity at a rotation rate [rad/s]."""
        return rate_factor(self.rate, rotation_rate)


def distorted_length(section: RectangularTube | CircularTube) -> float:
    """Length over which a corner that folds about its bisector distorts each of its members, l [m].

    For rectangular tubes that of the mechanism; round ones harden as over the same length.
    """
    wall = section.thickness
    if isinstance(section, CircularTube):
        mean = math.pi * (section.diameter - wall) / 4.0
    else:
        mean = math.sqrt((section.width - wall) * (section.depth - wall))
    return mean * math.sqrt(mean / wall)


def _later(material: Material) -> float:
    """How much later walls fold because they harden [-]."""
    return 1.0 + LATER * (hardening_ratio(material) - 1.0) if hardens(material) else 1.0


def _twisted(
    section: RectangularTube | CircularTube, material: Material, length: float | None
) -> PlasticTorsion:
    """Piece of the member that is twisted as the corner hardens; None: of `HARDENING` sides."""
    side = section.diameter if isinstance(section, CircularTube) else max(section.width, section.depth)
    # a torque that is constant needs no walls
    torque = None if hardens(material) else 1.0
    return PlasticTorsion.of(section, material, length or HARDENING * side, torque=torque)
