"""Members that carry more torque than their section and cannot twist, and open ones that twist far.

A hinge about bending axes alone carries any torque along its member.  The largest that two outputs in a row
reach is compared with the plastic torque of the member: of an open section with that of the warping that its
ends hold.  A member with one hinge that twists carries no more than that takes: so do all elastic members.

Elastic members of open sections have joints that only twist.  An obstacle meets the outline of such a section
anywhere, while in shells a flange without support gives way, and the web beside it carries the load.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from crumple.hinge import Freedom, build_torsion_law
from crumple.hinge.registry import OPEN_TORSION
from crumple.multibody.answer.forces import on_second
from crumple.multibody.answer.poses import SpatialPoses
from crumple.multibody.answer.solved import Solved
from crumple.multibody.checks.names import named
from crumple.numeric.rotation import turned
from crumple.result import Caution
from crumple.structure import Structure, placed_hinges
from crumple.structure.hinges.automatic import twists
from crumple.structure.hinges.runs.bars import bar_of, is_closed
from crumple.structure.hinges.runs.straight_runs import straight_run
from crumple.structure.hinges.shares import warping_span
from crumple.structure.hinges.spatial_hinges import interaction_of
from crumple.structure.struck_places import struck_places

TWISTED = math.radians(16.0)
"""Plastic twist of members between rigid ends up to which their law was compared with shells [rad]."""
ROUNDED = 1.0 - 1e-9
"""Share of the limit below which a moment is, whatever the rounding of its part along the member."""


def torque_cautions(structure: Structure, solved: Solved) -> Iterator[Caution]:
    """Cautions on torque.

    Parameters
    ----------
    structure, solved
        The structure and the result of its run.
    """
    yield from torques_without_twist(structure, solved)
    yield from twisted_members(structure, solved)


def twisted_members(structure: Structure, solved: Solved) -> Iterator[Caution]:
    """One caution for all open members that an obstacle strikes and that twist further than was compared.

    The plastic twist is at least the energy of the joints over their largest torques.
    """
    joints = {(one.member, one.station): one for one in placed_hinges(structure) if one.only_twists}
    twists_of: dict[str, float] = {}
    for (member, station), energy in solved.spread.items():
        joint = joints.get((member, station))
        if joint is not None and energy.size:
            twist = float(energy[-1]) / float(joint.record.positive.moment.max())
            twists_of[member] = twists_of.get(member, 0.0) + twist
    run = {member: straight_run(structure, member).stretches for member in twists_of}
    far = {
        member: twist
        for member, twist in twists_of.items()
        if twist > TWISTED and any(struck_places(structure, name) for name in run[member])
    }
    if far:
        most = math.degrees(max(far.values()))
        text = (
            f"{named('Member', list(far))} of open section, which an obstacle strikes, "
            f"{'twists' if len(far) == 1 else 'twist'} by up to {most:.3g} deg: the obstacle presses on the "
            "outline of the section, in truth on the wall beside a flange that gives way, which twists it "
            "far less. Hold the rotation of a node beside it about the member, or solve with shells."
        )
        for member, twist in far.items():
            yield Caution("open_member_twists", twist, TWISTED, "rad", f"member {member}", text)


def torques_without_twist(structure: Structure, solved: Solved) -> Iterator[Caution]:
    """One caution for all members that would yield in torsion, and cannot.

    Parameters
    ----------
    structure, solved
        The structure and the result of its run.  The planar kernel gives no forces, and so no caution.
    """
    found: dict[str, tuple[float, float]] = {}
    for member, torque, limit in _torques(structure, solved):
        if torque > found.get(member, (limit, limit))[0]:
            found[member] = torque, limit
    if found:
        one, most = len(found) == 1, max(torque / limit for torque, limit in found.values())
        text = (
            f"{named('Member', list(found))} {'carries' if one else 'carry'} up to {most:.3g} times the "
            f"plastic torque of {'its section' if one else 'their sections'}, but the hinges there cannot "
            "twist: the model is rigid in torsion. Give them 'axes: [y, z, x]'."
        )
        for member, (torque, limit) in found.items():
            yield Caution("torque_without_twist", torque, limit, "N*m", f"member {member}", text)


def _torques(structure: Structure, solved: Solved) -> Iterator[tuple[str, float, float]]:
    """Members without a hinge that twists, with torques that persist for two outputs and the limit [N m].

    Connections whose whole moment stays below the limit are left out.
    """
    poses = solved.poses
    if not isinstance(poses, SpatialPoses) or poses.rows < 2:
        return
    connections = poses.linkage.connections
    hinged = [(i, one.first, one.hinge.member) for i, one in enumerate(connections) if one.hinge is not None]
    twisting = {member for i, _, member in hinged if int(Freedom.X) in connections[i].free}
    sizes = np.linalg.norm(poses.record.joint_force[..., 3:], axis=-1)
    most = np.minimum(sizes[1:], sizes[:-1]).max(axis=0)
    for i, body, member in hinged:
        if member in twisting or not twists(structure, member):
            continue
        limit = _plastic_torque(structure, member)
        if most[i] < ROUNDED * limit:
            continue
        axis = turned(poses.quaternion(body), structure.frame_of(member).x)
        torque = np.abs(np.einsum("ni,ni->n", on_second(poses, i).moment, axis))
        yield member, float(np.minimum(torque[1:], torque[:-1]).max()), limit


def _plastic_torque(structure: Structure, member: str) -> float:
    """Torque at which a member yields along all of its length [N m]."""
    metal = structure.section_of(member), structure.material_of(member)
    if is_closed(metal[0]):
        return interaction_of(*metal).plastic_torque
    span, held_ends = warping_span(structure, bar_of(structure, member))
    return build_torsion_law(OPEN_TORSION, *metal, span, held_ends=held_ends).steady_torque
