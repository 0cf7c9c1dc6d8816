"""Stored laws of a hinge under loads other than bending: twist and shortening."""

from __future__ import annotations

from collections.abc import Mapping

from crumple.hinge import HingeLaw
from crumple.hinge.measured.law_file import read_law
from crumple.hinge.measured.place_hash import Load
from crumple.hinge.measured.stored import StoredLaw
from crumple.structure.hinges.corner.across import estimate_across, text_across
from crumple.structure.hinges.corner_laws import turned_corner
from crumple.structure.hinges.law_choice import component_text
from crumple.structure.hinges.places import HingePlace
from crumple.structure.parts import StructureParts


def stored_loads(place: HingePlace) -> tuple[Load, ...]:
    """Loads besides bending for which a hinge uses a stored law if there is one: it names no law for them."""
    keys = place.keys
    twists = "x" in (keys.axes or ()) and keys.twist is None
    shortens = keys.axial is not None and keys.axial.yields
    return (*(("torsion",) if twists else ()), *(("crush",) if shortens else ()))


def texts_of_loads(structure: StructureParts, place: HingePlace) -> Mapping[Load, str]:
    """Text of the stored law for each of these loads that has one.

    The twist of a corner's hinge is about the corner's tangent, if it has the axes of the corner.
    """
    if structure.laws is None:
        return {}
    texts = {load: component_text(structure, place.member, load) for load in stored_loads(place)}
    corner = turned_corner(structure, place.name, place.keys.axes)
    if corner is not None and "torsion" in texts:
        member = None if estimate_across(structure, corner, "tangent") is not None else texts["torsion"]
        texts["torsion"] = text_across(structure, corner, "tangent") or member
    return {load: text for load, text in texts.items() if text is not None}


def laws_of_loads(structure: StructureParts, place: HingePlace) -> Mapping[Load, StoredLaw]:
    """The same as laws."""
    return {
        load: structure.kept.once("read law", text, lambda text=text: read_law(text))  # type: ignore[misc]
        for load, text in texts_of_loads(structure, place).items()
    }


def twist_law(structure: StructureParts, place: HingePlace) -> HingeLaw | None:
    """Law of a hinge's twist where the input names none: stored, else at a corner the estimate; else None."""
    stored = laws_of_loads(structure, place).get("torsion")
    if stored is not None or "torsion" not in stored_loads(place):
        return stored
    corner = turned_corner(structure, place.name, place.keys.axes)
    return None if corner is None else estimate_across(structure, corner, "tangent")
