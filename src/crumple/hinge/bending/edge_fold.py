"""How rectangular tubes soften that bend about both axes of their section.

Unknown: the rotation at which the capacities C_y and C_z about the two axes stand after plastic rotations e_y
and e_z.  With the works W_y = C_y(0) e_y, W_z = C_z(0) e_z of both axes and the work D_0 of the section,
capacity C_y stands at the rotation s_y/C_y(0),

    s_y = k D_0 sqrt(W_y^2 + (c C_y(0) e_z)^2)/sqrt(W_y^2 + W_z^2),
    k = 1 - r q^4,    q = 2 W_y W_z/(W_y^2 + W_z^2)

and C_z alike.  c = 1/2: each axis folds its own pair of walls.  About a diagonal an edge is compressed, which
resists longer than the flanges that fold about an axis: the more, the thinner the walls,

    r = 0.7 p^2/(1 + (t/(0.033 a))^3),    p = short/long side,  a = mean side, both of the mid-line.

Limits: about one axis (q = 0) the law of that axis; thick walls r -> 0, and flat sections r -> 0, whose
diagonal is nearly the axis of their stronger pair of walls.
"""

from __future__ import annotations

from crumple.section import RectangularTube

CROSSED = 0.5
"""Weight of a rotation about one axis of a rectangular tube where it softens the moment about the other."""
THIN = 0.7
"""Share of the measure of a thin square tube that does not soften it about its diagonal: r for t -> 0."""
SLENDERNESS = 0.033
"""Wall over mean side at which half of this is left."""
BESIDE_A_CLAMP = 0.5
"""What is left of it beside a clamp or joint, read off seven tubes that shells bend there."""
EVENNESS = 4
"""Power of q; even, so that the sense of a rotation does not matter."""


def edge_relief(section: RectangularTube) -> float:
    """Share r of the measure that does not soften a tube bent about its diagonal [-].

    References
    ----------
    docs/theory/spatial_hinge.md; constants fitted there to shells.  Verified in
    tests/verification/characterisation/test_oblique_folds.py.
    """
    sides = section.width - section.thickness, section.depth - section.thickness
    slender = 2.0 * section.thickness / sum(sides) / SLENDERNESS
    return THIN * (min(sides) / max(sides)) ** 2 / (1.0 + slender**3)
