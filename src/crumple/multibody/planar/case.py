"""A structure in the form of the planar kernel; mass and momentum of its bodies, linear in the masses."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from crumple._core.planar.batch import TreeEnds
from crumple._core.planar.simulation import TreeModel
from crumple.errors import InputError
from crumple.multibody.answer.dents import DentHistory
from crumple.multibody.answer.hinge_histories import RecordedHinge
from crumple.multibody.answer.poses import TreePoses
from crumple.multibody.bodies.initial_motion import InitialMotion
from crumple.multibody.bodies.linkage import FREEDOM
from crumple.multibody.planar.mechanism import Mechanism, hinge_links, lower
from crumple.multibody.planar.model import planar_initial_motion, tree_model
from crumple.multibody.run import Run
from crumple.numeric.arrays import Floats
from crumple.structure import Structure


@dataclass(frozen=True, eq=False)
class PlanarCase:
    """A structure, its mechanism, and the arrays of the planar kernel; see `Case`."""

    structure: Structure
    mechanism: Mechanism
    model: TreeModel
    start: InitialMotion

    touched = False
    slowed = False

    @property
    def kernel_case(self) -> TreeModel:
        """See `Case`."""
        return self.model

    def dents(self, rows: object) -> tuple[DentHistory, ...]:
        """See `Case`: obstacles are in space."""
        return ()

    @cached_property
    def hinges(self) -> tuple[RecordedHinge, ...]:
        """See `Case`."""
        return recorded_hinges(self.mechanism)

    @property
    def topology(self) -> tuple[object, ...]:
        """See `Case`."""
        tree = self.model
        hinges = tuple((recorded.hinge.name, recorded.sign) for recorded in self.hinges)
        bodies = tuple((body.parent, body.joint) for body in tree.bodies)
        counts = len(tree.loads), len(tree.drives), len(tree.holds), self.mechanism.welds
        return (*hinges, bodies, counts)

    @property
    def velocity(self) -> Floats:
        """See `Case`."""
        return self.start.velocity

    @property
    def impulse(self) -> Floats:
        """See `Case`."""
        return self.start.impulse

    @property
    def own_bodies(self) -> int:
        """See `Case`."""
        return len(self.mechanism.bodies)

    @property
    def reference_points(self) -> Floats:
        """See `Case`: the joints, from which the kernel counts centres."""
        return np.zeros((len(self.mechanism.bodies), 2))

    @property
    def lumps(self) -> object:
        """See `Case`: places of nodes, and the motion at the start."""
        return self.structure.nodes, self.structure.initial_velocity

    def moved_mass(self, raw: Floats, other: PlanarCase) -> Floats:
        """See `Case`: about this case's joints."""
        joints = [np.array([link.position for link in one.mechanism.links]) for one in (other, self)]
        dx, dy = self.mechanism.plane.flat(joints[0] - joints[1]).T
        m, mx, my, about, spin, px, py, blow, bx, by = raw.T
        inertia = about + 2.0 * (dx * mx + dy * my) + m * (dx * dx + dy * dy)
        spins = spin + dx * py - dy * px, blow + dx * by - dy * bx
        return np.stack([m, mx + m * dx, my + m * dy, inertia, spins[0], px, py, spins[1], bx, by], axis=1)

    def raw_mass(self, about: Floats) -> Floats:
        """Mass, momentum and impulse of every body about a place of its frame, (bodies, 10).

        Columns: mass [kg], mass times centre x, y [kg m], inertia about the place [kg m^2]; angular momentum
        about it [N m s] and momentum x, y [N s] at the start; the same of the impulses.  All are sums
        over parts, so linear in each lump.
        """
        rows = []
        given = zip(self.model.bodies, about, self.start.velocity, self.start.impulse, strict=True)
        for body, (ax, ay), (w, x, y), (spin, px, py) in given:
            cx, cy = body.centre[0] - ax, body.centre[1] - ay
            m = body.mass
            about_place = body.inertia + m * (cx * cx + cy * cy)
            momentum = (body.inertia * w + m * (cx * y - cy * x), m * x, m * y)
            rows.append((m, m * cx, m * cy, about_place, *momentum, spin + cx * py - cy * px, px, py))
        return np.array(rows)

    @staticmethod
    def kernel_arrays(raw: Floats, about: Floats) -> tuple[Floats, Floats, Floats]:
        """The kernel's arrays of raw masses, (..., bodies, 10), about places, (..., bodies, 2).

        Returns
        -------
        bodies
            Centre x, y, mass, inertia about the centre, (..., bodies, 4).
        velocity, impulse
            Of and at the centres, (..., bodies, 3).
        """
        m, mx, my, about_place, spin, px, py, blow, bx, by = np.moveaxis(raw, -1, 0)
        with np.errstate(divide="ignore", invalid="ignore"):
            # a body without mass is refused by the kernel, row by row
            cx, cy = mx / m, my / m
            inertia = about_place - m * (cx * cx + cy * cy)
            velocity = np.stack([(spin - (cx * py - cy * px)) / inertia, px / m, py / m], axis=-1)
        impulse = np.stack([blow - (cx * by - cy * bx), bx, by], axis=-1)
        centre = about + np.stack([cx, cy], axis=-1)
        return np.concatenate([centre, np.stack([m, inertia], axis=-1)], axis=-1), velocity, impulse

    def end_poses(self, ends: TreeEnds) -> TreePoses:
        """See `Case`."""
        return TreePoses(self.mechanism, ends)


def recorded_hinges(mechanism: Mechanism) -> tuple[RecordedHinge, ...]:
    """Hinges in the kernel's order, one component each."""
    return tuple(
        RecordedHinge(hinge, (FREEDOM[hinge.axis],), k, sign)
        for k, (_, hinge, sign) in enumerate(hinge_links(mechanism.links))
    )


def planar_case(structure: Structure, run: Run) -> PlanarCase:
    """Lower a structure for the planar kernel.

    Raises
    ------
    InputError
        If it cannot be solved, or nothing can move.
    """
    mechanism = lower(structure)
    if not mechanism.bodies:
        raise InputError("nothing can move: every part is held and no member has a hinge")
    frequency = run.settings.resolved_frequency
    model = tree_model(structure, mechanism, run.duration, resolved_frequency=frequency)
    return PlanarCase(structure, mechanism, model, planar_initial_motion(structure, mechanism))
