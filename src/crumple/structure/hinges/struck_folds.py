"""Laws of automatic hinges where an obstacle strikes a tube: the fold that it starts there.

Theory in `crumple.hinge.bending.struck`.
"""

from __future__ import annotations

from crumple.hinge import HingeLaw
from crumple.hinge.bending.struck import StruckLaw, left_in_bending
from crumple.section import CircularTube, RectangularTube
from crumple.structure.hinges.automatic import strike_at
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
    if automatic_law(structure, reference) is None:
        return law
    strike = strike_at(structure, member, name)
    if strike is None:
        return law
    if isinstance(section, RectangularTube):
        return StruckLaw(law)
    moment = float(law.moment_capacity(0.0))
    return StruckLaw(
        law, left_in_bending(moment, section.diameter, section.thickness, strike.spans, strike.held)
    )
