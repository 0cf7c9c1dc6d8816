"""Hinges at mitred corners: one at the node, for both members, with the stored law or the estimate."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from crumple.errors import InputError
from crumple.hinge import build_law
from crumple.hinge.measured.law_file import read_law, write_law
from crumple.hinge.measured.library import mirrored
from crumple.structure.bending import planar
from crumple.structure.hinges.asked import any_automatic, automatic_of
from crumple.structure.hinges.corner.across import bisector_law, is_turned
from crumple.structure.hinges.corners import Corner, Lacks, corners, lacking
from crumple.structure.hinges.law_choice import automatic_law, folding_slip, stored_text, with_type
from crumple.structure.hinges.lengthening.stopped import presses
from crumple.structure.keys.hinge_axes import AxisLaws
from crumple.structure.keys.law import LawKeys, LawReference
from crumple.structure.keys.member import Hinge
from crumple.structure.parts import StructureParts
from crumple.text.names import listed

APART = "and fold outside of the joint by their own laws"
FOLDS = f"members are joined rigidly there {APART}, whereas in shells the mitre may fold at a smaller moment"
WITHOUT: Mapping[Lacks, tuple[str, str]] = {
    Lacks.ANGLE: ("the angle is above 100 deg", f"members are joined rigidly there, as in shells, {APART}"),
    Lacks.SECTION: (
        "the sections of the members differ",
        f"members are joined rigidly there, as in shells whose walls do not meet, {APART}",
    ),
    Lacks.METAL: ("the materials of the members differ", FOLDS),
}
"""Why corners have no law of their own, and what is there instead."""
ELASTIC, MITRED = "elastic-plastic", "mitred_corner"


def corner_laws(structure: StructureParts) -> Mapping[str, tuple[Corner, LawKeys]]:
    """Corners of automatic hinges with a law, stored or estimated, by node, and that law."""
    return structure.kept.once("corner laws", "", lambda: _corner_laws(structure))


def _corner_laws(structure: StructureParts) -> dict[str, tuple[Corner, LawKeys]]:
    found: dict[str, tuple[Corner, LawKeys]] = {}
    if not any(automatic_of(structure, member) for member in structure.members):
        return found
    for node, corner in corners(structure).items():
        asked = _asked(structure, corner)
        if asked is None:
            continue
        text = stored_text(structure, corner.place(structure))
        law = (
            _estimated(structure, corner, asked) if text is None else _stored(structure, corner, asked, text)
        )
        if law is not None:
            found[node] = (corner, law)
    return found


def corners_without_law(structure: StructureParts) -> list[str]:
    """Sentences on corners of automatic hinges that have no law of their own, alike ones together."""
    alike: dict[tuple[str, str], list[str]] = {}
    if not any_automatic(structure):
        return []
    for node, (lacks, reason) in lacking(structure).items():
        if lacks is not Lacks.INTENDED and all(_wants(structure, one) for one in structure.members_at[node]):
            alike.setdefault(WITHOUT.get(lacks, (reason, FOLDS)), []).append(node)
    having = corner_laws(structure)
    for node, corner in corners(structure).items():
        if node not in having and _asked(structure, corner) is not None:
            why = f"no formula has mitres of {structure.section_of(corner.first).kind} sections"
            if not _about_normal(structure, corner):
                why = "hinges do not turn about all axes ('axes: [y, z, x]')"
            then = (
                "hinges there have the law of their members, whereas the mitre may fold at a smaller moment"
            )
            alike.setdefault((why, then), []).append(node)
    return [
        f"Corner {nodes[0]} has no law of its own, since {why}: {then}."
        if len(nodes) == 1
        else f"Corners {listed(nodes)} have no laws of their own, since {why}: {then}."
        for (why, then), nodes in alike.items()
    ]


def _wants(structure: StructureParts, member: str) -> bool:
    """Whether a member has automatic hinges whose laws are not given."""
    asked = automatic_of(structure, member)
    return asked is not None and asked.laws is None and automatic_law(structure, asked.law) is not None


def _stored(structure: StructureParts, corner: Corner, asked: LawKeys, text: str) -> LawKeys:
    """Stored law of a corner; in a plane with the spring of its walls.

    That of a turned section is of rotations about the section's axis in this position.
    """
    own = text if corner.sense > 0 or corner.turned else write_law(mirrored(read_law(text)))
    law = with_type(asked, "file", text=own)
    if planar(structure) and law.form == "set-valued":
        law = law.model_copy(update={"form": ELASTIC})
    return law


def _estimated(structure: StructureParts, corner: Corner, asked: LawKeys) -> LawKeys | None:
    """Estimate of a corner without a stored law; None where there is none for its section or angle.

    Nor for a hinge that cannot turn about the normal of the corner's plane.
    """
    if not _about_normal(structure, corner):
        return None
    section, material = structure.section_of(corner.first), structure.material_of(corner.first)
    own = {"angle": corner.angle, "closing": "positive" if corner.sense > 0 else "negative"}
    try:
        build_law(MITRED, section, material, corner.axis, **own)
    except InputError:
        return None
    return with_type(asked, MITRED, **own)


def _about_normal(structure: StructureParts, corner: Corner) -> bool:
    """Whether the corner's hinge turns about the normal of its plane."""
    asked = automatic_of(structure, corner.first)
    if asked is None or corner.is_about(structure):
        return asked is not None
    if asked.axes is None:
        # in space hinges turn about all axes unless one is named
        return asked.axis is None or planar(structure)
    return {"x", "y", "z"} <= {*asked.axes}


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
            own = {**keys, "axis": corner.axis, "law": law, **_shortening(structure, corner, keys, law)}
        else:
            turned = is_turned(structure, corner, keys["axes"])
            aside = _out_of_plane(structure, corner, keys["law"]) if turned else keys["law"]
            rest = {axis: aside for axis in keys["axes"] if axis in ("y", "z")}
            # the first bending axis is the one that is reported
            axes = (corner.axis, *(axis for axis in keys["axes"] if axis != corner.axis))
            own = {**keys, "axes": axes, "law": None, "laws": AxisLaws(**{**rest, corner.axis: law})}
            own |= {"coupling": keys["coupling"] or "ellipsoid"} if turned else {}
            if turned and presses(structure) and _shortening(structure, corner, keys, law):
                own["axial"] = keys["axial"] or folding_slip(structure, corner.first)
        station = 0.0 if nodes[0] == node else length
        found.append(Hinge.model_construct(name=corner_name(node), at=station, **own))
    return found


def _shortening(
    structure: StructureParts, corner: Corner, keys: Mapping[str, Any], law: LawKeys
) -> dict[str, Any]:
    """Slip at a corner of elastic members in a plane that obstacles may press: compression folds it too.

    Without obstacles axial forces are small, and the planar kernel, which has no slip, solves the model. The
    shortening of round tubes and hats is not known. The input may say `axial: false` or another coupling; the
    regularised form cannot slip.
    """
    members = [structure.members[name] for name in (corner.first, corner.second)]
    asked = automatic_of(structure, corner.first)
    declined = asked is not None and asked.axial is None and "axial" in asked.model_fields_set
    known = structure.section_of(corner.first).kind == "rectangular_tube" and law.form != "regularised"
    able = structure.obstacles and all(member.elastic for member in members) and known
    if declined or not able or keys["coupling"] is not None:
        return {}
    return {"axial": keys["axial"] or folding_slip(structure, corner.first), "coupling": "tension-flange"}


def _out_of_plane(
    structure: StructureParts, corner: Corner, asked: LawReference | None
) -> LawReference | None:
    """Law about the bisector of a corner: stored, else the estimate, else its member's."""
    law = automatic_law(structure, asked)
    return asked if law is None else bisector_law(structure, corner, law) or asked


def corner_of(structure: StructureParts, hinge: str) -> Corner | None:
    """Corner whose hinge has a name."""
    return {corner_name(node): one for node, (one, _) in corner_laws(structure).items()}.get(hinge)


def turned_corner(structure: StructureParts, hinge: str, axes: Iterable[str] | None) -> Corner | None:
    """Corner whose hinge has a name, if the hinge has the axes of the corner in place of its member's.

    Parameters
    ----------
    structure, hinge
        The hinge.
    axes
        Section axes that it turns about.
    """
    corner = corner_of(structure, hinge)
    return corner if corner is not None and is_turned(structure, corner, axes) else None
