"""Materials as the description gives them."""

from __future__ import annotations

from typing import Any

from pydantic import model_validator

from crumple import material
from crumple.errors import InputError
from crumple.structure.quantity import (
    PoissonsRatio,
    PositiveDensity,
    PositiveRate,
    PositiveStress,
    RateExponent,
)
from crumple.structure.spec import Spec, refuse


class RateSpec(Spec):
    """Cowper-Symonds strain-rate law: stress times 1 + (strain rate / D)^(1/q)."""

    D: PositiveRate
    """Strain rate at which the stress doubles."""
    q: RateExponent
    """Exponent."""


class MaterialSpec(Spec):
    """Isotropic elastic-plastic metal."""

    youngs_modulus: PositiveStress
    """Young's modulus."""
    poissons_ratio: PoissonsRatio
    """Poisson's ratio."""
    density: PositiveDensity
    """Density."""
    yield_stress: PositiveStress
    """Yield stress."""
    ultimate_stress: PositiveStress | None = None
    """Nominal ultimate strength, where known."""
    flow_stress: PositiveStress | None = None
    """Mean stress in a fold at large strain; without it the yield stress."""
    yield_rate: RateSpec | None = None
    """Strain-rate law at yield; without it no rate effect."""
    flow_rate: RateSpec | None = None
    """Strain-rate law at large strain; without it no rate effect."""

    @model_validator(mode="before")
    @classmethod
    def _from_material(cls, given: Any) -> Any:
        """Take a `crumple.material.Material` too, where the structure is built in Python."""
        if not isinstance(given, material.Material):
            return given
        rates = {"yield_rate": given.yield_rate, "flow_rate": given.flow_rate}
        return {
            "youngs_modulus": given.youngs_modulus,
            "poissons_ratio": given.poissons_ratio,
            "density": given.density,
            "yield_stress": given.yield_stress,
            "ultimate_stress": given.ultimate_stress,
            "flow_stress": given.given_flow_stress,
            **{key: _keys(rate) for key, rate in rates.items() if rate is not None},
        }

    @model_validator(mode="after")
    def _consistent(self) -> MaterialSpec:
        try:
            self.material("")
        except InputError as error:
            refuse("the material is not consistent", problems=error.problems)
        return self

    def material(self, name: str) -> material.Material:
        """Material of the physics room, under the name that the description gives it."""
        return material.Material(
            name=name,
            youngs_modulus=self.youngs_modulus,
            poissons_ratio=self.poissons_ratio,
            density=self.density,
            yield_stress=self.yield_stress,
            ultimate_stress=self.ultimate_stress,
            given_flow_stress=self.flow_stress,
            yield_rate=_rate(self.yield_rate),
            flow_rate=_rate(self.flow_rate),
        )


def _keys(rate: object) -> dict[str, float]:
    """Keys of a rate law of the physics room."""
    if not isinstance(rate, material.CowperSymonds):
        refuse("this rate law cannot be described", allowed="a Cowper-Symonds law", key="flow_rate")
    return {"D": rate.D, "q": rate.q}


def _rate(spec: RateSpec | None) -> material.CowperSymonds | None:
    return None if spec is None else material.CowperSymonds(D=spec.D, q=spec.q)
