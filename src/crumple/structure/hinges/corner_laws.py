"""Hinges at mitred corners whose law is stored: one at the node, for both members."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from crumple.hinge.measured.law_file import read_law, write_law
from crumple.hinge.measured.library import mirrored
from crumple.structure.bending import planar
from crumple.structure.hinges.asked import automatic_of
from crumple.structure.hinges.corners import Corner, corners
from crumple.structure.hinges.law_choice import automatic_law, stored_text, with_type
from crumple.structure.keys.hinge_axes import AxisLaws
from crumple.structure.keys.law import LawKeys, LawReference
from crumple.structure.keys.member import Hinge
from crumple.structure.parts import StructureParts

ELASTIC = "elastic-plastic"


def corner_laws(structure: StructureParts) -> Mapping[str, tuple[Corner, LawKeys]]:
    """Corners of automatic hinges whose law is stored, by node, with the law of the hinge there."""
    if structure.laws is None:
        return {}
    return structure.kept.once("corner laws", "", lambda: _corner_laws(structure))


def _corner_laws(structure: StructureParts) -> dict[str, tuple[Corner, LawKeys]]:
    found = {}
    for node, corner in corners(structure).items():
        asked = _asked(structure, corner)
        text = None if asked is None else stored_text(structure, corner.place(structure))
        if asked is not None and text is not None:
            own = text if corner.sense > 0 else write_law(mirrored(read_law(text)))
            law = with_type(asked, "file", text=own)
            if planar(structure) and law.form == "set-valued":
                law = law.model_copy(update={"form": ELASTIC})
            found[node] = (corner, law)
    return found


def _asked(structure: StructureParts, corner: Corner) -> LawKeys | None:
    """Automatic law of both members of a corner; None if one of them has hinges or laws of its own."""
    laws = []
    for member in (corner.first, corner.second):
        asked = automatic_of(structure, member)
        if asked is None or asked.laws is not None:
            return None
        law = automatic_law(structure, asked.law)
        about = asked.axes or (asked.axis,)
        if law is None or not (about == (None,) or corner.axis in about):
            return None
        laws.append(law)
    return laws[0] if laws[0] == laws[1] else None


def corner_zones(structure: StructureParts, member: str) -> list[tuple[float, float]]:
    """Stretches of a member in which the hinge of a corner stands for all folds [m]."""
    length = structure.frame_of(member).length
    nodes = structure.members[member].nodes
    zones = {
        node: corner.zone(structure)
        for node, (corner, _) in corner_laws(structure).items()
        if member in (corner.first, corner.second)
    }
    ends = ((0.0, zones.get(nodes[0])), (length, zones.get(nodes[1])))
    return [(end - zone, end + zone) for end, zone in ends if zone is not None]


def corner_name(node: str) -> str:
    """Name of the hinge at a corner."""
    return f"corner-{node}"


def corner_hinges(structure: StructureParts, member: str, keys: Mapping[str, Any]) -> list[Hinge]:
    """Hinges at the corners of which a member is the first.

    Parameters
    ----------
    structure, member
        Where.
    keys
        Axes and laws of the member's other automatic hinges: in space those about other axes are kept.
    """
    nodes, length = structure.members[member].nodes, structure.frame_of(member).length
    found = []
    for node, (corner, law) in corner_laws(structure).items():
        if corner.first != member:
            continue
        if keys["axes"] is None:
            own = {**keys, "axis": corner.axis, "law": law}
        else:
            aside = _out_of_plane(structure, corner, keys["law"])
            rest = {axis: aside for axis in keys["axes"] if axis in ("y", "z")}
            # the first bending axis is the one that is reported
            axes = (corner.axis, *(axis for axis in keys["axes"] if axis != corner.axis))
            own = {**keys, "axes": axes, "law": None, "laws": AxisLaws(**{**rest, corner.axis: law})}
        station = 0.0 if nodes[0] == node else length
        found.append(Hinge.model_construct(name=corner_name(node), at=station, **own))
    return found


def _out_of_plane(
    structure: StructureParts, corner: Corner, asked: LawReference | None
) -> LawReference | None:
    """Law about the other bending axis of a corner's hinge: that out of its plane if it is stored."""
    law, text = automatic_law(structure, asked), out_of_plane_text(structure, corner)
    return asked if law is None or text is None else with_type(law, "file", text=text)


def out_of_plane_text(structure: StructureParts, corner: Corner) -> str | None:
    """Text of the stored law of a corner out of its plane."""
    place = corner.place_out_of_plane(structure)
    return None if place is None else stored_text(structure, place)
