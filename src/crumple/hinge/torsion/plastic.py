"""Plastic torque: the walls shear at yield and do not fold.

    T = T_p s(e)/s_y,    e = g/sqrt(3),    g = T_p phi/(l F)

T_p is the largest torque of the section, see `crumple.section.properties.plastic_torsion`, s(e) the hardening
curve of the metal, and g the shear strain of the walls that yield, whose shear forces add up to F = sum of t
L s_y/sqrt(3): twist by phi over the length l works T_p phi = F l g.  A metal without a curve has T = T_p.  An
upper bound of the peak: thin walls buckle in shear and fold.  Limits: one closed cell has Bredt's T_p = 2 A t
s_y/sqrt(3), and of equal walls with the perimeter L g = 2 A phi/(l L).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from crumple.errors import InputError, Problem
from crumple.hinge.law import Source, Trust, Validity
from crumple.hinge.torsion.torque_curve import TorqueCurve
from crumple.material import Material
from crumple.registry.quantity import PositiveMoment
from crumple.section import Section

STRAINS = (0.001, 0.002, 0.004, 0.007, 0.012, 0.02, 0.03, 0.045, 0.065, 0.09, 0.12, 0.16, 0.22, 0.3)
"""Plastic strains between which the torque is straight [-]; a law ends at the last."""
SOURCE = Source(
    "plastic torque of the section",
    Trust.DERIVED,
    "an upper bound; walls that fold in shear carry less",
)
VALIDITY = Validity(
    math.inf,
    "plastic torque, constant over the twist",
    (
        "the torque falls if walls fold in shear: the energy of torsion is overestimated",
        "no strain-rate factor: the strain rate of folds in torsion is not known",
    ),
)


@dataclass(frozen=True)
class PlasticTorsion(TorqueCurve):
    """Torque at yield, the same in both senses; it rises if the metal hardens.

    References
    ----------
    docs/theory/torsion.md.  Verified in tests/unit/hinge/record/test_spatial_recording.py.
    """

    name: ClassVar[str] = "plastic"

    validity: Validity = VALIDITY
    source: Source = SOURCE

    @classmethod
    def of(
        cls, section: Section, material: Material, length: float, *, torque: PositiveMoment | None = None
    ) -> PlasticTorsion:
        """Law of a section twisted over a length.

        Parameters
        ----------
        section, material
            For the plastic torque, its hardening and the elastic stiffness.
        length
            Twisted length [m].
        torque
            Constant torque [N m]; without it the plastic torque of the section, and its hardening.

        Raises
        ------
        InputError
            If the length or the torque is not positive.
        """
        for name, value in (("length", length), ("torque", 1.0 if torque is None else torque)):
            if not (math.isfinite(value) and value > 0.0):
                raise InputError(Problem(f"the {name} must be positive", f"{value:g}", "> 0", "", name))
        stiffness = material.shear_modulus * section.torsion_constant / length
        if torque is not None:
            return cls(torque, torque, elastic_stiffness=stiffness)
        from crumple.section import plastic_interaction  # noqa: PLC0415  (only this case needs walls)

        interaction = plastic_interaction(section, material)
        plastic = float(interaction.plastic_torque)
        if material.hardening is None:
            return cls(plastic, plastic, elastic_stiffness=stiffness)
        strain = np.array((0.0, *STRAINS))
        twist = length * math.sqrt(3.0) * strain * interaction.yielding_shear_force / plastic
        hardened = plastic * material.hardening.stress(strain) / material.yield_stress
        return cls(
            plastic,
            float(hardened[-1]),
            elastic_stiffness=stiffness,
            validity=replace(VALIDITY, basis=f"plastic torque of {1e3 * length:.4g} mm that harden"),
            twist=tuple(twist.tolist()),
            torque=tuple(hardened.tolist()),
        )
