"""From the kernel's record to named channels and summaries."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from crumple._core.tree import TreeRecord
from crumple.multibody.mechanism import Mechanism
from crumple.multibody.poses import Poses, piece_at
from crumple.multibody.rigid import Floats
from crumple.result import Channel, HingeSummary
from crumple.structure import Outputs, PlacedHinge, Structure
from crumple.structure.bending import bending_axis

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


def node_channels(structure: Structure, poses: Poses, nodes: Sequence[str]) -> Iterator[Channel]:
    """Displacement, velocity, mean acceleration between outputs, and rotation of nodes, in global axes."""
    for name in nodes:
        body = poses.node_body[name]
        start = np.asarray(structure.nodes[name], float)
        place, velocity = poses.place(body, start)
        rotation, rate = poses.rotation(body)
        acceleration = np.gradient(velocity, poses.time, axis=0) if poses.time.size > 1 else 0.0 * velocity
        fields = (
            ("displacement", "m", place - start),
            ("velocity", "m/s", velocity),
            ("acceleration", "m/s^2", acceleration),
            ("rotation", "rad", rotation),
            ("rotation_rate", "rad/s", rate),
        )
        for field, unit, values in fields:
            for i, axis in enumerate(AXES):
                yield Channel(f"node.{name}.{field}.{axis}", unit, np.ascontiguousarray(values[:, i]))


def section_channels(structure: Structure, poses: Poses, outputs: Outputs) -> Iterator[Channel]:
    """Rotation of one station of a member against another, about the member's axis across the plane."""
    for name, asked in outputs.section_rotations.items():
        frame = structure.frame_of(asked.member)
        ends = [piece_at(poses.pieces, asked.member, station).body for station in (asked.start, asked.end)]
        turned = poses.relative(ends[0], ends[1])
        if poses.normal is None:
            yield Channel(name, "rad", turned @ frame.axis(bending_axis(structure, asked.member)))
            continue
        projected = np.array([frame.y @ poses.normal, frame.z @ poses.normal])
        sign = float(np.sign(projected[np.argmax(np.abs(projected))]) or 1.0)
        yield Channel(name, "rad", sign * (turned @ poses.normal))


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
