"""What an input gives without effect: velocities of nodes without mass, held loads, one of two stresses.

Nothing is refused for them.  `nodes` of an initial velocity names lumped masses, and a node without one has
nothing to throw.  A load acts if one of its components that is not zero during the run lies along a freedom
that no support holds or drives.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from crumple.function import TimeFunction
from crumple.material.material import FOLD_STRAIN
from crumple.structure.checks.unusual import Unusual, given_laws
from crumple.structure.keys.load import Load
from crumple.structure.keys.motion import InitialVelocity
from crumple.structure.keys.stages import Stage
from crumple.structure.parts import StructureParts
from crumple.text.names import listed
from crumple.units import format_quantity

MOST_NAMED = 4
"""Nodes that a sentence names."""
APART = 0.05
"""Flow stress over that of the hardening curve, less one, beyond which both are named: moments differ as
much."""


def without_effect(
    structure: StructureParts, duration: float, stages: Sequence[Stage] = ()
) -> Iterator[Unusual]:
    """Sentences: all nodes without mass that are thrown, metals with two flow stresses, loads on supports.

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
    yield from _flow_stresses(structure)
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


def _flow_stresses(structure: StructureParts) -> Iterator[Unusual]:
    """A sentence for every metal whose flow stress is not that of its hardening curve."""
    for name in dict.fromkeys(member.material for member in structure.members.values()):
        spec = structure.materials[name]
        if spec.flow_stress is None or spec.hardening is None:
            continue
        of_curve = float(spec.hardening.curve(spec.yield_stress).stress(FOLD_STRAIN))
        if abs(spec.flow_stress / of_curve - 1.0) > APART:
            given, curve = (format_quantity(stress, "Pa") for stress in (spec.flow_stress, of_curve))
            yield Unusual(
                f"materials.{name}.flow_stress",
                spec.flow_stress,
                of_curve,
                "Pa",
                f"Material {name} has both flow_stress, {given}, and hardening, {curve} at a plastic strain "
                f"of {FOLD_STRAIN:g}: shells and the laws that hinges have by themselves follow the curve; "
                "formulas with one stress (crushing, dents, and laws such as kecman) take the flow_stress. "
                "Remove one of them.",
                "two_flow_stresses",
            )


def unused_names(structure: StructureParts) -> str:
    """Sentence on sections, materials and laws that nothing uses; empty if all are used."""
    members = structure.members.values()
    metals = {
        metal for section in structure.sections.values() for metal in section.named_materials().values()
    }
    used = {
        "section": {member.section for member in members},
        "material": metals | {member.material for member in members},
        "hinge law": {law for _, law in given_laws(structure) if isinstance(law, str)},
    }
    given = {
        "section": structure.sections,
        "material": structure.materials,
        "hinge law": structure.hinge_laws,
    }
    spare = {kind: [name for name in names if name not in used[kind]] for kind, names in given.items()}
    said = (
        f"{kind}{'s' if len(names) > 1 else ''} {listed(names)}" for kind, names in spare.items() if names
    )
    text = "; ".join(said)
    return f"Not used: {text}." if text else ""


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
