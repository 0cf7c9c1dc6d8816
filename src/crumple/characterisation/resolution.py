"""How finely and how slowly a sub-model is solved.

With mass m, length L, end rotation theta and plastic moment M_p, the kinetic energy near the middle of the
turn goes with m L^2 (theta/T)^2 and the plastic work with M_p theta.  So with the time of a turn by half a
sine wave

    T = slowness sqrt(m L^2 theta/M_p)

the share of kinetic energy depends on `slowness` alone.  At a mitre some elements are much smaller
than the others; added mass lets them have nearly the time step of the others.
docs/theory/characterisation.md.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from crumple.material import Material
from crumple.section import Axis, Section, half_fold_length

SCALED_STEP = 0.8
"""Least time step of corners over that in which sound passes an element of the nominal size [-]."""


@dataclass(frozen=True)
class Resolution:
    """Fineness of the mesh and slowness of the turn.

    Attributes
    ----------
    elements
        Elements along half a fold.
    slowness
        Time of a turn by half a sine wave over sqrt(m L^2 theta/M_p).
    """

    elements: float = 8.0
    slowness: float = 7.0

    def element_size(self, section: Section, axis: Axis) -> float:
        """Length of the elements [m]."""
        return half_fold_length(section, axis) / self.elements

    def duration(
        self, section: Section, material: Material, axis: Axis, length: float, rotation: float
    ) -> float:
        """Time in which half a sine wave turns a piece of a length [m] by an end rotation [rad]: T [s]."""
        mass = section.mass_per_length(material.density) * length
        moment = material.yield_stress * section.plastic_section_modulus(axis)
        return self.slowness * math.sqrt(mass * length**2 * rotation / moment)


NOMINAL = Resolution()


def scaled_step(size: float, material: Material) -> float:
    """Time step below which elements at a corner get more mass [s].

    Parameters
    ----------
    size
        Length of the elements away from the corner [m].
    material
        Young's modulus and density.

    References
    ----------
    docs/theory/characterisation.md, whose table has what the added mass changes.
    """
    return SCALED_STEP * size * math.sqrt(material.density / material.youngs_modulus)
