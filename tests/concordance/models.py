"""Multibody models that are judged: of the members, and of the source of the laws."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from crumple.analysis import Analysis
from crumple.structure import Structure
from crumple.structure.settings.stored_laws import StoredLaws

LAWS = Path(__file__).parent / "laws"
"""Laws from shells, of the sections and corners that somebody has characterised into this folder."""


def _rigid(analysis: Analysis) -> Analysis:
    return _with_members(analysis, "rigid")


def _elastic(analysis: Analysis) -> Analysis:
    return _with_members(analysis, "elastic")


def _with_members(analysis: Analysis, members: str) -> Analysis:
    settings = analysis.multibody.model_copy(update={"members": members})
    return analysis.model_copy(update={"multibody": settings})


def _stored_laws(analysis: Analysis) -> Analysis:
    from crumple.structure import with_used_laws

    laws = analysis.structure.model_copy(update={"laws": StoredLaws.read(LAWS)})
    return _with(analysis, with_used_laws(laws))


def _with(analysis: Analysis, structure: Structure) -> Analysis:
    return analysis.model_copy(update={"structure": structure})


ELASTIC = "elastic members"
MODELS: dict[str, Callable[[Analysis], Analysis]] = {
    "rigid members": _rigid,
    ELASTIC: _elastic,
}
if LAWS.is_dir():
    MODELS["rigid members, laws from shells"] = lambda analysis: _rigid(_stored_laws(analysis))
    MODELS["elastic members, laws from shells"] = lambda analysis: _elastic(_stored_laws(analysis))
