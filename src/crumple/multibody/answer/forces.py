"""Forces that a spatial run transmits: in connections, on supports, and in sections of members.

A connection's force is what the kernel found.  A clamp's follows from the forces on the part that it holds.
In a section of a rigid piece it follows from the force at the piece's end and the inertia of what lies
between:

    force on the stretch between = mass times acceleration of its centre
    moment about the section     = change of angular momentum about it

Both are taken in the middle of the last step before an output, where the kernel's forces balance the change
of momentum of every body exactly.  So near a free end, where the moment is a small difference of large ones,
its relative error is that of the whole motion.

Contact forces on the stretch itself are not known piece by piece and are left out.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from crumple._core.spatial.simulation import MINIMUM_STEP
from crumple.errors import InputError, Problem
from crumple.multibody.answer.poses import SpatialHistory, piece_at
from crumple.multibody.bodies.assembly import Piece
from crumple.multibody.bodies.linkage import GROUND, Linkage
from crumple.multibody.bodies.rigid import piece_mass
from crumple.numeric.arrays import Floats
from crumple.numeric.rotation import cross, product, turned, vector_quaternion
from crumple.result import Channel
from crumple.result.channels import AXES, channels_along
from crumple.section import fitted_interaction, plastic_interaction
from crumple.structure import Outputs, SectionForce, Structure

TOGETHER = 64
"""Connections whose forces are found at once: enough for NumPy, few enough for the memory."""


@dataclass(frozen=True, eq=False)
class Wrench:
    """Force [N], moment about a point [N m] and that point [m], in global axes, (n, 3) each."""

    force: Floats
    moment: Floats
    point: Floats

    def about(self, point: Floats) -> Floats:
        """Moment about another point [N m], (n, 3)."""
        return self.moment + cross(self.point - point, self.force)

    def opposite(self) -> Wrench:
        """The reaction: the same with opposite sign."""
        return Wrench(-self.force, -self.moment, self.point)


def on_second(poses: SpatialHistory, number: int) -> Wrench:
    """Force and moment that a connection exerts on its second body, about its place on the first."""
    kept = poses.wrenches
    if number not in kept:
        kept |= _on_second(poses, _asked_with(poses.linkage, number))
    wrench: Wrench = kept[number]
    return wrench


def _asked_with(linkage: Linkage, number: int) -> list[int]:
    """Connections near one that are of its kind: elastic joints, of which few are asked for, or others."""
    begin = number - number % TOGETHER
    elastic = [
        one.hinge is not None and not one.hinge.plastic
        for one in linkage.connections[begin : begin + TOGETHER]
    ]
    return [begin + k for k, one in enumerate(elastic) if one == elastic[number - begin]]


def _on_second(poses: SpatialHistory, numbers: list[int]) -> dict[int, Wrench]:
    """The same of several connections."""
    found = [poses.linkage.connections[i] for i in numbers]
    first, second = (np.array([getattr(one, side) for one in found]) for side in ("first", "second"))
    half = vector_quaternion(poses.relatives(first, second) / 2.0)
    middle = product(poses.quaternions(first), half)
    axes = turned(middle[:, :, None], np.array([one.axes for one in found]))
    along = poses.record.joint_force[:, numbers]
    place, _ = poses.motions(first, np.array([one.position for one in found]))
    force, moment = (np.einsum("nmk,nmki->mni", part, axes) for part in (along[..., :3], along[..., 3:]))
    points = np.ascontiguousarray(np.swapaxes(place, 0, 1))
    return {i: Wrench(force[k], moment[k], points[k]) for k, i in enumerate(numbers)}


def force_channels(structure: Structure, poses: SpatialHistory, local_time: Floats) -> Iterator[Channel]:
    """Channels of the forces on second sides of connections, of nodes on members, and on supports.

    Parameters
    ----------
    structure, poses
        The structure and the positions of its bodies.
    local_time
        Time since the start of the stage [s], (n,), in which loads are given.
    """
    for i, connection in enumerate(poses.linkage.connections):
        if connection.hinge is not None and not connection.hinge.plastic:
            continue
        wrench = on_second(poses, i)
        if connection.kind == "hinge":
            yield from _channels(f"cut.{connection.name}", wrench.opposite())
        elif connection.kind == "joint":
            yield from _channels(f"joint.{connection.name}", wrench)
        else:
            yield from _channels(f"support.{connection.name}", wrench.opposite())
    for name, node in _clamps(structure, poses.linkage):
        yield from _channels(f"support.{name}", _on_clamp(structure, poses, node, local_time))


def section_force_channels(
    structure: Structure, poses: SpatialHistory, outputs: Outputs
) -> Iterator[Channel]:
    """Force and moment in sections, in axes that move with the member, and their use of the capacity."""
    middle = _midway(poses) if outputs.section_forces else poses
    for name, asked in outputs.section_forces.items():
        force, moment = _in_section(structure, middle, asked)
        for quantity, unit, values in (("force", "N", force), ("moment", "N*m", moment)):
            for i, axis in enumerate(AXES):
                yield Channel(f"{name}.{quantity}.{axis}", unit, np.ascontiguousarray(values[:, i]))
        fit = fitted_interaction(
            plastic_interaction(structure.section_of(asked.member), structure.material_of(asked.member))
        )
        together = np.column_stack([force[:, 0], moment[:, 1], moment[:, 2], moment[:, 0]])
        yield Channel(f"{name}.use", "1", fit.gauge(together))


def check_sections(structure: Structure, linkage: Linkage, outputs: Outputs) -> None:
    """Refuse sections whose forces the rigid model does not determine.

    Raises
    ------
    InputError
        With every such section.
    """
    problems = [
        Problem(
            "the forces in this section are not determined: its piece of the member is rigid up to nodes at "
            "both ends",
            f"{1e3 * asked.at:.6g} mm of member {asked.member}",
            "a section next to a hinge or joint",
            "put a hinge into the member, for example with hinges: auto",
            f"outputs.section_forces.{name}",
        )
        for name, asked in outputs.section_forces.items()
        if _closing(linkage, piece_at(linkage.pieces, asked.member, asked.at)) is None
    ]
    if problems:
        raise InputError(problems)


def _midway(poses: SpatialHistory) -> SpatialHistory:
    """Bodies in the middle of the last step before every output."""
    record = poses.record
    turn, way = np.split(record.travel / 2.0, 2, axis=2)
    rotation = product(vector_quaternion(-turn), record.rotation)
    return replace(poses, record=replace(record, centre=record.centre - way, rotation=rotation))


def _in_section(structure: Structure, poses: SpatialHistory, asked: SectionForce) -> tuple[Floats, Floats]:
    """Force and moment of the second side on the first, (n, 3) each, in axes that move with the member."""
    linkage, frame = poses.linkage, structure.frame_of(asked.member)
    piece = piece_at(linkage.pieces, asked.member, asked.at)
    closing = _closing(linkage, piece)
    assert closing is not None
    side, number = closing
    wrench = on_second(poses, number)
    if linkage.connections[number].second != piece.body or side == "end":
        wrench = wrench.opposite()
    ends = (piece.start, asked.at) if side == "start" else (asked.at, piece.end)
    section = poses.place(piece.body, frame.position(asked.at))[0]
    needed, spin = _momentum_rate(structure, poses, piece, ends, section)
    force = needed - wrench.force
    moment = spin - wrench.about(section)
    if side == "end":
        force, moment = -force, -moment
    axes = turned(poses.quaternion(piece.body)[:, None], frame.axes[None])
    return np.einsum("nki,ni->nk", axes, force), np.einsum("nki,ni->nk", axes, moment)


def _momentum_rate(
    structure: Structure, poses: SpatialHistory, piece: Piece, ends: tuple[float, float], section: Floats
) -> tuple[Floats, Floats]:
    """Force [N] and moment about a section [N m], (n, 3), that move a stretch, less those of gravity."""
    stretch = piece_mass(structure, piece.member, *ends)
    gravity = np.asarray(structure.gravity, float)
    centre, _ = poses.place(piece.body, stretch.centre)
    if piece.body == GROUND:
        force = np.tile(-stretch.mass * gravity, (poses.rows, 1))
        return force, cross(centre - section, force)
    record, body = poses.record, poses.linkage.bodies[piece.body]
    after, _ = np.split(record.velocity[:, piece.body], 2, axis=1)
    turning, moving = np.split(record.acceleration[:, piece.body], 2, axis=1)
    step = np.maximum(record.step, MINIMUM_STEP)[:, None]
    before, spin = after - step * turning, after - step * turning / 2.0
    arm = centre - record.centre[:, piece.body]
    moved = stretch.mass * (moving - gravity)
    force = moved + stretch.mass * (cross(turning, arm) + cross(spin, cross(spin, arm)))
    # about the body's centre, between the true ends of the step as the kernel takes it
    offset = np.asarray(stretch.centre - body.centre)
    inertia = stretch.inertia + stretch.mass * (offset @ offset * np.eye(3) - np.outer(offset, offset))
    half = record.travel[:, piece.body, :3] / 2.0
    middle = poses.quaternion(piece.body)
    change = _momentum(inertia, product(vector_quaternion(half), middle), after)
    change -= _momentum(inertia, product(vector_quaternion(-half), middle), before)
    about = change / step + cross(arm, moved)
    return force, about + cross(centre - arm - section, force)


def _momentum(inertia: Floats, quaternion: Floats, spin: Floats) -> Floats:
    """Angular momentum of a body with an inertia at the start, (n, 3)."""
    columns = turned(quaternion[:, None], np.eye(3)[None])
    return np.asarray(np.einsum("nki,kl,nlj,nj->ni", columns, inertia, columns, spin))


def _closing(linkage: Linkage, piece: Piece) -> tuple[Literal["start", "end"], int] | None:
    """The connection at an end of a piece from which its section forces follow, and that end (0 or 1)."""
    pieces = linkage.pieces[piece.member]
    for i, connection in enumerate(linkage.connections):
        hinge = connection.hinge
        if hinge is not None and hinge.member == piece.member:
            if hinge.station == piece.start and piece is not pieces[0]:
                return "start", i
            if hinge.station == piece.end and piece is not pieces[-1]:
                return "end", i
    for i, connection in enumerate(linkage.connections):
        if connection.end is not None and connection.end[0] == piece.member:
            if connection.end[1] == 0 and piece is pieces[0]:
                return "start", i
            if connection.end[1] == 1 and piece is pieces[-1]:
                return "end", i
    return None


def _clamps(structure: Structure, linkage: Linkage) -> Iterator[tuple[str, str]]:
    """Supports that clamp a node which is alone on its rigid part, with that node."""
    held: dict[str, list[str]] = {}
    for name, support in structure.supports.items():
        if linkage.node_part[support.node] in linkage.ground_parts:
            held.setdefault(support.node, []).append(name)
    parts = [linkage.node_part[node] for node in held]
    for node, names in held.items():
        if parts.count(linkage.node_part[node]) == 1 and len(names) == 1:
            yield names[0], node


def _on_clamp(structure: Structure, poses: SpatialHistory, node: str, local_time: Floats) -> Wrench:
    """Force and moment of a rigid part of the ground on the support of its one clamped node, about it."""
    linkage, part = poses.linkage, poses.linkage.node_part[node]
    place = np.asarray(structure.nodes[node], float)
    force, moment = np.zeros((poses.rows, 3)), np.zeros((poses.rows, 3))
    for i, connection in enumerate(linkage.connections):
        if part in connection.parts:
            wrench = on_second(poses, i)
            wrench = wrench if connection.parts[1] == part else wrench.opposite()
            force, moment = force + wrench.force, moment + wrench.about(place)
    if part in linkage.part_mass:
        lump = linkage.part_mass[part]
        weight = lump.mass * np.asarray(structure.gravity, float)
        force, moment = force + weight, moment + cross(lump.centre - place, weight)
    for load in structure.loads:
        if linkage.node_part[load.node] != part:
            continue
        arm = np.asarray(structure.nodes[load.node], float) - place
        for i, axis in enumerate(AXES):
            pushed, bent = getattr(load.force, axis), getattr(load.moment, axis)
            if pushed is not None:
                one = np.outer(pushed(local_time), np.eye(3)[i])
                force, moment = force + one, moment + cross(arm, one)
            if bent is not None:
                moment = moment + np.outer(bent(local_time), np.eye(3)[i])
    return Wrench(force, moment, np.broadcast_to(place, force.shape))


def _channels(name: str, wrench: Wrench) -> Iterator[Channel]:
    yield from channels_along(f"{name}.force", wrench.force)
    yield from channels_along(f"{name}.moment", wrench.moment)
