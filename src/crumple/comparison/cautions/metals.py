"""Whether hinges and shells begin to yield at the same stress."""

from __future__ import annotations

from collections.abc import Iterator

from crumple.comparison.comparison import Source
from crumple.structure import Structure

APART = 0.05
"""Flow stress over yield stress, less one, from which both are said: moments at the start differ as much."""


def metal_sentences(reference: Source, structure: Structure) -> Iterator[tuple[str, bool]]:
    """Cautions where shells are perfectly plastic at a flow stress at which laws of hinges do not begin.

    Without a hardening curve shells have one stress, the flow stress.  Laws begin at the yield stress.

    Parameters
    ----------
    reference
        Nothing is said unless it is a shell run.
    structure
        Of both runs.
    """
    if reference.result.fidelity != "shell":
        return
    for name in dict.fromkeys(member.material for member in structure.members.values()):
        metal = structure.materials[name].material(name)
        more = metal.flow_stress / metal.yield_stress - 1.0
        if metal.hardening is None and more >= APART:
            yield (
                f"Material {name} has no hardening curve: the {reference.name} run is perfectly plastic at "
                f"its flow stress, {metal.flow_stress / 1e6:.4g} MPa, while laws of hinges begin at its "
                f"yield stress, {metal.yield_stress / 1e6:.4g} MPa. Their moments differ by up to "
                f"{100 * more:.0f} % until they fold, and another place may fold. With `hardening` both have "
                "the same metal.",
                True,
            )
