"""Driven supports that the structure cannot follow from its position at the start.

With all driven freedoms released the linkage moves in the null space N of its loops' equations, less what is
at a dead centre.  A driven freedom that does not move in it is held by the rigid parts themselves: a bar
between two pins, one of which is driven along it, or a straight beam whose end is driven aside.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from crumple.multibody.bodies.dead_centres import dead_centres, without
from crumple.multibody.bodies.linkage import Linkage
from crumple.multibody.bodies.mobility import NOTHING, loop_system, null_space, tree_of
from crumple.structure import FREEDOMS, Structure
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
    driven = {
        i: [FREEDOMS.index(freedom) for freedom in structure.supports[c.name].driven]
        for i, c in enumerate(linkage.connections)
        if c.kind == "support" and structure.supports[c.name].driven
    }
    if not driven:
        return ()
    connections = [
        replace(c, free=tuple(sorted({*c.free, *driven.get(i, ())})))
        for i, c in enumerate(linkage.connections)
    ]
    released = replace(linkage, connections=tuple(connections))
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


def stuck_note(drives: tuple[str, ...]) -> str:
    """A sentence about these freedoms; empty for none."""
    if not drives:
        return ""
    return (
        f"The structure cannot follow the driven motion of {listed(drives)} from where it stands: "
        "rigid parts would have to change their length. Give members hinges that lengthen ('axial'), let "
        "another support slide, or move a node of a straight member aside by 0.1 % of its length."
    )
