"""From a mechanism to the kernel's arrays: projection on its plane, hinge records, loads, start."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from crumple._core.tree import (
    JointKind,
    TreeBody,
    TreeDrive,
    TreeHinge,
    TreeHold,
    TreeLoad,
    TreeModel,
    TreeWeld,
)
from crumple.errors import InputError, Problem
from crumple.function import TimeFunction
from crumple.hinge import Envelope, Form, HingeRecord, SofteningVariable, Stop
from crumple.multibody.mechanism import GROUND, Mechanism
from crumple.multibody.rigid import Floats, RigidMass, lump_mass, piece_mass
from crumple.structure import InitialVelocity, Structure

FORMS = {Form.SET_VALUED: 0, Form.ELASTIC_PLASTIC: 1, Form.REGULARISED: 2}
SOFTENING = {SofteningVariable.PEAK: 0, SofteningVariable.ROTATION: 1, SofteningVariable.ACCUMULATED: 2}
SAMPLING = 1e-5
"""Error of a sampled function of time, relative to its largest value; far below any accuracy asked for."""
DRIVE_SAMPLING = 1e-8
"""The same for driven motion, whose rate is sampled: its pieces then add up to the motion within 1e-6."""
KINK = 0.01
"""Jump of a driven rate between two samples, relative to the largest rate, that counts as a kink."""
BRIEF = 1e-9
"""Time in which a driven rate passes a kink, relative to the duration."""
ACROSS = 1e-6
"""Share of a driven or initial motion that may point out of the plane: rounding of directions."""


@dataclass(frozen=True, eq=False)
class Start:
    """Motion at the start.

    Attributes
    ----------
    velocity
        Twists (rotation, x, y) of the bodies at their centres, (bodies, 3).
    impulse
        Impulses on the bodies at their centres, (bodies, 3).
    given_energy
        Energy of the described velocity field [J], of every part that has mass, ground parts included.
    """

    velocity: Floats
    impulse: Floats
    given_energy: float


def tree_model(structure: Structure, mechanism: Mechanism, duration: float) -> TreeModel:
    """Constants of the kernel's model.

    Parameters
    ----------
    structure, mechanism
        What is solved.
    duration
        Functions of time are sampled over it [s].
    """
    plane = mechanism.plane
    bodies, hinges = [], []
    dof = 0
    for body, link in zip(mechanism.bodies, mechanism.links, strict=True):
        joint = JointKind.FREE if link.free else JointKind.REVOLUTE
        parent = mechanism.links[link.parent].position if link.parent != GROUND else np.zeros(3)
        anchor, centre = plane.flat(link.position - parent), plane.flat(body.centre - link.position)
        inertia = float(plane.normal @ body.inertia @ plane.normal)
        bodies.append(TreeBody(link.parent, joint, _pair(anchor), _pair(centre), body.mass, inertia))
        if link.hinge is not None:
            hinges.append(tree_hinge(link.hinge.record, dof, link.sign))
        dof += bodies[-1].dofs
    return TreeModel(
        bodies=tuple(bodies),
        hinges=tuple(hinges),
        loads=tuple(_loads(structure, mechanism, duration)),
        drives=tuple(_drives(structure, mechanism, duration)),
        holds=tuple(_holds(structure, mechanism)),
        welds=tuple(_welds(mechanism)),
        gravity=_pair(plane.flat(np.asarray(structure.gravity, float))),
        length=max(structure.frame_of(name).length for name in structure.members),
    )


def tree_hinge(record: HingeRecord, dof: int, sign: float = 1.0) -> TreeHinge:
    """A record as the kernel takes it; a joint that turns the other way swaps the senses."""
    senses = ((record.positive, record.stop_positive), (record.negative, record.stop_negative))
    (positive, stop_positive), (negative, stop_negative) = senses if sign > 0.0 else senses[::-1]
    return TreeHinge(
        dof=dof,
        form=FORMS[record.form],
        softening=SOFTENING[record.softening_variable],
        positive=_curve(positive),
        negative=_curve(negative),
        elastic_stiffness=record.elastic_stiffness,
        regularisation_rate=record.regularisation_rate,
        rate_reference=record.rate_reference,
        rate_exponent=record.rate_exponent,
        viscous_damping=record.viscous_damping,
        stop_positive=_stop(stop_positive),
        stop_negative=_stop(stop_negative),
    )


def start_of(structure: Structure, mechanism: Mechanism) -> Start:
    """Velocities and impulses at the start, gathered as momentum of every body."""
    plane, n = mechanism.plane, len(mechanism.bodies)
    momentum, impulse = np.zeros((n, 3)), np.zeros((n, 3))
    energy = 0.0
    for part, body, fields in _moving_parts(structure, mechanism):
        if part.mass == 0.0:
            continue
        velocity = np.sum([_velocity(field, part.centre) for field in fields], axis=0)
        rate = np.sum([_rate(field) for field in fields], axis=0)
        energy += (part.mass * velocity @ velocity + rate @ part.inertia @ rate) / 2
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
    parts = np.array([mechanism.parts_of(body) for body in range(n)])
    velocity = momentum / (parts[:, None] * inertia.reshape(n, 3))
    impulse /= parts[:, None]
    for twin, whole in mechanism.welds:
        velocity[twin] = velocity[whole] if whole != GROUND else 0.0
        impulse[twin] = impulse[whole] if whole != GROUND else 0.0
    return Start(velocity, impulse, energy)


def _moving_parts(
    structure: Structure, mechanism: Mechanism
) -> Iterator[tuple[RigidMass, int, list[InitialVelocity]]]:
    """Every part with mass, its body, and the velocity fields that act on it."""

    def fields(kind: str, name: str) -> list[InitialVelocity]:
        def acts(field: InitialVelocity) -> bool:
            everywhere = field.nodes is None and field.members is None
            return everywhere or name in (getattr(field, kind) or ())

        return [field for field in structure.initial_velocity if acts(field)]

    for name, pieces in mechanism.pieces.items():
        if found := fields("members", name):
            for piece in pieces:
                yield piece_mass(structure, name, piece.start, piece.end), piece.body, found
    for mass in structure.masses.values():
        if found := fields("nodes", mass.node):
            yield lump_mass(structure, mass), mechanism.node_body[mass.node], found


def _rate(field: InitialVelocity) -> Floats:
    if field.axis is None:
        return np.zeros(3)
    axis = np.asarray(field.axis, float)
    return field.rotation * axis / np.linalg.norm(axis)


def _velocity(field: InitialVelocity, point: Floats) -> Floats:
    return np.asarray(field.translation, float) + np.cross(
        _rate(field), point - np.asarray(field.about, float)
    )


def _in_plane(mechanism: Mechanism, body: int, vector: Floats, where: str) -> None:
    """Refuse motion across the plane of a part that floats; a held one carries it in its hinges."""
    while mechanism.links[body].parent != GROUND:
        body = mechanism.links[body].parent
    if not mechanism.links[body].free:
        return
    if abs(vector @ mechanism.plane.normal) > ACROSS * float(np.linalg.norm(vector)):
        normal = ", ".join(f"{value:.3g}" for value in mechanism.plane.normal)
        what = "a floating part moves out of the plane; the multibody engine solves planar motion so far"
        todo = "take the part across the plane away, or turn the hinges' axes"
        raise InputError(Problem(what, f"{vector}", f"motion across [{normal}]", todo, where))


def _loads(structure: Structure, mechanism: Mechanism, duration: float) -> Iterator[TreeLoad]:
    plane = mechanism.plane
    for load in structure.loads:
        body = mechanism.node_body[load.node]
        if body == GROUND:
            continue
        point = _point(structure, mechanism, load.node)
        for kind, components in (("", load.force), ("r", load.moment)):
            for axis in components.model_fields_set:
                function, row = getattr(components, axis), plane.row(kind + axis)
                if function is not None and any(row):
                    yield TreeLoad(body, point, row, *_sampled(function, duration))


def _drives(structure: Structure, mechanism: Mechanism, duration: float) -> Iterator[TreeDrive]:
    """Driven freedoms of supports."""
    plane = mechanism.plane
    for name, support in structure.supports.items():
        body = mechanism.node_body[support.node]
        if body == GROUND:
            continue
        point = _point(structure, mechanism, support.node)
        for freedom in support.motion.model_fields_set:
            function, row = getattr(support.motion, freedom), plane.row(freedom)
            if function is None:
                continue
            if abs(math.hypot(*row) - 1.0) > ACROSS:
                raise InputError(
                    Problem(
                        "the driven direction lies across the plane of motion",
                        f"{freedom} of node {support.node}",
                        "a direction in the plane, or the rotation about its normal",
                        "drive another freedom, or turn the hinges' axes",
                        f"supports.{name}.motion",
                    )
                )
            times, values, rates = _sampled_motion(function, duration)
            yield TreeDrive(body, point, row, times, values, rates=rates)


def _holds(structure: Structure, mechanism: Mechanism) -> Iterator[TreeHold]:
    """Held freedoms of nodes that no clamp and no pin joint holds already."""
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
    """Parts of cut bodies, each held to its body where it hangs: at its own joint."""
    flat = mechanism.plane.flat
    for part, whole in mechanism.welds:
        joint = mechanism.links[part].position
        origin = mechanism.links[whole].position if whole != GROUND else np.zeros(3)
        yield TreeWeld(part, whole, (0.0, 0.0), _pair(flat(joint - origin)))


def _point(structure: Structure, mechanism: Mechanism, node: str) -> tuple[float, float]:
    """A node in the frame of its body."""
    link = mechanism.links[mechanism.node_body[node]]
    return _pair(mechanism.plane.flat(np.asarray(structure.nodes[node], float) - link.position))


def _sampled(function: TimeFunction, duration: float, error: float = SAMPLING) -> tuple[Floats, Floats]:
    coarse = np.abs(function(np.linspace(0.0, duration, 257)))
    return function.sampled(0.0, duration, max(error * float(coarse.max()), 1e-12))


def _sampled_motion(function: TimeFunction, duration: float) -> tuple[Floats, Floats, Floats]:
    """Times, displacements and rates of a driven motion; the rate's straight pieces add up to the motion."""
    times, values = _sampled(function, duration, DRIVE_SAMPLING)
    rates = np.asarray(function.derivative(times))
    # the rate just before each sample that makes its piece end where the motion does; at a kink it differs
    before = 2.0 * np.diff(values) / np.diff(times) - rates[:-1]
    kinks = np.flatnonzero(np.abs(before - rates[1:]) > KINK * np.abs(rates).max())
    brief = np.minimum(BRIEF * duration, np.diff(times)[kinks] / 2)
    times = np.insert(times, kinks + 1, times[kinks + 1] - brief)
    return times, np.insert(values, kinks + 1, values[kinks + 1]), np.insert(rates, kinks + 1, before[kinks])


def _curve(envelope: Envelope) -> tuple[Floats, Floats]:
    return envelope.rotation, envelope.moment


def _stop(stop: Stop | None) -> tuple[float, ...]:
    if stop is None:
        return ()
    return (stop.rotation, stop.stiffness, stop.exponent, stop.damping, stop.full_damping_penetration)


def _pair(vector: Floats) -> tuple[float, float]:
    return float(vector[0]), float(vector[1])


def _cross(a: Floats, b: Floats) -> float:
    return float(a[0] * b[1] - a[1] * b[0])
