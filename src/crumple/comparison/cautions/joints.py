"""Whether hinges and shells take joints for the same: T-joints welded or rigid, corners mitred or rigid."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from crumple.comparison.comparison import Source
from crumple.shell.mesh.joints import shortest_with_mitre
from crumple.structure import Structure
from crumple.structure.hinges.asked import automatic_of
from crumple.structure.hinges.corner_laws import corner_laws
from crumple.structure.hinges.corners import Corner
from crumple.structure.hinges.t_joints import t_laws, t_places
from crumple.text.names import listed


def joint_sentences(reference: Source, structure: Structure) -> Iterator[tuple[str, bool]]:
    """Cautions where the shells of the reference and the laws of the hinges mean different joints.

    Parameters
    ----------
    reference
        Nothing is said unless it is a shell run.
    structure
        Of both runs; its stored laws tell what the hinges stand for.
    """
    if reference.result.fidelity != "shell":
        return
    welded = reference.result.provenance.settings.get("t_joints") == "welded"
    own = t_laws(structure)
    if own and not welded:
        yield (
            f"The hinges at the T-joints {listed(list(own))} have laws of welded joints, whose face folds; "
            f"the {reference.name} run joins these members by rigid bodies, which are stronger. "
            "`analysis.shell.t_joints: welded` makes both alike.",
            True,
        )
    other = [
        node
        for node, joint in t_places(structure).items()
        if node not in own and automatic_of(structure, joint.branch) is not None
    ]
    if other and welded:
        yield (
            f"The {reference.name} run welds the T-joints {listed(other)} to one wall, which folds; the "
            "hinges there have the laws of their members, which are stronger. `crumple characterise FILE` "
            "on the input finds laws of the joints.",
            True,
        )
    yield from _corner_sentences(reference, structure)


def _corner_sentences(reference: Source, structure: Structure) -> Iterator[tuple[str, bool]]:
    short = [node for node, (corner, _) in corner_laws(structure).items() if _too_short(structure, corner)]
    if short:
        several = len(short) > 1
        yield (
            f"The hinge{'s' if several else ''} at the corner{'s' if several else ''} {listed(short)} "
            f"{'have laws' if several else 'has the law'} of mitred corners; the {reference.name} run joins "
            "the members there by rigid bodies, which are stronger, since a member is too short for its "
            "mitre.",
            True,
        )


def _too_short(structure: Structure, corner: Corner) -> bool:
    """Whether shells of a corner have no room for a mitre; its section counts to the middle of its wall."""
    section = structure.section_of(corner.first)
    across = 1 if corner.axis == "y" else 0
    reach = float(np.abs(section.outer_outline()[:, across]).max()) - 0.5 * getattr(section, "thickness", 0.0)
    least = shortest_with_mitre(reach, corner.angle)
    return any(structure.frame_of(name).length < least for name in (corner.first, corner.second))
