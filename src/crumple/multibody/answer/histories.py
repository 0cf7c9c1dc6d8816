"""Named channels and summaries from a kernel's run."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence

import numpy as np

from crumple.hinge import HingeRecord
from crumple.hinge.law_use import LawUse
from crumple.multibody.answer.dents import DentHistory, WallMotion
from crumple.multibody.answer.poses import Poses, piece_at
from crumple.multibody.answer.solved import HingeHistory, Solved
from crumple.multibody.answer.stated_errors import StatedErrors
from crumple.multibody.bodies.rigid import lump_mass, piece_mass
from crumple.numeric.arrays import Floats
from crumple.result import Channel, HingeSummary
from crumple.result.channels import channel, channels_along
from crumple.result.clearance import clearance
from crumple.section import Axis
from crumple.structure import Outputs, PlacedHinge, Structure
from crumple.structure.bending import bending_axis


def hinge_channels(
    hinges: Iterable[HingeHistory],
    spread: Mapping[tuple[str, float], Floats],
    dents: Iterable[DentHistory],
) -> Iterator[Channel]:
    """Rotation, rates, moment, capacity and energy of every hinge, and the energy of every member.

    `spread`: what elastic members dissipated between their hinges [J], by member and station [m]; `dents`: in
    their walls.
    """
    by_member: dict[str, Floats] = {}
    between = [(member, energy) for (member, _), energy in spread.items()]
    for member, energy in (*between, *((dent.tube.member, dent.energy) for dent in dents)):
        by_member[member] = by_member.get(member, 0.0) + energy
    for history in hinges:
        member = history.hinge.member
        by_member[member] = by_member.get(member, 0.0) + history.values("energy")
        for name, values in history.columns.items():
            yield channel(f"hinge.{history.hinge.name}.{name}", values)
    yield from (channel(f"member.{name}.energy", values) for name, values in by_member.items())


def energy_channels(solved: Solved) -> Iterator[Channel]:
    """Ledger: kinetic + elastic + dissipated (+ contact + friction) - external work - start = residual."""
    columns = {**solved.energy, "residual": solved.balance}
    yield from (channel(f"energy.{name}", values) for name, values in columns.items())


def node_channels(
    structure: Structure,
    poses: Poses,
    nodes: Sequence[str],
    time: Floats,
    walls: Mapping[str, WallMotion],
) -> Iterator[Channel]:
    """Displacement, velocity, mean acceleration between outputs, and rotation of nodes, in global axes.

    `walls`: motion of the walls at nodes in dents.  The place of a node is the mean of its section's walls.
    """
    for name in nodes:
        yield from node_motion(structure, poses, name, walls.get(name), time)


def node_motion(
    structure: Structure, poses: Poses, name: str, walls: WallMotion | None, time: Floats | None = None
) -> Iterator[Channel]:
    """The same for one node; without acceleration if the rows have no `time`, (n,)."""
    start = np.asarray(structure.nodes[name], float)
    place, velocity = node_place(structure, poses, name)
    if walls is not None:
        place, velocity = place + walls[0], velocity + walls[1]
    rotation, rate = _mean([poses.rotation(body) for body in poses.node_sides(name)])
    fields = {"displacement": place - start, "velocity": velocity}
    if time is not None:
        acceleration = np.gradient(velocity, time, axis=0) if time.size > 1 else 0.0 * velocity
        fields["acceleration"] = acceleration
    fields |= {"rotation": rotation, "rotation_rate": rate}
    for field, values in fields.items():
        yield from channels_along(f"node.{name}.{field}", values)


def node_place(structure: Structure, poses: Poses, node: str) -> tuple[Floats, Floats]:
    """Position [m] and velocity [m/s] of a node, the mean of its sides, (n, 3) each."""
    start = np.asarray(structure.nodes[node], float)
    return _mean([poses.place(body, start) for body in poses.node_sides(node)])


def _mean(motions: Sequence[tuple[Floats, Floats]]) -> tuple[Floats, Floats]:
    """Mean of motions, each two vectors, (n, 3)."""
    first, second = zip(*motions, strict=True)
    return np.mean(first, axis=0), np.mean(second, axis=0)


def section_channels(structure: Structure, poses: Poses, outputs: Outputs) -> Iterator[Channel]:
    """Rotation of one station of a member relative to another, about the member's axis across the plane."""
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


def distance_channels(
    structure: Structure, poses: Poses, outputs: Outputs, walls: Mapping[str, WallMotion]
) -> Iterator[Channel]:
    """Change of the distance between two nodes, negative if they approach.  `walls`: as for nodes."""
    for name, asked in outputs.distances.items():
        nodes = asked.start, asked.end
        ends = [np.asarray(structure.nodes[node], float) for node in nodes]
        places = [
            node_place(structure, poses, node)[0] + (walls[node][0] if node in walls else 0.0)
            for node in nodes
        ]
        before = float(np.linalg.norm(ends[1] - ends[0]))
        yield Channel(name, "m", np.linalg.norm(places[1] - places[0], axis=1) - before)


def clearance_channels(structure: Structure, poses: Poses, outputs: Outputs) -> Iterator[Channel]:
    """Smallest distance between a space that moves with a member and the other members; negative inside."""
    for name, asked in outputs.clearances.items():
        middle = structure.frame_of(asked.moves_with).length / 2.0
        carrier = piece_at(poses.pieces, asked.moves_with, middle).body
        corners = [poses.place(carrier, np.asarray(point, float))[0] for point in asked.points]
        bars, radii = [], []
        for member in asked.members or [other for other in structure.members if other != asked.moves_with]:
            frame, outline = structure.frame_of(member), structure.section_of(member).outer_outline()
            for piece in poses.pieces[member]:
                ends = [poses.place(piece.body, frame.position(s))[0] for s in (piece.start, piece.end)]
                bars.append(np.stack(ends, axis=1))
                radii.append(float(np.ptp(outline, axis=0).max()) / 2.0)
        least = clearance(np.stack(corners, axis=1), np.stack(bars, axis=1), np.array(radii))
        yield Channel(name, "m", least)


def gravity_channels(structure: Structure, poses: Poses) -> Iterator[Channel]:
    """Work of gravity since the start; empty without gravity."""
    gravity = np.asarray(structure.gravity, float)
    if not gravity.any():
        return
    parts = [
        (piece_mass(structure, member, piece.start, piece.end), piece.body)
        for member, pieces in poses.pieces.items()
        for piece in pieces
    ]
    parts += [(lump_mass(structure, lump), poses.node_body[lump.node]) for lump in structure.masses.values()]
    places, _ = poses.motions(
        np.array([body for _, body in parts]), np.array([part.centre for part, _ in parts])
    )
    work = sum(part.mass * ((places[:, k] - part.centre) @ gravity) for k, (part, _) in enumerate(parts))
    yield channel("energy.gravity", np.asarray(work, float))


def summaries(
    hinges: Iterable[HingeHistory],
    errors: StatedErrors | None = None,
    use: Callable[[str, Axis], LawUse | None] | None = None,
) -> dict[str, HingeSummary]:
    """Summaries of all hinges.

    Parameters
    ----------
    hinges
        Histories.
    errors
        Estimated errors, or None.
    use
        Says where the law of a hinge about an axis comes from.
    """
    found = {}
    for k, history in enumerate(hinges):
        hinge = history.hinge
        axis, law, bent = history.judged_by()
        record = _record_about(hinge, axis)
        envelopes = record.positive, record.negative
        rotation = np.union1d(envelopes[0].rotation, envelopes[1].rotation)
        positive, negative = (np.interp(rotation, e.rotation, e.moment) for e in envelopes)
        found[hinge.name] = HingeSummary(
            rotation_max=history.rotation_max,
            rotation_final=float(history.values("rotation")[-1]),
            time_of_rest=history.time_of_rest,
            energy=history.energy,
            moment_max=history.moment_max,
            fracture_time=history.fracture[0] if history.fracture else None,
            fracture_moment=history.fracture[1] if history.fracture else None,
            rotation_error=None if errors is None else float(errors.rotation[k]),
            energy_error=None if errors is None else float(errors.energy[k]),
            law=law.title,
            source=f"{law.source.citation} ({law.source.trust.value})",
            form=hinge.record.form.value,
            validity_rotation=law.validity.rotation_max,
            validity_basis=law.validity.basis,
            envelope={"rotation": rotation, "positive": positive, "negative": negative},
            position=tuple(float(value) for value in hinge.position),  # type: ignore[arg-type]
            law_rotation=bent,
            law_use=None if use is None else use(hinge.name, axis),
        )
    return found


def _record_about(hinge: PlacedHinge, axis: Axis) -> HingeRecord:
    """Curves of a hinge about one of its bending axes."""
    components = () if hinge.spatial is None else hinge.spatial.components
    return next((one.record for one in components if one.freedom.label == axis), hinge.record)
