"""Motions that begin and cannot go on: infinitesimal mechanisms, like two bars in one line between two pins.

To first order the rates N a, N the null space of the loops' equations, are free (see `mobility`).  To second
order the loops then miss closing by r(a), quadratic in a, and further rates make up for what lies in the
range of the equations.  What does not, s r(a) for a self-stress s (a left null vector), stays: a quadratic
form of a.  If it is definite for one s no motion can go on, however small (the second-order test of
frameworks; derived here for bodies by products of exponentials).  What is struck along such a motion its
joints stop.
"""

from __future__ import annotations

import numpy as np

from crumple.multibody.bodies.linkage import Linkage
from crumple.multibody.bodies.mobility import NOTHING, Tree, loop_system, too_large, tree_of
from crumple.numeric.arrays import Floats

SMALL = 1e-4
"""Rates that show second order: third order and rounding are both 1e-4 of it or less."""
DEFINITE = 1e-3
"""Smallest eigenvalue of a form over its largest from which it is definite."""
MOST_MOTIONS = 6
"""Independent motions above which no form is sought: their number grows with the square."""


def infinitesimal(linkage: Linkage) -> str:
    """A sentence where the structure can begin to move and not go on; else empty."""
    if not linkage.bodies or too_large(linkage):
        return ""
    tree = tree_of(linkage)
    system = loop_system(linkage, tree)
    if not len(system):
        return ""
    left, sizes, right = np.linalg.svd(system)
    rank = int(np.sum(sizes > NOTHING * max(float(sizes.max(initial=0.0)), 1.0)))
    motions, stresses = right[rank:], left[:, rank:].T
    if not 0 < len(motions) <= MOST_MOTIONS or not len(stresses):
        return ""

    def missing(rates: Floats) -> Floats:
        """What the loops miss by to second order, on every self-stress."""
        both = [_closure(linkage, tree, sign * SMALL * rates) for sign in (1.0, -1.0)]
        return stresses @ ((both[0] + both[1]) / 2.0) / SMALL**2

    count = len(motions)
    alone = [missing(one) for one in motions]
    forms = np.zeros((len(stresses), count, count))
    for i in range(count):
        forms[:, i, i] = alone[i]
        for j in range(i):
            forms[:, i, j] = forms[:, j, i] = (missing(motions[i] + motions[j]) - alone[i] - alone[j]) / 2.0
    together = np.einsum("s,sij->ij", np.einsum("sii->s", forms), forms)
    if not any(_definite(form) for form in (*forms, together)):
        return ""
    return (
        "The structure can begin to move but not go on (bars in one line between supports, for example): its "
        "joints take at once what is given to that motion. Let a support slide, or give members hinges that "
        "lengthen ('axial')."
    )


def _definite(form: Floats) -> bool:
    sizes = np.linalg.eigvalsh(form)
    least, most = float(np.abs(sizes).min()), float(np.abs(sizes).max())
    return most > DEFINITE and least > DEFINITE * most and bool(sizes[0] * sizes[-1] > 0.0)


def _closure(linkage: Linkage, tree: Tree, rates: Floats) -> Floats:
    """Twists, (6 loops,), by which the loops miss closing after finite motion of all freedoms."""
    columns = tree.columns

    def moved(own: list[int], sign: float) -> Floats:
        return _exponential(sum((sign * rates[k] * columns[k] for k in own), np.zeros(6)))

    def place(body: int) -> Floats:
        found = np.eye(4)
        for _, own, sign in tree.path(body):
            found = moved(own, sign) @ found
        return found

    rows = []
    for closing, own in tree.loops:
        connection = linkage.connections[closing]
        first = place(connection.first) @ moved(own, 1.0)
        gap = np.linalg.solve(place(connection.second), first)
        rows += [gap[2, 1], gap[0, 2], gap[1, 0], *gap[:3, 3]]
    return np.array(rows)


def _exponential(twist: Floats) -> Floats:
    """Rigid motion (4, 4) of a small twist, to fourth order."""
    (x, y, z), v = twist[:3], twist[3:]
    rate = np.zeros((4, 4))
    rate[:3, :3], rate[:3, 3] = [[0, -z, y], [z, 0, -x], [-y, x, 0]], v
    square = rate @ rate
    return np.eye(4) + rate + square / 2.0 + square @ rate / 6.0 + square @ square / 24.0
