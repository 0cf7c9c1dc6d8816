"""Quasi-static stages with loads on unsupported motions, found before solving.

With all hinges locked the supports and joints leave motions, see `mobility`.  Where a load or gravity has
power in one of them there is no equilibrium at the start, whatever the hinges can carry.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from crumple.errors import Status
from crumple.multibody.bodies.linkage import Linkage
from crumple.multibody.bodies.mobility import free_twists
from crumple.numeric.arrays import Floats
from crumple.structure import Stage, Structure

ROUNDING = 1e-9
"""Power relative to the largest possible power of the same force, below which it is zero."""
SAMPLES = 1001
"""Number of times in a stage at which its loads are evaluated."""


def unheld_notes(structure: Structure, linkage: Linkage, stages: tuple[Stage, ...]) -> tuple[str, ...]:
    """A sentence for every quasi-static stage in which nothing resists some loads or gravity.

    Parameters
    ----------
    structure, linkage
        A structure that passed its checks, and its bodies and connections.
    stages
        Of the analysis.  Those with obstacles or contact of members may find rest there and are left out.
    """
    found = []
    for stage in stages:
        there = structure.obstacles if stage.obstacles is None else stage.obstacles
        if stage.kind != "quasi-static" or there or structure.member_contact is not None:
            continue
        moving = list(dict.fromkeys(_moving(structure, linkage, stage)))
        if moving:
            found.append(
                f"Stage {stage.name} is quasi-static, and nothing resists {' and '.join(moving)}: "
                f"unless an equilibrium is near, the run ends with the status '{Status.UNHELD.value}'."
            )
    return tuple(found)


def _moving(structure: Structure, linkage: Linkage, stage: Stage) -> Iterator[str]:
    """Loads that do work in a motion without rotation of any hinge."""
    centres = np.array([body.centre for body in linkage.bodies]).reshape(-1, 3)
    masses = np.array([body.mass for body in linkage.bodies])
    if any(structure.gravity):
        weights = np.outer(masses, structure.gravity)
        if _powerful(free_twists(linkage, centres, locked=True)[..., 3:], weights):
            yield "gravity"
    times = np.linspace(0.0, stage.duration, SAMPLES)
    for load in structure.loads:
        body = linkage.node_body[load.node]
        if body < 0:
            continue
        points = np.broadcast_to(np.asarray(structure.nodes[load.node], float), centres.shape)
        twists = free_twists(linkage, points, locked=True)[:, [body]]
        for parts, rates, what in (
            (load.force, twists[..., 3:], "force"),
            (load.moment, twists[..., :3], "moment"),
        ):
            for i, axis in enumerate("xyz"):
                function = getattr(parts, axis)
                if function is not None and np.any(function(times)) and _powerful(rates, np.eye(3)[[i]]):
                    yield f"the {what} on node {load.node}"


def _powerful(velocities: Floats, forces: Floats) -> bool:
    """Whether forces (b, 3) do work in any motion (motions, b, 3)."""
    power = np.abs(np.einsum("kbi,bi->k", velocities, forces))
    most = np.einsum("kb,b->k", np.linalg.norm(velocities, axis=2), np.linalg.norm(forces, axis=1))
    return bool(np.any(power > ROUNDING * np.maximum(most, np.finfo(float).tiny)))
