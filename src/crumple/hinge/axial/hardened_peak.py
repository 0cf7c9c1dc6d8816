"""Peak of a column whose metal hardens: its walls strain uniformly until they fold.

Unknown: the plastic strain e at which the force is largest. Walls of metal with the curve s(e) and slope
s'(e) buckle plastically at a strain that grows with thickness and with the exponent of hardening there,

    e = C r^p nu^q,      nu = e s'(e)/s(e)
    flat walls           r = t/b, b between mid-lines:      C = 4.62, p = 1.53, q = 0.327
    round walls          r = t/D, D of the mid-line:        C = 4.06, p = 1.20, q = 0.569

and the force per squash load, of an area that grows as the column shortens, is s(e) exp(e)/s_y.  The form is
that of plastic buckling by deformation theory (p = 2 and q near 0 for flat walls, p = 1 and q = 1/2 for round
ones), the constants are read off columns between rigid ends in shells; docs/theory/axial_crushing.md.

Limits: without hardening e = 0 and the peak is the squash load.  With a yield plateau, s'(0) = 0, the walls
fold on the plateau.  Derived and fitted here.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from crumple.material import Material
from crumple.material.hardening.curve import HardeningCurve
from crumple.numeric.arrays import Floats
from crumple.numeric.monotone_root import rising_root

LARGEST = 0.2
"""Plastic strain up to which a column strains uniformly at most; shells of the thickest walls: 0.1."""
SMALLEST = 1e-6
"""Plastic strain from which the largest force is sought."""
STEPS = 200
POINTS = 6
"""Straight pieces of the rise of the force."""


@dataclass(frozen=True)
class Walls:
    """Constants C, p, q of a kind of walls."""

    factor: float
    thickness: float
    hardening: float

    def strain(self, material: Material, ratio: float) -> float:
        """Plastic strain at the largest force.

        Parameters
        ----------
        material
            Its hardening curve; without one the strain is 0.
        ratio
            Thickness over width or diameter of the mid-line [-].

        References
        ----------
        Derived above.  Verified in tests/verification/hinge/test_axial_crushing.py.
        """
        curve = material.hardening
        if curve is None:
            return 0.0

        def ahead(strain: float) -> float:
            exponent = strain * float(curve.slope(strain)) / float(curve.stress(strain))
            return float(strain - self.factor * ratio**self.thickness * exponent**self.hardening)

        places = np.geomspace(SMALLEST, LARGEST, STEPS)
        beyond = next((k for k, place in enumerate(places) if ahead(place) >= 0.0), None)
        if beyond is None:
            return LARGEST
        return 0.0 if beyond == 0 else rising_root(ahead, places[beyond - 1], places[beyond], 1e-9)


FLAT, ROUND = Walls(4.62, 1.53, 0.327), Walls(4.06, 1.20, 0.569)


def rise(material: Material, strain: float) -> float:
    """Force over squash load [-] of a column shortened uniformly by a plastic strain."""
    curve = material.hardening
    return 1.0 if curve is None else float(curve.stress(strain) * np.exp(strain)) / material.yield_stress


def strain_at(material: Material, force: float) -> float:
    """Plastic strain [-] at which a column carries a multiple of its squash load; at most `LARGEST`."""
    if material.hardening is None or force <= 1.0:
        return 0.0
    if force >= rise(material, LARGEST):
        return LARGEST
    return rising_root(lambda strain: rise(material, strain) - force, 0.0, LARGEST, 1e-9)


def necking_strain(curve: HardeningCurve) -> float:
    """Plastic strain at which a bar in tension necks, where the slope falls to the stress; at most `LARGEST`.

    References
    ----------
    Considere's condition, as in `crumple.material.hardening.swift`.
    """
    places = np.geomspace(SMALLEST, LARGEST, STEPS)
    below = np.flatnonzero(curve.slope(places) <= curve.stress(places))
    return float(places[below[0]]) if below.size else LARGEST


def uniform_yield(curve: HardeningCurve, strain: float, sense: int) -> tuple[Floats, Floats]:
    """Plastic strains [-] up to a strain, and the force there over that at its end [-]; nothing up to 0.

    Parameters
    ----------
    curve, strain
        Hardening, and where the uniform yield ends.
    sense
        1: tension, whose area shrinks; -1: compression.
    """
    if strain <= SMALLEST:
        return np.zeros(0), np.zeros(0)
    places = strain * np.linspace(0.0, 1.0, POINTS + 1) ** 2
    force = curve.stress(places) * np.exp(-sense * places)
    return places, np.asarray(force / force[-1])
