"""How a metal's stress rises with plastic strain and with strain rate, as the description gives it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Annotated, Any, Literal

from pydantic import Discriminator, Field, Tag, model_validator

from crumple import material
from crumple.errors import InputError
from crumple.registry.quantity import (
    NUMBER,
    NonNegativeNumber,
    PositiveNumber,
    PositiveRate,
    PositiveStress,
    RateExponent,
)
from crumple.registry.refusal import refuse
from crumple.structure.schema.spec import Spec, type_tag

MOST_POINTS = 1000
"""Points of one hardening table."""
HardeningExponent = Annotated[float, replace(NUMBER, example="0.12", at_least=0.0, at_most=1.0)]


class CowperSymondsSpec(Spec):
    """Cowper-Symonds strain-rate law: stress times 1 + (strain rate / D)^(1/q)."""

    type: Literal["cowper-symonds"] = "cowper-symonds"
    """Kind of law; this one where it is left out."""
    D: PositiveRate
    """Strain rate at which the stress doubles."""
    q: RateExponent
    """Exponent."""

    def law(self) -> material.CowperSymonds:
        """Law of the physics room."""
        return material.CowperSymonds(D=self.D, q=self.q)


class JohnsonCookSpec(Spec):
    """Johnson-Cook strain-rate law: stress times 1 + C ln(strain rate / reference), 1 below the reference."""

    type: Literal["johnson-cook"] = "johnson-cook"
    """Kind of law."""
    C: NonNegativeNumber
    """Rise of the stress per e-fold of strain rate."""
    reference: PositiveRate = 1.0
    """Strain rate of the static test."""

    def law(self) -> material.JohnsonCook:
        """Law of the physics room."""
        return material.JohnsonCook(C=self.C, reference=self.reference)


def _rate_tag(given: Any) -> str:
    """The key ``type`` chooses; without it the power law."""
    return "(type=cowper-symonds)" if isinstance(given, Mapping) and "type" not in given else type_tag(given)


RateSpec = Annotated[
    Annotated[CowperSymondsSpec, Tag("(type=cowper-symonds)")]
    | Annotated[JohnsonCookSpec, Tag("(type=johnson-cook)")],
    Discriminator(_rate_tag),
]
"""Any strain-rate law; ``type`` says which, Cowper-Symonds without it."""


class HardeningTableSpec(Spec):
    """Straight lines of true stress against plastic strain; the last stress is held."""

    type: Literal["table"] = "table"
    """Kind of curve."""
    plastic_strain: Annotated[tuple[NonNegativeNumber, ...], Field(min_length=1, max_length=MOST_POINTS)]
    """Plastic strains, from 0."""
    true_stress: Annotated[tuple[PositiveStress, ...], Field(min_length=1, max_length=MOST_POINTS)]
    """True stresses, the first one the yield stress."""

    @model_validator(mode="after")
    def _rises(self) -> HardeningTableSpec:
        try:
            material.HardeningTable(self.plastic_strain, self.true_stress)
        except InputError as error:
            refuse("this is no hardening table", problems=error.problems)
        return self

    def curve(self, yield_stress: float) -> material.HardeningCurve:
        """Curve of the physics room."""
        return material.HardeningTable(self.plastic_strain, self.true_stress)


class SwiftSpec(Spec):
    """Power law: yield stress times (1 + plastic strain / prestrain)^exponent."""

    type: Literal["swift"] = "swift"
    """Kind of curve."""
    prestrain: PositiveNumber
    """Plastic strain that scales the law."""
    exponent: HardeningExponent
    """Exponent."""

    def curve(self, yield_stress: float) -> material.HardeningCurve:
        """Curve of the physics room."""
        return material.Swift(yield_stress, self.prestrain, self.exponent)


class VoceSpec(Spec):
    """Saturating law: yield stress + saturation (1 - exp(-plastic strain / strain))."""

    type: Literal["voce"] = "voce"
    """Kind of curve."""
    saturation: PositiveStress
    """How much the stress rises in the end."""
    strain: PositiveNumber
    """Plastic strain in which 63 % of the rise happens."""

    def curve(self, yield_stress: float) -> material.HardeningCurve:
        """Curve of the physics room."""
        return material.Voce(yield_stress, self.saturation, self.strain)


HardeningSpec = Annotated[
    Annotated[HardeningTableSpec, Tag("(type=table)")]
    | Annotated[SwiftSpec, Tag("(type=swift)")]
    | Annotated[VoceSpec, Tag("(type=voce)")],
    Discriminator(type_tag),
]
"""Any hardening curve; ``type`` says which."""


def rate_keys(law: material.RateLaw) -> dict[str, Any]:
    """Keys that describe a rate law of the physics room."""
    if isinstance(law, material.JohnsonCook):
        return {"type": "johnson-cook", "C": law.C, "reference": law.reference}
    return {"D": law.D, "q": law.q}


def hardening_keys(curve: material.HardeningCurve) -> dict[str, Any]:
    """Keys that describe a hardening curve of the physics room."""
    if isinstance(curve, material.Swift):
        return {"type": "swift", "prestrain": curve.prestrain, "exponent": curve.exponent}
    if isinstance(curve, material.Voce):
        return {"type": "voce", "saturation": curve.saturation, "strain": curve.strain}
    if isinstance(curve, material.PerfectlyPlastic):
        return {"type": "table", "plastic_strain": [0.0], "true_stress": [curve.yield_stress]}
    if isinstance(curve, material.HardeningTable):
        return {
            "type": "table",
            "plastic_strain": list(curve.plastic_strain),
            "true_stress": list(curve.true_stress),
        }
    refuse("this hardening curve cannot be described", allowed="a table, Swift or Voce", key="hardening")
