"""Contacts whose walls crush, for parts that a rigid contact drives against what cannot give way."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

from crumple._core.spatial.model import SpatialObstacle
from crumple.multibody.answer.solved import CrushedContact
from crumple.multibody.bodies.capsules import capsule_rows
from crumple.multibody.bodies.crumpling_ends import CrumplingEnd
from crumple.multibody.bodies.obstacles.bodies import Touching
from crumple.result import CrumpledEnd
from crumple.section import plastic_interaction
from crumple.structure import Structure


def with_crushing(structure: Structure, touching: Touching) -> Touching:
    """The same model with walls that crush under every contact, at the squash load of their member.

    Capsules side by side in a section share it.  Of two members in contact the weaker one counts.  The squash
    load, area times yield stress, is an upper bound of what a wall carries under a contact; see
    docs/theory/rigid_contact.md.  End faces and corners are round: the crushed end of a wall has no corners.
    """
    members = touching.members
    force = {
        member: _squash_load(structure, member)
        / len(capsule_rows(structure.section_of(member).outer_outline())[0])
        for member in set(members)
    }
    capsules = [
        replace(capsule, crush_force=force[member])
        for capsule, member in zip(touching.model.capsules, members, strict=False)
    ]
    capsules += touching.model.capsules[len(members) :]

    def without_corners(obstacle: SpatialObstacle) -> SpatialObstacle:
        met = obstacle.capsules or ()
        kept = [k for k, i in enumerate(met) if i < len(members) or i in touching.points]
        ends = None if obstacle.ends is None else tuple(obstacle.ends[k] for k in kept)
        return replace(obstacle, capsules=tuple(met[k] for k in kept), ends=ends)

    obstacles = tuple(without_corners(obstacle) for obstacle in touching.model.obstacles)
    model = replace(touching.model, capsules=tuple(capsules), obstacles=obstacles)
    return replace(touching, model=model)


def crushed_contacts(
    structure: Structure, touching: Touching, crushed: Sequence[tuple[int, int, int, float]]
) -> Iterator[CrushedContact]:
    """What the kernel reports as crushed, by the names of the input.

    Parameters
    ----------
    structure, touching
        The structure, and its model.
    crushed
        Obstacle, capsules and depth [m] of every crushed contact, as `SpatialSimulation.crushed`.
    """
    for obstacle, first, second, depth in crushed:
        if second in touching.points:
            continue
        member = touching.members[second]
        if obstacle >= 0:
            yield CrushedContact(
                member, f"obstacle {touching.obstacles[obstacle]}", depth, _squash_load(structure, member)
            )
            continue
        other = touching.members[first]
        force = min(_squash_load(structure, name) for name in (member, other))
        yield CrushedContact(member, f"member {other}", depth, force)


def crumpled_ends(
    touching: Touching, crushed: Sequence[tuple[int, int, int, float]]
) -> Iterator[CrumpledEnd]:
    """Ends of members that crumpled, from the same."""
    points: dict[CrumplingEnd, list[tuple[float, float]]] = {}
    for _, _, second, depth in crushed:
        if second in touching.points:
            force = touching.model.capsules[second].crush_force
            points.setdefault(touching.points[second], []).append((depth, depth * force))
    for end, parts in points.items():
        depth, energy = max(depth for depth, _ in parts), sum(energy for _, energy in parts)
        yield CrumpledEnd(end.member, end.node, end.obstacle, depth, energy)


def _squash_load(structure: Structure, member: str) -> float:
    """Area times yield stress of a member [N]."""
    return plastic_interaction(structure.section_of(member), structure.material_of(member)).squash_force
