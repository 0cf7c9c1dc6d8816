"""What an engineer must know before believing a shell result: assumptions and warnings."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from crumple._core.shell.simulation import Element, ShellState
from crumple.numeric.arrays import Floats
from crumple.result import StageSummary
from crumple.shell.answer.record import ENERGIES, Record
from crumple.shell.answer.weld_histories import weld_assumptions, weld_warnings
from crumple.shell.checks.folds import coarse_folds
from crumple.shell.mesh.joints import Kind
from crumple.shell.mesh.quality import wall_metals
from crumple.shell.model.bodies import Body, Lump
from crumple.shell.model.metal import in_words
from crumple.shell.model.model import ShellCase
from crumple.shell.model.obstacles import too_sharp
from crumple.shell.model.places import Span
from crumple.structure import ShellSettings, Stage, Structure
from crumple.structure.checks.partly_driven import driven_assumptions
from crumple.structure.hinges.places import hinge_places

LOST_SHARE = 5e-3
"""Share of the given energy that may vanish at the start before a warning."""
HOURGLASS_SHARE = 0.05
"""Hourglass energy over the largest internal energy above which there is a warning."""
GIVEN_BY_CONTACT = 0.01
"""Energy that contact forces gave to the walls, over the largest internal energy, for a warning."""
PRESSED_IN = 0.5
"""Penetration over the contact distance above which there is a warning."""
ADDED_SHARE = 0.01
"""Mass added by scaling, over the mass of the walls, above which there is a warning."""
MASS_SHARE = 0.01
"""Relative difference of the meshed mass from that of the sections above which there is a warning."""
OFF_CENTRE = 0.05
"""Distance of a held body's centre of mass from its node, over the section's size, for a warning."""
FLAT = 1e-6
"""Spread of a section's points across their line over that along it, below which they lie in a line."""
SLOW_SHARE = 0.05
"""Kinetic or damped energy over the internal energy above which a stage is not quasi-static."""
LEAST_ENERGY = 1e-9
"""Energy [J] below which shares of the energy are not meaningful."""


def energy_residual(record: Record) -> float:
    """Largest abs(residual) over the initial kinetic energy and the largest external work."""
    energy = record["energy"]
    given = float(
        energy[0, ENERGIES.index("kinetic")] + np.abs(energy[:, ENERGIES.index("external_work")]).max()
    )
    worst = float(np.abs(energy[:, ENERGIES.index("residual")]).max())
    return worst / given if given > LEAST_ENERGY else 0.0


def assumptions(structure: Structure, case: ShellCase, settings: ShellSettings) -> tuple[str, ...]:
    """Sentences stating the assumptions of the model."""
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
        elif joint.tee is not None:
            tee = joint.tee
            found.append(
                f"The walls of {tee.branch.member} are welded at node {node} to the face of {tee.before} and "
                f"{tee.after} that they meet."
            )
        elif joint.is_body:
            found.append(f"The section at node {node} is rigid.")
    found += driven_assumptions(structure)
    found += weld_assumptions(structure, case)
    for name, member in structure.members.items():
        length = structure.frame_of(name).length
        found += [
            f"Member {name} is rigid from {1e3 * a:.4g} to {1e3 * b:.4g} mm."
            for a, b in member.rigid_parts(length)
        ]
    found += [
        f"Hinge {zone.place.name} is represented by "
        f"{' and '.join(_span(case, span) for span in zone.spans)}: its rotation is that between the "
        "sections there, its energy the plastic work of the walls between them."
        for zone in case.zones
    ]
    return tuple(found)


def _without_effect(structure: Structure, case: ShellCase, settings: ShellSettings) -> Iterator[str]:
    """Settings that have no effect in this model."""
    if settings.self_contact == "off" and case.model.settings.self_contact:
        yield "Self-contact is on despite its setting, because the structure has contact of members."
    if structure.member_contact is not None and structure.member_contact.restitution:
        yield "The restitution of member contact has no effect: walls rebound by their own elasticity."
    if settings.coarse_sections == "on" and not case.report.triangles:
        yield "There are no coarser sections: no range of long elements is long enough for them."


def _held(settings: ShellSettings) -> str:
    """Resistance to the modes that one-point integration does not see."""
    if settings.element == "stabilised":
        return "physical stabilisation of the hourglass modes with the stiffness of the metal"
    return f"hourglass control by {settings.hourglass}"


def warnings(structure: Structure, case: ShellCase, record: Record, state: ShellState) -> tuple[str, ...]:
    """Warnings about the result."""
    energy = {name: record["energy"][:, i] for i, name in enumerate(ENERGIES)}
    found = [*_mesh_warnings(structure, case), *coarse_folds(structure, case.mesh)]
    found += _flat_members(structure, case)
    internal = float((energy["elastic"] + energy["plastic"]).max())
    hourglass = float(energy["hourglass"].max())
    artificial = case.model.settings.element is Element.BELYTSCHKO_TSAY
    if artificial and internal > LEAST_ENERGY and hourglass > HOURGLASS_SHARE * internal:
        found.append(
            f"Hourglass energy reaches {hourglass / internal:.1%} of the internal energy: "
            "refine the mesh, or use the other hourglass control."
        )
    found += given_by_contact(energy["contact"], internal)
    depth = state.deepest_penetration
    if depth > 1.0:
        found.append(
            "Walls passed through each other: contact was too soft, and later folds are not physical."
        )
    elif depth > PRESSED_IN:
        found.append(f"Walls penetrated each other by up to {depth:.0%} of the contact distance.")
    for name, row in zip(structure.obstacles, state.obstacles, strict=True):
        if row[-1] > 1.0:
            found.append(
                f"Walls penetrated obstacle {name} by {row[-1]:.2g} half thicknesses: contact was too soft."
            )
    torn = int((state.element_field("alive") < 0.5).sum())
    if torn:
        found.append(
            f"{torn} of {len(state.model.elements)} elements reached the failure strain and were deleted. "
            "Where walls tear depends on the element size."
        )
    if state.added_mass > ADDED_SHARE * state.mass:
        found.append(f"Mass scaling added {state.added_mass:.3g} kg to {state.mass:.3g} kg of walls.")
    found += weld_warnings(structure, case, record)
    kinetic, given = float(energy["kinetic"][0]), case.start.given_energy
    if not structure.impulses and given - kinetic > LOST_SHARE * given:
        found.append(
            f"{given - kinetic:.4g} J of the {given:.4g} J given are lost at the start, because the initial "
            "motion is not compatible with the supports and rigid sections."
        )
    return tuple(found)


def given_by_contact(contact: Floats, internal: float) -> list[str]:
    """The warning where contact forces gave energy to the walls, as where these slide off each other's edges.

    Parameters
    ----------
    contact
        Minus the work of the contact forces at the outputs [J].
    internal
        Largest internal energy [J].
    """
    given = -float(contact.min(initial=0.0))
    if internal <= LEAST_ENERGY or given <= GIVEN_BY_CONTACT * internal:
        return []
    return [
        f"Contact forces gave the walls {given:.4g} J ({given / internal:.1%} of the internal energy) that "
        "nothing put in: what was dissipated may be too large by as much. Compare with a finer mesh."
    ]


def slow_warnings(stages: Sequence[Stage], ended: Sequence[StageSummary], record: Record) -> tuple[str, ...]:
    """Warnings about quasi-static stages that are too short to be free of inertia."""
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
    """Largest kinetic energy after a stage's first tenth, and damping energy, over its internal energy."""
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
                f"The mesh of member {name} has {area / section.area:.1%} of the area of its section, "
                "because its corners are meshed coarsely."
            )
    for name in too_sharp(structure, case.report.largest_side):
        found.append(
            f"Obstacle {name} has so small a radius that it can pass between nodes: use smaller elements."
        )
    for body in case.bodies:
        if not body.held or body.stretch or body.pin is not None:
            continue
        ((node, lump),) = body.lumps.items()
        distance = _off_centre(case, body, lump)
        if distance:
            found.append(
                f"The support of node {node} acts at the joint's centre of mass, {1e3 * distance:.3g} mm "
                "from the node."
            )
    return found


def _flat_members(structure: Structure, case: ShellCase) -> Iterator[str]:
    """Members of one flat wall with hinges: section nodes in a line do not define a plane."""
    for name in dict.fromkeys(place.member for place in hinge_places(structure)):
        points = case.mesh.tubes[name].contour.points
        spread = np.linalg.svd(points - points.mean(axis=0), compute_uv=False)
        if spread[1] < FLAT * spread[0]:
            yield (
                f"Member {name} is one flat wall, whose section nodes are in a line and do not define a "
                "rotation. The reported rotations of hinges in this member are not meaningful; use "
                "displacements instead."
            )


def _off_centre(case: ShellCase, body: Body, lump: Lump) -> float:
    """Distance of a body's lump or of its sections' middle from its node [m]; 0 if it is small."""
    walls = case.mesh.position[body.nodes[body.nodes < case.mesh.walls]]
    size, centre = float(np.ptp(walls, axis=0).max()), lump.centre if lump.mass > 0.0 else body.place
    distance = max(float(np.linalg.norm(at - body.place)) for at in (walls.mean(axis=0), centre))
    return distance if distance > OFF_CENTRE * size else 0.0


def _span(case: ShellCase, span: Span) -> str:
    first, last = (f"{1e3 * float(case.mesh.tubes[span.member].stations[ring]):.3g}" for ring in span[1:])
    return f"member {span.member} from {first} to {last} mm"
