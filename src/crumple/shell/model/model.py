"""From a structure and its mesh to the stepper's frozen model."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from crumple._core.shell.simulation import (
    Cut,
    Element,
    Hourglass,
    RigidSet,
    Sheet,
    ShellMaterial,
    ShellModel,
    SpotWeld,
)
from crumple._core.shell.simulation import ShellSettings as CoreSettings
from crumple.numeric.arrays import Integers
from crumple.shell.checks.refusals import damping_of
from crumple.shell.mesh.contour import triple
from crumple.shell.mesh.mesh import Mesh, clamped_nodes, mesh_of
from crumple.shell.mesh.quality import MeshReport, report_of, wall_metals, wall_thickness
from crumple.shell.model.bodies import Body, bodies_of, taken_nodes
from crumple.shell.model.drives import loads_of, motions_of
from crumple.shell.model.initial_motion import InitialMotion, shell_initial_motion
from crumple.shell.model.metal import shell_material
from crumple.shell.model.obstacles import obstacles_of, refuse_walls_inside
from crumple.shell.model.places import HingeZone, SupportCut, hinge_zones, support_cut
from crumple.shell.model.rigid_parts import rigid_elements
from crumple.shell.model.spaces import Space, spaces_of
from crumple.shell.model.welds import Spot, spots_of
from crumple.structure import Outputs, ShellSettings, Stage, Structure

CONTACT_DAMPING = 0.1
"""Damping of contact, share of critical: takes the chatter of single nodes, not the rebound of walls."""


@dataclass(frozen=True, eq=False)
class ShellCase:
    """A structure as the shell engine computes it.

    Attributes
    ----------
    mesh, report
        Nodes and elements, and their quality.
    bodies
        Rigid bodies in the order of the model's rigid sets.
    start
        Motion at the start.
    zones
        Where each hinge is measured, in the order of the model's first cuts.
    supports
        What the model's further cuts look at, by support.
    welds
        Described spot welds, in the order of the model's.
    spaces
        Spaces whose clearances are requested.
    model
        What the stepper takes in the first stage.
    """

    mesh: Mesh
    report: MeshReport
    bodies: tuple[Body, ...]
    start: InitialMotion
    zones: tuple[HingeZone, ...]
    supports: dict[str, SupportCut]
    welds: tuple[Spot, ...]
    spaces: tuple[Space, ...]
    model: ShellModel


def lower(
    structure: Structure,
    settings: ShellSettings,
    outputs: Outputs | None = None,
    duration: float = 1.0,
    stage: Stage | None = None,
) -> ShellCase:
    """Mesh a structure and gather everything that the stepper needs.

    Parameters
    ----------
    structure
        Sound.
    settings
        Of the mesh and the method.
    outputs
        Stations that shall have a ring.
    duration
        Functions of time are sampled over it [s], where no stage is given.
    stage
        First stage.

    Raises
    ------
    InputError
        If the structure cannot be meshed, or its walls start inside an obstacle.
    """
    stage = stage or Stage(name="run", duration=duration)
    mesh = mesh_of(structure, settings, outputs)
    report = report_of(structure, mesh)
    bodies = bodies_of(structure, mesh, settings.weld_pitch)
    welds = spots_of(structure, mesh, taken_nodes(mesh, bodies))
    first = {
        "initial_velocity": structure.initial_velocity + stage.initial_velocity,
        "impulses": structure.impulses + stage.impulses,
    }
    start = shell_initial_motion(structure.model_copy(update=first), mesh, bodies)
    refuse_walls_inside(structure, mesh, stage)
    zones = hinge_zones(structure, mesh)
    rigid = rigid_elements(structure, mesh)
    held = {
        name: support_cut(structure, mesh, bodies, rigid, support.node)
        for name, support in structure.supports.items()
    }
    cuts = [_cut(zone.cut_elements, zone.cut_nodes) for zone in zones]
    materials, sheets, sheet = _sheets(structure, mesh, settings, rigid)
    model = ShellModel(
        position=mesh.position,
        elements=mesh.quads,
        thickness=wall_thickness(mesh),
        materials=materials,
        sheets=sheets,
        sheet=sheet,
        fixed=_fixed(mesh, bodies),
        velocity=start.velocity,
        spin=start.spin,
        rigid_sets=[_rigid_set(body) for body in bodies],
        spot_welds=[_spot_weld(spot) for spot in welds],
        cuts=[*cuts, *(_cut(cut.elements, cut.nodes) for cut in held.values())],
        settings=_settings(structure, settings),
    )
    spaces = spaces_of(structure, mesh, outputs)
    case = ShellCase(mesh, report, bodies, start, zones, held, welds, spaces, model)
    return replace(case, model=model_of_stage(structure, settings, case, stage, 0.0))


def model_of_stage(
    structure: Structure, settings: ShellSettings, case: ShellCase, stage: Stage, begin: float
) -> ShellModel:
    """Model with the loads, drives, obstacles and damping of one stage.

    Parameters
    ----------
    structure, settings, case
        What is computed.
    stage, begin
        The stage, and the time at which it starts [s].
    """
    return replace(
        case.model,
        loads=list(loads_of(structure, case.mesh, stage, begin)),
        motions=list(motions_of(structure, case.bodies, stage, begin)),
        obstacles=list(obstacles_of(structure, case.mesh, stage, begin)),
        settings=replace(case.model.settings, damping=damping_of(settings, stage)),
    )


def _sheets(
    structure: Structure, mesh: Mesh, settings: ShellSettings, rigid: NDArray[np.bool_]
) -> tuple[list[ShellMaterial], list[Sheet], Integers]:
    """Materials of the walls, one sheet each, rigid ones last; and the sheet of every element."""
    metals, number = wall_metals(structure, mesh)
    lobatto = settings.thickness_rule == "lobatto"
    materials = [shell_material(metal) for metal in metals]
    if rigid.any():
        materials += [replace(material, rigid=True) for material in materials]
        number = number + len(metals) * rigid
    sheets = [Sheet(i, settings.thickness_points, lobatto) for i in range(len(materials))]
    return materials, sheets, number


def _fixed(mesh: Mesh, bodies: tuple[Body, ...]) -> NDArray[np.bool_]:
    """Freedoms of nodes that are held: of clamped sections, but for those of a body, which is held itself."""
    fixed = np.zeros((len(mesh.position), 6), dtype=bool)
    fixed[clamped_nodes(mesh)] = True
    for body in bodies:
        fixed[body.nodes] = False
    return fixed


def _rigid_set(body: Body) -> RigidSet:
    lump = body.lump
    xx, yy, zz = np.diag(lump.inertia)
    xy, yz, zx = lump.inertia[0, 1], lump.inertia[1, 2], lump.inertia[2, 0]
    return RigidSet(
        nodes=body.nodes.astype(np.uint32),
        mass=lump.mass,
        at=triple(lump.centre),
        inertia=(float(xx), float(yy), float(zz), float(xy), float(yz), float(zx)),
        fixed=body.held,
        pin=None if body.pin is None else triple(body.pin),
    )


def _spot_weld(spot: Spot) -> SpotWeld:
    first, second = spot.first, spot.second
    return SpotWeld(
        first.nodes.astype(np.uint32),
        second.nodes.astype(np.uint32),
        first.weights,
        second.weights,
        *spot.strength,
    )


def _cut(elements: Integers, nodes: Integers) -> Cut:
    return Cut(elements=elements.astype(np.uint32), nodes=nodes.astype(np.uint32))


def _settings(structure: Structure, settings: ShellSettings) -> CoreSettings:
    coefficient = settings.hourglass_coefficient
    warping = settings.warping_correction == "on"
    x, y, z = structure.gravity
    friction = 0.0 if structure.member_contact is None else structure.member_contact.friction
    return CoreSettings(
        safety=settings.safety_factor,
        scaled_step=settings.mass_scaling or 0.0,
        least_step=settings.minimum_time_step,
        damping=settings.damping,
        gravity=(x, y, z),
        thickness_update=settings.thickness_update == "on",
        warping_correction=warping,
        element=Element(settings.element),
        drill_stiffness=settings.drill_stiffness if warping else 0.0,
        hourglass=Hourglass(settings.hourglass),
        hourglass_membrane=coefficient,
        hourglass_shear=coefficient,
        hourglass_bending=coefficient,
        self_contact=settings.self_contact == "on" or structure.member_contact is not None,
        contact_friction=max(settings.contact_friction, friction),
        contact_damping=CONTACT_DAMPING,
    )
