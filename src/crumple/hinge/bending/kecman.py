"""Kecman-type law of a rectangular tube: largest moment, then a folding mechanism until the walls touch.

Unknown: the capacity M(theta).  Three branches:

    theta <= theta_T             start: cap        Mmax (and M = min(Mmax, M_mech): continuous, one kink)
                                 start: parabola   Mmax - c theta^2, value and slope of M_mech at theta_T
    theta_T <= theta <= theta_J  M_mech = dW/dtheta of the mechanism (crumple.hinge.bending.kecman_mechanism)
    theta > theta_J              after_jamming (crumple.hinge.bending.jamming)

The parabola's theta_T solves Mmax - M_mech + theta M_mech'/2 = 0, and c = (Mmax - M_mech)/theta_T^2.
Limits: rolling_weight 0 leaves one rolling line per ear; M_mech ~ t^2 but Mmax ~ t, so thick walls leave the
plateau later, and may jam before.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import Enum
from functools import cached_property
from typing import ClassVar

import numpy as np

from crumple.errors import InputError, Problem
from crumple.hinge.bending.folding import FoldingLaw
from crumple.hinge.bending.jamming import AfterJamming
from crumple.hinge.bending.kecman_mechanism import FoldMechanism
from crumple.hinge.bending.kecman_range import kecman_validity
from crumple.hinge.bending.largest_moment import PeakMoment, peak_moment
from crumple.hinge.law import Source, Trust
from crumple.hinge.options import choice, number_between
from crumple.hinge.rate import hinge_rate
from crumple.hinge.stop import Stop
from crumple.hinge.tube_library.formula_band import with_library_band
from crumple.material import Material
from crumple.numeric.arrays import Floats
from crumple.numeric.sign_change import sign_change
from crumple.registry.quantity import RollingWeight
from crumple.section import Axis, RectangularTube, Section

SOURCE = Source(
    "Kecman-type mechanism, after D. Kecman, Int. J. Mech. Sci. 25 (1983) 623-636",
    Trust.DERIVED,
    "mechanism energy derived independently; capacity rule, rolling radius and the weight "
    "of the second rolling line as quoted by others, original tables not seen",
)


class Start(Enum):
    """Start of the curve, before the mechanism governs."""

    CAP = "cap"
    """Largest moment until the mechanism falls below it."""
    PARABOLA = "parabola"
    """Parabola from the largest moment, tangent to the mechanism."""


@dataclass(frozen=True)
class KecmanLaw(FoldingLaw):
    """Kecman-type mechanism of a rectangular tube.

    About one axis; the same in both senses.

    Attributes
    ----------
    mechanism, peak
        Origin of the two branches.
    start
        Option for the curve before the mechanism governs.
    validity, after_jamming, rate, stop
        See `FoldingLaw`.

    References
    ----------
    docs/theory/kecman.md.  Verified in tests/verification/hinge/test_kecman_curves.py.
    """

    name: ClassVar[str] = "kecman"
    source: ClassVar[Source] = SOURCE

    mechanism: FoldMechanism
    peak: PeakMoment
    start: Start

    @classmethod
    def of(
        cls,
        section: Section,
        material: Material,
        axis: Axis = "y",
        *,
        rolling_weight: RollingWeight = 1.0,
        start: Start | str = Start.CAP,
        after_jamming: AfterJamming | str = AfterJamming.SECOND_FOLD,
    ) -> KecmanLaw:
        """Law of a rectangular tube.

        Parameters
        ----------
        section
            Rectangular tube; the mechanism takes its outer dimensions and sharp corners.
        material
            Yield stress for the largest moment, flow stress for the mechanism, flow rate for the rate factor.
        axis
            Axis of bending.
        rolling_weight
            Weight of the second rolling line of each web.
        start
            Start: the largest moment until the mechanism falls below it, or a parabola tangent to it.
        after_jamming
            What follows when the walls touch: a further fold in series, an elastic stop, or the moment held.

        Returns
        -------
        KecmanLaw
            Frozen law.

        Raises
        ------
        InputError
            If the section is not a rectangular tube, an option is out of range, or no parabola touches the
            mechanism before it jams.
        """
        if not isinstance(section, RectangularTube):
            allowed, todo = "rectangular_tube", "use a table or a constant law for this section"
            raise InputError(
                Problem("the Kecman-type mechanism is for rectangular tubes", section.kind, allowed, todo)
            )
        mechanism = FoldMechanism(
            section.flange_width(axis),
            section.bending_depth(axis),
            section.thickness,
            material.flow_stress,
            number_between("rolling_weight", rolling_weight, 0.0, 1.0),
        )
        peak = peak_moment(section, material, axis)
        after = choice("after_jamming", after_jamming, AfterJamming)
        law = cls(
            mechanism,
            peak,
            choice("start", start, Start),
            validity=kecman_validity(section, material, axis, peak, mechanism),
            after_jamming=after,
            rate=hinge_rate(material.flow_rate),
            stop=_jamming_stop(mechanism, section, material, axis) if after is AfterJamming.STOP else None,
        )
        if law.start is Start.PARABOLA and law.mechanism_from > mechanism.jamming_angle:
            what = "no parabola from the largest moment is tangent to the mechanism before the walls touch"
            raise InputError(Problem(what, "parabola", "cap", "use start: cap for this section", "start"))
        return replace(law, validity=with_library_band(law, section, material, axis))

    @property
    def title(self) -> str:
        """One line for people."""
        a, b, t = (
            1e3 * length for length in (self.mechanism.width, self.mechanism.depth, self.mechanism.thickness)
        )
        return f"Kecman-type mechanism, flange {a:g} mm, depth {b:g} mm, wall {t:g} mm"

    @property
    def jamming_angle(self) -> float:
        """Rotation at which the flange halves touch [rad]."""
        return self.mechanism.jamming_angle

    @cached_property
    def mechanism_from(self) -> float:
        """theta_T: rotation from which the mechanism governs [rad]; infinite if it never does."""

        def cap(rotation: Floats) -> Floats:
            return self.peak.moment - self.mechanism.moment(rotation)

        def tangent(rotation: Floats) -> Floats:
            return cap(rotation) + rotation * self.mechanism.slope(rotation) / 2.0

        condition = cap if self.start is Start.CAP else tangent
        crossing = sign_change(condition, 1e-4 * self.jamming_angle, self.jamming_angle)
        return np.inf if crossing is None else crossing

    @property
    def fold_kinks(self) -> tuple[float, ...]:
        """Rotations up to jamming where the slope or the curvature jumps [rad]."""
        return (self.mechanism_from,) if self.mechanism_from < self.jamming_angle else ()

    @cached_property
    def _parabola(self) -> float:
        """Coefficient c of the starting parabola [N m/rad^2]."""
        drop = self.peak.moment - self.mechanism.moment(self.mechanism_from)
        return float(drop / self.mechanism_from**2)

    def single_fold(self, rotation: Floats) -> Floats:
        """Capacity of one fold up to jamming [N m]."""
        parabola = self._parabola if self.start is Start.PARABOLA else 0.0
        capacity: Floats = np.asarray(self.peak.moment - parabola * rotation**2)
        governed = rotation > self.mechanism_from
        capacity[governed] = self.mechanism.moment(rotation[governed])
        return capacity


def _jamming_stop(mechanism: FoldMechanism, section: RectangularTube, material: Material, axis: Axis) -> Stop:
    """Stop at the jamming angle, as stiff as the unfolded tube over the length of the fold, EI/(2h)."""
    stiffness = material.youngs_modulus * section.second_moment(axis) / (2.0 * mechanism.half_length)
    return Stop(mechanism.jamming_angle, stiffness)
