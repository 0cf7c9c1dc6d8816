"""A metal as the shell elements take it."""

from __future__ import annotations

import numpy as np

from crumple._core.shell import ShellMaterial
from crumple.material import CowperSymonds, JohnsonCook, Material

TABLE_STRAINS = np.concatenate([[0.0], np.geomspace(1e-4, 3.0, 80)])
"""Plastic strains at which a hardening curve is sampled: 14 % apart, so that straight lines between err by
less than 0.1 % of a Swift curve; constant beyond the last, which no sheet reaches."""


def shell_material(material: Material) -> ShellMaterial:
    """Elastic, then the hardening curve; without one perfectly plastic at the flow stress."""
    rate = rate_of(material)
    curve = material.hardening
    return ShellMaterial(
        density=material.density,
        youngs_modulus=material.youngs_modulus,
        poissons_ratio=material.poissons_ratio,
        yield_stress=material.flow_stress if curve is None else None,
        hardening=None if curve is None else (TABLE_STRAINS, curve.stress(TABLE_STRAINS)),
        rate_reference=np.inf if rate is None else rate.D,
        rate_exponent=1.0 if rate is None else rate.q,
    )


def rate_of(material: Material) -> CowperSymonds | None:
    """Strain-rate law at large strain, else at yield; a logarithmic one as the power law nearest to it."""
    law = material.flow_rate or material.yield_rate
    return law.as_cowper_symonds() if isinstance(law, JohnsonCook) else law


def in_words(material: Material) -> str:
    """What the elements take the metal for."""
    rate = rate_of(material)
    plastic = "along its hardening curve"
    if material.hardening is None:
        plastic = f"perfectly plastic at {material.flow_stress / 1e6:.4g} MPa"
    raised = "" if rate is None else f", raised with the strain rate (D {rate.D:g} 1/s, q {rate.q:g})"
    return f"Material {material.name} is elastic, then {plastic}{raised}."
