"""Law of a section that is no tube and whose metal hardens: its law at yield times the effect in a tube.

    M(theta) = M_F(theta; s_y) c(theta)

with M_F the formula of the shape, or the estimate where there is none, for a metal that is perfectly plastic
at the yield stress, and c the effect of hardening in the rectangular tube that has the outer size and the
wall of the section (`hardening`).  The product is ours.  Limits: those of `hardening_tube`.
docs/theory/tube_library.md.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import ClassVar, Self

from crumple.errors import InputError, Problem
from crumple.hinge.bending.estimate import automatic_type
from crumple.hinge.bending.profiles.folded_plates import FoldedPlatesLaw
from crumple.hinge.law import Source, Trust
from crumple.hinge.registry import build_law
from crumple.hinge.tube_library.hardening import HardeningEffect, at_yield, hardens
from crumple.hinge.tube_library.hardening_tube import HardeningTubeLaw
from crumple.material import Material
from crumple.section import Axis, CircularTube, RectangularTube, Section

SOURCE = Source(
    "law of the section at yield, times the effect of hardening in the tube of its outer size",
    Trust.ESTIMATED,
    "the product is ours; a law from shells (crumple characterise) replaces it",
)


@dataclass(frozen=True)
class HardeningSectionLaw(HardeningTubeLaw):
    """Law of a section other than a tube whose metal has a hardening curve.

    References
    ----------
    docs/theory/tube_library.md.  Verified in tests/unit/hinge/bending/test_hardening_section.py.
    """

    name: ClassVar[str] = "hardening_section"
    source: ClassVar[Source] = SOURCE

    @classmethod
    def of(cls, section: Section, material: Material, axis: Axis = "y") -> Self:
        """Law of a section.

        Parameters
        ----------
        section
            Any but rectangular and circular tubes.
        material
            With a hardening curve.
        axis
            Axis of bending.

        Raises
        ------
        InputError
            If the section is a tube, or the metal does not harden.
        """
        if isinstance(section, RectangularTube | CircularTube):
            what, allowed = "this law is for sections that are no tubes", "channels, hats and other walls"
            raise InputError(Problem(what, section.kind, allowed, "use hardening_tube or auto", "section"))
        if not hardens(material):
            what, todo = "this law is for metals that harden", "give a hardening curve, or use the law auto"
            raise InputError(Problem(what, material.name, "a hardening curve that rises", todo, "hardening"))
        plain = at_yield(material)
        formula = build_law(automatic_type(section, plain, axis), section, plain, axis)
        own = formula.validity
        basis = f"{own.basis}; its metal hardens as that of the tube around it, an estimate"
        # folding plates that harden were compared with shells, other formulas were not
        compared = isinstance(formula, FoldedPlatesLaw)
        validity = replace(own, uncertainty=own.uncertainty if compared else None, basis=basis)
        return cls(formula, _in_tube_around(section, material, axis), validity)


def _in_tube_around(section: Section, material: Material, axis: Axis) -> HardeningEffect:
    """Effect in the rectangular tube of the same outer size and wall; none without such a tube."""
    width, depth = section.flange_width(axis), section.bending_depth(axis)
    try:
        around = RectangularTube(width, depth, section.thickness)
    except InputError:
        return HardeningEffect()
    return HardeningEffect.of(around, material, "y")
