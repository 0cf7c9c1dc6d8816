"""Errors of a result, from its difference to a run of another accuracy.

Two runs make errors e of the answer and e' of the other run, of which only the difference is known.  Where
both are smooth in the length of the steps, e' is about 4 e and the difference exceeds the error.  Impacts,
friction that sticks or slips, and hinges that lock make it a matter of chance: the error changes its sign
from one accuracy to the next, at another one for each hinge, and the difference of a single hinge can vanish.
So

1. the difference of a hinge is not taken below the root mean square of those of all hinges, weighted by what
   they turned: their errors have one common cause, the motion of the whole;
2. the larger of both is multiplied by a margin for the chance that the two errors are nearly equal.

The root mean square is not used beyond the rotation of a hinge itself, so that hinges at rest err by nothing.
Measured in docs/theory/stated_errors.md.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from crumple.multibody.answer.solved import HingeHistory, Solved
from crumple.numeric.arrays import Floats
from crumple.structure import Structure

MARGIN = 1.5
"""Stated error over the difference of two runs.  Independent normal errors whose standard deviations are in
the ratio r of the accuracies leave the answer's error above c times the difference with the probability
(atan((1 + 1/c)/r) - atan((1 - 1/c)/r))/pi; with r = 4 that is 15 % for c = 1, 10 % for c = 1.5."""


@dataclass(frozen=True, eq=False)
class StatedErrors:
    """Errors of a result.

    Attributes
    ----------
    rotation
        Of the largest and the final rotation of each hinge [rad], (hinges,).
    energy
        Of the energy that each hinge absorbed [J], (hinges,).
    displacement
        Of the displacement of each node at the end [m], by node.
    """

    rotation: Floats
    energy: Floats
    displacement: Mapping[str, float]


def stated_errors(structure: Structure, other: Solved, solved: Solved) -> StatedErrors:
    """Errors of a result, from its difference to another run, and from loads that no step resolves.

    Rotations and energies go with the square of the speed that makes them, so a share of the speed is twice
    that of either.

    Parameters
    ----------
    structure
        For the places of its nodes.
    other
        Run of another accuracy.
    solved
        The answer.
    """
    unseen = 2.0 * solved.unseen
    turned = np.array([hinge.rotation_max for hinge in solved.hinges])
    energy, beside = (np.array([hinge.energy for hinge in run.hinges]) for run in (solved, other))
    moved, moved_beside = (_moved(structure, run) for run in (solved, other))
    far, apart = (np.linalg.norm(vectors, axis=1) for vectors in (moved, moved_beside - moved))
    displacement = MARGIN * apart + 0.5 * unseen * far
    rotation = with_chance(rotation_differences(other, solved), turned)
    # what a hinge absorbs is not known better than how far it turns
    share = np.divide(rotation, turned, out=np.zeros_like(turned), where=turned > 0.0)
    return StatedErrors(
        rotation=rotation + unseen * turned,
        energy=np.maximum(with_chance(np.abs(beside - energy), energy), share * energy) + unseen * energy,
        displacement=dict(zip(solved.poses.node_body, displacement.tolist(), strict=True)),
    )


def rotation_differences(other: Solved, solved: Solved) -> Floats:
    """Larger difference of the largest and the final rotation of each hinge in two runs [rad], (hinges,)."""
    found = [
        max(abs(a.rotation_max - b.rotation_max), abs(_final(a) - _final(b)))
        for a, b in zip(other.hinges, solved.hinges, strict=True)
    ]
    return np.array(found, dtype=float)


def with_chance(differences: Floats, values: Floats) -> Floats:
    """Errors of values of one kind whose differences in two runs are known, (n,) each, in their unit."""
    weights = np.abs(values)
    whole = float(weights.sum())
    common = float(np.sqrt((weights * differences**2).sum() / whole)) if whole > 0.0 else 0.0
    return np.asarray(MARGIN * np.maximum(differences, np.minimum(common, weights)))


def _final(hinge: HingeHistory) -> float:
    return float(hinge.values("rotation")[-1])


def _moved(structure: Structure, solved: Solved) -> Floats:
    """Displacements of all nodes at the end [m], (nodes, 3)."""
    poses = solved.poses
    names = list(poses.node_body)
    points = np.array([structure.nodes[name] for name in names], dtype=float).reshape(-1, 3)
    bodies = np.array([poses.node_body[name] for name in names], dtype=np.int64)
    places, _ = poses.places(bodies, points, np.array([poses.rows - 1]))
    return np.asarray(places[0] - points)
