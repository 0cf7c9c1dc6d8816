"""Law of a tube whose metal hardens: its formula at yield times the effect of hardening in the library.

    M(theta) = M_F(theta; s_y) c(theta),    c(theta) = m(theta; x, h) / m(theta; x, 1)

with M_F the formula of the shape for a metal that is perfectly plastic at the yield stress, and m the share
of the plastic moment in the library, at the tube x of its range that is nearest in each coordinate.  The
product is ours.  Limits: h -> 1 leaves the formula; theta -> 0 leaves its largest moment, since walls that
have just yielded have not hardened.  docs/theory/tube_library.md.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from crumple.errors import InputError, Problem
from crumple.hinge.law import HingeLaw, SofteningVariable, Source, Trust, Validity
from crumple.hinge.rate import HingeRate
from crumple.hinge.registry import DEFAULT_BENDING, build_law
from crumple.hinge.stop import Stop
from crumple.hinge.tube_library.formula_band import with_library_band
from crumple.hinge.tube_library.hardening import HardeningEffect, at_yield, hardens
from crumple.material import Material
from crumple.material.hardening.table import HardeningTable
from crumple.material.material import FOLD_STRAIN
from crumple.numeric.arrays import Floats
from crumple.section import Axis, CircularTube, RectangularTube, Section

SOURCE = Source(
    "formula of the tube at yield, times the effect of hardening in the library of shell sub-models",
    Trust.FITTED,
    "the product is ours; a law from shells (crumple characterise) replaces it",
)


@dataclass(frozen=True)
class HardeningTubeLaw:
    """Law of a rectangular or circular tube whose metal has a hardening curve.

    Attributes
    ----------
    formula
        Law of the same tube without hardening.
    effect
        Of the hardening.
    validity
        Range and band.

    References
    ----------
    docs/theory/tube_library.md.  Verified in tests/verification/characterisation/test_hardening_tube.py.
    """

    name: ClassVar[str] = "hardening_tube"
    source: ClassVar[Source] = SOURCE
    softening_variable: ClassVar[SofteningVariable] = SofteningVariable.PEAK
    elastic_stiffness: ClassVar[float | None] = None

    formula: HingeLaw
    effect: HardeningEffect
    validity: Validity

    @classmethod
    def of(cls, section: Section, material: Material, axis: Axis = "y") -> HardeningTubeLaw:
        """Law of a tube.

        Parameters
        ----------
        section
            Rectangular or circular tube.
        material
            With a hardening curve, or a flow stress above its yield stress in place of one.
        axis
            Axis of bending.

        Raises
        ------
        InputError
            If the section is no such tube, or the metal does not harden.
        """
        if not isinstance(section, (RectangularTube, CircularTube)):
            what, allowed = "this law is for tubes", "rectangular_tube or circular_tube"
            raise InputError(Problem(what, section.kind, allowed, "use auto for this section", "section"))
        material = _with_curve(material)
        if not hardens(material):
            what, todo = "this law is for metals that harden", "give a hardening curve, or use the law auto"
            allowed = "a hardening curve that rises, or a flow stress above the yield stress"
            raise InputError(Problem(what, material.name, allowed, todo, "hardening"))
        formula = build_law(DEFAULT_BENDING[section.kind], section, at_yield(material), axis)
        law = cls(formula, HardeningEffect.of(section, material, axis), formula.validity)
        basis = (
            "a formula that hardens as the tubes of the library; ten clamped tubes were compared with shells"
        )
        own = replace(formula.validity, uncertainty=None, basis=basis)
        return replace(law, validity=with_library_band(replace(law, validity=own), section, material, axis))

    @property
    def title(self) -> str:
        """One line for people."""
        return f"{self.formula.title}, hardening up to {max(self.effect.factor):.3g} times"

    @property
    def symmetric(self) -> bool:
        """Whether both senses have one curve."""
        return self.formula.symmetric

    @property
    def rate(self) -> HingeRate | None:
        """Strain-rate law of the hinge."""
        return self.formula.rate

    @property
    def jamming_angle(self) -> float | None:
        """Rotation at which the walls touch [rad]."""
        return self.formula.jamming_angle

    @property
    def stop(self) -> Stop | None:
        """None: the walls fold further."""
        return self.formula.stop

    def kinks(self, sense: int = 1) -> tuple[float, ...]:
        """Rotations where the slope jumps [rad]: those of the formula and of the table."""
        return tuple(sorted({*self.formula.kinks(sense), *self.effect.rotation[1:]}))

    def moment_capacity(self, rotation: ArrayLike, sense: int = 1) -> Floats:
        """Capacity [N m] at a rotation [rad]; see `HingeLaw`."""
        return np.asarray(
            self.formula.moment_capacity(rotation, sense) * self.effect.at(rotation), np.float64
        )

    def rate_factor(self, rotation_rate: ArrayLike) -> Floats:
        """Factor on the capacity at a rotation rate [rad/s]."""
        return self.formula.rate_factor(rotation_rate)


def _with_curve(material: Material) -> Material:
    """The metal with a curve that rises to its flow stress where it has none: one number is used of it."""
    if material.hardening is not None or material.flow_stress <= material.yield_stress:
        return material
    curve = HardeningTable((0.0, FOLD_STRAIN), (material.yield_stress, material.flow_stress))
    return replace(material, hardening=curve, given_flow_stress=None)
