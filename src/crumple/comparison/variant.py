"""Other multibody models of the same structure, to see what an assumption costs."""

from __future__ import annotations

from crumple.structure import ConstantLaw, HingePlace, Member, Structure
from crumple.structure.hinges import hinge_places, law_spec
from crumple.structure.law import LawKeys, LawReference
from crumple.structure.member import Bars

ELASTIC = "elastic-plastic"
BARS = 8
"""Rigid bars that stand for an elastic member: its lowest frequencies are then right within some per cent."""


def with_elastic_hinges(structure: Structure) -> Structure | None:
    """The structure with every hinge elastic-plastic; None where they are already, or there are none."""
    places = {place.name: place for place in hinge_places(structure)}
    forms = {law_spec(structure, place).form for place in places.values()}
    if not places or forms == {ELASTIC}:
        return None
    members = {name: _elastic(structure, name, member, places) for name, member in structure.members.items()}
    return structure.model_copy(update={"members": members})


def with_elastic_members(structure: Structure) -> Structure | None:
    """The structure with every hinge elastic-plastic and every member of one bar cut into several.

    Between the bars lie elastic-plastic hinges at the plastic moment, which carry the member's elastic
    bending and its vibration.  None where no member is one bar.
    """
    elastic = with_elastic_hinges(structure) or structure
    cut = ConstantLaw(form=ELASTIC)
    members = {
        name: member.model_copy(update={"bars": Bars(number=BARS, law=cut)}) if member.bars.number == 1 else member
        for name, member in elastic.members.items()
    }
    if members == dict(elastic.members):
        return None
    return elastic.model_copy(update={"members": members})


def _elastic(structure: Structure, name: str, member: Member, places: dict[str, HingePlace]) -> Member:
    hinges = tuple(
        hinge.model_copy(update={"law": _law(structure, places[hinge.name])}) for hinge in member.hinges
    )
    bars = member.bars
    between = next((p for p in places.values() if p.member == name and p.name not in {h.name for h in hinges}), None)
    if between is not None:
        bars = bars.model_copy(update={"law": _law(structure, between)})
    return member.model_copy(update={"hinges": hinges, "bars": bars})


def _law(structure: Structure, place: HingePlace) -> LawReference:
    spec: LawKeys = law_spec(structure, place)
    changed = spec.model_copy(update={"form": ELASTIC})
    return changed  # type: ignore[return-value]
