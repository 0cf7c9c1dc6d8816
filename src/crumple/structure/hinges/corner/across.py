"""Laws of a mitred corner out of its plane, about its bisector and its tangent: stored, or estimated.

These are the principal directions of the corner (docs/theory/mitred_corner.md), so its hinge has them for its
axes in place of those of its first member.
"""

from __future__ import annotations

from collections.abc import Iterable

from crumple.errors import InputError
from crumple.hinge import HingeLaw, build_law
from crumple.hinge.measured.place_hash import DIRECTIONS, Direction
from crumple.structure.hinges.corners import Corner
from crumple.structure.hinges.law_choice import stored_text, with_type
from crumple.structure.keys.law import LawKeys
from crumple.structure.parts import StructureParts

ACROSS = "mitred_corner_across"


def text_across(structure: StructureParts, corner: Corner, about: Direction) -> str | None:
    """Text of the stored law of a corner about one of its directions."""
    return stored_text(structure, corner.place_out_of_plane(structure, about))


def estimate_across(structure: StructureParts, corner: Corner, about: Direction) -> HingeLaw | None:
    """Estimate of a corner about one of its directions; None where there is none for its section or angle."""
    metal = structure.section_of(corner.first), structure.material_of(corner.first)
    try:
        return build_law(ACROSS, *metal, corner.across, angle=corner.angle, about=about)
    except InputError:
        return None


def is_turned(structure: StructureParts, corner: Corner, axes: Iterable[str] | None) -> bool:
    """Whether the hinge of a corner has the corner's axes: there is a law about one, and it turns about all.

    A round tube has no axis of its own that would be normal to the corner's plane, so its hinge has them too.

    Parameters
    ----------
    structure, corner
        Where.
    axes
        Section axes that the hinge turns about.
    """
    if {*(axes or ())} != {"x", "y", "z"}:
        return False
    return corner.is_round(structure) or any(
        text_across(structure, corner, about) is not None
        or estimate_across(structure, corner, about) is not None
        for about in DIRECTIONS
    )


def bisector_law(structure: StructureParts, corner: Corner, asked: LawKeys) -> LawKeys | None:
    """Law about the bisector, with the keys that the input asks for; None: that of the member in bending."""
    text = text_across(structure, corner, "bisector")
    if text is not None:
        return with_type(asked, "file", text=text)
    if estimate_across(structure, corner, "bisector") is None:
        return None
    return with_type(asked, ACROSS, angle=corner.angle, about="bisector")
