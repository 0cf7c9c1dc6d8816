"""Axial crushing of hinges that can shorten along their members: crush length, forces and energy."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace

from crumple.hinge import Freedom
from crumple.multibody.answer.solved import HingeHistory
from crumple.result import CrushSummary, HingeSummary, crush_summary
from crumple.result.crush import BENT
from crumple.structure import Structure


def crush_of(structure: Structure, history: HingeHistory) -> CrushSummary | None:
    """Crushing figures of one hinge; None if it cannot shorten along its member."""
    spatial = history.hinge.spatial
    if spatial is None or Freedom.AXIAL not in spatial.freedoms:
        return None
    stop = spatial.components[spatial.freedoms.index(Freedom.AXIAL)].record.stop_negative
    return crush_summary(
        history.values("slip.x.travel"),
        history.values("slip.x.force"),
        structure.frame_of(history.hinge.member).length,
        None if stop is None else stop.rotation,
        # what a zone that did not bend has absorbed is the work of crushing alone
        history.energy if history.rotation_max <= BENT else None,
    )


def with_crush(
    structure: Structure, histories: Iterable[HingeHistory], summaries: Mapping[str, HingeSummary]
) -> dict[str, HingeSummary]:
    """Add the figures of axial crushing to the summaries of hinges that can shorten."""
    crushes = {history.hinge.name: crush_of(structure, history) for history in histories}
    return {name: replace(summary, crush=crushes.get(name)) for name, summary in summaries.items()}
