"""Moment over curvature of a section from first yield to full plasticity, no wall buckling.

Plane sections stay plane: strain = curvature (height - c), with c such that no axial force is left.  The
metal is cut into layers by the lines of equal height; the moment is the sum of stress x height x area.
Limits: M = E I curvature before yield; the plastic moment at large curvature without hardening.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from crumple.material import Material
from crumple.numeric.arrays import Floats
from crumple.numeric.monotone_root import rising_root
from crumple.section.properties.polygons import above
from crumple.section.section import Axis, Section
from crumple.section.wall_section import walls_of
from crumple.section.walled import WalledSection, angle_of

LAYERS = 400
"""The moment errs by some 1e-5: a layer's stress is that at its centre."""
STRAINS = np.concatenate([[0.0], np.geomspace(1e-5, 1.0, 60)])
"""Plastic strains at which a hardening curve is sampled."""


def bending_moment(section: Section, material: Material, axis: Axis | float, curvature: ArrayLike) -> Floats:
    """Moment that a curvature needs.

    Parameters
    ----------
    section
        Tube or section of walls.
    material
        Metal of the walls that name none: elastic, then along its hardening curve, else perfectly plastic at
        its flow stress, as in the shell engine.
    axis
        Direction of the moment vector.
    curvature
        About that axis [1/m], > 0, (n,).

    Returns
    -------
    NDArray
        About the centroid [N m], (n,).

    References
    ----------
    Verified in tests/verification/section/test_bending_curve.py.
    """
    height, area, metals = _layers(walls_of(section), material, angle_of(axis))
    curves = [_stress_over_strain(metal) for metal in metals]

    def stress(kappa: float, middle: float) -> Floats:
        strain = kappa * (height - middle)
        pairs = zip(strain.T, curves, strict=True)
        return np.stack([np.sign(e) * np.interp(np.abs(e), *curve) for e, curve in pairs], axis=1)

    def moment(kappa: float) -> float:
        small = 1e-9 * float(area.sum()) * material.flow_stress
        ends = float(height.min()), float(height.max())
        middle = rising_root(lambda c: -float((stress(kappa, c) * area).sum()), *ends, small)
        return float((stress(kappa, middle) * area * height).sum())

    return np.array([moment(kappa) for kappa in np.asarray(curvature, float)])


def _layers(
    section: WalledSection, material: Material, angle: float
) -> tuple[Floats, Floats, list[Material]]:
    """Height [m] and area [m^2] of every layer of every metal, (LAYERS, metals) each, and the metals."""
    polygons = np.asarray(section.centred_polygons * np.exp(-1j * angle))
    levels = np.linspace(polygons.imag.min(), polygons.imag.max(), LAYERS + 1)
    upper = above(polygons, np.zeros(LAYERS + 1), levels)
    own = section.metals(material)
    metals = list(dict.fromkeys(own))
    which = np.array([[metal == one for one in metals] for metal in own], float)
    area, first_moment = (-np.diff(of @ which, axis=0) for of in (upper.area, upper.height))
    height = np.divide(first_moment, area, out=np.zeros_like(area), where=area > 0.0)
    return height, area, metals


def _stress_over_strain(metal: Material) -> tuple[Floats, Floats]:
    """Strains and stresses of a metal in tension; the last stress goes on."""
    curve = metal.hardening
    flow = np.full(STRAINS.shape, metal.flow_stress) if curve is None else curve.stress(STRAINS)
    return np.append(0.0, flow / metal.youngs_modulus + STRAINS), np.append(0.0, flow)
