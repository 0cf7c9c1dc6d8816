"""Dead centres: freedoms that can begin to move at the start and cannot go on.

Two bars in one line between two pins are an example.  To first order the rates a = N c, N the null space of
the loops' equations J a = 0, are free (see `mobility`).  A loop is a product of motions exp(a_i X_i) along
it, X_i the twists of its freedoms, which to second order misses closing by

    J b + 1/2 sum_{i<j} a_i a_j [X_i, X_j] ,

b being rates of second order (Baker, Campbell, Hausdorff).  Rotations of one connection count as one motion,
and all freedoms of a hinge; a slot of a joint or support stays with its first body, so that it comes before
the rotations, as the first axis of a universal joint comes before the second.
Some b makes up for it if and only if every self-stress s (J^T s = 0) does no work on it: the quadratic forms

    Q_s(c) = 1/2 sum_{i<j} a_i a_j s.[X_i, X_j] = 0      for all s.

The motions that go on are the zeros of all forms.  A form that is semidefinite leaves its kernel alone, which
is taken first, form by form; what the others leave is found from random motions by Newton's method on Q = 0
(least change; it halves the share of a motion that cannot go on).  A freedom that moves in N and in none of
the zeros found is at a dead centre: its parts are rigid however hinges yield, since second-order rigid
frameworks are rigid (Connelly and Whiteley 1996; bodies in place of bars derived here).
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from crumple.multibody.bodies.linkage import GROUND, Linkage
from crumple.multibody.bodies.mobility import NOTHING, Tree, loop_system, null_spaces, scale_of, tree_of
from crumple.numeric.arrays import Floats

Freedom = tuple[int, int]
"""A connection, and one of the relative freedoms that it leaves."""

DEFINITE = 1e-6
"""Eigenvalue of a form over its largest below which it is rounding, or the effect of places that are nearly
in line."""
MOST_SOUGHT = 40
"""Independent motions above which zeros are not sought: the work grows with the cube of their number."""
HALVINGS = 40
"""Newton steps towards a zero: a share that cannot go on falls to 1e-12 of itself."""
CROOKED = (1e-3, 3e-3, 1e-2)
"""Offset of hinges from which several ways go on, over the size of the structure, and lean [rad] of their
axes.  The first is the straightness that standards ask of members (EN 10219-2: 0.2 % of the length;
EN 1090-2: 0.1 %).  The others follow if the loops remain too near to their crossing with it."""
CLEAR = 5e-4
"""Least singular value of loops that are moved aside far enough.  Impulses along a loop go with its inverse
square, and with them the rounding of rates: with rates of 100 rad/s it is 2e-16 x 100/CLEAR^2 = 1e-7 rad/s, a
tenth of the rate at which locked hinges may creep."""
GONE = 1e-6
"""Share of a random motion that is left in a freedom at a dead centre: far above 1e-12, far below any that
goes on."""


@dataclass(frozen=True)
class DeadCentres:
    """What stands at a dead centre at the start.

    Attributes
    ----------
    held
        Freedoms that cannot go on.
    aside
        Place [m], (3,), and axes, (3, 3), a little beside their own, of connections from which several ways
        go on at once, like two equal members side by side that bend together to either side: a perfect
        geometry decides for none.
    offset
        Of these places, over the size of the structure.
    """

    held: frozenset[Freedom] = frozenset()
    aside: dict[int, tuple[Floats, Floats]] = field(default_factory=dict)
    offset: float = CROOKED[0]

    def __bool__(self) -> bool:
        return bool(self.held or self.aside)

    @property
    def connections(self) -> frozenset[int]:
        """Connections whose freedoms are held."""
        return frozenset(connection for connection, _ in self.held)


def dead_centres(linkage: Linkage) -> DeadCentres:
    """Freedoms that can begin to move at the start and not go on, and crossings of several ways.

    Parameters
    ----------
    linkage
        Bodies and connections; hinges count as free.

    References
    ----------
    R. Connelly, W. Whiteley, Second-order rigidity and prestress stability for tensegrity frameworks, SIAM J.
    Discrete Math. 9 (1996) 453-491.  Verified in tests/unit/multibody/bodies/test_dead_centres.py.
    """
    if not linkage.bodies or not (problem := _problem(linkage)):
        return DeadCentres()
    tree, motions, forms = problem
    going = _going_on(forms)
    begins = np.abs(motions).max(axis=0)
    goes = np.abs(going @ motions).max(axis=0, initial=0.0)
    at = np.flatnonzero((begins > NOTHING**0.5) & (goes < GONE * begins))
    held = frozenset(_freedom(linkage, tree, int(k)) for k in at if tree.owner[k] != GROUND)
    # joints and supports carry no moments where the hinges can
    hinges = frozenset(freedom for freedom in held if linkage.connections[freedom[0]].hinge is not None)
    left = without(linkage, hinges)
    if _problem(left):
        hinges, left = held, without(linkage, held)
    for offset in CROOKED:
        aside = _crooked(left, offset)
        if not aside or _least(left, aside) >= CLEAR:
            break
    return DeadCentres(hinges, aside, offset)


def _least(linkage: Linkage, aside: dict[int, tuple[Floats, Floats]]) -> float:
    """Least singular value of the loops that are independent once connections are moved aside."""
    connections = list(linkage.connections)
    for i, (place, axes) in aside.items():
        connections[i] = replace(connections[i], position=place, axes=axes)
    moved = replace(linkage, connections=tuple(connections))
    sizes = np.linalg.svd(loop_system(moved, tree_of(moved)), compute_uv=False)
    return float(sizes[sizes > NOTHING * max(float(sizes.max()), 1.0)].min())


def _problem(linkage: Linkage) -> tuple[Tree, Floats, Floats] | None:
    """Spanning tree, motions of first order (n, freedoms), and the forms on them; None without any form."""
    tree = tree_of(linkage)
    system = loop_system(linkage, tree)
    if not len(system):
        return None
    motions, stresses = null_spaces(system)
    if not len(motions) or not len(stresses):
        return None
    forms = _forms(linkage, tree, motions, stresses)
    return (tree, motions, forms) if len(forms) else None


def _freedom(linkage: Linkage, tree: Tree, column: int) -> Freedom:
    owner = tree.owner[column]
    return owner, linkage.connections[owner].free[column - tree.owner.index(owner)]


def without(linkage: Linkage, held: frozenset[Freedom]) -> Linkage:
    """A linkage without the freedoms that are held."""
    connections = [
        replace(c, free=tuple(freedom for freedom in c.free if (i, freedom) not in held))
        for i, c in enumerate(linkage.connections)
    ]
    return replace(linkage, connections=tuple(connections))


def _crooked(linkage: Linkage, offset: float) -> dict[int, tuple[Floats, Floats]]:
    """Change places and axes so that only one of the motions that cross at a dead centre is left, or none."""
    if not (problem := _problem(linkage)):
        return {}
    tree, motions, forms = problem
    rng = np.random.default_rng(0)
    taking_part = np.abs(np.einsum("nk,snm,mk->sk", motions, forms, motions)).max(axis=0)
    owners = {tree.owner[int(k)] for k in np.flatnonzero(taking_part > DEFINITE * taking_part.max())}
    _, length = scale_of(linkage)
    found: dict[int, tuple[Floats, Floats]] = {}
    for owner in sorted(owners - {GROUND}):
        connection = linkage.connections[owner]
        across, lean = rng.normal(size=3), rng.normal(size=3)
        turning = [freedom - 3 for freedom in connection.free if freedom >= 3]
        if len(turning) == 1:
            # what turns about one axis alone stays in the plane across it, beside the line of its member
            across = rng.choice([-1.0, 1.0]) * np.cross(connection.axes[turning[0]], connection.axes[0])
            across, lean = (across if np.any(across) else connection.axes[1]), np.zeros(3)
        place = connection.position + offset * length * across / np.linalg.norm(across)
        found[owner] = place, _leaning(connection.axes, lean, offset)
    return found


def _leaning(axes: Floats, lean: Floats, angle: float) -> Floats:
    """Axes, as rows, rotated by a small angle about a vector; unchanged if there is none."""
    if not np.any(lean):
        return axes
    x, y, z = angle * lean / np.linalg.norm(lean)
    # the rows' nearest orthonormal ones
    left, _, right = np.linalg.svd(axes @ np.array([[1.0, -z, y], [z, 1.0, -x], [-y, x, 1.0]]))
    turned: Floats = left @ right
    return turned


def _forms(linkage: Linkage, tree: Tree, motions: Floats, stresses: Floats) -> Floats:
    """Independent forms Q_s on the motions, (forms, motions, motions), scaled to the largest."""
    width = len(tree.owner)
    total = np.zeros((len(stresses), width, width))
    for row, (closing, own) in enumerate(tree.loops):
        along = _along(linkage, tree, closing, own)
        if not along:
            continue
        index = np.array([k for _, k, _ in along])
        twists = np.array([sign * tree.columns[k] for _, k, sign in along])
        part = np.array([_part(linkage, tree, owner, k) for owner, k, _ in along])
        work = 0.5 * np.einsum("sx,ijx->sij", stresses[:, 6 * row : 6 * row + 6], _brackets(twists))
        ahead = np.triu(np.ones((len(index),) * 2), 1) * np.any(part[:, None] != part[None, :], axis=2)
        total[:, index[:, None], index[None, :]] += work * ahead
    forms = motions @ (total + total.transpose(0, 2, 1)) @ motions.T / 2.0
    _, sizes, rows = np.linalg.svd(forms.reshape(len(forms), -1), full_matrices=False)
    if not sizes[0] > NOTHING:
        return np.zeros((0, len(motions), len(motions)))
    kept = sizes > DEFINITE * sizes[0]
    independent: Floats = (sizes[kept] / sizes[0])[:, None] * rows[kept]
    return independent.reshape(-1, len(motions), len(motions))


def _along(linkage: Linkage, tree: Tree, closing: int, own: list[int]) -> list[tuple[int, int, float]]:
    """Connection, freedom and sign of the motions around a loop, in the order of the loop."""
    connection = linkage.connections[closing]
    first, second = list(tree.path(connection.first)), list(tree.path(connection.second))
    while first and second and first[-1][0] == second[-1][0]:
        first.pop()
        second.pop()
    passing = [
        *reversed(first),
        (closing, own, 1.0),
        *((passed, free, -sign) for passed, free, sign in second),
    ]
    # against its sense a connection is passed from its last freedom to its first
    return [(passed, k, sign) for passed, free, sign in passing for k in free[:: int(sign)]]


def _part(linkage: Linkage, tree: Tree, owner: int, column: int) -> tuple[int, int]:
    """Connection of a freedom, and the motion of that connection to which it belongs."""
    if owner == GROUND or linkage.connections[owner].hinge is not None:
        return owner, 0
    connection, (_, freedom) = linkage.connections[owner], _freedom(linkage, tree, column)
    return owner, freedom if connection.universal else freedom // 3


def _brackets(twists: Floats) -> Floats:
    """[X_i, X_j] of all pairs, (n, n, 6)."""
    turn, shift = twists[:, :3], twists[:, 3:]
    spin = np.cross(turn[:, None], turn[None, :])
    move = np.cross(turn[:, None], shift[None, :]) + np.cross(shift[:, None], turn[None, :])
    return np.concatenate([spin, move], axis=2)


def _going_on(forms: Floats) -> Floats:
    """Motions that span the zeros of all forms, (m, motions)."""
    basis = np.eye(forms.shape[1])
    while len(basis):
        reduced = basis @ forms @ basis.T
        kernel = _kernel_of_definite(reduced)
        if kernel is None:
            return _zeros(reduced) @ basis if len(basis) <= MOST_SOUGHT else basis
        basis = kernel @ basis
    return basis


def _kernel_of_definite(forms: Floats) -> Floats | None:
    """Kernel of a semidefinite form, or of the sum of all weighed by their traces; None if there is none."""
    scale = np.abs(forms).max(initial=0.0)
    if scale <= DEFINITE:
        return None
    together = np.einsum("s,sij->ij", np.einsum("sii->s", forms), forms)
    for form in (*forms, together):
        sizes, vectors = np.linalg.eigh(form)
        if sizes[-1] < -sizes[0]:
            sizes = -sizes
        least, most = sizes.min(), sizes.max()
        if most > DEFINITE * scale and least > -DEFINITE * most:
            kernel: Floats = vectors.T[sizes <= DEFINITE * most]
            return kernel
    return None


def _zeros(forms: Floats) -> Floats:
    """Zeros of indefinite forms, from a few more random motions than there are motions, (m, motions)."""
    count = forms.shape[1]
    if np.abs(forms).max(initial=0.0) <= DEFINITE:
        return np.eye(count)
    found = np.random.default_rng(0).normal(size=(count + 3, count))
    for _ in range(HALVINGS):
        slopes = np.einsum("sij,mj->msi", forms, found)
        missed = np.einsum("msi,mi->ms", slopes, found)
        found -= np.einsum("mis,ms->mi", np.linalg.pinv(2.0 * slopes, rcond=1e-9), missed)
    return found
