"""What an input gives and what moves nothing: velocities of nodes without mass, loads on what supports hold.

Nothing is refused for them.  `nodes` of an initial velocity names lumped masses, and a node without one has
nothing to throw.  A load acts if one of its components that is not zero during the run lies along a freedom
that no support holds or drives.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from crumple.function import TimeFunction
from crumple.structure.checks.unusual import Unusual
from crumple.structure.keys.load import Load
from crumple.structure.keys.motion import InitialVelocity
from crumple.structure.keys.stages import Stage
from crumple.structure.parts import StructureParts
from crumple.text.names import listed

MOST_NAMED = 4
"""Nodes that a sentence names."""


def without_effect(
    structure: StructureParts, duration: float, stages: Sequence[Stage] = ()
) -> Iterator[Unusual]:
    """One sentence for all nodes without mass that are thrown, one for all loads that supports take.

    Parameters
    ----------
    structure
        Checked.
    duration
        Of the run [s].
    stages
        Of the run; empty for one dynamic stage.
    """
    fields = [*structure.initial_velocity, *(field for stage in stages for field in stage.initial_velocity)]
    moving = [field for field in fields if any(field.translation) or field.rotation]
    empty = list(dict.fromkeys(node for field in moving for node in massless_nodes(structure, field)))
    if empty:
        several = len(empty) > 1
        yield Unusual(
            f"node {empty[0]}",
            0.0,
            0.0,
            "kg",
            f"An initial_velocity names node{'s' if several else ''} {listed(empty, MOST_NAMED)}, where "
            f"there {'are no masses' if several else 'is no mass'}: 'nodes' throws masses at these nodes, "
            "and nothing moves there. Name 'members' to throw members, or give a mass.",
            "thrown_without_mass",
        )
    longest = max((stage.duration for stage in stages), default=duration)
    held = [load for load in structure.loads if load_is_held(structure, load, longest)]
    if held:
        nodes = list(dict.fromkeys(load.node for load in held))
        supports = dict.fromkeys(name for node in nodes for name, _ in structure.supports_at[node])
        whose = f"support{'s' if len(supports) > 1 else ''} {listed(supports, MOST_NAMED)}"
        yield Unusual(
            f"node {nodes[0]}",
            0.0,
            0.0,
            "1",
            f"Loads at node{'s' if len(nodes) > 1 else ''} {listed(nodes, MOST_NAMED)} act only along what "
            f"{whose} hold{'' if len(supports) > 1 else 's'}: they go into the support and load no member. "
            "Move them to another node, or free this direction.",
            "held_load",
        )


def massless_nodes(structure: StructureParts, field: InitialVelocity) -> list[str]:
    """Nodes that a velocity field names and that carry no lumped mass.

    Parameters
    ----------
    structure
        With its masses.
    field
        One field.
    """
    return [node for node in field.nodes or () if node not in structure.masses_at]


def load_is_held(structure: StructureParts, load: Load, duration: float) -> bool:
    """Whether a load is not zero, and supports hold or drive all directions in which it acts.

    Parameters
    ----------
    structure
        With its supports.
    load
        One load.
    duration
        Within which it acts [s].
    """
    acting = {name for name, function in _components(load) if function.largest(0.0, duration) > 0.0}
    blocked: set[str] = set()
    for _, support in structure.supports_at.get(load.node, ()):
        blocked |= {*support.held, *support.driven}
    return bool(acting) and acting <= blocked


def _components(load: Load) -> Iterator[tuple[str, TimeFunction]]:
    """Freedoms and functions of a load's components."""
    for prefix, part in (("", load.force), ("r", load.moment)):
        for axis in "xyz":
            function = getattr(part, axis)
            if function is not None:
                yield f"{prefix}{axis}", function
