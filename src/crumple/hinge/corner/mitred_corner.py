"""Mitred corner of two rectangular tubes, bent in its plane: an estimate, with constants fitted to shells.

At the mitre the force of a flange changes its direction by the angle alpha between the members. Nothing
but the bending of the flange's own wall resists what turns it, so that the flange carries little force
there; the webs carry the moment, over the length h/cos(alpha/2) of the mitre. With the distances b and h
of the mid-lines of webs and flanges and the wall t,

    M_0 = sigma_y t [h^2/2 (1 - g s^2)/(1 - s^2) + b h/sqrt(1 + x^2)] <= M_p,
    x = b s/(k t),    s = sin(alpha/2)

and, with the moment M_K(theta) of the straight member's Kecman-type mechanism,

    closing   M = (M_0^-p + ((1 - c s) M_F)^-p)^(-1/p)
    opening   M = min(o M_0, (1 + d s) M_K, M_p)

where M_F is that of the mechanism before it is capped. A metal with a hardening curve has these moments at
its yield stress, times the effect c_h of hardening on the straight member (`HardeningEffect`): all of it in
an opened corner, 1 + (1 - e s)(c_h - 1) in a closed one. The constants were fitted to corners solved by
shells. Limits: alpha -> 0 or a thick wall (x -> 0) gives the straight member, rounded where its fold
begins; for large x the flange carries k t/(b s) of its yield force. Elastic stiffness of the corner's
own: K = r E t h^2.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from crumple.hinge.bending.kecman import KecmanLaw
from crumple.hinge.corner.hat_corner import HatCornerLaw
from crumple.hinge.corner.in_plane import TOUCHING, Closing, InPlaneLaw, jammed, jamming_of, rounded, slope_of
from crumple.hinge.corner.round_corner import RoundCornerLaw
from crumple.hinge.law import Source, Trust, Validity
from crumple.hinge.options import choice
from crumple.hinge.tube_library.hardening import HardeningEffect, at_yield
from crumple.material import Material
from crumple.numeric.arrays import Floats
from crumple.numeric.sign_change import sign_change
from crumple.registry.quantity import PositiveAngle
from crumple.section import Axis, CircularTube, ClosedHat, Section

SOURCE = Source(
    "mitred corner: webs over the mitre, flanges by bending of their walls, softening of the straight tube",
    Trust.FITTED,
    "derived here, with constants fitted to corners solved by shells; a law from shells "
    "(crumple characterise) replaces it",
)
WEB, FLANGE = 0.56, 2.44
"""g and k of the moment at the start [-]."""
CLOSING, OPENING, OPEN_RISE = 0.45, 0.75, 1.12
"""c, d and o of the moment of both senses [-]."""
STIFFNESS = 0.34
"""r of the elastic stiffness [-]."""
REACH = math.radians(60.0)
"""Rotation up to which the corners were solved by shells."""
UNCERTAINTY = 0.25
"""Half-width of the band [-]; see the table in the theory page."""


@dataclass(frozen=True)
class MitredCornerLaw(InPlaneLaw):
    """Corner of two tubes or closed hats in a mitre, bent in its plane: an estimate from shells.

    Attributes
    ----------
    start, plastic, slope, tube, closing, elastic_stiffness, validity, jamming
        See `InPlaneLaw`.

    References
    ----------
    docs/theory/mitred_corner.md.  Verified in tests/verification/hinge/test_mitred_corners.py.
    """

    source: ClassVar[Source] = SOURCE

    tube: KecmanLaw

    @classmethod
    def of(
        cls,
        section: Section,
        material: Material,
        axis: Axis = "y",
        *,
        angle: PositiveAngle,
        closing: Closing | str = Closing.POSITIVE,
    ) -> InPlaneLaw:
        """Law of a corner; of round tubes a `RoundCornerLaw`, of closed hats a `HatCornerLaw`.

        Parameters
        ----------
        section
            Rectangular or circular tube, or closed hat, of both members.
        material
            Yield stress and elastic modulus.
        axis
            Axis of the section that is normal to the corner's plane.
        angle
            Angle between the members' axes, 0 in line [rad].
        closing
            Sense of the hinge's rotation that closes the corner.  Hats have their plate inside if it is
            positive, their crown if it is negative.

        Raises
        ------
        InputError
            If the section is none of these, or the angle is outside 5 to 100 degrees.
        """
        s, sense = slope_of(angle), choice("closing", closing, Closing)
        if isinstance(section, CircularTube):
            return RoundCornerLaw.of(section, material, angle=angle, closing=sense)
        if isinstance(section, ClosedHat):
            return HatCornerLaw.of(section, material, axis, angle=angle, closing=sense)
        tube = KecmanLaw.of(section, at_yield(material), axis, after_jamming="hold")
        wall = section.thickness
        across, deep = section.flange_width(axis) - wall, section.bending_depth(axis) - wall
        webs = deep**2 / 2.0 * (1.0 - WEB * s**2) / (1.0 - s**2)
        flanges = across * deep / math.hypot(1.0, across * s / (FLANGE * wall))
        plastic = float(tube.moment_capacity(0.0))
        return cls(
            min(material.yield_stress * wall * (webs + flanges), plastic),
            plastic,
            s,
            tube,
            sense,
            STIFFNESS * material.youngs_modulus * wall * deep**2,
            Validity(REACH, "corners of other proportions were solved by shells that far", (), UNCERTAINTY),
            effect=HardeningEffect.of(section, material, axis),
            jamming=jamming_of(across, deep, wall),
        )

    def kinks(self, sense: int = 1) -> tuple[float, ...]:
        """Rotations where the slope jumps [rad]."""
        end = self.tube.jamming_angle
        jams = {at * end for at in TOUCHING} if self.jamming else set()
        hardens = {*self.effect.rotation[1:]}
        if self.closes(sense):
            return tuple(sorted({end} | jams | hardens))

        def above(rotation: Floats) -> Floats:
            return self._opening_start - self._opened_fold(rotation, sense)

        crossing = sign_change(above, 1e-4 * end, end * (1.0 - 1e-9))
        # the capped part of the straight member's curve has no kinks
        fold = {kink for kink in {*self.tube.kinks(sense)} | jams if float(above(np.asarray(kink))) >= 0.0}
        return tuple(sorted(fold | hardens | (set() if crossing is None else {crossing})))

    def at_yield(self, rotation: ArrayLike, sense: int = 1) -> Floats:
        """Capacity [N m] at a rotation [rad] of a metal that stays at its yield stress."""
        rotation = np.asarray(rotation, np.float64)
        if not self.closes(sense):
            return np.asarray(np.minimum(self._opening_start, self._opened_fold(rotation, sense)))
        end = self.tube.jamming_angle
        fold = (1.0 - CLOSING * self.slope) * self.tube.mechanism.moment(np.minimum(rotation, end))
        moment = rounded(self.start, fold) * jammed(rotation, end, self.jamming)
        return np.asarray(np.minimum(moment, self.plastic))

    def _opened_fold(self, rotation: Floats, sense: int) -> Floats:
        """Moment of the fold of an opened corner [N m]."""
        fold = (1.0 + OPENING * self.slope) * self.tube.moment_capacity(rotation, sense)
        return fold * jammed(rotation, self.tube.jamming_angle, self.jamming)

    @property
    def _opening_start(self) -> float:
        return min(OPEN_RISE * self.start, self.plastic)
