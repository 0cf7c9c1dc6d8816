"""A structure as the kernel's arrays, and the mass and momentum of its bodies in a form linear in masses."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from crumple._core.planar.simulation import TreeModel
from crumple.errors import InputError
from crumple.multibody.bodies.initial_motion import Start
from crumple.multibody.planar.mechanism import Mechanism, hinge_links, lower
from crumple.multibody.planar.model import start_of, tree_model
from crumple.numeric.arrays import Floats
from crumple.structure import Structure

RawMass = Floats


@dataclass(frozen=True, eq=False)
class Lowered:
    """A structure, the mechanism that it becomes, and its arrays."""

    structure: Structure
    mechanism: Mechanism
    tree: TreeModel
    start: Start

    @property
    def hinges(self) -> list[tuple[str, float]]:
        """Names of the hinges in the kernel's order, and the signs of their rotations there."""
        return [(hinge.name, sign) for _, hinge, sign in hinge_links(self.mechanism.links)]

    @property
    def topology(self) -> tuple[object, ...]:
        """What must be the same for two models to be variants of each other."""
        tree = self.tree
        bodies = tuple((body.parent, body.joint) for body in tree.bodies)
        counts = len(tree.loads), len(tree.drives), len(tree.holds), self.mechanism.welds
        return (*self.hinges, bodies, counts)


def lowered(structure: Structure, duration: float) -> Lowered:
    """Lower a structure for the planar kernel.

    Raises
    ------
    InputError
        If it cannot be solved, or nothing can move.
    """
    mechanism = lower(structure)
    if not mechanism.bodies:
        raise InputError("nothing can move: every part is held and no member has a hinge")
    return Lowered(
        structure, mechanism, tree_model(structure, mechanism, duration), start_of(structure, mechanism)
    )


def raw_mass(model: Lowered) -> RawMass:
    """Mass, momentum and impulse of every body about its joint, (bodies, 10).

    Columns: mass [kg], mass times centre x, y [kg m], inertia about the joint [kg m^2]; angular momentum
    about the joint [N m s] and momentum x, y [N s] at the start; the same of the impulses.  All are sums
    over parts, so linear in each lump.
    """
    rows = []
    given = zip(model.tree.bodies, model.start.velocity, model.start.impulse, strict=True)
    for body, (w, x, y), (spin, px, py) in given:
        cx, cy = body.centre
        m = body.mass
        about_joint = body.inertia + m * (cx * cx + cy * cy)
        momentum = (body.inertia * w + m * (cx * y - cy * x), m * x, m * y)
        rows.append((m, m * cx, m * cy, about_joint, *momentum, spin + cx * py - cy * px, px, py))
    return np.array(rows)


def tree_arrays(raw: RawMass) -> tuple[Floats, Floats, Floats]:
    """The kernel's arrays of raw masses, (..., bodies, 10).

    Returns
    -------
    bodies
        Centre x, y, mass, inertia about the centre, (..., bodies, 4).
    velocity, impulse
        Of and at the centres, (..., bodies, 3).
    """
    m, mx, my, about_joint, spin, px, py, blow, bx, by = np.moveaxis(raw, -1, 0)
    with np.errstate(divide="ignore", invalid="ignore"):
        # a body without mass is refused by the kernel, row by row
        cx, cy = mx / m, my / m
        inertia = about_joint - m * (cx * cx + cy * cy)
        velocity = np.stack([(spin - (cx * py - cy * px)) / inertia, px / m, py / m], axis=-1)
    impulse = np.stack([blow - (cx * by - cy * bx), bx, by], axis=-1)
    return np.stack([cx, cy, m, inertia], axis=-1), velocity, impulse
