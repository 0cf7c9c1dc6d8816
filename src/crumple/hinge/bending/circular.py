"""Circular tube in bending: plastic moment or elastic ovalisation, followed by a kink.

Unknown: M(theta) of a tube of mean radius R and wall t.

    largest moment   min(s_y Z_pl, 0.987 E R t^2/sqrt(1 - nu^2))            second: Brazier's elastic limit
    kink begins      theta_k = k_c 2 H_b,  k_c = t/((pi - 2) R^2)           plastic ovalisation, derived:
        fibres at s_y on a curvature k press the wall inwards by s_y t k per area; the ring is a mechanism of
        four hinges when  s_y t k R^2 (pi/2 - 1) = 2 m_p,  m_p = s_y t^2/4;  the quarters then turn by psi and
        Z = 4 t R^2 (cos psi - (pi/2 - 1) sin psi), unstably, down to 0.3035 of Z_pl when flat (psi = 45 deg)
    after that       min(largest moment, mechanism of the square tube with the same length of mid-line)

The last line scales a known mechanism to another shape: an estimate, not a derivation; its lower limit is the
flattened tube's 0.3035 M_p.  The length 2 H_b over which the tube ovalises is that of a square tube's fold.
Limits: thick walls never buckle elastically; thin ones: M -> Brazier ~ R t^2.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from crumple.errors import InputError, Problem
from crumple.hinge.bending.capped import CappedMechanism
from crumple.hinge.bending.folding import FoldingLaw
from crumple.hinge.bending.jamming import AfterJamming
from crumple.hinge.bending.kecman_mechanism import FoldMechanism
from crumple.hinge.law import Source, Trust, Validity
from crumple.hinge.options import choice
from crumple.hinge.rate import hinge_rate, rate_warnings
from crumple.hinge.stop import Stop
from crumple.hinge.tube_library.formula_band import with_library_band
from crumple.material import Material
from crumple.numeric.arrays import Floats
from crumple.numeric.sign_change import sign_change
from crumple.registry.quantity import RollingWeight
from crumple.section import Axis, CircularTube, Section, half_fold_length

SOURCE = Source(
    "plastic moment, Brazier's ovalisation limit, plastic ovalisation, kink as a square tube",
    Trust.DERIVED,
    "Brazier's limit is classical and quoted; the onset of the kink is derived here; the kinked branch is "
    "that of a square tube with the same length of mid-line",
)
FLATTENED = math.sqrt(0.5) * (2.0 - math.pi / 2.0)
"""Plastic modulus of the flat four-hinge ring over that of the round one [-], 0.3035."""


@dataclass(frozen=True)
class CircularLaw(FoldingLaw):
    """Circular tube: plastic or ovalisation moment, then a kink scaled from a square tube.

    The same about every axis and in both senses.

    Attributes
    ----------
    fold
        Largest moment and scaled mechanism.
    residual
        Moment of the flattened tube [N m]; the kinked branch does not fall below it.
    kink_from
        theta_k: rotation at which the tube ovalises plastically [rad].
    elastic_limit
        Brazier's moment [N m].
    validity, after_jamming, rate, stop
        See `FoldingLaw`.

    References
    ----------
    docs/theory/circular_tube.md.  Verified in tests/verification/hinge/test_circular_bending.py.
    """

    name: ClassVar[str] = "circular"
    source: ClassVar[Source] = SOURCE

    fold: CappedMechanism
    residual: float
    kink_from: float
    elastic_limit: float

    @classmethod
    def of(
        cls,
        section: Section,
        material: Material,
        axis: Axis = "y",
        *,
        rolling_weight: RollingWeight = 1.0,
        after_jamming: AfterJamming | str = AfterJamming.HOLD,
    ) -> CircularLaw:
        """Law of a circular tube.

        Parameters
        ----------
        section
            Circular tube.
        material
            Yield stress, elastic constants; flow stress for the kink; flow rate for the rate factor.
        axis
            Any: the tube has the same properties about all axes.
        rolling_weight
            Weight of the second rolling line of each web of the square tube.
        after_jamming
            What follows when the walls touch: a further fold in series, an elastic stop, or the moment held.

        Raises
        ------
        InputError
            If the section is not a circular tube or an option is unknown.
        """
        if not isinstance(section, CircularTube):
            what, todo = "this law is for circular tubes", "use kecman for a rectangular one"
            raise InputError(Problem(what, section.title, "circular_tube", todo, "section"))
        after = choice("after_jamming", after_jamming, AfterJamming)
        t = section.thickness
        radius = (section.diameter - t) / 2.0
        plastic = material.yield_stress * section.plastic_section_modulus(axis)
        limit = brazier_moment(radius, t, material)
        side = math.pi * radius / 2.0 + t
        mechanism = FoldMechanism(side, side, t, material.flow_stress, rolling_weight)
        fold = CappedMechanism(min(plastic, limit), mechanism)
        kink = 2.0 * half_fold_length(section, axis) * ovalisation_curvature(radius, t)
        stiffness = material.youngs_modulus * section.second_moment(axis) / side
        law = cls(
            fold,
            min(FLATTENED * plastic, fold.peak),
            kink,
            limit,
            validity=_validity(min(kink, fold.folding_from, fold.jamming_angle), plastic, limit, material),
            after_jamming=after,
            rate=hinge_rate(material.flow_rate),
            stop=Stop(fold.jamming_angle, stiffness) if after is AfterJamming.STOP else None,
        )
        return replace(law, validity=with_library_band(law, section, material, axis))

    @property
    def title(self) -> str:
        """One line for people."""
        return "circular tube, kink scaled from a square tube"

    @property
    def jamming_angle(self) -> float:
        """Rotation at which the scaled fold jams [rad]."""
        return self.fold.jamming_angle

    @property
    def fold_kinks(self) -> tuple[float, ...]:
        """Rotations up to jamming where the slope jumps [rad]."""
        jamming = self.jamming_angle
        floor = sign_change(
            lambda at: self.residual - self.fold.mechanism.moment(at), 1e-4 * jamming, jamming
        )
        return (*self.fold.kinks, *(() if floor is None or floor >= jamming else (floor,)))

    def single_fold(self, rotation: Floats) -> Floats:
        """Capacity of one fold [N m] at rotations up to jamming [rad]."""
        return np.maximum(self.fold.moment(rotation), self.residual)


def brazier_moment(radius: float, thickness: float, material: Material) -> float:
    """Largest elastic moment of an ovalising tube, 0.987 E R t^2/sqrt(1 - nu^2) [N m]; R: mean radius [m]."""
    stretch = math.sqrt(1.0 - material.poissons_ratio**2)
    return 0.987 * material.youngs_modulus * radius * thickness**2 / stretch


def ovalisation_curvature(radius: float, thickness: float) -> float:
    """Curvature [1/m] at which a fully plastic tube becomes a ring mechanism, t/((pi - 2) R^2)."""
    return thickness / ((math.pi - 2.0) * radius**2)


def _validity(rotation_max: float, plastic: float, limit: float, material: Material) -> Validity:
    warnings = [
        "the kinked branch is the mechanism of a square tube with the same length of mid-line: scaled, not "
        "derived"
    ]
    if limit < plastic:
        warnings.append(
            f"thin wall: it ovalises elastically at {limit / plastic:.2f} of the plastic moment, and local "
            "buckling, which is not modelled, may occur first"
        )
    warnings += rate_warnings(material)
    basis = (
        f"up to {math.degrees(rotation_max):.1f} deg the section carries its largest moment; plastic "
        "ovalisation and the kink are validated neither by tests nor by solid elements"
    )
    return Validity(rotation_max, basis, tuple(warnings))
