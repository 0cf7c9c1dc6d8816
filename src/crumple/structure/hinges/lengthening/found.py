"""Members that a run shows to change their length: forces along them that fold or yield their walls.

Which members a structure presses or pulls so far is a matter of where it folds, and known when it has been
solved (crumple.multibody.lengthening).  What this makes of their candidates: `with_elastic_members`.
"""

from __future__ import annotations

from collections.abc import Collection

from crumple.structure.parts import StructureParts
from crumple.structure.settings.multibody_settings import MultibodySettings

FOUND = "lengthening members"
"""Kind of data under which a structure keeps what its runs showed."""


def lengthening_members(
    structure: StructureParts, settings: MultibodySettings, moving: float
) -> frozenset[str]:
    """Members of an input that a run has shown to change their length; none before it is solved.

    Parameters
    ----------
    structure
        As of the input.
    settings, moving
        Of the run, and its time in motion [s]: what another run shows does not change it.
    """
    found: frozenset[str] = structure.kept.get((FOUND, (settings, moving)), frozenset())
    return found


def note_lengthening(
    structure: StructureParts, settings: MultibodySettings, moving: float, members: Collection[str]
) -> None:
    """Keep which members of an input change their length, for all that asks for it from now on."""
    structure.kept[FOUND, (settings, moving)] = frozenset(members)
