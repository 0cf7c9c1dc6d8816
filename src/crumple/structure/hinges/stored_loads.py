"""Stored laws of a hinge under loads other than bending: twist and shortening."""

from __future__ import annotations

from collections.abc import Mapping

from crumple.hinge import HingeLaw
from crumple.hinge.measured.law_file import read_law
from crumple.hinge.measured.place_hash import Load
from crumple.hinge.measured.stored import StoredLaw
from crumple.structure.hinges.corner_laws import across_law, corner_laws, corner_name, out_of_plane_text
from crumple.structure.hinges.corners import Corner
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

    At a corner the law out of its plane, stored or estimated, is also that of the twist of its first member.
    """
    if structure.laws is None:
        return {}
    texts = {load: component_text(structure, place.member, load) for load in stored_loads(place)}
    corner = _corner_of(structure, place)
    if corner is not None and "torsion" in texts:
        member = None if across_law(structure, corner) is not None else texts["torsion"]
        texts["torsion"] = out_of_plane_text(structure, corner) or member
    return {load: text for load, text in texts.items() if text is not None}


def laws_of_loads(structure: StructureParts, place: HingePlace) -> Mapping[Load, StoredLaw]:
    """The same as laws."""
    return {
        load: structure.kept.once("read law", text, lambda text=text: read_law(text))  # type: ignore[misc]
        for load, text in texts_of_loads(structure, place).items()
    }


def twist_law(structure: StructureParts, place: HingePlace) -> HingeLaw | None:
    """Law of a hinge's twist where the input names none: stored, else at a corner the estimate; else None."""
    stored, corner = laws_of_loads(structure, place).get("torsion"), _corner_of(structure, place)
    if stored is not None or corner is None or "torsion" not in stored_loads(place):
        return stored
    return across_law(structure, corner)


def _corner_of(structure: StructureParts, place: HingePlace) -> Corner | None:
    """Corner whose hinge it is."""
    return {corner_name(node): one for node, (one, _) in corner_laws(structure).items()}.get(place.name)
