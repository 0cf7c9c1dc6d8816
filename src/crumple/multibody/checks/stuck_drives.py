"""Driven supports that the structure cannot follow from its position at the start, or that hold it loosely.

With all driven freedoms released the linkage moves in the null space N of its loops' equations, less what is
at a dead centre.  A driven freedom that does not move in it is held by the rigid parts themselves: a bar
between two pins, one of which is driven along it, or a straight beam whose end is driven aside.

A node that has a motion along some axes and no `fix` is free in the other directions.  If nothing else holds
it there, which the motions with all hinges locked show, what hangs on it drifts or turns as it likes.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from crumple.multibody.bodies.dead_centres import dead_centres, without
from crumple.multibody.bodies.linkage import Linkage
from crumple.multibody.bodies.mobility import (
    NOTHING,
    free_twists,
    loop_system,
    mobility,
    null_space,
    too_large,
    tree_of,
)
from crumple.numeric.arrays import Floats
from crumple.structure import FREEDOMS, Structure, planar
from crumple.structure.checks.partly_driven import in_words, partly_driven
from crumple.text.names import listed


def stuck_drives(structure: Structure, linkage: Linkage) -> tuple[str, ...]:
    """Driven freedoms that the structure cannot follow at the start, as "support freedom".

    Parameters
    ----------
    structure, linkage
        What is driven, and its bodies and connections.

    Notes
    -----
    Each alone, all other drives released.  A drive that becomes impossible later, as a bar straightens, is
    not found.
    """
    driven = _driven(structure, linkage)
    if not driven:
        return ()
    released = with_drives_released(structure, linkage)
    left = without(released, dead_centres(released).held)
    tree = tree_of(left)
    system = loop_system(left, tree)
    if not len(system):
        return ()
    moves = np.abs(null_space(system)[0]).max(axis=0, initial=0.0) > NOTHING**0.5
    found = []
    for i, freedoms in driven.items():
        c = left.connections[i]
        first = tree.owner.index(i) if i in tree.owner else 0
        for freedom in freedoms:
            if freedom not in c.free or not moves[first + c.free.index(freedom)]:
                found.append(f"{c.name} {FREEDOMS[freedom]}")
    return tuple(found)


def with_drives_released(structure: Structure, linkage: Linkage) -> Linkage:
    """The same linkage in which all that supports drive is free: what drives move is not stuck."""
    driven = _driven(structure, linkage)
    if not driven:
        return linkage
    connections = [
        replace(c, free=tuple(sorted({*c.free, *driven.get(i, ())})))
        for i, c in enumerate(linkage.connections)
    ]
    return replace(linkage, connections=tuple(connections))


def _driven(structure: Structure, linkage: Linkage) -> dict[int, list[int]]:
    """Driven freedoms by the connection of their support."""
    return {
        i: [FREEDOMS.index(freedom) for freedom in structure.supports[c.name].driven]
        for i, c in enumerate(linkage.connections)
        if c.kind == "support" and structure.supports[c.name].driven
    }


def stuck_note(drives: tuple[str, ...]) -> str:
    """A sentence about these freedoms; empty for none."""
    if not drives:
        return ""
    return (
        f"The structure cannot follow the driven motion of {listed(drives)} from where it stands: "
        "rigid parts would have to change their length. Give members hinges that lengthen ('axial'), let "
        "another support slide, or move a node of a straight member aside by 0.1 % of its length."
    )


def loose_drives(structure: Structure, linkage: Linkage) -> tuple[str, ...]:
    """A sentence about every support that drives a node which nothing holds in other directions.

    Parameters
    ----------
    structure, linkage
        What is driven, and its bodies and connections.

    Notes
    -----
    Not reported: nodes at which a support fixes something, whose other directions are free on purpose, and of
    structures in a plane what leads out of it.
    """
    doubtful = [one for one in partly_driven(structure) if not one.held]
    if not doubtful or too_large(linkage) or not mobility(linkage, locked=True).motions:
        return ()
    found = []
    for one in doubtful:
        body = linkage.node_body[one.node]
        if body < 0:
            continue
        place = np.asarray(structure.nodes[one.node], float)
        twists = free_twists(linkage, np.tile(place, (len(linkage.bodies), 1)), locked=True)[:, body]
        rates = np.abs(_in_plane(structure, twists)).max(axis=0, initial=0.0)
        moves = rates > NOTHING**0.5 * max(float(np.abs(twists).max(initial=0.0)), 1.0)
        free = tuple(freedom for freedom, moving in zip(FREEDOMS, moves, strict=True) if moving)
        if free:
            held = ", ".join(free)
            found.append(
                f"Support {one.support} drives node {one.node} {in_words(one.driven)} and holds nothing "
                f"else, and nothing else holds it {in_words(free)}. Where it is not to move freely, add "
                f"'fix: [{held}]' to supports.{one.support}."
            )
    return tuple(found)


def _in_plane(structure: Structure, twists: Floats) -> Floats:
    """Displacements and rotations of twists, both (motions, 6), without what leads out of a plane."""
    spin, speed = twists[:, :3], twists[:, 3:]
    if planar(structure):
        normal = np.asarray(structure.bending_normal, float)
        spin, speed = np.outer(spin @ normal, normal), speed - np.outer(speed @ normal, normal)
    return np.concatenate([speed, spin], axis=1)
