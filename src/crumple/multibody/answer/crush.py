"""Hinges that can shorten or lengthen along their members: crush length, stretch, forces and energy."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace

from crumple.hinge import Freedom
from crumple.multibody.answer.solved import HingeHistory
from crumple.result import CrushSummary, HingeSummary, crush_summary
from crumple.result.crush import BENT, MOVED, StretchSummary, stretch_summary
from crumple.structure import Structure
from crumple.structure.hinges.automatic import lengthens


def crush_of(structure: Structure, history: HingeHistory) -> CrushSummary | None:
    """Crushing figures of one hinge; None if it cannot shorten along its member.

    One that only may lengthen, because its member is held at both ends or braced, has them if it was crushed.
    """
    spatial = history.hinge.spatial
    if spatial is None or Freedom.AXIAL not in spatial.freedoms:
        return None
    slip = spatial.components[spatial.freedoms.index(Freedom.AXIAL)]
    stop = slip.record.stop_negative
    found = crush_summary(
        history.values("slip.x.travel"),
        history.values("slip.x.force"),
        structure.frame_of(history.hinge.member).length,
        None if stop is None else stop.rotation,
        # what a zone that did not bend has absorbed is the work of crushing alone
        history.energy if history.rotation_max <= BENT else None,
    )
    unasked = lengthens(structure, history.hinge.member)
    return None if unasked and found.efficiency <= MOVED else replace(found, law=slip.origin)


def _stretch_of(structure: Structure, history: HingeHistory) -> StretchSummary | None:
    spatial = history.hinge.spatial
    if spatial is None or Freedom.AXIAL not in spatial.freedoms:
        return None
    travel, force = (history.values(f"slip.x.{what}") for what in ("travel", "force"))
    return stretch_summary(travel, force, structure.frame_of(history.hinge.member).length)


def with_crush(
    structure: Structure, histories: Iterable[HingeHistory], summaries: Mapping[str, HingeSummary]
) -> dict[str, HingeSummary]:
    """Add the figures of crushing and stretching to the summaries of hinges that can shorten or lengthen."""
    found = {h.hinge.name: (crush_of(structure, h), _stretch_of(structure, h)) for h in histories}
    return {
        name: replace(summary, crush=crush, stretch=stretch)
        for name, summary in summaries.items()
        for crush, stretch in (found.get(name, (None, None)),)
    }
