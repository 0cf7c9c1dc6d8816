"""Where what holds a run against a force across it lies: at its end, or beyond kinks that nothing holds.

A run whose end only meets another member, nearly in line, is not held there if the far end of that member may
slide along it: both move across together, and the tube spans to the support beyond.  A member that cannot
slide holds the kink as a strut does, and so does one at a large angle.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from crumple.numeric.arrays import Floats
from crumple.structure.hinges.corners import leaving
from crumple.structure.hinges.runs.straight_runs import StraightRun, straight_run
from crumple.structure.keys.motion import FREEDOMS
from crumple.structure.parts import StructureParts

NEARLY_IN_LINE = math.cos(math.radians(45.0))
"""Least cosine between a run and what goes on beyond its end, and the least component of a direction that a
support leaves free, for it to slide that way."""


@dataclass(frozen=True)
class HeldEnd:
    """What holds one end of a run.

    Attributes
    ----------
    run, node
        The run that ends there: another one if it lies beyond kinks.
    further
        How much further than the end of the first run it lies, along that [m].
    """

    run: StraightRun
    node: str
    further: float = 0.0


def held_end(structure: StructureParts, run: StraightRun, end: int, across: Floats) -> HeldEnd:
    """What holds one end of a run against a force across it.

    Parameters
    ----------
    structure, run
        A straight run.
    end
        0 or 1, as in `run.ends`.
    across
        Unit vector of the force, (3,).
    """
    member, node = run.ends[end]
    own = HeldEnd(run, node)
    line = -leaving(structure, member, node)
    beyond, further = _onwards(structure, run, node), 0.0
    passed = set(run.stretches)
    while beyond is not None and passed.isdisjoint(beyond.stretches):
        passed |= beyond.stretches.keys()
        first, last = beyond.ends if beyond.nodes[0] == node else beyond.ends[::-1]
        along = leaving(structure, *first)
        in_line = float(along @ line)
        if in_line < NEARLY_IN_LINE:
            return own
        further, node = further + beyond.length * in_line, last[1]
        if structure.supports_at.get(node):
            free = _free(structure, node)
            slides = float(np.linalg.norm(along[free])) >= NEARLY_IN_LINE
            held = float(np.linalg.norm(across[~free])) >= NEARLY_IN_LINE
            return HeldEnd(beyond, node, further) if slides and held else own
        beyond = _onwards(structure, beyond, node)
    return own


def _onwards(structure: StructureParts, run: StraightRun, node: str) -> StraightRun | None:
    """The only other run at the end of one, if nothing else holds, weighs on or joins the node."""
    others = [name for name in structure.members_at.get(node, ()) if name not in run.stretches]
    alone = len(others) == 1 and structure.has_line(others[0]) and node not in structure.loaded_nodes
    return straight_run(structure, others[0]) if alone and not structure.joints_at.get(node) else None


def _free(structure: StructureParts, node: str) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    """Which global directions the supports of a node leave free, (3,)."""
    supports = structure.supports_at.get(node, ())
    held = {freedom for _, support in supports for freedom in (*support.held, *support.driven)}
    return np.array([freedom not in held for freedom in FREEDOMS[:3]])
