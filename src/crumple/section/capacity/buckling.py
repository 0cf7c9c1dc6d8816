"""How much of a plate under compression still carries at yield: effective widths.

Plate of width b, thickness t, compression f1 at its more compressed edge, f2 at the other, psi = f2/f1:

    f_cr   = k pi^2 E/(12 (1 - nu^2)) (t/b)^2,   lambda = sqrt(f1/f_cr)
    held at both edges:     k = 4 + 2 (1 - psi)^3 + 2 (1 - psi)           (4 at psi = 1, 24 at psi = -1)
    b_e = b for lambda <= 0.673, else b (1 - 0.22/lambda)/lambda
    b_e1 = b_e/(3 - psi) beside f1;  b_e2 = b_e/2 for psi <= -0.236, else b_e - b_e1, beside the neutral axis
                                     or the other edge; nothing is left out where they meet

The step of b_e2 at psi = -0.236 is bridged linearly down to -0.336, so that capacities are continuous.

    free at one edge:       most compressed at the free edge    k = 0.57 - 0.21 psi + 0.07 psi^2
                            at the held edge, psi >= 0           k = 0.578/(psi + 0.34) - 0.0013 psi
                                              psi < 0            k = 1.7 - 5 psi + 17.1 psi^2
                            the part b_e/b of the compressed width stays, beside the held edge

Limits: psi = 1 gives 4 and 0.43; a plate in tension keeps all.  Below psi = -1 (held) or -3 (free edge in
compression: none needed) the value at that end stays, on the safe side.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from crumple.material import Material

# Slenderness up to which a plate carries yield over its whole width; root of (1 - 0.22/x)/x = 1.
FULL = 0.5 + math.sqrt(0.25 - 0.22)

# psi where the standard's rule steps, and how far the bridge reaches: chosen here, short against the range
# of psi.
_STEP, _BRIDGE = -0.236, 0.1


class Carried(NamedTuple):
    """What buckling leaves of a plate.

    ``ratio`` buckling stress over the largest compression (infinite in tension); the plate carries nothing
    between the distances ``start`` and ``end`` [m] from its first edge, equal where it carries all over.
    """

    ratio: float
    start: float
    end: float


def held_coefficient(psi: float) -> float:
    """Buckling coefficient of a plate held at both edges; psi in (-inf, 1]."""
    psi = max(psi, -1.0)
    return 4.0 + 2.0 * (1.0 - psi) ** 3 + 2.0 * (1.0 - psi)


def outstand_coefficient(psi: float, *, at_free_edge: bool) -> float:
    """Buckling coefficient of a plate with one free edge; psi = f2/f1, f1 the larger compression."""
    if at_free_edge:
        psi = max(psi, -3.0)
        return 0.57 - 0.21 * psi + 0.07 * psi * psi
    psi = max(psi, -1.0)
    # the small term, added here, joins the two rules of the standard at psi = 1
    joined = 0.578 / 1.34 - 0.43
    return 0.578 / (psi + 0.34) - joined * psi if psi >= 0.0 else 1.7 - 5.0 * psi + 17.1 * psi * psi


def plate_stress(coefficient: float, width: float, thickness: float, material: Material) -> float:
    """Elastic buckling stress of a plate [Pa]."""
    stiffness = math.pi**2 * material.youngs_modulus / (12.0 * (1.0 - material.poissons_ratio**2))
    return coefficient * stiffness * (thickness / width) ** 2


def width_factor(ratio: float) -> float:
    """b_e/b for a buckling stress over compression of ``ratio``."""
    slenderness = 1.0 / math.sqrt(ratio)
    return 1.0 if slenderness <= FULL else (1.0 - 0.22 / slenderness) / slenderness


def held_plate(width: float, thickness: float, first: float, last: float, material: Material) -> Carried:
    """Plate held at both edges.

    Parameters
    ----------
    width, thickness
        [m]
    first, last
        Compression at its two edges [Pa], negative in tension.
    material
        Elastic moduli are used.
    """
    if max(first, last) <= 0.0:
        return Carried(math.inf, 0.0, 0.0)
    if last > first:
        turned = held_plate(width, thickness, last, first, material)
        return Carried(turned.ratio, width - turned.end, width - turned.start)
    psi = last / first
    ratio = plate_stress(held_coefficient(psi), width, thickness, material) / first
    effective = width * width_factor(ratio)
    near = effective / (3.0 - psi)
    share = min(max((_STEP - psi) / _BRIDGE, 0.0), 1.0)
    far = (1.0 - share) * (effective - near) + share * effective / 2.0
    compressed = width if psi >= 0.0 else width / (1.0 - psi)
    if effective == width or near + far >= compressed:
        return Carried(ratio, 0.0, 0.0)
    return Carried(ratio, near, compressed - far)


def outstand(width: float, thickness: float, held: float, free: float, material: Material) -> Carried:
    """Plate with one free edge; compression at the held and at the free edge [Pa]."""
    if max(held, free) <= 0.0:
        return Carried(math.inf, 0.0, 0.0)
    at_free = free > held
    larger, smaller = (free, held) if at_free else (held, free)
    psi = smaller / larger
    coefficient = outstand_coefficient(psi, at_free_edge=at_free)
    ratio = plate_stress(coefficient, width, thickness, material) / larger
    lost = 1.0 - width_factor(ratio)
    if psi >= 0.0:
        return Carried(ratio, width * (1.0 - lost), width)
    compressed = width / (1.0 - psi)
    if at_free:
        return Carried(ratio, width - lost * compressed, width)
    return Carried(ratio, (1.0 - lost) * compressed, compressed)
