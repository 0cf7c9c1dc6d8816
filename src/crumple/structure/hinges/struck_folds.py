"""Tubes that obstacles strike between their ends: laws of their folds there, and dents of their walls.

Theory in `crumple.hinge.bending.struck`.
"""

from __future__ import annotations

from collections.abc import Mapping

from crumple.hinge import HingeLaw
from crumple.hinge.bending.struck import Dent, StruckLaw, dent_of, left_in_bending
from crumple.section import CircularTube, RectangularTube
from crumple.structure.hinges.automatic import strikes_on
from crumple.structure.hinges.law_choice import automatic_law
from crumple.structure.keys.law import LawReference
from crumple.structure.parts import StructureParts


def with_strike(
    structure: StructureParts, member: str, name: str, reference: LawReference | None, law: HingeLaw
) -> HingeLaw:
    """Law of a hinge, changed if it is an automatic one of a tube where an obstacle strikes.

    Parameters
    ----------
    structure, member, name
        The hinge.
    reference, law
        What the input says of its law, which it may name itself; and the law.
    """
    section = structure.section_of(member)
    if not structure.obstacles or not isinstance(section, CircularTube | RectangularTube):
        return law
    strike = strikes_on(structure, member).get(name)
    if strike is None or automatic_law(structure, reference) is None:
        return law
    if isinstance(section, RectangularTube):
        return StruckLaw(law)
    moment = float(law.moment_capacity(0.0))
    return StruckLaw(
        law, left_in_bending(moment, section.diameter, section.thickness, strike.spans, strike.held)
    )


def dents(structure: StructureParts, obstacle: str) -> Mapping[str, Dent]:
    """Members whose wall an obstacle dents, and how: tubes that it strikes at an automatic hinge."""
    return {
        member: dent_of(section, structure.material_of(member))
        for member in structure.members
        if structure.has_line(member)
        and isinstance(section := structure.section_of(member), CircularTube | RectangularTube)
        and any(obstacle in strike.obstacles for strike in strikes_on(structure, member).values())
    }
