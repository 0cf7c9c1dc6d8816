"""Hinges that broke: time, moment, and remaining resistance."""

from __future__ import annotations

import math
from collections.abc import Iterable

from crumple.hinge import Freedom
from crumple.multibody.answer.solved import HingeHistory
from crumple.units import format_quantity

SHOWN = 6
"""Number of broken hinges that are reported individually, the first ones."""


def broken_warnings(hinges: Iterable[HingeHistory]) -> list[str]:
    """A sentence for each of the first hinges that broke, one for all others, and one on the consequences.

    Parameters
    ----------
    hinges
        Histories of one run.
    """
    broke = [(*history.fracture, history) for history in hinges if history.fracture]
    broke.sort(key=lambda item: item[0])
    found = [_sentence(when, moment, history) for when, moment, history in broke[:SHOWN]]
    if len(broke) > SHOWN:
        found.append(f"{len(broke) - SHOWN} further hinges broke; their times are in the collapse log.")
    if broke:
        found.append(
            "Results after a fracture are uncertain: cracked walls are not modelled, and separating parts, "
            "with their further impacts, need another model."
        )
    return found


def _sentence(when: float, moment: float, history: HingeHistory) -> str:
    spatial = history.hinge.spatial
    assert spatial is not None, "only these break"
    angle = math.degrees(spatial.fracture)
    axes = [freedom.label for freedom in spatial.freedoms if freedom is not Freedom.AXIAL]
    free = f"rotates freely about {_joined(axes)}"
    if Freedom.AXIAL in spatial.freedoms:
        free += " and slips freely along the member"
    records = [component.record for component in spatial.components]
    stops = any(record.stop_positive or record.stop_negative for record in records)
    return (
        f"Hinge {history.hinge.name} broke at {format_quantity(when, 's')}, where its plastic rotation "
        f"reached {angle:.4g} deg under {format_quantity(moment, 'N*m')}. Since then it {free}"
        f"{', up to its stops' if stops else ''}, and does not separate."
    )


def _joined(names: list[str]) -> str:
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} and {names[-1]}"
