"""Further multibody models of the same structure, to see the effect of an assumption."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from crumple.comparison.measure.motion import HingeMotion
from crumple.section import bending_moment
from crumple.structure import HingePlace, Member, Structure
from crumple.structure.bending import bending_axis
from crumple.structure.hinges.automatic import hinges_of
from crumple.structure.hinges.places import hinge_places, law_spec
from crumple.structure.hinges.shares import about_axis
from crumple.structure.keys.hinge_axes import AxisLaws
from crumple.structure.keys.law import LawKeys, LawReference, Regularisation
from crumple.structure.keys.member import Bars, Hinge

ELASTIC = "elastic-plastic"
ELASTIC_HINGES, ELASTIC_MEMBERS, SHELL_LAWS = "elastic hinges", "elastic members", "laws of the shells"
MODEL_NAMES = ("multibody", "shell", ELASTIC_HINGES, ELASTIC_MEMBERS, SHELL_LAWS)
"""Names of the own results of a comparison."""
"""Names of the further models in a comparison."""
LEAST_TURN = np.radians(2.0)
"""Least plastic rotation [rad] from which a law can be determined."""
INTERVALS = 24
"""Intervals of that law: wide enough to average out vibration."""
CURVATURES = np.array([1.0, 1.03, 1.07, 1.12, 1.2, 1.3, 1.5, 2.0, 3.0, 5.0, 10.0, 30.0, 100.0])
"""Where the moment over curvature of an elastic member is sampled, over the curvature of first yield."""
BARS = (8, 7, 9, 6, 10, 11)
"""Numbers of rigid bars to represent an elastic member; the first whose cuts avoid its hinges is used."""
CLEAR = 0.15
"""Least distance of a cut from a hinge, over the length of a bar: the part between is a separate body."""


def with_elastic_hinges(structure: Structure) -> Structure | None:
    """The structure with every hinge elastic-plastic; None if all are already, or if there are none."""
    places = {place.name: place for place in hinge_places(structure)}
    forms = {law_spec(structure, place).form for place in places.values()}
    if not places or forms == {ELASTIC}:
        return None
    members = {name: _elastic(structure, name, member, places) for name, member in structure.members.items()}
    return structure.model_copy(update={"members": members})


def with_elastic_members(structure: Structure) -> Structure | None:
    """The structure with every hinge elastic-plastic and every member divided into several bars.

    The bars are connected by elastic-plastic hinges that yield as the section does in bending, see
    `yielding_law`.  They represent elastic bending of the member, its vibration, and yielding that spreads
    along it.  None if no member consists of one bar.
    """
    elastic = with_elastic_hinges(structure) or structure
    members = {
        name: _cut(structure, name, member) if member.bars.number == 1 else member
        for name, member in elastic.members.items()
    }
    if members == dict(elastic.members):
        return None
    return elastic.model_copy(update={"members": members})


def _cut(structure: Structure, name: str, member: Member) -> Member:
    """A member of one bar divided into several, outside its rigid parts."""
    number, length = _bars(structure, name), structure.frame_of(name).length
    parts = member.rigid_parts(length)
    if parts == ((0.0, length),):
        return member
    law = yielding_law(structure, name, length / number)
    if not parts:
        return member.model_copy(update={"bars": Bars(number=number, law=law)})
    cuts = {i: i * length / number for i in range(1, number)}
    between = tuple(
        Hinge(name=f"{name}-{i}", at=cut, law=law)
        for i, cut in cuts.items()
        if not any(start <= cut <= end for start, end in parts)
    )
    given = member.given_hinges or hinges_of(structure, name)
    return member.model_copy(update={"hinges": (*given, *between)})


def yielding_law(structure: Structure, member: str, length: float) -> LawKeys:
    """Law of a hinge that represents a length [m] of a member in uniform bending with plane walls.

    Capacity over plastic rotation, length x (curvature - M/EI): it rises from the moment of first yield to
    the plastic moment.
    """
    section, material = structure.section_of(member), structure.material_of(member)
    axis = bending_axis(structure, member)
    rigidity = structure.flexural_rigidity(member, axis)
    curve = material.hardening
    stress = material.flow_stress if curve is None else curve.yield_stress
    curvature = CURVATURES * stress * section.elastic_section_modulus(axis) / rigidity
    moment = bending_moment(section, material, axis, curvature)
    plastic = length * (curvature - moment / rigidity)
    rotation, kept = np.unique(np.maximum.accumulate(plastic - plastic[0]), return_index=True)
    table = {"rotation": _numbers(rotation), "moment": _numbers(moment[kept])}
    return LawKeys(type="table", form=ELASTIC, rate="off", **table)


def _bars(structure: Structure, member: str) -> int:
    """Number of equal bars of a member whose cuts avoid its hinges, as far as possible."""
    length = structure.frame_of(member).length
    stations = [place.station / length for place in hinge_places(structure) if place.member == member]

    def clearance(number: int) -> float:
        return min((abs(s * number - round(s * number)) for s in stations if s * number > 0.5), default=1.0)

    return next((number for number in BARS if clearance(number) > CLEAR), max(BARS, key=clearance))


def with_measured_laws(structure: Structure, motions: Sequence[HingeMotion]) -> Structure | None:
    """The structure with elastic members, and hinges that carry the moments measured in another result.

    Parameters
    ----------
    structure
        Any.
    motions
        Hinges measured in the other result; a hinge without a fold keeps its law.

    Returns
    -------
    Structure or None
        None if no hinge folded.  The law is the moment over the plastic rotation of the fold, so a run with
        it is not a prediction: it shows the difference that remains with these moments.
    """
    laws = {m.name: law for m in motions if m.fold and (law := measured_law(m)) is not None}
    if not laws:
        return None
    base = with_elastic_members(structure) or structure
    members = {
        name: member.model_copy(
            update={
                "hinges": tuple(
                    h.model_copy(update={"law": laws[h.name], "laws": None}) if h.name in laws else h
                    for h in hinges_of(base, name)
                )
            }
        )
        for name, member in base.members.items()
    }
    return base.model_copy(update={"members": members})


def measured_law(motion: HingeMotion) -> LawKeys | None:
    """Moment for growing plastic rotation, averaged over intervals; None for too small a rotation."""
    plastic = np.maximum.accumulate(np.maximum(motion.sense * motion.plastic_rotation, 0.0))
    if not plastic[-1] > LEAST_TURN:
        return None
    grown = np.diff(plastic)
    moment = motion.sense * (motion.moment[1:] + motion.moment[:-1]) / 2
    middle = (plastic[1:] + plastic[:-1]) / 2
    which = np.minimum((middle / plastic[-1] * INTERVALS).astype(np.int64), INTERVALS - 1)
    turned, rotation, work = (
        np.bincount(which, grown * of, INTERVALS) for of in (np.ones_like(grown), middle, moment)
    )
    keep = (turned > 0.0) & (work > 0.0)
    if not keep.any():
        return None
    capacity, places = work[keep] / turned[keep], rotation[keep] / turned[keep]
    return LawKeys(
        type="table",
        form=ELASTIC,
        rotation=(0.0, *_numbers(places)),
        moment=(float(capacity[0]), *_numbers(capacity)),
        rate="off",
    )


def _numbers(values: np.ndarray) -> tuple[float, ...]:
    return tuple(float(value) for value in values)


def _elastic(structure: Structure, name: str, member: Member, places: dict[str, HingePlace]) -> Member:
    hinges = tuple(
        hinge.model_copy(update=_laws(structure, hinge, places[hinge.name]))
        for hinge in hinges_of(structure, name)
    )
    bars = member.bars
    between = next(
        (p for p in places.values() if p.member == name and p.name not in {h.name for h in hinges}), None
    )
    if between is not None:
        bars = bars.model_copy(update={"law": _law(structure, between)})
    return member.model_copy(update={"hinges": hinges, "bars": bars})


def _laws(structure: Structure, hinge: Hinge, place: HingePlace) -> dict[str, Any]:
    """Keys of a hinge with elastic-plastic laws, one for each axis where they differ."""
    if hinge.laws is None:
        return {"law": _law(structure, place)}
    laws = {axis: _law(structure, about_axis(place, axis)) for axis in hinge.bending}
    return {"law": None, "laws": AxisLaws(**laws)}


def _law(structure: Structure, place: HingePlace) -> LawReference:
    return law_spec(structure, place).model_copy(update={"form": ELASTIC, "regularisation": Regularisation()})
