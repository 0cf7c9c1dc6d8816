"""Materials as the description gives them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Annotated, Any

from pydantic import ConfigDict, Field, model_validator

from crumple import material
from crumple.errors import InputError
from crumple.material.hardening.curve import HardeningCurve
from crumple.registry.quantity import (
    Converted,
    PoissonsRatio,
    PositiveDensity,
    PositiveNumber,
    PositiveStress,
)
from crumple.registry.refusal import refuse
from crumple.structure.keys.metal_curves import HardeningSpec, RateSpec, hardening_keys, rate_keys
from crumple.structure.remembered import remembered
from crumple.structure.schema.problems import suggestion
from crumple.structure.schema.spec import Spec


def _grade_or_values(schema: dict[str, Any]) -> None:
    """A grade brings every value that is not given."""
    schema["anyOf"] = [{"required": ["grade"]}, {"required": schema.pop("required")}]


class MaterialSpec(Spec):
    """Isotropic elastic-plastic metal, by its values or by a named grade."""

    model_config = ConfigDict(json_schema_extra=_grade_or_values)

    grade: Annotated[str, Field(max_length=40)] | None = None
    """Named grade such as S355: typical, not design values; the other keys override it."""
    youngs_modulus: PositiveStress
    """Young's modulus; a grade has its own."""
    poissons_ratio: PoissonsRatio
    """Poisson's ratio; a grade has its own."""
    density: PositiveDensity
    """Density; a grade has its own."""
    yield_stress: PositiveStress
    """Yield stress; a grade has its own."""
    ultimate_stress: PositiveStress | None = None
    """Nominal ultimate strength, where known; a grade has its own."""
    flow_stress: PositiveStress | None = None
    """Mean stress in a fold at large strain; without it that of `hardening`, or of a grade's curve, at a
    plastic strain of 0.1, else the yield stress."""
    yield_rate: RateSpec | None = None
    """Strain-rate law at yield; without it no rate effect."""
    flow_rate: RateSpec | None = None
    """Strain-rate law at large strain; without it no rate effect."""
    hardening: HardeningSpec | None = None
    """True stress against plastic strain, from the yield stress; shells follow it. Without it they are
    perfectly plastic at the flow stress, but for a grade without `flow_stress`, which has a curve."""
    failure_strain: PositiveNumber | None = None
    """Plastic strain at which a wall tears: a shell element is deleted when all its points reach it."""

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
            **{key: rate_keys(rate) for key, rate in rates.items() if rate is not None},
            "hardening": None if given.hardening is None else hardening_keys(given.hardening),
            "failure_strain": given.failure_strain,
        }

    @model_validator(mode="before")
    @classmethod
    def _from_grade(cls, given: Any) -> Any:
        """Fill in what the grade knows and the description does not give."""
        if not isinstance(given, Mapping) or not isinstance(given.get("grade"), str):
            return given
        try:
            found = material.grade(given["grade"])
        except InputError as error:
            meant = suggestion(given["grade"], material.grades())
            refuse(
                "unknown grade",
                problems=[
                    replace(problem, todo=meant or "choose one of these, or give values")
                    for problem in error.problems
                ],
            )
        metal = found.material
        values = {
            "youngs_modulus": metal.youngs_modulus,
            "poissons_ratio": metal.poissons_ratio,
            "density": metal.density,
            "yield_stress": metal.yield_stress,
            "ultimate_stress": metal.ultimate_stress,
        }
        known = {key: Converted(value) for key, value in values.items() if value is not None}
        return {**known, **given, "grade": found.name}

    @model_validator(mode="after")
    def _consistent(self) -> MaterialSpec:
        try:
            self.material("")
        except InputError as error:
            refuse("the material is not consistent", problems=error.problems)
        return self

    def material(self, name: str) -> material.Material:
        """Material of the physics room, under the name that the description gives it."""
        return _made(self, name)

    def _curve(self) -> HardeningCurve | None:
        if self.hardening is not None:
            return self.hardening.curve(self.yield_stress)
        if self.grade is None or self.flow_stress is not None:
            return None
        return material.grade_curve(self.grade, self.yield_stress, self.ultimate_stress)

    @property
    def statement(self) -> str:
        """Statement about the values of its grade; empty without a grade."""
        return "" if self.grade is None else material.grade(self.grade).statement


@remembered(256)
def _made(spec: MaterialSpec, name: str) -> material.Material:
    """One object per description, shared by all parts of the lowering."""
    return material.Material(
        name=name,
        youngs_modulus=spec.youngs_modulus,
        poissons_ratio=spec.poissons_ratio,
        density=spec.density,
        yield_stress=spec.yield_stress,
        ultimate_stress=spec.ultimate_stress,
        given_flow_stress=spec.flow_stress,
        yield_rate=None if spec.yield_rate is None else spec.yield_rate.law(),
        flow_rate=None if spec.flow_rate is None else spec.flow_rate.law(),
        hardening=spec._curve(),
        failure_strain=spec.failure_strain,
    )
