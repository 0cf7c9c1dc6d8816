"""Further multibody models of the same structure, to see the effect of an assumption."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Literal

import numpy as np

from crumple.analysis import Analysis
from crumple.comparison.measure.motion import HingeMotion
from crumple.structure import HingePlace, Member, Structure, with_elastic_members
from crumple.structure.hinges.automatic import hinges_of
from crumple.structure.hinges.places import hinge_places, law_spec
from crumple.structure.hinges.shares import about_axis
from crumple.structure.keys.hinge_axes import AxisLaws
from crumple.structure.keys.law import LawKeys, LawReference, Regularisation
from crumple.structure.keys.member import Hinge

ELASTIC = "elastic-plastic"
ELASTIC_HINGES, SHELL_LAWS = "elastic hinges", "laws of the shells"
ELASTIC_MEMBERS, RIGID_MEMBERS = "elastic members", "rigid members"
"""Names of the further models in a comparison."""
MODEL_NAMES = ("multibody", "shell", ELASTIC_HINGES, ELASTIC_MEMBERS, RIGID_MEMBERS, SHELL_LAWS)
"""Names of the own results of a comparison."""
LEAST_TURN = np.radians(2.0)
"""Least plastic rotation [rad] from which a law can be determined."""
INTERVALS = 24
"""Intervals of that law: wide enough to average out vibration."""


def variants_of(analysis: Analysis, motions: Sequence[HingeMotion]) -> dict[str, Analysis]:
    """Further models of an analysis, by name: each differs in one assumption.

    Parameters
    ----------
    analysis
        Of the candidate.  If its members bend, they are rigid in one of the models, otherwise elastic.
    motions
        Hinges measured in the reference, see `with_measured_laws`.
    """
    structure = analysis.structure
    elastic = _with_members(analysis, structure, "elastic")
    bending = with_elastic_members(structure, elastic.multibody, analysis.time_in_motion)
    found = {}
    if with_elastic_members(structure, analysis.multibody, analysis.time_in_motion) is not structure:
        found[RIGID_MEMBERS] = _with_members(analysis, structure, "rigid")
    else:
        if (hinges := with_elastic_hinges(structure)) is not None:
            found[ELASTIC_HINGES] = analysis.model_copy(update={"structure": hinges})
        if bending is not structure:
            found[ELASTIC_MEMBERS] = elastic
    # automatic hinges of elastic members also twist and lengthen
    if (measured := with_measured_laws(bending, motions)) is not None:
        found[SHELL_LAWS] = _with_members(analysis, measured, "elastic")
    return found


def _with_members(analysis: Analysis, structure: Structure, members: Literal["rigid", "elastic"]) -> Analysis:
    settings = analysis.multibody.model_copy(update={"members": members})
    return analysis.model_copy(update={"structure": structure, "multibody": settings})


def with_elastic_hinges(structure: Structure) -> Structure | None:
    """The structure with every hinge elastic-plastic; None if all are already, or if there are none."""
    places = {place.name: place for place in hinge_places(structure)}
    forms = {law_spec(structure, place).form for place in places.values()}
    if not places or forms == {ELASTIC}:
        return None
    members = {name: _elastic(structure, name, member, places) for name, member in structure.members.items()}
    return structure.model_copy(update={"members": members})


def with_measured_laws(structure: Structure, motions: Sequence[HingeMotion]) -> Structure | None:
    """The structure with hinges that carry the moments measured in another result.

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
    members = {
        name: member.model_copy(
            update={
                "hinges": tuple(
                    h.model_copy(update={"law": laws[h.name], "laws": None}) if h.name in laws else h
                    for h in hinges_of(structure, name)
                )
                # of a member without hinges none is asked for: if it is elastic, it folds where it yields
                or member.hinges
            }
        )
        for name, member in structure.members.items()
    }
    return structure.model_copy(update={"members": members})


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
    return member.model_copy(update={"hinges": hinges or member.hinges, "bars": bars})


def _laws(structure: Structure, hinge: Hinge, place: HingePlace) -> dict[str, Any]:
    """Keys of a hinge with elastic-plastic laws, one for each axis where they differ."""
    if hinge.laws is None:
        return {"law": _law(structure, place)}
    laws = {axis: _law(structure, about_axis(place, axis)) for axis in hinge.bending}
    return {"law": None, "laws": AxisLaws(**laws)}


def _law(structure: Structure, place: HingePlace) -> LawReference:
    return law_spec(structure, place).model_copy(update={"form": ELASTIC, "regularisation": Regularisation()})
