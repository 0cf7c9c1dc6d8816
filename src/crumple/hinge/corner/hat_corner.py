"""Mitred corner of two closed hats, bent in the plane of their webs: an estimate, fitted to shells.

As in rectangular tubes (`mitred_corner`) a sheet's force would have to turn at the mitre, which the bending
of its own wall resists. A sheet of width b and thickness t between two webs carries 1/sqrt(1 + x^2) of its
yield force, x = b s/(k t), s = sin(alpha/2). A lip of width f outside of its web is held at one edge: a
force q per area folds it at q f^2/2 = m_p, the sheet between webs at q b^2/16 = m_p, so that b = l f with l
= 2 sqrt(2) stands for it. With the forces C of the crown and P of plate and lips, at the distance e below
the foot of the webs, the force W of both webs per depth, and their depth D between mid-lines,

    M_0 = W D^2/4 (1 - g s^2)/(1 - s^2) + (C + P) D/2 + P e - (C - P)^2/(4 W)

which is the moment of a section that yields about the axis of no force. Of C and P the larger is at most
the smaller with the webs. The inner side of a corner is pressed if it is closed, the outer one if it is
opened:

    closing   M = (M_0^-p + ((1 - c s) M_F)^-p)^(-1/p)
    opening   M = (M_o^-n + ((1 + d s) M_F)^-n)^(-1/n),    M_o = M_p - (M_p - M_0) exp(-theta/(u s))

M_F is the mechanism of the tube with the faces of the profile. In the straight member it is none of a
pressed plate, because lips that lie in one plane keep the webs from bulging; at the mitre they bend out of
their planes and do not. Towards alpha = 0 the member's own mechanism takes its place. In a closed corner
all sheets sink into the section, where plate and lips lie on each other, and lips carry more (l = l_c); in
an opened one they part, its flanges stretch and the walls come into line. A positive rotation about y
presses the plate, so the sense that closes the corner says which side is inside. g, k and c are those of
tubes; l_c, p of either side, d, u, n and the stiffness are fitted. Limits: alpha -> 0 gives the straight
member, rounded where its fold begins; without lips, crown and plate alike, M_0 is that of the tube.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from crumple.errors import InputError, Problem
from crumple.hinge.bending.capped import CappedMechanism
from crumple.hinge.bending.profiles.folded_profile import FoldedProfileLaw, not_compared
from crumple.hinge.bending.profiles.profile_mechanism import ProfileMechanism
from crumple.hinge.corner.in_plane import TOUCHING, Closing, InPlaneLaw, jammed, jamming_of, rounded, slope_of
from crumple.hinge.law import Source, Trust, Validity
from crumple.hinge.tube_library.hardening import HardeningEffect, at_yield
from crumple.material import Material
from crumple.numeric.arrays import Floats
from crumple.section import Axis, ClosedHat, RectangularTube

SOURCE = Source(
    "mitred corner of closed hats: webs over the mitre, sheets and lips by bending of their walls",
    Trust.FITTED,
    "derived here, with constants fitted to corners solved by shells; a law from shells "
    "(crumple characterise) replaces it",
)
WEB, SHEET = 0.56, 2.44
"""g and k of the moment at the start [-], those of tubes."""
LIP, CLOSED_LIP = 2.0 * math.sqrt(2.0), 0.65
"""l and l_c, width of the sheet between webs that stands for a lip over the lip's [-]."""
CLOSING, OPENING = 0.45, 1.5
"""c and d of the folds of both senses [-]."""
CROWN, PLATE, OPENED = 2.0, 6.0, 4.0
"""p of a crown and of a plate inside, and n: transitions from the start to the fold [-]."""
CROWN_FOLD = 1.1
"""f of the fold of a crown inside [-]."""
STRETCH = 0.9
"""u, rotation over which an opened corner becomes as strong as its members, over s [rad]."""
WHOLE = math.radians(15.0)
"""Angle from which folds are those of corners [rad]; in line they are the member's.  None below 30 deg was
solved."""
STIFFNESS = 0.27
"""r of the elastic stiffness [-]."""
FLATTEST = math.radians(30.0) * (1.0 - 1e-9)
"""Smallest angle of the corners that were solved by shells."""
REACH = math.radians(40.0)
"""Rotation up to which the corners were solved by shells."""
UNCERTAINTY = 0.25
"""Half-width of the band [-]; see the table in the theory page."""


@dataclass(frozen=True)
class HatCornerLaw(InPlaneLaw):
    """Corner of two closed hats in a mitre, bent in the plane of their webs: an estimate from shells.

    Attributes
    ----------
    start, plastic, slope, tube, closing, elastic_stiffness, validity, jamming
        See `InPlaneLaw`.
    opened
        Moment at which it begins to turn when it is opened [N m].
    inner, outer
        Mechanism of the inner side, which a closed corner presses, and of the outer one.
    bent
        Share of these mechanisms in the folds; the rest is the member's [-].

    References
    ----------
    docs/theory/mitred_corner.md.  Verified in tests/verification/characterisation/test_hat_corners.py.
    """

    source: ClassVar[Source] = SOURCE

    tube: FoldedProfileLaw
    opened: float
    inner: ProfileMechanism
    outer: ProfileMechanism
    bent: float

    @classmethod
    def of(
        cls, section: ClosedHat, material: Material, axis: Axis, *, angle: float, closing: Closing
    ) -> HatCornerLaw:
        """Law of a corner; as `MitredCornerLaw.of`.

        Raises
        ------
        InputError
            If the axis is not that along crown and plate.
        """
        if axis != "y":
            what, todo = "there is no law of a corner of closed hats about this axis", "use the member's law"
            raise InputError(Problem(what, axis, "y, along crown and plate", todo, "axis"))
        s = slope_of(angle)
        metal = at_yield(material)
        member = FoldedProfileLaw.of(section, metal, after_jamming="hold")
        plate_inside = closing is Closing.POSITIVE
        peaks = member.positive.peak, member.negative.peak
        inside, outside = peaks if plate_inside else peaks[::-1]
        depth = section.depth - section.thickness
        bent = min(1.0, angle / WHOLE)
        return cls(
            min(start_of(section, metal, s, CLOSED_LIP), inside),
            max(peaks),
            s,
            member,
            closing,
            STIFFNESS * material.youngs_modulus * section.thickness * depth**2,
            _validity(section, material, angle),
            min(start_of(section, metal, s, LIP), outside),
            _mechanism(section, metal, plate_pressed=plate_inside),
            _mechanism(section, metal, plate_pressed=not plate_inside),
            bent,
            effect=_effect(section, material),
            jamming=bent * jamming_of(section.width - section.thickness, depth, section.thickness),
        )

    def kinks(self, sense: int = 1) -> tuple[float, ...]:
        """Rotations where the slope jumps [rad]: those of jamming, of hardening, and of the member."""
        own = () if self.bent == 1.0 else self._member(sense).mechanism.kinks
        end = self.inner.jamming_angle
        jams = {at * end for at in TOUCHING} if self.jamming and self.closes(sense) else set()
        return tuple(sorted({end, *jams, *self.effect.rotation[1:], *own}))

    def at_yield(self, rotation: ArrayLike, sense: int = 1) -> Floats:
        """Capacity [N m] at a rotation [rad] of a metal that stays at its yield stress."""
        rotation, end = np.asarray(rotation, np.float64), self.inner.jamming_angle
        upto = np.minimum(rotation, end)
        closes, member = self.closes(sense), self._member(sense)
        at_corner = (self.inner if closes else self.outer).moment(upto)
        share, power = (CROWN_FOLD, CROWN) if closes and sense < 0 else (1.0, PLATE)
        fold = self.bent * share * at_corner + (1.0 - self.bent) * member.mechanism.moment(upto)
        if closes:
            moment = rounded(self.start, (1.0 - CLOSING * self.slope) * fold, power)
            return np.asarray(np.minimum(moment * jammed(rotation, end, self.jamming), self.plastic))
        opened = self.opened - (member.peak - self.opened) * np.expm1(-upto / (STRETCH * self.slope))
        return rounded(opened, (1.0 + OPENING * self.slope) * fold, OPENED)

    def _member(self, sense: int) -> CappedMechanism:
        """Fold of the straight member."""
        return self.tube.positive if sense > 0 else self.tube.negative


def start_of(section: ClosedHat, material: Material, s: float, held: float) -> float:
    """Moment at the start [N m], with the width that stands for a lip over the lip's [-]."""
    hat, plate = section.hat_material or material, section.plate_material or material
    wall, under = section.thickness, section.plate_thickness or section.thickness
    between, lip = section.width - wall, section.flange + wall / 2.0

    def force(width: float, thickness: float, metal: Material, over: float = 1.0) -> float:
        """Force that a sheet carries at the mitre [N]."""
        across = over * width * s / (SHEET * thickness)
        return metal.yield_stress * width * thickness / math.hypot(1.0, across)

    crown = force(between, wall, hat)
    own = 2.0 * force(lip, wall, hat, held)
    other = 2.0 * force(lip, under, plate, held) + force(between, under, plate)
    depth, below = section.depth - wall, (wall + under) / 2.0
    webs = 2.0 * wall * hat.yield_stress * depth
    pressed = own + other
    below *= other / pressed
    # what the other side and the webs cannot balance carries no moment
    crown, pressed = min(crown, pressed + webs), min(pressed, crown + webs)
    web_moment = webs * depth / 4.0 * (1.0 - WEB * s**2) / (1.0 - s**2)
    offset = (crown - pressed) ** 2 * depth / (4.0 * webs)
    return web_moment + (crown + pressed) * depth / 2.0 + pressed * below - offset


def _mechanism(section: ClosedHat, material: Material, *, plate_pressed: bool) -> ProfileMechanism:
    """Mechanism of the tube with the faces of the profile, either side pressed."""
    hat, plate = section.hat_material or material, section.plate_material or material
    layer = (section.plate_thickness or section.thickness) / section.thickness
    lips = 2.0 * section.flange
    face = lips + (section.width + lips) * layer**2 * plate.flow_stress / hat.flow_stress
    pressed, stretched = (face, section.width) if plate_pressed else (section.width, face)
    return ProfileMechanism(
        section.width,
        section.depth,
        section.thickness,
        hat.flow_stress,
        compressed_face=pressed,
        stretched_face=stretched,
    )


def _validity(section: ClosedHat, material: Material, angle: float) -> Validity:
    """Range and band; none for other hats, and flatter corners, than those that were solved."""
    warnings = []
    if outside := not_compared(section, material):
        warnings.append(f"corners of other hats were solved by shells ({outside})")
    if angle < FLATTEST:
        warnings.append("corners of 30 to 90 deg were solved by shells")
    band = None if warnings else UNCERTAINTY
    basis = "corners of other hats were solved by shells that far"
    return Validity(REACH, basis, ("the spot welds do not fail in this law", *warnings), band)


def _effect(section: ClosedHat, material: Material) -> HardeningEffect:
    """Effect of hardening in the rectangular tube of the hat's size and wall."""
    return HardeningEffect.of(RectangularTube(section.width, section.depth, section.thickness), material)
