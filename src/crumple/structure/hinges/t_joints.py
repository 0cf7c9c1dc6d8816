"""Welded T-joints: a member that ends on a face of two others in line, and the hinge at its end.

The law of such a joint (crumple characterise --chord) holds for a branch at a right angle.  The fold is in
the face, so the hinge lies in its mid-plane.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np

from crumple.hinge.measured.place_hash import t_joint_hash
from crumple.section import AXES, Axis, half_fold_length
from crumple.section.shapes.rectangular_tube import RectangularTube
from crumple.structure.bending import bending_axis, planar
from crumple.structure.hinges.asked import automatic_of
from crumple.structure.hinges.corners import ALONG, leaving
from crumple.structure.hinges.law_choice import automatic_law, stored_text, with_type
from crumple.structure.keys.hinge_axes import AxisLaws
from crumple.structure.keys.law import LawKeys, LawReference
from crumple.structure.keys.member import Hinge
from crumple.structure.parts import StructureParts

Plane = Literal["in", "across"]
"""In the plane of both axes, or about the chord's axis."""
OBLIQUE = math.radians(10.0)
"""Difference from a right angle up to which the law of a right-angled joint is used."""


@dataclass(frozen=True)
class TPlace:
    """A branch on a chord.

    Attributes
    ----------
    node
        At which three members meet.
    branch, before, after
        The member that ends there, and the two in line.
    section, chord
        Of branch and chord, turned as in the sub-model: the branch's width lies along the chord, and it
        stands on a face across the chord's z axis.
    axes
        Axis of the branch's own section for each plane.
    """

    node: str
    branch: str
    before: str
    after: str
    section: RectangularTube
    chord: RectangularTube
    axes: Mapping[Plane, Axis]

    @property
    def face(self) -> float:
        """Distance of the mid-plane of the face from the node [m]."""
        return (self.chord.depth - self.chord.thickness) / 2.0

    @property
    def zone(self) -> float:
        """Distance from the node within which the law stands for all folds of the branch [m]."""
        side = max(self.section.width, self.section.depth)
        return self.face + side + max(half_fold_length(self.section, axis) for axis in AXES)

    def place(self, structure: StructureParts, plane: Plane) -> str:
        """Hash of the place, by which a store knows its law."""
        metal = structure.material_of(self.branch)
        return t_joint_hash(self.section, self.chord, metal, across=plane == "across")

    def plane(self, axis: Axis) -> Plane:
        """Plane of the joint in which a rotation about an axis of the branch's section turns it."""
        return "in" if self.axes["in"] == axis else "across"


def t_places(structure: StructureParts) -> Mapping[str, TPlace]:
    """T-joints that have a sub-model, by node."""
    return structure.kept.once("T-joints", "", lambda: _t_places(structure))


def _t_places(structure: StructureParts) -> dict[str, TPlace]:
    found = {}
    for node, members in structure.members_at.items():
        if len(members) != 3 or not all(structure.has_line(name) for name in members):
            continue
        if structure.joints_at.get(node) or structure.supports_at.get(node):
            continue
        place = next((p for p in (_t_place(structure, node, name) for name in members) if p), None)
        if place is not None:
            found[node] = place
    return found


def _t_place(structure: StructureParts, node: str, branch: str) -> TPlace | None:
    """Joint with one of three members as its branch; None where there is no sub-model for it."""
    before, after = (name for name in structure.members_at[node] if name != branch)
    own, chord = structure.section_of(branch), structure.section_of(before)
    metals = {replace(structure.material_of(name), name="") for name in (branch, before, after)}
    if not (isinstance(own, RectangularTube) and isinstance(chord, RectangularTube)) or len(metals) > 1:
        return None
    frames = [structure.frame_of(name).axes for name in (branch, before, after)]
    apart = leaving(structure, before, node) @ leaving(structure, after, node)
    # turned by half a turn about an axis a tube is the same
    in_line = apart < 0.0 and np.allclose(np.abs(frames[1] @ frames[2].T), np.eye(3), atol=ALONG)
    if chord != structure.section_of(after) or not in_line:
        return None
    out = frames[1][1:] @ leaving(structure, branch, node)
    normal = int(np.argmax(np.abs(out)))
    across = frames[0][1:] @ frames[1][2 - normal]
    if abs(out[normal]) < math.cos(OBLIQUE) or max(np.abs(out).min(), np.abs(across).min()) > ALONG:
        return None
    # the branch's axis across the chord is that about which it turns in the plane
    in_plane: Axis = AXES[int(np.argmax(np.abs(across)))]
    turned = own if in_plane == "z" else replace(own, width=own.depth, depth=own.width)
    chord = chord if normal == 1 else replace(chord, width=chord.depth, depth=chord.width)
    if turned.depth > chord.width:
        return None
    axes: dict[Plane, Axis] = {"in": in_plane, "across": "y" if in_plane == "z" else "z"}
    return TPlace(node, branch, before, after, turned, chord, axes)


def t_laws(structure: StructureParts) -> Mapping[str, tuple[TPlace, Mapping[Axis, LawKeys]]]:
    """T-joints of automatic hinges with a stored law, by node, and their laws by axis of the branch."""
    return structure.kept.once("laws of T-joints", "", lambda: _t_laws(structure))


def _t_laws(structure: StructureParts) -> dict[str, tuple[TPlace, Mapping[Axis, LawKeys]]]:
    found: dict[str, tuple[TPlace, Mapping[Axis, LawKeys]]] = {}
    if structure.laws is None:
        return found
    for node, joint in t_places(structure).items():
        asked = automatic_of(structure, joint.branch)
        law = None if asked is None or asked.laws is not None else automatic_law(structure, asked.law)
        if asked is None or law is None:
            continue
        alone = asked.axis or (bending_axis(structure, joint.branch) if planar(structure) else None)
        laws = {}
        for axis in asked.axes or ((alone,) if alone else AXES):
            text = None if axis == "x" else stored_text(structure, joint.place(structure, joint.plane(axis)))
            if text is not None and axis != "x":
                laws[axis] = _stored(structure, law, text)
        if laws:
            found[node] = (joint, laws)
    return found


def _stored(structure: StructureParts, asked: LawKeys, text: str) -> LawKeys:
    """Stored law of a joint; in a plane with the spring of its walls."""
    law = with_type(asked, "file", text=text)
    if planar(structure) and law.form == "set-valued":
        law = law.model_copy(update={"form": "elastic-plastic"})
    return law


def t_joint_zones(structure: StructureParts, member: str) -> list[tuple[float, float]]:
    """Stretches of a branch in which the hinge of its joint stands for all folds [m]."""
    length = structure.frame_of(member).length
    return [
        (0.0, joint.zone) if starts else (length - joint.zone, length)
        for joint, _, starts in _at_ends(structure, member)
    ]


def t_joint_name(node: str) -> str:
    """Name of the hinge at a T-joint."""
    return f"t-joint-{node}"


def t_joint_hinges(structure: StructureParts, member: str, keys: Mapping[str, Any]) -> list[Hinge]:
    """Hinges of a branch at its T-joints; about an axis without a stored law they have the member's.

    Parameters
    ----------
    structure, member
        Where.
    keys
        Axes and laws of the member's other automatic hinges.
    """
    length, found = structure.frame_of(member).length, []
    for joint, laws, starts in _at_ends(structure, member):
        if keys["axes"] is None:
            own = {**keys, "law": laws[keys["axis"]]}
        else:
            bending = [axis for axis in keys["axes"] if axis in AXES]
            rest: dict[Axis, LawReference | None] = dict.fromkeys(bending, keys["law"])
            own = {**keys, "law": None, "laws": AxisLaws(**{**rest, **laws})}
        station = joint.face if starts else length - joint.face
        found.append(Hinge.model_construct(name=t_joint_name(joint.node), at=station, **own))
    return found


def _at_ends(structure: StructureParts, member: str) -> list[tuple[TPlace, Mapping[Axis, LawKeys], bool]]:
    """Joints of which a member is the branch, their laws, and whether it starts there."""
    first = structure.members[member].nodes[0]
    return [
        (joint, laws, node == first)
        for node, (joint, laws) in t_laws(structure).items()
        if joint.branch == member
    ]
