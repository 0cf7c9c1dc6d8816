"""From a mechanism to the kernel's arrays: projection on its plane, hinge records, loads, start."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from crumple._core.planar.simulation import (
    JointKind,
    TreeBody,
    TreeDrive,
    TreeHinge,
    TreeHold,
    TreeLoad,
    TreeModel,
    TreeWeld,
)
from crumple.cancelling import go_on
from crumple.errors import InputError, Problem
from crumple.hinge import HingeRecord
from crumple.multibody.bodies.actions import applied_loads, driven_freedoms
from crumple.multibody.bodies.hinge_constants import FORMS, SOFTENING, hinge_constants
from crumple.multibody.bodies.initial_motion import InitialMotion, motion_of, moving_parts, refuse_speeding
from crumple.multibody.bodies.linkage import GROUND
from crumple.multibody.bodies.sampled_functions import breaks_of
from crumple.multibody.planar.mechanism import Mechanism, hinge_links
from crumple.numeric.arrays import Floats
from crumple.structure import Structure

ACROSS = 1e-6
"""Share of a driven or initial motion that may point out of the plane: rounding of directions."""


def tree_model(
    structure: Structure, mechanism: Mechanism, duration: float, *, resolved_frequency: float = math.inf
) -> TreeModel:
    """Constants of the kernel's model.

    Parameters
    ----------
    structure, mechanism
        The structure and its mechanism.
    duration
        Functions of time are sampled over it [s].
    resolved_frequency
        Vibration of elastic hinges above it [Hz] does not shorten the steps.
    """
    plane = mechanism.plane
    return TreeModel(
        bodies=tuple(_bodies(mechanism)),
        hinges=tuple(_hinges(mechanism)),
        loads=tuple(_loads(structure, mechanism, duration)),
        drives=tuple(_drives(structure, mechanism, duration)),
        holds=tuple(_holds(structure, mechanism)),
        welds=tuple(_welds(mechanism)),
        gravity=_pair(plane.flat(np.asarray(structure.gravity, float))),
        length=max(structure.frame_of(name).length for name in structure.members),
        breaks=breaks_of(structure, duration),
        resolved_frequency=resolved_frequency,
    )


def _bodies(mechanism: Mechanism) -> Iterator[TreeBody]:
    """Bodies in the plane; all vectors are projected at once, a chain has thousands."""
    plane, links = mechanism.plane, mechanism.links
    position = np.array([link.position for link in links]).reshape(-1, 3)
    # the ground's frame is that of the world
    parent = np.array([link.parent for link in links], int)
    start = np.where(parent[:, None] == GROUND, 0.0, position[parent])
    centre = np.array([body.centre for body in mechanism.bodies]).reshape(-1, 3)
    inertia = np.array([body.inertia for body in mechanism.bodies]).reshape(-1, 3, 3)
    anchors, centres = plane.flat(position - start).tolist(), plane.flat(centre - position).tolist()
    about = (plane.normal @ inertia @ plane.normal).tolist()
    for i, (body, link) in enumerate(zip(mechanism.bodies, links, strict=True)):
        go_on()
        joint = JointKind.FREE if link.free else JointKind.REVOLUTE
        yield TreeBody(link.parent, joint, tuple(anchors[i]), tuple(centres[i]), body.mass, about[i])


def _hinges(mechanism: Mechanism) -> Iterator[TreeHinge]:
    for dof, hinge, sign in hinge_links(mechanism.links):
        go_on()
        yield tree_hinge(hinge.record, dof, sign)


def tree_hinge(record: HingeRecord, dof: int, sign: float = 1.0) -> TreeHinge:
    """A record for the kernel; for a joint that rotates in the opposite sense the senses are exchanged."""
    form, softening = FORMS[record.form], SOFTENING[record.softening_variable]
    return TreeHinge(dof=dof, form=form, softening=softening, **hinge_constants(record, sign))


def planar_initial_motion(structure: Structure, mechanism: Mechanism) -> InitialMotion:
    """Velocities and impulses at the start, as momentum of every body."""
    plane, n = mechanism.plane, len(mechanism.bodies)
    momentum, impulse = np.zeros((n, 3)), np.zeros((n, 3))
    energy = 0.0
    for part, body, fields in moving_parts(structure, mechanism, structure.initial_velocity):
        go_on()
        if part.mass == 0.0:
            continue
        velocity, rate = motion_of(fields, part.centre)
        energy += float(part.mass * velocity @ velocity + rate @ part.inertia @ rate) / 2
        if body == GROUND:
            continue
        _in_plane(mechanism, body, velocity, "initial_velocity")
        linear = part.mass * plane.flat(velocity)
        arm = plane.flat(part.centre - mechanism.bodies[body].centre)
        spin = float(plane.normal @ part.inertia @ rate) + _cross(arm, linear)
        momentum[body] += (spin, *linear)
    for i, given in enumerate(structure.impulses):
        body = mechanism.node_body[given.node]
        if body == GROUND:
            continue
        _in_plane(mechanism, body, np.asarray(given.impulse), f"impulses[{i}]")
        linear = plane.flat(np.asarray(given.impulse, float))
        arm = plane.flat(np.asarray(structure.nodes[given.node]) - mechanism.bodies[body].centre)
        impulse[body] += (
            float(plane.normal @ np.asarray(given.angular_impulse)) + _cross(arm, linear),
            *linear,
        )
    inertia = np.array([[plane.normal @ b.inertia @ plane.normal, b.mass, b.mass] for b in mechanism.bodies])
    refuse_speeding((momentum / inertia.reshape(n, 3))[:, 1:], impulse[:, 1:], inertia.reshape(n, 3)[:, 1])
    parts = np.array([mechanism.parts_of(body) for body in range(n)])
    velocity = momentum / (parts[:, None] * inertia.reshape(n, 3))
    impulse /= parts[:, None]
    for twin, whole in mechanism.welds:
        velocity[twin] = velocity[whole] if whole != GROUND else 0.0
        impulse[twin] = impulse[whole] if whole != GROUND else 0.0
    return InitialMotion(velocity, impulse, energy)


def _in_plane(mechanism: Mechanism, body: int, vector: Floats, where: str) -> None:
    """Refuse motion across the plane of a floating part; hinges carry it in a part that is held."""
    if abs(vector @ mechanism.plane.normal) <= ACROSS * float(np.linalg.norm(vector)):
        return
    while mechanism.links[body].parent != GROUND:
        body = mechanism.links[body].parent
    if mechanism.links[body].free:
        normal = ", ".join(f"{value:.3g}" for value in mechanism.plane.normal)
        what = "a floating part moves out of the plane; the multibody engine solves planar motion only"
        todo = "remove the part normal to the plane, or change the hinges' axes"
        raise InputError(Problem(what, f"{vector}", f"motion across [{normal}]", todo, where))


def _loads(structure: Structure, mechanism: Mechanism, duration: float) -> Iterator[TreeLoad]:
    for load in applied_loads(structure, mechanism.node_body, duration):
        row = mechanism.plane.row(load.freedom)
        if any(row):
            yield TreeLoad(load.body, _point(structure, mechanism, load.node), row, load.times, load.values)


def _drives(structure: Structure, mechanism: Mechanism, duration: float) -> Iterator[TreeDrive]:
    """Driven freedoms of supports."""
    for driven in driven_freedoms(structure, duration):
        body, row = mechanism.node_body[driven.node], mechanism.plane.row(driven.freedom)
        if body == GROUND:
            continue
        if abs(math.hypot(*row) - 1.0) > ACROSS:
            raise InputError(
                Problem(
                    "the driven direction lies across the plane of motion",
                    f"{driven.freedom} of node {driven.node}",
                    "a direction in the plane, or the rotation about its normal",
                    "drive another degree of freedom, or change the hinges' axes",
                    f"supports.{driven.support}.motion",
                )
            )
        point = _point(structure, mechanism, driven.node)
        yield TreeDrive(body, point, row, driven.times, driven.values, rates=driven.rates)


def _holds(structure: Structure, mechanism: Mechanism) -> Iterator[TreeHold]:
    """Held freedoms of nodes that are not yet held by a clamp or a pin joint."""
    plane = mechanism.plane
    for support in structure.supports.values():
        body = mechanism.node_body[support.node]
        if body == GROUND or support.node in mechanism.pin_joints:
            continue
        for freedom in support.held:
            row = plane.row(freedom)
            size = math.hypot(*row)
            if size > 0.0:
                unit = (row[0] / size, row[1] / size, row[2] / size)
                yield TreeHold(body, _point(structure, mechanism, support.node), unit)


def _welds(mechanism: Mechanism) -> Iterator[TreeWeld]:
    """Parts of cut bodies, each welded to its body at its own joint."""
    flat = mechanism.plane.flat
    for part, whole in mechanism.welds:
        joint = mechanism.links[part].position
        origin = mechanism.links[whole].position if whole != GROUND else np.zeros(3)
        yield TreeWeld(part, whole, (0.0, 0.0), _pair(flat(joint - origin)))


def _point(structure: Structure, mechanism: Mechanism, node: str) -> tuple[float, float]:
    """A node in the frame of its body."""
    link = mechanism.links[mechanism.node_body[node]]
    return _pair(mechanism.plane.flat(np.asarray(structure.nodes[node], float) - link.position))


def _pair(vector: Floats) -> tuple[float, float]:
    return float(vector[0]), float(vector[1])


def _cross(a: Floats, b: Floats) -> float:
    return float(a[0] * b[1] - a[1] * b[0])
