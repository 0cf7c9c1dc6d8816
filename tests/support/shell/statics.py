"""Linear statics with the shell engine's own elements: tangent stiffness by differences, sparse equations.

The engine steps through time; a linear answer free of inertia and damping is the test of an element alone.
Nodes that share no element are displaced together, so that a mesh takes some sixty evaluations, however
large it is.
"""

from __future__ import annotations

import numpy as np
from scipy.sparse import coo_matrix, csr_matrix, diags
from scipy.sparse.linalg import splu

from crumple._core.shell.simulation import ShellModel, ShellState

STEP = 1e-8
"""Displacement over the mesh's element size, and rotation, of the differences: far in the linear range."""


def _neighbours(elements: np.ndarray, nodes: int) -> csr_matrix:
    """Which nodes share an element."""
    rows, columns = (a.ravel() for a in np.broadcast_arrays(elements[:, :, None], elements[:, None, :]))
    return coo_matrix((np.ones(rows.size), (rows, columns)), shape=(nodes, nodes)).tocsr()


def _groups(near: csr_matrix) -> np.ndarray:
    """Number of a group for every node: those of a group have no neighbour in common."""
    group = np.full(near.shape[0], -1)
    second = near @ near
    for node in range(near.shape[0]):
        taken = set(group[second.indices[second.indptr[node] : second.indptr[node + 1]]])
        group[node] = next(k for k in range(len(taken) + 1) if k not in taken)
    return group


def stiffness(model: ShellModel) -> csr_matrix:
    """Tangent stiffness of the undeformed mesh [N/m, N, N m], (6 n, 6 n)."""
    x, elements = model.position, np.asarray(model.elements, dtype=int)
    n = len(x)
    near = _neighbours(elements, n)
    group = _groups(near)
    corner = x[elements]
    length = STEP * np.linalg.norm(corner[:, 2] - corner[:, 0], axis=1).mean()
    state = ShellState(model)
    start = state.checkpoint()
    rows, columns, values = [], [], []
    for g in range(group.max() + 1):
        members = np.flatnonzero(group == g)
        for dof in range(6):
            u = np.zeros((n, 6))
            u[members, dof] = length if dof < 3 else STEP
            state.restore(start)
            force = state.deform(x + u[:, :3], u[:, :3], u[:, 3:], 1.0) / u[members[0], dof]
            for node in members:
                around = near.indices[near.indptr[node] : near.indptr[node + 1]]
                rows.append((6 * around[:, None] + np.arange(6)).ravel())
                columns.append(np.full(6 * len(around), 6 * node + dof))
                values.append(force[around].ravel())
    entries = np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))
    return coo_matrix(entries, shape=(6 * n, 6 * n)).tocsr()


def solve(
    model: ShellModel, force: np.ndarray, held: np.ndarray, given: np.ndarray | None = None
) -> np.ndarray:
    """Displacements and rotations (n, 6) [m, rad] under nodal forces and moments (n, 6) [N, N m].

    Held freedoms keep their ``given`` value, else 0.  Freedoms that nothing holds (the drill of a flat
    sheet) get 1e-9 of the mean rotational stiffness.
    """
    K = stiffness(model)
    K = (K + K.T) / 2
    free = np.flatnonzero(~held.ravel())
    turning = free % 6 >= 3
    light = 1e-9 * np.abs(K.diagonal()[free][turning]).mean() * turning
    u = np.zeros(6 * len(model.position)) if given is None else np.where(held, given, 0.0).ravel()
    load = force.ravel()[free] - (K @ u)[free]
    u[free] = splu((K[free][:, free] + diags(light)).tocsc()).solve(load)
    return u.reshape(-1, 6)
