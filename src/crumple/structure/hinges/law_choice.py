"""Which law a hinge has that names none, or `auto`: stored, from the library, a formula or an estimate."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

from crumple.errors import InputError, Problem
from crumple.hinge.bending.estimate import automatic_type
from crumple.hinge.law import HingeLaw
from crumple.hinge.measured.library import by_place
from crumple.hinge.measured.place_hash import Load, place_hash
from crumple.hinge.measured.stored import StoredLaw, bounded
from crumple.hinge.registry import AUTO, Fold, build_law, law_options
from crumple.hinge.tube_library.clamped import clamped_fold_distance
from crumple.material import Material
from crumple.section import Axis, Section, fold_distance
from crumple.structure.keys.hinge_axes import AxialSlip
from crumple.structure.keys.law import LawKeys, LawReference
from crumple.structure.parts import StructureParts
from crumple.structure.remembered import remembered

KEPT = 1024
"""Laws that a process keeps."""
FOLDING = {"rectangular_tube": "superfolding", "circular_tube": "circular"}
"""Laws of crushing by the kind of section; others have none that holds for any size."""
CLAMPED = "clamped_tube"
"""Law of folds beside clamps and joints; it goes before a stored one, whose fold lies between two pieces."""


class Surroundings(NamedTuple):
    """What lies beside a fold.

    Attributes
    ----------
    fold
        Whether a joint or clamp keeps the section in shape there; None: not known.
    span
        Estimated distance from this joint or clamp to where the member carries no moment [m].
    distance
        Distance of the fold from it [m].
    """

    fold: Fold | None = None
    span: float | None = None
    distance: float | None = None


UNKNOWN = Surroundings()
"""Of a fold of which nothing is known."""


def automatic_law(structure: StructureParts, reference: LawReference | None) -> LawKeys | None:
    """Keys of a law that is chosen automatically; None for a law that the input names itself."""
    named = structure.hinge_laws.get(reference) if isinstance(reference, str) else reference
    if named is None:
        return plain_law(AUTO) if reference in (None, AUTO) else None
    return named if named.type == AUTO else None


def chosen_law(
    structure: StructureParts, member: str, axis: Axis, asked: LawKeys, near: Surroundings
) -> LawKeys:
    """Law of a hinge in a straight member about an axis.

    Parameters
    ----------
    structure, member, axis
        The hinge; its section and material must exist.
    asked
        Law of type `auto`: its further keys, as form and bound, are those of the law that is found.
    near
        What lies beside it.
    """
    spec = structure.members[member]

    def choose() -> LawKeys:
        section, material = structure.section_of(member), structure.material_of(member)
        kind = automatic_type(section, material, axis, near.fold, build=formula)
        text = stored_text(structure, place_hash(section, material, axis)) if structure.laws else None
        if text is not None and kind != CLAMPED:
            return with_type(asked, "file", text=text)
        if kind == CLAMPED:
            given = {"distance": near.distance, "span": near.span}
            return with_type(asked, kind, **{key: one for key, one in given.items() if one is not None})
        return plain_law(kind) if asked == plain_law(AUTO) else with_type(asked, kind)

    return structure.kept.once("chosen law", (spec.section, spec.material, axis, asked, near), choose)


def distance_of_fold(structure: StructureParts, member: str, axis: Axis, fold: Fold | None) -> float:
    """Distance of an automatic hinge about an axis from the joint or clamp beside it [m]."""
    spec = structure.members[member]

    def find() -> float:
        section, material = structure.section_of(member), structure.material_of(member)
        if fold == "clamped" and automatic_type(section, material, axis, fold, build=formula) == CLAMPED:
            return clamped_fold_distance(section, material, axis)
        return fold_distance(section, axis)

    return structure.kept.once("fold distance", (spec.section, spec.material, axis, fold), find)


def component_text(structure: StructureParts, member: str, load: Load) -> str | None:
    """Text of the stored law of a straight member's fold under a load other than bending."""
    if structure.laws is None:
        return None
    section, material = structure.section_of(member), structure.material_of(member)
    return stored_text(structure, place_hash(section, material, load=load))


def folding_slip(structure: StructureParts, member: str) -> AxialSlip:
    """How a compressed member shortens: tubes fold, by a stored law where there is one, others yield."""
    law = FOLDING.get(structure.section_of(member).kind)
    return AxialSlip() if law is None or component_text(structure, member, "crush") else AxialSlip(law=law)


def stored_text(structure: StructureParts, place: str) -> str | None:
    """Text of the law that the structure's store has for a place."""
    return stored_texts(structure).get(place)


def stored_texts(structure: StructureParts) -> Mapping[str, str]:
    """Texts of the laws of the structure's store, by place."""
    store = structure.laws
    return {} if store is None else structure.kept.once("stored laws", "", lambda: by_place(store.texts))


def with_type(asked: LawKeys, kind: str, **own: str | float) -> LawKeys:
    """Keys of a law of another type, with those that every law has."""
    common = {key: getattr(asked, key) for key in LawKeys.model_fields if key in asked.model_fields_set}
    return LawKeys(**{**common, **own, "type": kind})


# which law a hinge has, the hinge, and what yields in its member ask for the same
@remembered(KEPT)
def formula(kind: str, section: Section, material: Material, axis: Axis) -> HingeLaw:
    """Law of a type that follows from a section and a material alone."""
    return build_law(kind, section, material, axis)


# the same for every hinge of a chain
@remembered(KEPT)
def plain_law(kind: str) -> LawKeys:
    """A law of a type with its defaults."""
    return LawKeys(type=kind)


# a law is a pure function of these four: the hinges of a chain and the runs of a study share it
@remembered(KEPT)
def made_law(section: Section, material: Material, axis: Axis, spec: LawKeys) -> HingeLaw:
    """Law of keys for a section, a material and an axis of bending.

    Raises
    ------
    InputError
        If the law does not fit the section, or a bound is asked of one without a band.
    """
    given = {name: value for name, value in spec.own.items() if value is not None}
    options = set(law_options(spec.type))
    if "elastic_stiffness" in options and not isinstance(spec.elastic_stiffness, str):
        given["elastic_stiffness"] = spec.elastic_stiffness
    law = (
        build_law(spec.type, section, material, axis, **given)
        if given
        else formula(spec.type, section, material, axis)
    )
    if spec.bound != "nominal" and not isinstance(law, StoredLaw) and law.validity.uncertainty is None:
        what = f"the law about {axis} has no band, so it has no {spec.bound} bound"
        todo = "leave 'bound' out; of several axes, give it under 'laws' to those whose law has a band"
        raise InputError(Problem(what, law.title, "a law with a band, or bound: nominal", todo, "bound"))
    return bounded(law, spec.bound)
