"""Whether hinges and shells take T-joints for the same: welded to one wall, or rigid."""

from __future__ import annotations

from collections.abc import Iterator

from crumple.comparison.comparison import Source
from crumple.structure import Structure
from crumple.structure.hinges.asked import automatic_of
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
