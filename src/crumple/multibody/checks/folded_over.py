"""Hinges that bent so far that the pieces on both sides would pass through each other.

A hinge is a point on the members' axes, and nothing else in the model keeps its two pieces apart.  Up to a
right angle they lead away from each other; beyond it they come back, wall against wall.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from crumple.hinge import Freedom
from crumple.multibody.answer.solved import HingeHistory, Solved
from crumple.numeric.arrays import Floats
from crumple.numeric.crossing import first_above
from crumple.result import Caution
from crumple.structure import Structure
from crumple.text.names import listed
from crumple.units import format_quantity

RIGHT = math.pi / 2.0
"""Bending [rad] of a hinge above which its pieces come back towards each other."""
MOST_NAMED = 4
"""Hinges that the sentence names, the first ones."""


def folded_over(structure: Structure, solved: Solved) -> Iterator[Caution]:
    """A caution for every hinge that bent by more than a right angle; one sentence for all.

    Twist is left out, and so are joints and supports that turn freely, which are no hinges.

    Parameters
    ----------
    structure, solved
        The structure and the result of its run.
    """
    bent = {history.hinge.name: bending(history) for history in solved.hinges}
    most = {history.hinge.name: largest_bending(history) for history in solved.hinges}
    when = {
        name: first_above(solved.time, values, RIGHT) or float(solved.time[np.argmax(values)])
        for name, values in bent.items()
        if most[name] > RIGHT
    }
    if not when:
        return
    order = sorted(when, key=lambda name: when[name])
    cases = (f"{name} (at {format_quantity(when[name], 's', 3)})" for name in order)
    what, them = ("Hinge", "it") if len(order) == 1 else ("Hinges", "them")
    members = {history.hinge.member for history in solved.hinges if history.hinge.name in when}
    rigid = not solved.bending_tried and any(not structure.members[name].elastic for name in members)
    elastic = ", let members bend with analysis.multibody.members: elastic," if rigid else ""
    text = (
        f"{what} {listed(cases, MOST_NAMED)} bent past 90 deg: the pieces on both sides of {them} would meet "
        f"and here pass through each other. Do not trust the result after "
        f"{format_quantity(when[order[0]], 's', 3)}: solve with shells{elastic} or place hinges elsewhere."
    )
    for name in order:
        yield Caution("folded_over", most[name], RIGHT, "rad", f"hinge {name}", text)


def largest_bending(history: HingeHistory) -> float:
    """Largest bending of a hinge [rad]: over all steps if it does not twist, else over the outputs."""
    spatial = history.hinge.spatial
    twists = spatial is not None and Freedom.X in spatial.freedoms
    return float(bending(history).max(initial=0.0 if twists else history.rotation_max))


def bending(history: HingeHistory) -> Floats:
    """Magnitude of the bending of a hinge, without its twist [rad], (n,)."""
    parts = [f"rotation.{axis}" for axis in "yz" if f"rotation.{axis}" in history.columns]
    if parts:
        return np.asarray(np.linalg.norm([history.values(name) for name in parts], axis=0))
    spatial = history.hinge.spatial
    twists = spatial is not None and not {Freedom.Y, Freedom.Z} & set(spatial.freedoms)
    whole = np.abs(history.values("rotation"))
    return np.zeros_like(whole) if twists else whole
