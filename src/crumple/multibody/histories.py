"""From the kernel's record to named channels and summaries."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from crumple._core.tree import TreeRecord
from crumple.multibody.mechanism import GROUND, Mechanism
from crumple.multibody.rigid import Floats
from crumple.result import Channel, HingeSummary
from crumple.structure import Outputs, PlacedHinge, Structure

AXES = ("x", "y", "z")


def hinge_links(mechanism: Mechanism) -> list[tuple[int, PlacedHinge, float]]:
    """Joint coordinate, hinge and sign of every hinge, in the kernel's order."""
    found, dof = [], 0
    for link in mechanism.links:
        if link.hinge is not None:
            found.append((dof, link.hinge, link.sign))
        dof += 3 if link.free else 1
    return found


def hinge_channels(mechanism: Mechanism, record: TreeRecord) -> Iterator[Channel]:
    """Rotation, rates, moment, capacity and absorbed energy of every hinge."""
    for k, (dof, hinge, sign) in enumerate(hinge_links(mechanism)):
        plastic, moment, capacity, dissipated = record.hinge[:, k, :4].T
        columns = (
            ("rotation", "rad", sign * record.q[:, dof]),
            ("rotation_rate", "rad/s", sign * record.w[:, dof]),
            ("plastic_rotation", "rad", sign * plastic),
            ("moment", "N*m", sign * moment),
            ("capacity", "N*m", capacity),
            ("energy", "J", dissipated),
        )
        yield from (Channel(f"hinge.{hinge.name}.{name}", unit, values) for name, unit, values in columns)


def energy_channels(record: TreeRecord) -> Iterator[Channel]:
    """Ledger: kinetic + elastic + dissipated - external work - start = residual."""
    kinetic, external = record.energy[:, 0], record.energy[:, 5]
    dissipated = record.hinge[:, :, 3].sum(axis=1)
    stored = record.energy[:, 1:5].sum(axis=1) - dissipated
    residual = kinetic + stored + dissipated - external
    columns = {
        "kinetic": kinetic,
        "elastic": stored,
        "dissipated": dissipated,
        "external_work": external,
        "residual": residual - (residual[0] if residual.size else 0.0),
    }
    yield from (Channel(f"energy.{name}", "J", values) for name, values in columns.items())


def node_channels(
    structure: Structure, mechanism: Mechanism, record: TreeRecord, nodes: Sequence[str]
) -> Iterator[Channel]:
    """Displacement, velocity, mean acceleration between outputs, and rotation of nodes, in global axes."""
    plane = mechanism.plane
    for name in nodes:
        body = mechanism.node_body[name]
        start = np.asarray(structure.nodes[name], float)
        place, velocity, angle, rate = motion_of(mechanism, record, body, start)
        acceleration = np.gradient(velocity, record.time, axis=0) if record.time.size > 1 else 0.0 * velocity
        fields = (
            ("displacement", "m", place - start),
            ("velocity", "m/s", velocity),
            ("acceleration", "m/s^2", acceleration),
            ("rotation", "rad", angle[:, None] * plane.normal),
            ("rotation_rate", "rad/s", rate[:, None] * plane.normal),
        )
        for field, unit, values in fields:
            for i, axis in enumerate(AXES):
                yield Channel(f"node.{name}.{field}.{axis}", unit, np.ascontiguousarray(values[:, i]))


def motion_of(
    mechanism: Mechanism, record: TreeRecord, body: int, point: Floats
) -> tuple[Floats, Floats, Floats, Floats]:
    """Motion of a point that is fixed to a body.

    Parameters
    ----------
    body
        Its number; -1 for the ground.
    point
        Position at the start, global [m], (3,).

    Returns
    -------
    place, velocity
        Global [m], [m/s], (n, 3).
    angle, rate
        Of the body about the plane's normal [rad], [rad/s], (n,).
    """
    n = record.time.size
    if body == GROUND:
        return np.tile(point, (n, 1)), np.zeros((n, 3)), np.zeros(n), np.zeros(n)
    plane = mechanism.plane
    angle, rate = record.pose[:, body, 0], record.velocity[:, body, 0]
    arm = point - mechanism.bodies[body].centre
    origin = mechanism.bodies[body].centre - mechanism.links[body].position
    turned = rotated(plane.flat(arm), angle)
    centre = record.pose[:, body, 1:] + rotated(plane.flat(origin), angle)
    across = float(point @ plane.normal) * plane.normal
    flat_velocity = record.velocity[:, body, 1:] + rate[:, None] * np.stack(
        [-turned[:, 1], turned[:, 0]], axis=1
    )
    return plane.raised(centre + turned) + across, plane.raised(flat_velocity), angle, rate


def rotated(vector: Floats, angle: Floats) -> Floats:
    """A plane vector (2,) turned by every angle (n,): (n, 2)."""
    c, s = np.cos(angle), np.sin(angle)
    return np.stack([c * vector[0] - s * vector[1], s * vector[0] + c * vector[1]], axis=1)


def section_channels(
    structure: Structure, mechanism: Mechanism, record: TreeRecord, outputs: Outputs
) -> Iterator[Channel]:
    """Rotation of one station of a member against another, about the member's own axis nearest the normal."""
    for name, asked in outputs.section_rotations.items():
        frame = structure.frame_of(asked.member)
        projected = np.array([frame.y @ mechanism.plane.normal, frame.z @ mechanism.plane.normal])
        sign = float(np.sign(projected[np.argmax(np.abs(projected))]) or 1.0)
        ends = [mechanism.piece_at(asked.member, station).body for station in (asked.start, asked.end)]
        angles = [record.pose[:, b, 0] if b != GROUND else np.zeros(record.time.size) for b in ends]
        yield Channel(name, "rad", sign * (angles[1] - angles[0]))


def summaries(
    mechanism: Mechanism, record: TreeRecord, errors: Floats | None = None
) -> dict[str, HingeSummary]:
    """What every hinge did.

    Parameters
    ----------
    errors
        Estimated error of each largest rotation [rad], (hinges,), or None.
    """
    found = {}
    for k, (dof, hinge, sign) in enumerate(hinge_links(mechanism)):
        rotation_max, moment_max, rest, turning, energy = record.summary[k]
        law, envelopes = hinge.law, (hinge.record.positive, hinge.record.negative)
        rotation = np.union1d(envelopes[0].rotation, envelopes[1].rotation)
        positive, negative = (np.interp(rotation, e.rotation, e.moment) for e in envelopes)
        found[hinge.name] = HingeSummary(
            rotation_max=float(rotation_max),
            rotation_final=float(sign * record.q[-1, dof]),
            time_of_rest=None if turning else float(rest),
            energy=float(energy),
            moment_max=float(moment_max),
            rotation_error=None if errors is None else float(errors[k]),
            law=law.title,
            source=f"{law.source.citation} ({law.source.trust.value})",
            form=hinge.record.form.value,
            validity_rotation=law.validity.rotation_max,
            validity_basis=law.validity.basis,
            envelope={"rotation": rotation, "positive": positive, "negative": negative},
            position=tuple(float(value) for value in hinge.position),  # type: ignore[arg-type]
        )
    return found
