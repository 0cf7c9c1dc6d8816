"""One metal, isotropic: the few numbers that plastic hinges and shells both need."""

from __future__ import annotations

import math
from dataclasses import dataclass

from crumple.errors import InputError, Problem
from crumple.material.hardening.curve import HardeningCurve
from crumple.material.rate import RateLaw
from crumple.registry.quantity import texts_to_si
from crumple.units import format_quantity

UNITS = {
    "youngs_modulus": "Pa",
    "poissons_ratio": "1",
    "density": "kg/m^3",
    "yield_stress": "Pa",
    "ultimate_stress": "Pa",
    "given_flow_stress": "Pa",
    "failure_strain": "1",
}
"""SI unit of each number of a material; texts with units are taken too."""
FOLD_STRAIN = 0.1
"""Plastic strain at which the hardening is measured: of the order of those in a fold."""


@dataclass(frozen=True)
class Material:
    """Isotropic elastic-plastic metal.

    Attributes
    ----------
    name
        What the input calls it.
    youngs_modulus
        [Pa], > 0.
    poissons_ratio
        [-], from 0 to below 0.5.
    density
        [kg/m^3], > 0.
    yield_stress
        [Pa], > 0, below Young's modulus.
    ultimate_stress
        Nominal ultimate strength [Pa], at least the yield stress, or None where unknown.
    given_flow_stress
        Mean stress [Pa] in a fold at large strain, or None: see `flow_stress`.
    yield_rate, flow_rate
        Strain-rate law at yield and at large strain; None: no rate effect.
    hardening
        True stress against plastic strain, from the same yield stress; None: perfectly plastic, or unknown.
    failure_strain
        Plastic strain at which the metal tears [-], > 0; None: never, or unknown. Hinges do not use it.

    Raises
    ------
    InputError
        With every value that cannot be accepted.
    """

    name: str
    youngs_modulus: float
    poissons_ratio: float
    density: float
    yield_stress: float
    ultimate_stress: float | None = None
    given_flow_stress: float | None = None
    yield_rate: RateLaw | None = None
    flow_rate: RateLaw | None = None
    hardening: HardeningCurve | None = None
    failure_strain: float | None = None

    def __post_init__(self) -> None:
        texts_to_si(self, UNITS)
        problems = [*_not_positive(self), *_inconsistent(self)]
        if problems:
            raise InputError(problems)

    @property
    def flow_stress(self) -> float:
        """Stress that folds work against [Pa]: given, else of the hardening curve, else the yield stress.

        Of a curve it is the stress at the plastic strain `FOLD_STRAIN`, the measure of hardening of the tube
        library.  The yield stress alone is on the low side for a metal that hardens: Kecman-type mechanisms
        take the nominal ultimate strength, so give that or an energy-equivalent stress where there is no
        curve.
        """
        if self.given_flow_stress is not None:
            return self.given_flow_stress
        return self.yield_stress if self.hardening is None else float(self.hardening.stress(FOLD_STRAIN))

    @property
    def shear_modulus(self) -> float:
        """E / (2 (1 + nu)) [Pa]."""
        return self.youngs_modulus / (2.0 * (1.0 + self.poissons_ratio))


def _not_positive(material: Material) -> list[Problem]:
    """Problems of values that must be positive and finite."""
    values = {
        "youngs_modulus": (material.youngs_modulus, "Pa", "steel has about 210 GPa"),
        "density": (material.density, "kg/m^3", "steel has about 7850 kg/m^3"),
        "yield_stress": (material.yield_stress, "Pa", "structural steel starts at 235 MPa"),
        "ultimate_stress": (material.ultimate_stress, "Pa", "leave it out if it is unknown"),
        "flow_stress": (material.given_flow_stress, "Pa", "leave it out to use the yield stress"),
        "failure_strain": (material.failure_strain, "", "leave it out if nothing tears"),
    }
    return [
        Problem(
            f"{name.replace('_', ' ')} must be positive",
            f"{value:g} {unit}".strip(),
            f"> 0 {unit}".strip(),
            todo,
            name,
        )
        for name, (value, unit, todo) in values.items()
        if value is not None and not (math.isfinite(value) and value > 0.0)
    ]


def _inconsistent(material: Material) -> list[Problem]:
    """Problems of values that contradict each other or leave their physical range."""
    problems = []
    if not 0.0 <= material.poissons_ratio < 0.5:
        problems.append(
            Problem(
                "Poisson's ratio is out of range",
                f"{material.poissons_ratio:g}",
                "0 <= nu < 0.5",
                "metals have about 0.3",
                "poissons_ratio",
            )
        )
    if material.yield_stress >= material.youngs_modulus > 0.0:
        problems.append(
            Problem(
                "the yield stress is not below Young's modulus",
                f"{_pascals(material.yield_stress)} with E = {_pascals(material.youngs_modulus)}",
                "a yield strain well below 1",
                "check the units of both (MPa, GPa)",
                "yield_stress",
            )
        )
    if material.ultimate_stress is not None and 0.0 < material.ultimate_stress < material.yield_stress:
        problems.append(
            Problem(
                "the ultimate stress is below the yield stress",
                f"{_pascals(material.ultimate_stress)} with yield {_pascals(material.yield_stress)}",
                "ultimate >= yield",
                "exchange the two, or leave the ultimate stress out",
                "ultimate_stress",
            )
        )
    curve = material.hardening
    # a part in a million: curves and yield stress may come from the same text in different units
    if curve is not None and abs(curve.yield_stress / material.yield_stress - 1.0) > 1e-6:
        problems.append(
            Problem(
                "the hardening curve does not begin at the yield stress",
                _pascals(curve.yield_stress),
                _pascals(material.yield_stress),
                "give both the same yield stress",
                "hardening",
            )
        )
    return problems


def _pascals(stress: float) -> str:
    """A stress [Pa] in a readable unit."""
    return format_quantity(stress, "Pa", 6)
