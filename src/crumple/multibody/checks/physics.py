"""Impossible results: violated laws of mechanics, and states beyond the capacity of the members.

A violation (falling dissipation, a rebound without an energy source) ends a run with a status.  A caution is
read before the result: forces that no wall carries, and the like.  Formulas: docs/theory/result_checks.md.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator, Mapping
from dataclasses import replace

import numpy as np

from crumple.hinge import Freedom
from crumple.multibody.answer.crush import crush_of
from crumple.multibody.answer.forces import on_second
from crumple.multibody.answer.poses import SpatialPoses
from crumple.multibody.answer.solved import CrushedContact, Solved
from crumple.multibody.bodies.rigid import lump_mass, piece_mass
from crumple.multibody.checks.crushing import buckling_cautions, crushing_cautions, lengths_beyond
from crumple.multibody.checks.folded_over import folded_over
from crumple.multibody.checks.names import named
from crumple.multibody.checks.overloaded import folds_between, overloaded_sections, pressed_folds
from crumple.multibody.checks.struck import pressed_beyond, struck_cautions
from crumple.multibody.checks.torque import torque_cautions
from crumple.numeric.arrays import Floats
from crumple.numeric.rotation import turned
from crumple.result import Caution
from crumple.structure import Structure
from crumple.structure.checks.doubtful import double_members
from crumple.structure.hinges.lengthening.nodes_met import TOGETHER, supports_met
from crumple.structure.hinges.spatial_hinges import interaction_of
from crumple.structure.keys.obstacles import gap
from crumple.units import format_quantity, plain_number

FALL = 1e-3
"""Fall of a dissipated energy over the energy input that counts: the bound of the energy residual, so that
what the ledger may leave open is no violation."""
NO_ENERGY = 1e-9
"""Energy [J] whose fall is rounding: of 1 N m over the turn by which a locked hinge creeps, 1e-9 rad."""
REBOUND = 0.1
"""Energy of an obstacle's rebound over its energy at the start that needs no energy source: the elastic
rebound of metal structures, which rigid bars lack, takes less."""
FAST = 4.0
"""Speed of a node over the reference speed.  A light part struck by a heavy one at most doubles its speed, a
lever doubles that again."""
IMPACT = 0.1
"""Energy lost in rigid impacts relative to the energy input, above which a warning is given."""
CRUSHED = 0.01
"""Depth to which walls are crushed at a contact over the smaller side of the section, above which a caution
says so."""
USED_UP = 0.95
"""Depth to which an end crumpled over the largest side of its section, above which it cannot go on."""
AT_OUTPUTS = frozenset(
    {
        "axial_compression",
        "axial_tension",
        "buckling",
        "deep_dent",
        "held_fold",
        "node_speed",
        "overloaded_section",
        "pressed_beyond",
        "pressed_fold",
        "torque_without_twist",
    }
)
"""Cautions whose quantity is known at the outputs alone, as their sentences say: with outputs farther apart
they may be missing, and means over an impact are larger the closer they are."""
STRUCK = 0.5
"""Energy lost in rigid impacts relative to the energy input, above which the mean force of the impact is
compared with the force that folds a member."""


def energy_put_in(solved: Solved) -> float:
    """Energy of the motion at the start, and the largest external work [J]."""
    kinetic = float(solved.energy["kinetic"][0])
    return max(kinetic, solved.given - solved.lost) + float(np.abs(solved.energy["external_work"]).max())


def physics_cautions(structure: Structure, solved: Solved, *, slow: Collection[str]) -> tuple[Caution, ...]:
    """Cautions of all checks that a multibody run did not pass.

    Parameters
    ----------
    structure, solved
        The structure and the result of its run.
    slow
        Names of the stages that were quasi-static.
    """
    if len(solved.time) < 2:
        return ()
    total = energy_put_in(solved)
    struck = _lost_in_impacts(solved) > STRUCK * total
    found = (
        *falling_energies(solved, total),
        *rebounds(structure, solved),
        *folded_over(structure, solved),
        *tensions(structure, solved),
        *crushing_cautions(structure, solved, struck=struck),
        *(buckling_cautions(structure, solved) if slow else ()),
        *struck_cautions(structure, solved),
        *pressed_beyond(structure, solved, slow),
        *overloaded_sections(structure, solved),
        *folds_between(structure, solved),
        *pressed_folds(structure, solved),
        *torque_cautions(structure, solved),
        *fast_nodes(structure, solved, total),
        *impact_losses(structure, solved, total),
        *jammed_folds(solved),
        *closed_crush_zones(structure, solved),
        *lengths_beyond(structure, solved),
        *crushed_walls(structure, solved),
        *crumpled_ends(structure, solved),
        *deep_dents(solved),
    )
    every = format_quantity(float(np.diff(solved.time).max()), "s", 3)
    judged = f" Judged at the outputs, every {every}."
    return tuple(replace(one, text=one.text + judged) if one.code in AT_OUTPUTS else one for one in found)


def falling_energies(solved: Solved, total: float) -> Iterator[Caution]:
    """Energies that can only increase and decreased: those dissipated by hinges and by friction."""
    rising = {f"hinge {history.hinge.name}": history.values("energy") for history in solved.hinges}
    rising |= {name: solved.energy[name] for name in ("friction",) if name in solved.energy}
    for place, values in rising.items():
        fall = largest_fall(values)
        limit = max(FALL * total, NO_ENERGY)
        if fall > limit:
            yield Caution(
                "dissipation_falls",
                fall,
                limit,
                "J",
                place,
                f"The energy that {place} has dissipated falls by {format_quantity(fall, 'J', 3)}: "
                "dissipated energy cannot come back.",
                violation=True,
            )


def largest_fall(values: Floats) -> float:
    """Largest fall of a history below its earlier maximum, with zero before its start."""
    reached = np.maximum.accumulate(np.concatenate([[0.0], values]))
    return float((reached[1:] - values).max())


def rebounds(structure: Structure, solved: Solved) -> Iterator[Caution]:
    """Masses that rebound from an impact without restitution with energy that has no source."""
    kinetic = float(solved.energy["kinetic"][0])
    given = float(np.abs(solved.energy["external_work"]).max()) + float(solved.energy["elastic"].max())
    channels = {channel.name: channel.values for channel in solved.further}
    for name, obstacle in structure.obstacles.items():
        speed = float(np.linalg.norm(obstacle.velocity))
        if obstacle.mass is None or obstacle.restitution > 0.0 or speed == 0.0:
            continue
        along = np.asarray(obstacle.velocity, float) / speed
        velocity = np.column_stack([channels[f"obstacle.{name}.velocity.{axis}"] for axis in "xyz"])
        back = max(float(-(velocity @ along).min()), 0.0)
        own, returned = obstacle.mass * speed**2 / 2.0, obstacle.mass * back**2 / 2.0
        limit = REBOUND * own + given + max(kinetic - own, 0.0)
        if returned > limit:
            yield Caution(
                "rebound",
                returned,
                limit,
                "J",
                f"obstacle {name}",
                f"Obstacle {name} rebounds at {format_quantity(back, 'm/s', 3)} with restitution 0: the "
                f"structure can return at most {format_quantity(limit, 'J', 3)}, and the rebound has "
                f"{format_quantity(returned, 'J', 3)}. Rigid members have transmitted the energy "
                "instead; solve with shells.",
                violation=True,
            )


def tensions(structure: Structure, solved: Solved) -> Iterator[Caution]:
    """Members that cannot lengthen and are in tension beyond yield of the whole section for two outputs."""
    pulled: dict[str, float] = {}
    for member, force in axial_tensions(structure, solved):
        pulled[member] = max(force, pulled.get(member, 0.0))
    for member, force in pulled.items():
        limit = interaction_of(structure.section_of(member), structure.material_of(member)).squash_force
        if force > limit:
            yield Caution(
                "axial_tension",
                force,
                limit,
                "N",
                f"member {member}",
                f"Member {member} is pulled by up to {plain_number(force / 1e3)} kN along its axis and "
                f"yields in tension at {plain_number(limit / 1e3)} kN, but nothing in it can lengthen: the "
                "motion is that of a rigid bar. Give it hinges with an axial law, or solve with shells.",
            )


def axial_tensions(structure: Structure, solved: Solved) -> Iterator[tuple[str, float]]:
    """Members and the largest axial tension [N] that persists for two outputs at a hinge without slip."""
    poses = solved.poses
    if not isinstance(poses, SpatialPoses):
        return
    # of two in one place, equal and opposite forces of any size are a possible set
    double = double_members(structure)
    for i, connection in enumerate(poses.linkage.connections):
        hinge = connection.hinge
        if hinge is None or not hinge.plastic or int(Freedom.AXIAL) in connection.free:
            continue
        if hinge.member in double:
            continue
        axis = turned(poses.quaternion(connection.first), structure.frame_of(hinge.member).x)
        pulling = -np.einsum("ni,ni->n", on_second(poses, i).force, np.broadcast_to(axis, (len(axis), 3)))
        yield hinge.member, float(np.minimum(pulling[1:], pulling[:-1]).max())


def fast_nodes(structure: Structure, solved: Solved, total: float) -> Iterator[Caution]:
    """Nodes that move faster than the energy input explains."""
    speeds = node_speeds(structure, solved)
    channels = {channel.name: channel.values for channel in solved.further}
    masses = [obstacle.mass for obstacle in structure.obstacles.values() if obstacle.mass is not None]
    given = [
        float(np.linalg.norm([channels[f"obstacle.{name}.velocity.{axis}"][0] for axis in "xyz"]))
        if obstacle.mass is not None
        else float(np.linalg.norm(obstacle.velocity))
        for name, obstacle in structure.obstacles.items()
    ]
    start = max((float(speed[0]) for speed in speeds.values()), default=0.0)
    moving = moving_mass(structure, solved) + sum(masses)
    reference = max([start, *given, math.sqrt(2.0 * total / moving) if moving > 0.0 else 0.0])
    if reference == 0.0:
        return
    found = {node: float(speed.max()) for node, speed in speeds.items() if speed.max() > FAST * reference}
    if not found:
        return
    fastest = max(found.values())
    text = (
        f"{named('Node', list(found))} reach{'es' if len(found) == 1 else ''} up to "
        f"{format_quantity(fastest, 'm/s', 3)}, {fastest / reference:.2g} times the "
        f"{format_quantity(reference, 'm/s', 3)} of what moves at the start or of all masses together under "
        "the energy input: rigid members accelerate strongly near a dead centre."
    )
    for node, speed in found.items():
        yield Caution("node_speed", speed, FAST * reference, "m/s", f"node {node}", text)


def node_speeds(structure: Structure, solved: Solved) -> Mapping[str, Floats]:
    """Speed of every node at the output times [m/s], (n,)."""
    poses = solved.poses
    names = [node for node in structure.nodes if node in poses.node_body]
    bodies = np.array([poses.node_body[node] for node in names])
    _, velocity = poses.motions(bodies, np.array([structure.nodes[node] for node in names], float))
    return dict(zip(names, np.linalg.norm(velocity, axis=2).T, strict=True))


def moving_mass(structure: Structure, solved: Solved) -> float:
    """Mass of all parts that are not held by the ground [kg]."""
    poses = solved.poses
    pieces = sum(
        piece_mass(structure, member, piece.start, piece.end).mass
        for member, pieces in poses.pieces.items()
        for piece in pieces
        if piece.body >= 0
    )
    lumps = [lump for lump in structure.masses.values() if poses.node_body[lump.node] >= 0]
    return pieces + sum(lump_mass(structure, lump).mass for lump in lumps)


def impact_losses(structure: Structure, solved: Solved, total: float) -> Iterator[Caution]:
    """Energy that was lost in impacts between rigid bodies, and obstacles that supports stop."""
    lost = _lost_in_impacts(solved)
    where = "impacts between rigid bodies, which store no elastic energy and do not fold at the impact"
    if solved.crushed:
        where = "walls that are crushed at contacts, since nothing else can give way"
    if lost > IMPACT * total:
        stopped = "".join(
            f" Obstacle {obstacle} meets node {node}, which supports hold."
            for obstacle, node in supports_met(structure)
            if _reached(structure, solved, obstacle, node)
        )
        yield Caution(
            "impact_loss",
            lost,
            IMPACT * total,
            "J",
            "",
            f"{format_quantity(lost, 'J', 4)} of {format_quantity(total, 'J', 4)} energy input "
            f"({lost / total:.0%}) are lost in {where}; a shell run shows where it goes.{stopped}",
        )


def _reached(structure: Structure, solved: Solved, obstacle: str, node: str) -> bool:
    """Whether an obstacle comes to the walls around a held node, by its distances at the output times."""
    channels = {channel.name: channel.values for channel in solved.further}
    names = [f"obstacle.{obstacle}.displacement.{axis}" for axis in "xyz"]
    path = np.stack([channels.get(name, np.zeros(1)) for name in names], axis=-1)
    outlines = [structure.section_of(name).outer_outline() for name in structure.members_at[node]]
    half = max((float(np.ptp(outline, axis=0).max()) / 2.0 for outline in outlines), default=0.0)
    places = np.asarray(structure.nodes[node], float) - path
    return bool(gap(structure.obstacles[obstacle], places).min() <= half + TOGETHER)


def _lost_in_impacts(solved: Solved) -> float:
    crumpled = sum(end.energy for end in solved.crumpled)
    return float(solved.energy.get("contact", np.zeros(1))[-1]) - crumpled


def jammed_folds(solved: Solved) -> Iterator[Caution]:
    """Hinges with rotations beyond that at which the walls of the fold touch."""
    beyond: dict[float, dict[str, float]] = {}
    for history in solved.hinges:
        for _, law, bent in history.bent_by_law():
            if law.jamming_angle is not None and bent > law.jamming_angle:
                beyond.setdefault(law.jamming_angle, {})[history.hinge.name] = bent
    for jams, hinges in beyond.items():
        turned_by = _span([math.degrees(bent) for bent in hinges.values()])
        names = named("Hinge", list(hinges))
        text = (
            f"{names} turned by {turned_by} deg; the walls jam at {math.degrees(jams):.1f} deg, and what "
            "follows is an estimate."
        )
        for name, bent in hinges.items():
            yield Caution("beyond_jamming", bent, jams, "rad", f"hinge {name}", text)


def closed_crush_zones(structure: Structure, solved: Solved) -> Iterator[Caution]:
    """Members that were crushed until all folds were closed: the stop of the stroke carries the force."""
    for history in solved.hinges:
        crush = crush_of(structure, history)
        if crush is None or crush.stroke is None or not crush.bottomed_out:
            continue
        yield Caution(
            "bottomed_out",
            crush.length,
            crush.stroke,
            "m",
            f"hinge {history.hinge.name}",
            f"Member {history.hinge.member} bottomed out at hinge {history.hinge.name}: it is crushed by "
            f"{format_quantity(crush.length, 'm', 3)}, and its folds are closed at "
            f"{format_quantity(crush.stroke, 'm', 3)}. The force rises from then on, to that of a stop.",
        )


def crushed_walls(structure: Structure, solved: Solved) -> Iterator[Caution]:
    """Members whose walls were crushed at a contact because nothing else could give way."""
    deepest: dict[str, CrushedContact] = {}
    for contact in sorted(solved.crushed, key=lambda contact: contact.depth):
        limit = CRUSHED * float(np.ptp(structure.section_of(contact.member).outer_outline(), axis=0).min())
        if contact.depth > limit:
            deepest[contact.member] = contact
    if not deepest:
        return
    loads = _span([contact.force / 1e3 for contact in deepest.values()])
    depths = _span([contact.depth * 1e3 for contact in deepest.values()])
    pressing = " and ".join(sorted({contact.other for contact in deepest.values()}))
    text = (
        f"{named('Member', list(deepest))} cannot give way where {pressing} "
        f"press{'es' if pressing.count(' ') == 1 else ''}: walls are crushed there by {depths} mm at the "
        f"squash load, {loads} kN, an upper bound of what they carry; a shell run shows how they fail."
    )
    for member, contact in deepest.items():
        limit = CRUSHED * float(np.ptp(structure.section_of(member).outer_outline(), axis=0).min())
        yield Caution("crushed_contact", contact.depth, limit, "m", f"member {member}", text)


def crumpled_ends(structure: Structure, solved: Solved) -> Iterator[Caution]:
    """Ends that crumpled by all that they can: from there on their contact is rigid."""
    for end in solved.crumpled:
        limit = USED_UP * float(np.ptp(structure.section_of(end.member).outer_outline(), axis=0).max())
        if end.depth > limit:
            yield Caution(
                "crumpled_end",
                end.depth,
                limit,
                "m",
                f"member {end.member}",
                f"End {end.node} of member {end.member} crumpled by {format_quantity(end.depth, 'm', 3)} "
                f"on obstacle {end.obstacle}, about the largest side of its section: from there on its "
                "contact is rigid; a shell run shows how it goes on.",
            )


def deep_dents(solved: Solved) -> Iterator[Caution]:
    """Obstacles that press tubes flatter than the laws of dents were compared for."""
    deep = [dent for dent in solved.dents if dent.depth.max(initial=0.0) > dent.tube.dent.compared]
    for obstacle in dict.fromkeys(dent.tube.obstacle for dent in deep):
        dents = [dent for dent in deep if dent.tube.obstacle == obstacle]
        depth = max(float(dent.depth.max()) for dent in dents)
        limit = min(dent.tube.dent.compared for dent in dents)
        members = list(dict.fromkeys(dent.tube.member for dent in dents))
        text = (
            f"Obstacle {obstacle} dents {named('member', members)} by {format_quantity(depth, 'm', 3)}: the "
            f"law was compared with shells up to {format_quantity(limit, 'm', 3)}. Solve with shells."
        )
        for member in members:
            yield Caution("deep_dent", depth, limit, "m", f"member {member}", text)


def _span(values: list[float]) -> str:
    """The common value, or the smallest and the largest."""
    return " to ".join(dict.fromkeys(f"{value:.3g}" for value in (min(values), max(values))))
