"""Band of a formula from the library of tubes: how far its energy is from that of the solved tubes.

With the energies E_F of the formula and E_L of the library up to a rotation, and the band b of the library,
the energy of the tube is expected in E_L (1 -+ b).  The band of the formula is the half-width about E_F that
contains this, the larger one of two rotations (derived here):

    u = max over 10 and 30 deg of max(|E_L (1 + b)/E_F - 1|, |E_L (1 - b)/E_F - 1|)

docs/theory/tube_library.md.
"""

from __future__ import annotations

import math
from dataclasses import replace

from crumple.errors import InputError
from crumple.hinge.energy import absorbed_energy
from crumple.hinge.law import HingeLaw, Validity
from crumple.hinge.tube_library.law import TubeLibraryLaw
from crumple.material import Material
from crumple.section import Axis, Section

COMPARED_AT = (math.radians(10.0), math.radians(30.0))
"""Rotations up to which energies are compared [rad]."""
LARGEST = 0.95
"""Largest band that is stated: the lower bound of a law must be positive."""


def formula_band(law: HingeLaw, section: Section, material: Material, axis: Axis) -> float | None:
    """Relative half-width of the band of a formula [-]; None where the library has no such tube.

    Parameters
    ----------
    law
        Of the formula, for this section, material and axis.
    """
    try:
        library = TubeLibraryLaw.of(section, material, axis)
    except InputError:
        return None
    band = library.validity.uncertainty or 0.0
    shares = [absorbed_energy(library, end) / absorbed_energy(law, end) for end in COMPARED_AT]
    found = max(abs(share * (1.0 + side) - 1.0) for share in shares for side in (-band, band))
    return min(found, LARGEST)


def with_library_band(law: HingeLaw, section: Section, material: Material, axis: Axis) -> Validity:
    """Range of a formula with its band from the library; unchanged where the library has no such tube."""
    own = law.validity
    found = formula_band(law, section, material, axis)
    if found is None:
        return own
    basis = f"{own.basis}; the band is that of its energy against the library of tubes, to 10 and to 30 deg"
    return replace(
        own,
        rotation_max=max(own.rotation_max, COMPARED_AT[-1]),
        basis=basis,
        uncertainty=max(found, own.uncertainty or 0.0),
    )
