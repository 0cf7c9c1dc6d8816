"""A metal as the shell elements take it."""

from __future__ import annotations

import numpy as np

from crumple._core.shell.simulation import ShellMaterial
from crumple.material import CowperSymonds, HardeningCurve, JohnsonCook, Material
from crumple.numeric.arrays import Floats

TABLE_STRAINS = np.concatenate([[0.0], np.geomspace(1e-4, 3.0, 80)])
"""Plastic strains at which a hardening curve is sampled: 14 % apart, so that straight lines between err by
less than 0.1 % of a Swift curve; constant beyond the last, which no sheet reaches."""


def shell_material(material: Material) -> ShellMaterial:
    """Elastic, then the hardening curve; without one perfectly plastic at the flow stress."""
    law = material.flow_rate or material.yield_rate
    power = law if isinstance(law, CowperSymonds) else None
    logarithm = law if isinstance(law, JohnsonCook) and law.C > 0.0 else None
    curve = material.hardening
    return ShellMaterial(
        density=material.density,
        youngs_modulus=material.youngs_modulus,
        poissons_ratio=material.poissons_ratio,
        yield_stress=material.flow_stress if curve is None else None,
        hardening=None if curve is None else _table(curve),
        rate_reference=power.D if power else (logarithm.reference if logarithm else np.inf),
        rate_exponent=power.q if power else 1.0,
        rate_logarithm=logarithm.C if logarithm else 0.0,
        failure_strain=np.inf if material.failure_strain is None else material.failure_strain,
    )


def _table(curve: HardeningCurve) -> tuple[Floats, Floats]:
    """Points that the elements join by straight lines: the curve's own, else samples."""
    strains = np.array(curve.kinks) if curve.kinks else TABLE_STRAINS
    return strains, curve.stress(strains)


def in_words(material: Material) -> str:
    """Description of the metal as the elements use it."""
    law = material.flow_rate or material.yield_rate
    plastic = "along its hardening curve"
    if material.hardening is None:
        plastic = f"perfectly plastic at {material.flow_stress / 1e6:.4g} MPa"
    raised = ""
    if isinstance(law, CowperSymonds):
        raised = f", raised with the strain rate (Cowper-Symonds, D {law.D:g} 1/s, q {law.q:g})"
    elif law is not None:
        raised = f", raised with the strain rate (Johnson-Cook, C {law.C:g} from {law.reference:g} 1/s)"
    torn = (
        ""
        if material.failure_strain is None
        else f"; elements are deleted at a plastic strain of {material.failure_strain:g}"
    )
    return f"Material {material.name} is elastic, then {plastic}{raised}{torn}."
