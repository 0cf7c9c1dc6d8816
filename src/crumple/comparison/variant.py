"""Other multibody models of the same structure, to see what an assumption costs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from crumple.comparison.motion import HingeMotion
from crumple.structure import ConstantLaw, HingePlace, Member, Structure, TableLaw
from crumple.structure.automatic import hinges_of
from crumple.structure.hinges import hinge_places, law_spec
from crumple.structure.law import LawKeys, LawReference
from crumple.structure.member import Bars

ELASTIC = "elastic-plastic"
LEAST_TURN = np.radians(2.0)
"""Plastic rotation [rad] from which a law can be read off."""
INTERVALS = 16
"""Of that law: wide enough that vibration averages out."""
BARS = (8, 7, 9, 6, 10, 11)
"""Numbers of rigid bars that stand for an elastic member; the first whose cuts keep clear of its hinges."""
CLEAR = 0.15
"""Least distance of a cut from a hinge over the length of a bar: between them lies a body of its own."""


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
        name: member.model_copy(update={"bars": Bars(number=_bars(structure, name), law=cut)})
        if member.bars.number == 1
        else member
        for name, member in elastic.members.items()
    }
    if members == dict(elastic.members):
        return None
    return elastic.model_copy(update={"members": members})


def _bars(structure: Structure, member: str) -> int:
    """Number of equal bars of a member whose cuts keep clear of its hinges, as far as one does."""
    length = structure.frame_of(member).length
    stations = [place.station / length for place in hinge_places(structure) if place.member == member]

    def clearance(number: int) -> float:
        return min((abs(s * number - round(s * number)) for s in stations if s * number > 0.5), default=1.0)

    return next((number for number in BARS if clearance(number) > CLEAR), max(BARS, key=clearance))


def with_measured_laws(
    structure: Structure, motions: Sequence[HingeMotion], total: float | None = None
) -> Structure | None:
    """The structure with elastic members, and hinges that carry the moments measured in another result.

    Parameters
    ----------
    structure
        Any.
    motions
        Hinges measured in that result; a hinge without a fold keeps its law.
    total
        Plastic work of the whole structure at the end [J]: what falls outside all folds is given to
        them in proportion to their own, since the model can take it up nowhere else.

    Returns
    -------
    Structure or None
        None where no hinge folded.  The law is the moment conjugate to plastic work against plastic rotation,
        so a run with it is no prediction: it shows what is left of the difference once the law is right.
    """
    folds = [m for m in motions if m.fold]
    if total is not None and folds:
        inside = sum(float(m.plastic_work[-1]) for m in folds)
        factor = total / inside if inside > 0.0 else 1.0
        folds = [replace(m, plastic_work=m.plastic_work * factor) for m in folds]
    laws = {m.name: law for m in folds if (law := measured_law(m)) is not None}
    if not laws:
        return None
    base = with_elastic_members(structure) or structure
    members = {
        name: member.model_copy(
            update={
                "hinges": tuple(
                    h.model_copy(update={"law": laws[h.name]}) if h.name in laws else h
                    for h in hinges_of(base, name)
                )
            }
        )
        for name, member in base.members.items()
    }
    return base.model_copy(update={"members": members})


def measured_law(motion: HingeMotion) -> TableLaw | None:
    """Plastic work over plastic rotation, interval by interval, as a table; None where it hardly turned."""
    plastic = np.maximum.accumulate(np.maximum(motion.sense * motion.plastic_rotation, 0.0))
    if not plastic[-1] > LEAST_TURN:
        return None
    grid, first = np.unique(plastic, return_index=True)
    grown = np.maximum.accumulate(motion.plastic_work)
    done = grown[np.append(first[1:] - 1, len(plastic) - 1)]
    edges = np.linspace(0.0, plastic[-1], INTERVALS + 1)
    moment = np.diff(np.interp(edges, grid, done)) / np.diff(edges)
    keep = moment > 0.0
    if not keep.any():
        return None
    rotation = ((edges[1:] + edges[:-1]) / 2)[keep]
    return TableLaw(
        form=ELASTIC,
        rotation=(0.0, *map(float, rotation)),
        moment=(float(moment[keep][0]), *map(float, moment[keep])),
        rate="off",
    )


def _elastic(structure: Structure, name: str, member: Member, places: dict[str, HingePlace]) -> Member:
    hinges = tuple(
        hinge.model_copy(update={"law": _law(structure, places[hinge.name])})
        for hinge in hinges_of(structure, name)
    )
    bars = member.bars
    between = next(
        (p for p in places.values() if p.member == name and p.name not in {h.name for h in hinges}), None
    )
    if between is not None:
        bars = bars.model_copy(update={"law": _law(structure, between)})
    return member.model_copy(update={"hinges": hinges, "bars": bars})


def _law(structure: Structure, place: HingePlace) -> LawReference:
    spec: LawKeys = law_spec(structure, place)
    changed = spec.model_copy(update={"form": ELASTIC})
    return changed  # type: ignore[return-value]
