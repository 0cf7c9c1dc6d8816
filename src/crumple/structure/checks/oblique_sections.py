"""Members that bend about axes of their section that are not principal, which hinges and elastic members do.

Hinges and joints turn about the section's own axes y and z, each with its own stiffness and law.  A moment M
about y then gives the curvature M/(E I_y) alone.  With a product moment I_yz the curvature is

    M I_z/(E (I_y I_z - I_yz^2)) about y    and    M I_yz/(E (I_y I_z - I_yz^2)) about z

(unsymmetric bending, in any text on strength of materials).  Shells have both.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

from crumple.section.walled import WalledSection
from crumple.structure.checks.unusual import Unusual
from crumple.structure.hinges.hinges import plastic_hinges
from crumple.structure.parts import StructureParts
from crumple.text.names import listed

ASIDE = math.radians(5.0)
"""Direction of a deflection off that of the load [rad], above which a caution is given."""


def oblique_sections(structure: StructureParts) -> Iterator[Unusual]:
    """One caution for each section with such axes, of members that bend or fold.

    Parameters
    ----------
    structure
        With elastic members as they are solved.
    """
    hinged = {hinge.member for hinge in plastic_hinges(structure)}
    users: dict[str, list[str]] = {}
    for name, member in structure.members.items():
        if member.elastic or name in hinged:
            users.setdefault(member.section, []).append(name)
    for section, members in users.items():
        shape = structure.section_of(members[0])
        if not isinstance(shape, WalledSection):
            continue
        found = shape.properties
        smaller = min(found.second_moment_y, found.second_moment_z)
        aside = math.atan2(abs(found.product_moment), smaller)
        if aside > ASIDE:
            both = found.second_moment_y * found.second_moment_z
            softer, angle = both / (both - found.product_moment**2), math.degrees(found.principal_angle)
            text = (
                f"The axes y and z of section {section} ({listed(members)}) are not its principal axes, "
                f"which lie at {angle:.3g} deg to them. Hinges and elastic members bend about y and z apart "
                f"here; such a member bends {softer:.3g} times as far, and up to "
                f"{math.degrees(aside):.3g} deg aside of its load. Shells have both."
            )
            yield Unusual(f"section {section}", aside, ASIDE, "rad", text, "oblique_section")
