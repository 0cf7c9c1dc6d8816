"""Where the law of each hinge comes from, for people: user, store, library, formula, or an estimate."""

from __future__ import annotations

import hashlib
import math
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import TypeVar

from crumple.errors import InputError
from crumple.hinge import HingeLaw, HingeRecord
from crumple.hinge.bending.dented import DentedLaw, WrappedLaw
from crumple.hinge.bending.pressed import PressedLaw
from crumple.hinge.inside import LawInside
from crumple.hinge.law_use import INPUT, LawUse, Origin
from crumple.hinge.measured.library import place_of
from crumple.hinge.measured.place_hash import LENGTH, content_hash
from crumple.hinge.measured.stored import StoredLaw
from crumple.section import Axis
from crumple.section.shapes.rectangular_tube import RectangularTube
from crumple.structure.hinges.corner_laws import corner_laws, corner_name
from crumple.structure.hinges.corners import corners
from crumple.structure.hinges.elastic_members import with_elastic_members
from crumple.structure.hinges.hinges import plastic_hinges
from crumple.structure.hinges.law_choice import automatic_law, stored_texts
from crumple.structure.hinges.places import HingePlace, has_clamped_law, hinge_places, law_of, law_spec
from crumple.structure.hinges.shares import about_axis, axes_of
from crumple.structure.hinges.stored_loads import texts_of_loads
from crumple.structure.hinges.t_joints import TPlace, t_joint_name, t_laws, t_places
from crumple.structure.parts import StructureParts
from crumple.structure.settings.multibody_settings import MultibodySettings

Parts = TypeVar("Parts", bound=StructureParts)

UNNAMED: Mapping[str, Origin] = {"estimate": "estimate", "library": "library", "clamped_tube": "library"}
"""Origins of laws that the input does not name, by their types; others are formulas."""
AT_END = 1e-6
"""Distance of a hinge from its member's end, over the member's length, that is rounding."""


def law_uses(structure: StructureParts) -> Mapping[str, LawUse]:
    """Origin of the law of every plastic hinge, by name."""
    return structure.kept.once("law uses", "", lambda: _law_uses(structure))


def _law_uses(structure: StructureParts) -> dict[str, LawUse]:
    places = {place.name: place for place in hinge_places(structure)}
    return {
        hinge.name: law_use(structure, places[hinge.name], hinge.law, hinge.record)
        for hinge in plastic_hinges(structure)
    }


def law_types_of(structure: StructureParts) -> dict[str, str]:
    """Type of the law of every hinge, by name, such as ``kecman`` or ``library``; no law is built.

    A hinge with other laws about its second axis has both: ``library about y, kecman about z``.
    """
    found = {}
    for place in hinge_places(structure):
        about = {axis: law_spec(structure, about_axis(place, axis)).type for axis in axes_of(place)}
        alike = len(set(about.values())) == 1
        each = ", ".join(f"{kind} about {axis}" for axis, kind in about.items())
        found[place.name] = next(iter(about.values())) if alike else each
    return found


def law_use_about(structure: StructureParts) -> Callable[[str, Axis], LawUse]:
    """Gives the origin of the law of a plastic hinge about one of its bending axes."""
    first = law_uses(structure)
    hinges = {hinge.name: hinge for hinge in plastic_hinges(structure)}
    places = {place.name: place for place in hinge_places(structure)}

    def use(name: str, axis: Axis) -> LawUse:
        hinge = hinges[name]
        if axis == hinge.axis or hinge.spatial is None:
            return first[name]
        record = next(one.record for one in hinge.spatial.components if one.freedom.label == axis)
        return law_use(structure, about_axis(places[name], axis), hinge.laws[axis], record)

    return use


def used_texts(structure: StructureParts) -> tuple[str, ...]:
    """Texts of the stored laws that the hinges of a structure have, or have with elastic members; sorted."""
    if structure.laws is None:
        return ()
    # elastic members fold where rigid ones have no hinges
    structure = with_elastic_members(structure, MultibodySettings(members="elastic"), 0.0)
    found = set()
    for place in hinge_places(structure):
        for axis in axes_of(place):
            about = about_axis(place, axis)
            text = stored_text_of(structure, about, law_of(structure, about))
            found |= set() if text is None else {text}
        found |= set(texts_of_loads(structure, place).values())
    return tuple(sorted(found))


def with_used_laws(structure: Parts) -> Parts:
    """The structure with a store of the laws that its hinges use; the other laws do not affect it."""
    if structure.laws is None:
        return structure
    used = used_texts(structure)
    if used == structure.laws.texts:
        return structure
    return structure.model_copy(update={"laws": replace(structure.laws, texts=used)})


def law_use(structure: StructureParts, place: HingePlace, law: HingeLaw, record: HingeRecord) -> LawUse:
    """Origin of the law of a hinge.

    Parameters
    ----------
    structure, place
        The hinge.
    law, record
        Its law, and the record that the solver has.
    """
    text = stored_text_of(structure, place, law)
    origin: Origin = "stored"
    if text is None:
        named = is_named_law(structure, place)
        # a law that hardens is of the origin of what it hardens
        origin = "user" if named else UNNAMED.get(getattr(law, "formula", law).name, "formula")
    band = law.validity.uncertainty
    content = content_hash(text) if text is not None else _hash_of_record(law, record)
    better = (
        "" if origin == "user" or (origin == "stored" and band is not None) else _command(structure, place)
    )
    if origin == "stored" and better:
        better += " --converge"
    return LawUse(origin, content, band, better, _has_checksum(law))


def _has_checksum(law: HingeLaw) -> bool:
    """Whether nobody changed the law of a file; laws of no file have nothing to change."""
    while isinstance(law, LawInside):
        law = law.law
    return not isinstance(law, StoredLaw) or law.has_checksum


def stored_text_of(structure: StructureParts, place: HingePlace, law: HingeLaw) -> str | None:
    """Text of the stored law that a hinge has; None if its law is not from the store."""
    while isinstance(law, DentedLaw | WrappedLaw | PressedLaw):
        law = law.law
    if structure.laws is None or not isinstance(law, StoredLaw) or is_named_law(structure, place):
        return None
    own = place_of(law)
    return None if own is None else stored_texts(structure).get(own)


def is_named_law(structure: StructureParts, place: HingePlace) -> bool:
    """Whether the input names the law of a hinge; that from the store of a corner or joint is not named."""
    if automatic_law(structure, place.law) is not None:
        return False
    corner = place.name in {corner_name(node) for node in corner_laws(structure)}
    return not corner and place.name not in {t_joint_name(node) for node in t_laws(structure)}


def _command(structure: StructureParts, place: HingePlace) -> str:
    """Command that characterises the place; none beside a clamp whose law goes before a stored one."""
    spec = structure.members[place.member]
    joint = _joint_near(structure, place)
    if joint is not None:
        return _joint_command(structure, joint, place)
    if has_clamped_law(structure, place):
        return ""
    words = ["crumple", "characterise", f"{INPUT}:{spec.section}", "--material", f"{INPUT}:{spec.material}"]
    if place.axis != "y":
        words += ["--axis", place.axis]
    corner = _corner_near(structure, place)
    if corner is not None:
        words += ["--angle", f"'{math.degrees(corner):.6g} deg'"]
    return " ".join(words)


def _joint_command(structure: StructureParts, joint: TPlace, place: HingePlace) -> str:
    """Command that characterises a T-joint; names sections where they lie as in the sub-model."""
    spec, chord = structure.members[joint.branch], structure.members[joint.before]
    names = [
        f"{INPUT}:{name}" if turned == structure.section_of(member) else f"'{_plain_name(turned)}'"
        for member, name, turned in (
            (joint.branch, spec.section, joint.section),
            (joint.before, chord.section, joint.chord),
        )
    ]
    words = ["crumple", "characterise", names[0], "--chord", names[1]]
    words += ["--material", f"{INPUT}:{spec.material}"]
    return " ".join(words if joint.plane(place.axis) == "in" else [*words, "--load", "out-of-plane"])


def _plain_name(tube: RectangularTube) -> str:
    """A tube as the command line takes it."""
    sides = "x".join(f"{1e3 * side:.6g}" for side in (tube.width, tube.depth, tube.thickness))
    rounded = f"x{1e3 * tube.corner_radius:.6g}" if tube.corner_radius else ""
    return f"rectangular_tube {sides}{rounded}"


def _joint_near(structure: StructureParts, place: HingePlace) -> TPlace | None:
    """T-joint in whose zone a hinge of its branch lies."""
    length = structure.frame_of(place.member).length
    for joint in t_places(structure).values():
        if joint.branch == place.member:
            starts = structure.members[place.member].nodes[0] == joint.node
            if (place.station if starts else length - place.station) <= joint.zone + AT_END * length:
                return joint
    return None


def _corner_near(structure: StructureParts, place: HingePlace) -> float | None:
    """Angle of the corner in whose zone a hinge lies [rad]."""
    try:
        found = corners(structure)
    except InputError:
        return None
    length = structure.frame_of(place.member).length
    for node, station in zip(structure.members[place.member].nodes, (0.0, length), strict=True):
        corner = found.get(node)
        if corner is not None and abs(place.station - station) <= corner.zone(structure) + AT_END * length:
            return corner.angle
    return None


def _hash_of_record(law: HingeLaw, record: HingeRecord) -> str:
    """Hash of the name and the sampled curves of a law."""
    found = hashlib.sha256(law.name.encode())
    for curve in (record.positive, record.negative):
        found.update(curve.rotation.astype("<f8").tobytes())
        found.update(curve.moment.astype("<f8").tobytes())
    return found.hexdigest()[:LENGTH]
