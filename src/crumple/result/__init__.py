"""Results: the data of a run, filters, and storage."""

from crumple.result.caution import Caution, sentences
from crumple.result.crush import CrumpledEnd, CrushSummary, DentedWall, crush_summary
from crumple.result.filters import ChannelClass, Standard, cfc
from crumple.result.nearby import LawRange, Mode, Modes
from crumple.result.pictures import missing_pictures
from crumple.result.result import (
    Channel,
    HingeSummary,
    Opening,
    OutputSummary,
    Provenance,
    Result,
    StageSummary,
    States,
)
from crumple.result.store import read, write
from crumple.result.summary import summary, summary_json

__all__ = [
    "Caution",
    "Channel",
    "ChannelClass",
    "CrumpledEnd",
    "CrushSummary",
    "DentedWall",
    "HingeSummary",
    "LawRange",
    "Mode",
    "Modes",
    "Opening",
    "OutputSummary",
    "Provenance",
    "Result",
    "StageSummary",
    "Standard",
    "States",
    "cfc",
    "crush_summary",
    "missing_pictures",
    "read",
    "sentences",
    "summary",
    "summary_json",
    "write",
]
