"""Sections beside nodes that carry more than their walls can, where the model has no hinge.

A rigid bar carries any load.  What loads the end of a member at a node follows from the forces of the
connections on one side of it, where the rigid parts of the model branch like a tree:

    force = sum of the connections' forces,    moment = sum of their moments about the node

without the inertia of the rigid parts between, which must carry no mass of their own.  It is compared with
the plastic interaction of the section.  An end with a hinge within one side and one fold of the node, or of
where the joint there ends, is left out: there the hinge stands for the fold.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator

import numpy as np

from crumple.hinge import Coupling
from crumple.multibody.answer.forces import on_second
from crumple.multibody.answer.poses import SpatialHistory, SpatialPoses
from crumple.multibody.answer.solved import Solved
from crumple.multibody.bodies.linkage import Linkage
from crumple.multibody.checks.names import named
from crumple.numeric.arrays import Floats
from crumple.numeric.rotation import turned
from crumple.result import Caution
from crumple.section import Axis, CircularTube, half_fold_length
from crumple.structure import Structure, placed_hinges
from crumple.structure.hinges.asked import automatic_of
from crumple.structure.hinges.corner_laws import corner_of
from crumple.structure.hinges.elastic_members import folds_from
from crumple.structure.hinges.joint_reach import joint_reach
from crumple.structure.hinges.joints.placed_hinge import PlacedHinge
from crumple.structure.hinges.spatial_hinges import interaction_fit_of
from crumple.units import format_quantity

USED = 1.1
"""Use of a section's capacity above which a caution is given: the fit of the interaction is up to 6 % off."""
FLANGE, PRESSED_TURN = 0.3, math.radians(3.0)
"""Share of a fold's moment that its compression would take if it turned about its tension flange, and turn
of a hinge above it, from which a caution says so."""
HELD = 0.1
"""Share of a fold's moment that tension would give it in the mean, from which a caution says so."""
LEAST_TURN = math.radians(1.0)
"""Rotation of a joint below which no fold of any section softens: its law is not asked."""
BEND = ", or let members bend with analysis.multibody.members: elastic"
"""What else helps rigid bars that carry too much."""
AXES: tuple[Axis, ...] = ("y", "z")


def overloaded_sections(structure: Structure, solved: Solved) -> Iterator[Caution]:
    """One caution for all members with an end that is overloaded and has no hinge.

    Parameters
    ----------
    structure, solved
        The structure and the result of its run.  The planar kernel gives no forces, and so no caution.
    """
    poses = solved.poses
    if not isinstance(poses, SpatialPoses) or poses.rows < 2:
        return
    found: dict[str, float] = {}
    hinges = np.array([hinge.position for hinge in poses.linkage.hinges]).reshape(-1, 3)
    for member, spec in structure.members.items():
        if spec.rigid is not False:
            continue
        for node in spec.nodes:
            if not _has_hinge(structure, hinges, member, node):
                use = _use(structure, poses, member, node)
                if use > USED:
                    found[member] = max(use, found.get(member, 0.0))
    if found:
        one = len(found) == 1
        text = (
            f"{named('Member', list(found))} {'is' if one else 'are'} loaded up to "
            f"{max(found.values()):.3g} times what the walls carry at an end without a hinge, where the "
            f"model is rigid: {'it' if one else 'they'} would fold there. {_helps(structure, found, solved)}."
        )
        for member, use in found.items():
            yield Caution("overloaded_section", use, USED, "1", f"member {member}", text)


def _helps(structure: Structure, members: Iterable[str], solved: Solved) -> str:
    """What else than it has lets a member fold or bend at its end."""
    automatic = all(automatic_of(structure, name) is not None for name in members)
    elastic = all(structure.members[name].elastic for name in members)
    found = "Give a hinge there with 'hinges'" if automatic else "Write 'hinges: auto'"
    return found if elastic or solved.bending_tried else found + BEND


def _has_hinge(structure: Structure, hinges: Floats, member: str, node: str) -> bool:
    """Whether one of the hinges, at places (hinges, 3), stands for a fold at a member's end."""
    section, place = structure.section_of(member), np.asarray(structure.nodes[node], float)
    side = float(np.ptp(section.outer_outline(), axis=0).max())
    near = joint_reach(structure, member, node) + side
    near += 2.0 * max(half_fold_length(section, axis) for axis in AXES)
    return bool(np.any(np.linalg.norm(hinges - place, axis=1) <= near))


def _use(structure: Structure, poses: SpatialHistory, member: str, node: str) -> float:
    """Largest use of the capacity at a member's end that persists for two outputs; 0 where not known."""
    loads = _loads(structure, poses.linkage, member, node)
    if not loads:
        return 0.0
    body = poses.node_body[node]
    section = poses.place(body, np.asarray(structure.nodes[node], float))[0]
    wrenches = [
        on_second(poses, number) if second else on_second(poses, number).opposite()
        for number, second in loads
    ]
    force = sum((wrench.force for wrench in wrenches), np.zeros_like(section))
    moment = sum((wrench.about(section) for wrench in wrenches), np.zeros_like(section))
    axes = turned(poses.quaternion(body)[:, None], structure.frame_of(member).axes[None])
    along, bent = (np.einsum("nki,ni->nk", axes, values) for values in (force, moment))
    fit = interaction_fit_of(structure.section_of(member), structure.material_of(member))
    use = fit.gauge(np.column_stack([along[:, 0], bent[:, 1], bent[:, 2], bent[:, 0]]))
    return float(np.minimum(use[1:], use[:-1]).max())


def _loads(structure: Structure, linkage: Linkage, member: str, node: str) -> list[tuple[int, bool]]:
    """Hinges on one side of a member's end, and whether that side is their second; none where not known."""
    if not structure.supports_at.get(node) and len(structure.members_at[node]) < 2:
        # a free end carries what touches it alone
        return []
    first, last = structure.members[member].nodes
    if any(linkage.pieces[member][1:]):
        return [_nearest(structure, linkage, member, node)]
    other = last if node == first else first
    sides = [_side(structure, linkage, start, member) for start in (node, other)]
    if any(node in nodes and other in nodes for nodes, _ in sides):
        return []
    loads = [loads for nodes, loads in sides if not any(_is_loaded(structure, one) for one in nodes)]
    return loads[0] if loads else []


def _side(
    structure: Structure, linkage: Linkage, start: str, without: str
) -> tuple[set[str], list[tuple[int, bool]]]:
    """Nodes that are rigid with one when a member is cut, and the hinges around them."""
    nodes, rest, loads = {start}, [start], []
    while rest:
        node = rest.pop()
        for name in structure.members_at[node]:
            if name == without:
                continue
            if linkage.pieces[name][1:]:
                loads.append(_nearest(structure, linkage, name, node))
                continue
            further = set(structure.members[name].nodes) - nodes
            nodes |= further
            rest += further
    return nodes, loads


def _nearest(structure: Structure, linkage: Linkage, member: str, node: str) -> tuple[int, bool]:
    """Number of the hinge of a member that is nearest to a node of it; whether this is its second side."""
    own = [
        (connection.hinge.station, i)
        for i, connection in enumerate(linkage.connections)
        if connection.hinge is not None and connection.hinge.member == member
    ]
    second = structure.members[member].nodes[1] == node
    return (max(own) if second else min(own))[1], second


def _is_loaded(structure: Structure, node: str) -> bool:
    """Whether anything but members acts at a node: a support, a joint, a mass, a load."""
    others = (structure.supports_at, structure.joints_at, structure.masses_at)
    return any(at.get(node) for at in others) or any(load.node == node for load in structure.loads)


def folds_between(structure: Structure, solved: Solved) -> Iterator[Caution]:
    """Members that yield between their hinges by more than a fold takes before it softens.

    The rotation is at least the energy of a joint over its largest moment.
    """
    joints = {
        (one.member, one.station): one
        for one in placed_hinges(structure)
        if not (one.plastic or one.only_twists)
    }
    turned: dict[str, tuple[float, float]] = {}
    for (member, station), energy in solved.spread.items():
        joint = joints.get((member, station))
        if joint is not None and energy.size:
            parts = () if joint.spatial is None else joint.spatial.components
            records = (joint.record, *(part.record for part in parts))
            most = float(energy[-1]) / max(float(record.positive.moment.max()) for record in records)
            turned[member] = max((most, station), turned.get(member, (0.0, 0.0)))
    for member, (most, station) in turned.items():
        if most < LEAST_TURN:
            continue
        metal = structure.section_of(member), structure.material_of(member)
        limit = min(folds_from(*metal, axis) for axis in AXES)
        if most > limit:
            where = format_quantity(station, "m", 3)
            text = (
                f"Member {member} yields by {math.degrees(most):.3g} deg at {where}, between its hinges, "
                "where the model does not let it fold: a fold carries less from "
                f"{math.degrees(limit):.3g} deg on. "
                "Give it hinges at its ends and there (hinges: [{name: ..., at: ..., axes: [y, z]}, ...]), "
                "or more (hinges: {spacing: ...})."
            )
            yield Caution("fold_between_hinges", most, limit, "rad", f"member {member}", text)


def pressed_folds(structure: Structure, solved: Solved) -> Iterator[Caution]:
    """Cautions for hinges whose folds an axial force presses, or holds, more than the whole section says.

    In shells a fold that has softened turns about its tension flange, so that compression N takes N b/2 of
    its moment, b the depth between the flanges; the walls of a whole section lose less, and a hinge that
    cannot shorten loses nothing.  Laws of corners know of it, and so do hinges with that coupling.  Tension
    gives as much, up to the moment of the section that has not softened; hinges of elastic members know it,
    and round tubes gain nothing in shells.
    """
    pressed: dict[str, float] = {}
    held: dict[str, float] = {}
    for name, lost, softened, flow in _axial_shares(structure, solved):
        if float(flow[lost > FLANGE].sum()) > PRESSED_TURN:
            pressed[name] = float(lost[flow > 0.0].max())
        given = np.minimum(-lost, softened).clip(0.0)
        if flow.sum() > PRESSED_TURN and given @ flow > HELD * flow.sum():
            held[name] = float(given @ flow / flow.sum())
    if pressed:
        one, most = len(pressed) == 1, max(pressed.values())
        text = (
            f"{named('Hinge', list(pressed))} {'folds' if one else 'fold'} under compression that would take "
            f"up to {100.0 * most:.0f} % of {'its' if one else 'their'} moment about the tension flange, "
            "about which softened folds of tubes turn in shells. The interaction of the whole section takes "
            "less (and nothing where a hinge has no 'axial'): forces may be too large, and the structure may "
            "fold elsewhere. Compare with shells."
        )
        for name, value in pressed.items():
            yield Caution("pressed_fold", value, FLANGE, "1", f"hinge {name}", text)
    if held:
        one, most = len(held) == 1, max(held.values())
        text = (
            f"{named('Hinge', list(held))} {'folds' if one else 'fold'} under tension, which keeps walls "
            f"from folding in shells: up to {100.0 * most:.0f} % of {'its' if one else 'their'} moment that "
            "the law has lost would be there in the mean. Rotations may be too large by as much. Compare "
            "with shells."
        )
        for name, value in held.items():
            yield Caution("held_fold", value, HELD, "1", f"hinge {name}", text)


def _axial_shares(structure: Structure, solved: Solved) -> Iterator[tuple[str, Floats, Floats, Floats]]:
    """Of every fold between outputs: what compression takes of its largest moment about the tension flange.

    The smaller of both outputs, none if it changes its sense; negative: what tension gives.  With what the
    fold has lost of that moment, and its rotation [rad].
    """
    poses = solved.poses
    if not isinstance(poses, SpatialPoses) or poses.rows < 2:
        return
    histories = {history.hinge.name: history for history in solved.hinges}
    for number, connection in enumerate(poses.linkage.connections):
        hinge = connection.hinge
        if hinge is None or hinge.name not in histories or _knows_compression(structure, hinge):
            continue
        axis = turned(poses.quaternion(connection.first), structure.frame_of(hinge.member).x)
        pressed = np.einsum("nk,nk->n", on_second(poses, number).force, np.broadcast_to(axis, (len(axis), 3)))
        section = structure.section_of(hinge.member)
        arm = min(section.bending_depth(about) for about in AXES) / 2.0 - section.thickness / 2.0
        largest = float(hinge.record.positive.moment.max())
        smaller = np.median([pressed[1:], pressed[:-1], np.zeros(len(pressed) - 1)], axis=0)
        lost = smaller * arm / largest
        if hinge.flanges or isinstance(section, CircularTube):
            lost = np.maximum(lost, 0.0)
        history = histories[hinge.name]
        capacity = history.values("capacity")
        softened = 1.0 - capacity[1:] / capacity.max()
        yield hinge.name, lost, softened, np.abs(np.diff(history.values("plastic_rotation")))


def _knows_compression(structure: Structure, hinge: PlacedHinge) -> bool:
    """Whether a hinge is a corner's, or turns about its tension flange, or is no fold."""
    flange = hinge.spatial is not None and hinge.spatial.surface.coupling is Coupling.TENSION_FLANGE
    return not hinge.plastic or flange or corner_of(structure, hinge.name) is not None
