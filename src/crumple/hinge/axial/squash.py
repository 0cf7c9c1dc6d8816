"""Peak force of a column of flat walls: squash load, or less if walls buckle first.

Unknown: P, the sum of the wall forces at yield, each reduced to its effective width b_e:

    P = s_y t sum(b_e) f,  b_e = b min(1, (1 - 0.22/lambda)/lambda),    lambda = sqrt(s_y/s_cr)
    s_cr = k pi^2 E/(12 (1 - nu^2)) (t/b)^2,   k = 4 between two corners, 0.43 with one edge free

b runs along the mid-line from corner to corner; f is the rise of the force until the walls fold, 1 without
hardening (`hardened_peak`).  Limits: thick walls squash (lambda <= 0.673); a slender wall
carries t^2 sqrt(k pi^2 E s_y/(12 (1 - nu^2))) whatever its width.  No column buckling.
"""

from __future__ import annotations

import math

from crumple.hinge.axial.hardened_peak import rise
from crumple.material import Material

HELD, FREE = 4.0, 0.43
"""Buckling coefficients of a plate under uniform stress: both long edges held, and one free."""


def effective_width(width: float, thickness: float, material: Material, coefficient: float = HELD) -> float:
    """Width [m] of a wall that carries the yield stress in uniform compression.

    References
    ----------
    Winter's rule as in cold-formed steel codes; standard text, not seen.
    Verified in tests/verification/hinge/test_axial_crushing.py.
    """
    modulus = material.youngs_modulus / (12.0 * (1.0 - material.poissons_ratio**2))
    critical = coefficient * math.pi**2 * modulus * (thickness / width) ** 2
    slenderness = math.sqrt(material.yield_stress / critical)
    return width * min(1.0, (1.0 - 0.22 / slenderness) / slenderness) if slenderness > 0.5 else width


def squash_force(walls: list[tuple[float, float, float]], material: Material, strain: float = 0.0) -> float:
    """Peak force [N] of walls (mid-line width [m], thickness [m], buckling coefficient).

    `strain`: plastic strain at which they fold [-], see `hardened_peak`.
    """
    carried = sum(effective_width(b, t, material, k) * t for b, t, k in walls)
    return material.yield_stress * carried * rise(material, strain)
