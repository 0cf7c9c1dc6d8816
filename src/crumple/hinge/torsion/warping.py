"""Torque of open walls: their own twist and their warping, side by side.

With the span L between the ends of the member, m = L sqrt(G J/(E I_w)), and the torques T_s of the walls in
themselves (Saint-Venant) and T_w of the warping that ends hold,

    k = G J/L / (1 - f),   f = tanh(m/2)/(m/2) both ends held,  tanh(m)/m one,  0 none     (Vlasov)
    T_w = 2 B_p/L, B_p/L, 0;     T(phi) = min(G J/L phi, T_s) + min((k - G J/L) phi, T_w)

B_p is the plastic bimoment, see `crumple.section.properties.plastic_bimoment`.  A hinge that stands for the
length l of the member has l/L of its twist.  Limits: long members have G J/L and T_s, short ones 12 E I_w/L^3
(one end held: 3) and 2 B_p/L, as two flanges in sway.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar, Literal

from crumple.errors import InputError, Problem
from crumple.hinge.law import Source, Trust, Validity
from crumple.hinge.torsion.torque_curve import TorqueCurve
from crumple.material import Material
from crumple.registry.quantity import PositiveLength
from crumple.section import Section

HeldEnds = Literal["both", "one", "none"]
"""Ends of a member that cannot warp."""
SOURCE = Source(
    "Vlasov's torsion and plastic bimoment of the section",
    Trust.DERIVED,
    "from the yield stress; walls that buckle carry less",
)
VALIDITY = Validity(
    math.inf,
    "plastic torque and plastic bimoment",
    ("the torque falls if walls buckle: the energy of torsion is overestimated",),
)


@dataclass(frozen=True)
class WarpingTorsion(TorqueCurve):
    """Torque of open walls whose ends hold warping, the same in both senses; the metal does not harden.

    Attributes
    ----------
    initial_torque, steady_torque
        At which the first of both parts yields, and both [N m].

    References
    ----------
    docs/theory/torsion.md.  Verified in tests/verification/hinge/test_torsion_collapse.py.
    """

    name: ClassVar[str] = "warping"

    validity: Validity = VALIDITY
    source: Source = SOURCE

    @classmethod
    def of(
        cls,
        section: Section,
        material: Material,
        length: float,
        *,
        span: PositiveLength | None = None,
        held_ends: HeldEnds | None = None,
    ) -> WarpingTorsion:
        """Law of a section without cells.

        Parameters
        ----------
        section, material
            For stiffness, plastic torque and plastic bimoment.
        length
            Length that the law stands for [m].
        span
            Length of the member between its ends [m]; without it that of the hinge's member.
        held_ends
            Ends of the member that cannot warp; without it those with a support, mass, load or other member.

        Raises
        ------
        InputError
            If the section has a cell, or a length is not positive.
        """
        span = length if span is None else span
        for name, value in (("length", length), ("span", span)):
            if not (math.isfinite(value) and value > 0.0):
                raise InputError(Problem(f"the {name} must be positive", f"{value:g}", "> 0", "", name))
        from crumple.section import plastic_interaction, walls_of  # noqa: PLC0415  (needs walls)
        from crumple.section.properties.plastic_bimoment import plastic_bimoment  # noqa: PLC0415

        walls = walls_of(section)
        if walls.skeleton.cells:
            what, todo = "the law warping is for open walls", "name the law 'plastic'"
            raise InputError(Problem(what, section.title, "a section without cells", todo))
        interaction = plastic_interaction(section, material)
        held = ("none", "one", "both").index(held_ends or "both")
        bimoment = plastic_bimoment(walls.skeleton, interaction.yields)
        own, warping = float(interaction.plastic_torque), held * bimoment / span
        uniform = material.shear_modulus * walls.torsion_constant / span
        warped = material.youngs_modulus * walls.warping_constant / span
        stiffness = uniform / (1.0 - _share_that_warps(span * math.sqrt(uniform / warped), held))
        twists = [own / uniform, warping / (stiffness - uniform) if held else own / uniform]
        first, last = min(twists), max(twists)
        start, end = stiffness * first, own + warping
        return cls(
            min(start, end),
            end,
            elastic_stiffness=stiffness * span / length,
            twist=(0.0, max(last - end / stiffness, 0.0) * length / span) if held else (),
            torque=(min(start, end), end) if held else (),
        )


def _share_that_warps(size: float, held: int) -> float:
    """The f of the module for m and the number of held ends; 1 - f is that of a beam in sway as m falls."""
    if held == 0:
        return 0.0
    size /= held
    return math.tanh(size) / size
