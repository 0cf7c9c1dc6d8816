"""Hinges that can shorten or lengthen along their members: crush length, stretch, forces and energy."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace

import numpy as np

from crumple.hinge import Freedom
from crumple.hinge.record.spatial_record import HingeComponent
from crumple.multibody.answer.solved import HingeHistory
from crumple.result import CrushSummary, HingeSummary, crush_summary
from crumple.result.crush import BENT, MOVED, StretchSummary, slip_work, stretch_summary
from crumple.structure import Structure
from crumple.structure.hinges.automatic import lengthens

SAME = 1e-9
"""Relative difference of shortenings that is rounding."""


def crush_of(structure: Structure, history: HingeHistory) -> CrushSummary | None:
    """Crushing figures of one hinge; None if it cannot shorten along its member.

    One that only may lengthen, because its member is held at both ends or braced, has them if it was crushed.
    """
    spatial = history.hinge.spatial
    if spatial is None or Freedom.AXIAL not in spatial.freedoms:
        return None
    slip = spatial.components[spatial.freedoms.index(Freedom.AXIAL)]
    stroke = _stroke(slip)
    found = crush_summary(
        history.values("slip.x.travel"),
        history.values("slip.x.force"),
        structure.frame_of(history.hinge.member).length,
        stroke,
        _dissipated(history, stroke)[0],
    )
    unasked = lengthens(structure, history.hinge.member)
    return None if unasked and found.efficiency <= MOVED else replace(found, law=slip.origin)


def _stroke(slip: HingeComponent) -> float | None:
    """Shortening [m] at which folds close: where the force begins to rise up to a stop, else the stop."""
    stop, curve = slip.record.stop_negative, slip.record.negative
    rising = np.flatnonzero(np.diff(curve.moment) > 0.0)
    if stop is None or not rising.size:
        return None if stop is None else stop.rotation
    start, end = curve.rotation[rising[-1]], curve.rotation[rising[-1] + 1]
    # what yields along the member before it folds is no part of the curve
    spread = np.zeros(0) if slip.spread is None else slip.spread.shortening[0]
    before = float(spread[-1]) if len(spread) else 0.0
    closes = abs(end + before - stop.rotation) <= SAME * stop.rotation
    return stop.rotation - float(end - start) if closes else stop.rotation


def _stretch_of(structure: Structure, history: HingeHistory) -> StretchSummary | None:
    spatial = history.hinge.spatial
    if spatial is None or Freedom.AXIAL not in spatial.freedoms:
        return None
    travel, force = (history.values(f"slip.x.{what}") for what in ("travel", "force"))
    length = structure.frame_of(history.hinge.member).length
    return stretch_summary(travel, force, length, _dissipated(history, None)[1])


def _dissipated(history: HingeHistory, stroke: float | None) -> tuple[float, float]:
    """Energy of the slip of a hinge in compression and in tension [J].

    The sums over the outputs have shares of what the hinge absorbed at all steps: of all of it if it did not
    bend, else of no more.  What a stop holds is no part of it.
    """
    travel, force, capacity = (
        history.values(f"slip.x.{what}") for what in ("plastic_travel", "force", "capacity")
    )
    if stroke is not None:
        force = np.where(travel < -stroke, np.clip(force, -capacity, capacity), force)
    crushed, stretched = slip_work(travel, force)
    whole = crushed + stretched
    if whole <= 0.0:
        # outputs this far apart do not see the slip
        return (history.energy, 0.0) if history.rotation_max <= BENT else (0.0, 0.0)
    share = history.energy / whole
    if history.rotation_max > BENT:
        share = min(share, 1.0)
    return share * crushed, share * stretched


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
