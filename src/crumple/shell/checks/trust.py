"""What an engineer must know before believing a shell result: assumptions and warnings."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from crumple._core.shell.simulation import Element, ShellState
from crumple.result import StageSummary
from crumple.shell.answer.record import ENERGIES, Record
from crumple.shell.answer.weld_histories import weld_assumptions, weld_warnings
from crumple.shell.mesh.joints import Kind
from crumple.shell.mesh.quality import wall_metals
from crumple.shell.model.bodies import Body, Lump
from crumple.shell.model.metal import in_words
from crumple.shell.model.model import ShellCase
from crumple.shell.model.obstacles import too_sharp
from crumple.structure import ShellSettings, Stage, Structure
from crumple.structure.hinges.hinges import hinge_places

LOST_SHARE = 5e-3
"""Share of the given energy that may vanish at the start before a warning."""
HOURGLASS_SHARE = 0.05
"""Hourglass energy over the largest internal energy above which what holds the elements is no physics."""
PRESSED_IN = 0.5
"""Penetration over the distance kept above which contact is soft enough to be worth a warning."""
ADDED_SHARE = 0.01
"""Mass added by scaling, over the walls' mass, above which inertia is no longer that of the structure."""
MASS_SHARE = 0.01
"""Difference of the meshed mass from that of the sections above which it is worth a warning."""
OFF_CENTRE = 0.05
"""Distance of a held body's centre of mass from its node, over the section's size, worth a warning."""
FLAT = 1e-6
"""Spread of a section's points across their line over that along it, below which they lie in a line."""
SLOW_SHARE = 0.05
"""Kinetic or damped energy over the internal energy above which a stage is not quasi-static."""
LEAST_ENERGY = 1e-9
"""Energy [J] below which nothing has been put in and shares mean nothing."""


def energy_residual(record: Record) -> float:
    """Largest abs(residual) over the initial kinetic energy and the largest external work."""
    energy = record["energy"]
    given = float(
        energy[0, ENERGIES.index("kinetic")] + np.abs(energy[:, ENERGIES.index("external_work")]).max()
    )
    worst = float(np.abs(energy[:, ENERGIES.index("residual")]).max())
    return worst / given if given > LEAST_ENERGY else 0.0


def assumptions(structure: Structure, case: ShellCase, settings: ShellSettings) -> tuple[str, ...]:
    """Sentences stating what the model takes for granted."""
    found = [
        f"Walls are shells along their mid-lines: {case.report}.",
        f"One-point quadrilaterals ({settings.element}) with {settings.thickness_points} points through the "
        f"thickness ({settings.thickness_rule}), {_held(settings)}, thickness update "
        f"{settings.thickness_update}, warping correction {settings.warping_correction}, self-contact "
        f"{'on' if case.model.settings.self_contact else 'off'}.",
        *_without_effect(structure, case, settings),
    ]
    found += [in_words(metal) for metal in wall_metals(structure, case.mesh)[0]]
    for node, joint in case.mesh.joints.items():
        if joint.kind is Kind.RIGID and len(joint.ends) > 1:
            members = ", ".join(end.member for end in joint.ends)
            found.append(f"The ends of {members} at node {node} are cut back and move as one rigid body.")
        elif joint.is_body:
            found.append(f"The section at node {node} is rigid.")
    found += weld_assumptions(structure, case)
    for name, member in structure.members.items():
        length = structure.frame_of(name).length
        found += [
            f"Member {name} is rigid from {1e3 * a:.4g} to {1e3 * b:.4g} mm."
            for a, b in member.rigid_parts(length)
        ]
    found += [
        f"Hinge {zone.place.name} is the stretch of member {zone.place.member} from "
        f"{_station(case, zone.place.member, zone.first)} to "
        f"{_station(case, zone.place.member, zone.last)} mm: rotation between the sections there, "
        "plastic work in the walls between."
        for zone in case.zones
    ]
    return tuple(found)


def _without_effect(structure: Structure, case: ShellCase, settings: ShellSettings) -> Iterator[str]:
    """What was asked for and changes nothing here."""
    if settings.self_contact == "off" and case.model.settings.self_contact:
        yield "Walls touch walls although self-contact is off, since the structure has contact of members."
    if structure.member_contact is not None and structure.member_contact.restitution:
        yield "The restitution of members is that of rigid bodies: walls rebound by their own elasticity."
    if settings.coarse_sections == "on" and not case.report.triangles:
        yield "No stretch of long elements is long enough for coarser sections: there are none."


def _held(settings: ShellSettings) -> str:
    """What holds the modes that one point does not see."""
    if settings.element == "stabilised":
        return "the varying strains held by the metal's own stiffness"
    return f"hourglass control by {settings.hourglass}"


def warnings(structure: Structure, case: ShellCase, record: Record, state: ShellState) -> tuple[str, ...]:
    """Sentences that must be read before believing the result."""
    energy = {name: record["energy"][:, i] for i, name in enumerate(ENERGIES)}
    found = [*_mesh_warnings(structure, case), *_flat_members(structure, case)]
    internal = float((energy["elastic"] + energy["plastic"]).max())
    hourglass = float(energy["hourglass"].max())
    artificial = case.model.settings.element is Element.BELYTSCHKO_TSAY
    if artificial and internal > LEAST_ENERGY and hourglass > HOURGLASS_SHARE * internal:
        found.append(
            f"Hourglass energy reaches {hourglass / internal:.1%} of the internal energy: "
            "use a finer mesh, or the other hourglass control."
        )
    depth = state.deepest_penetration
    if depth > 1.0:
        found.append(
            "Walls passed through each other: contact could not hold them, and later folds are not real."
        )
    elif depth > PRESSED_IN:
        found.append(
            f"Walls pressed into each other by up to {depth:.0%} of the distance that contact keeps."
        )
    for name, row in zip(structure.obstacles, state.obstacles, strict=True):
        if row[-1] > 1.0:
            found.append(
                f"Walls went {row[-1]:.2g} half thicknesses into obstacle {name}: it could not hold them."
            )
    torn = int((state.element_field("alive") < 0.5).sum())
    if torn:
        found.append(
            f"{torn} of {len(state.model.elements)} elements have torn and are gone: where walls tear "
            "depends on the size of the elements."
        )
    if state.added_mass > ADDED_SHARE * state.mass:
        found.append(f"Mass scaling added {state.added_mass:.3g} kg to {state.mass:.3g} kg of walls.")
    found += weld_warnings(structure, case, record)
    kinetic, given = float(energy["kinetic"][0]), case.start.given_energy
    if not structure.impulses and given - kinetic > LOST_SHARE * given:
        found.append(
            f"{given - kinetic:.4g} J of the given {given:.4g} J is lost at the start: the given motion does "
            "not fit the supports and rigid sections."
        )
    return tuple(found)


def slow_warnings(stages: Sequence[Stage], ended: Sequence[StageSummary], record: Record) -> tuple[str, ...]:
    """Sentences on quasi-static stages that were run too fast to be free of inertia."""
    found = []
    for stage, summary in zip(stages, ended, strict=False):
        if stage.kind != "quasi-static":
            continue
        kinetic, damped = slow_shares(record, summary)
        if max(kinetic, damped) > SLOW_SHARE:
            found.append(
                f"Stage {stage.name} is not quasi-static: kinetic energy is up to {kinetic:.1%}, damping "
                f"{damped:.1%} of the internal energy. Give it a longer duration."
            )
    return tuple(found)


def slow_shares(record: Record, stage: StageSummary) -> tuple[float, float]:
    """Largest kinetic energy after a stage's first tenth, and what it damped, over its internal energy."""
    time, energy = record["time"], {name: record["energy"][:, i] for i, name in enumerate(ENERGIES)}
    late = (time > stage.start + 0.1 * (stage.end - stage.start)) & (
        time <= stage.end * (1 + 1e-9) + LEAST_ENERGY
    )
    if not late.any():
        return 0.0, 0.0
    inside = np.searchsorted(time, (stage.start, stage.end))
    internal = float((energy["elastic"] + energy["plastic"])[late].max())
    if internal <= LEAST_ENERGY:
        return 0.0, 0.0
    damped = (
        energy["damping"][min(inside[1], len(time) - 1)] - energy["damping"][min(inside[0], len(time) - 1)]
    )
    return float(energy["kinetic"][late].max()) / internal, float(damped) / internal


def _mesh_warnings(structure: Structure, case: ShellCase) -> list[str]:
    found = []
    for name, tube in case.mesh.tubes.items():
        section = structure.section_of(name)
        area = tube.contour.area
        if abs(area / section.area - 1.0) > MASS_SHARE:
            found.append(
                f"The mesh of member {name} has {area / section.area:.1%} of its section's area: "
                "its corners are drawn coarsely."
            )
    for name in too_sharp(structure, case.report.largest_side):
        found.append(
            f"Obstacle {name} is round so tightly that it presses in between the nodes: use smaller elements."
        )
    for body in case.bodies:
        if not body.held or body.stretch or body.pin is not None:
            continue
        ((node, lump),) = body.lumps.items()
        distance = _off_centre(case, body, lump)
        if distance:
            found.append(
                f"The support of node {node} holds the joint's centre of mass, {1e3 * distance:.3g} mm "
                "from the node."
            )
    return found


def _flat_members(structure: Structure, case: ShellCase) -> Iterator[str]:
    """Members of one flat wall with hinges: a section's nodes in a line have no plane that could turn."""
    for name in dict.fromkeys(place.member for place in hinge_places(structure)):
        points = case.mesh.tubes[name].contour.points
        spread = np.linalg.svd(points - points.mean(axis=0), compute_uv=False)
        if spread[1] < FLAT * spread[0]:
            yield (
                f"Member {name} is one flat wall: nodes in a line do not tell how a section turns, so the "
                "rotations told of hinges in it mean nothing; read displacements."
            )


def _off_centre(case: ShellCase, body: Body, lump: Lump) -> float:
    """Distance of a body's lump or of its sections' middle from its node [m]; 0 where it does not matter."""
    walls = case.mesh.position[body.nodes[:-1]]
    size, centre = float(np.ptp(walls, axis=0).max()), lump.centre if lump.mass > 0.0 else body.place
    distance = max(float(np.linalg.norm(at - body.place)) for at in (walls.mean(axis=0), centre))
    return distance if distance > OFF_CENTRE * size else 0.0


def _station(case: ShellCase, member: str, ring: int) -> str:
    return f"{1e3 * float(case.mesh.tubes[member].stations[ring]):.3g}"
