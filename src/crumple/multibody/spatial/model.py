"""From a linkage to the spatial kernel's constants: bodies, joints, hinges, loads and driven supports."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, MutableMapping
from dataclasses import replace

import numpy as np

from crumple._core.spatial.model import (
    Coupling as SurfaceCoupling,
)
from crumple._core.spatial.model import (
    SpatialBody,
    SpatialComponent,
    SpatialDrive,
    SpatialHinge,
    SpatialJoint,
    SpatialLoad,
    SpatialModel,
    SpatialSurface,
)
from crumple.hinge import Coupling, HingeComponent, HingeRecord, SpatialHingeRecord
from crumple.multibody.bodies.actions import applied_loads, driven_freedoms
from crumple.multibody.bodies.hinge_constants import FORMS, SOFTENING, hinge_constants
from crumple.multibody.bodies.linkage import Connection, Linkage
from crumple.multibody.bodies.sampled_functions import breaks_of
from crumple.structure import FREEDOMS, PlacedHinge, Structure

COUPLINGS = {
    Coupling.NONE: SurfaceCoupling.NONE,
    Coupling.ELLIPSOID: SurfaceCoupling.ELLIPSOID,
    Coupling.BALL: SurfaceCoupling.BALL,
    Coupling.SECTION: SurfaceCoupling.SECTION,
    Coupling.TENSION_FLANGE: SurfaceCoupling.TENSION_FLANGE,
}


STILL = 3.0
"""Factor on the dampers of elastic members in runs with quasi-static stages: decays that are much faster than
a push must be resolved as it sets in."""


def spatial_model(
    structure: Structure,
    linkage: Linkage,
    duration: float,
    *,
    resolved_frequency: float = math.inf,
    still: bool = False,
) -> SpatialModel:
    """Constants of the kernel's model, without obstacles.

    Parameters
    ----------
    structure, linkage
        The structure, and its bodies and connections.
    duration
        Functions of time are sampled over it [s].
    resolved_frequency
        Vibration of elastic hinges above it [1/s] does not shorten steps.
    still
        Whether the run has quasi-static stages.
    """
    x, y, z = structure.gravity
    return SpatialModel(
        bodies=tuple(SpatialBody(body.mass, body.inertia, body.centre) for body in linkage.bodies),
        joints=tuple(_joint(connection) for connection in linkage.connections),
        hinges=kernel_hinges(linkage, still=still),
        loads=tuple(_loads(structure, linkage, duration)),
        drives=tuple(drive for _, drive in support_drives(structure, linkage, duration)),
        gravity=(x, y, z),
        length=max(structure.frame_of(name).length for name in structure.members),
        resolved_frequency=resolved_frequency,
        breaks=breaks_of(structure, duration),
    )


def kernel_hinges(
    linkage: Linkage, made: MutableMapping[PlacedHinge, SpatialHinge] | None = None, *, still: bool = False
) -> tuple[SpatialHinge, ...]:
    """Hinges of the kernel's model; those that a linkage with the same connections `made` are taken.

    `still`: as of `spatial_model`.
    """
    kept: MutableMapping[PlacedHinge, SpatialHinge] = {} if made is None else made
    for i, connection in enumerate(linkage.connections):
        if connection.hinge is not None and connection.hinge not in kept:
            own = _hinge(i, connection)
            kept[connection.hinge] = _stilled(own) if still and not connection.hinge.plastic else own
    return tuple(kept[hinge] for hinge in linkage.hinges)


def support_drives(
    structure: Structure, linkage: Linkage, duration: float
) -> Iterator[tuple[str, SpatialDrive]]:
    """Driven freedoms of supports, each with the support's name."""
    joints = {c.name: i for i, c in enumerate(linkage.connections) if c.kind == "support"}
    for driven in driven_freedoms(structure, duration):
        if driven.support in joints:
            joint, freedom = joints[driven.support], FREEDOMS.index(driven.freedom)
            start = float(structure.supports[driven.support].driven[driven.freedom](0.0))
            yield driven.support, SpatialDrive(joint, freedom, driven.times, driven.rates, start)


def _joint(connection: Connection) -> SpatialJoint:
    return SpatialJoint(
        first=connection.first,
        second=connection.second,
        position=connection.position,
        axes=connection.axes,
        held=connection.held,
        cross=connection.universal,
    )


def _hinge(joint: int, connection: Connection) -> SpatialHinge:
    assert connection.hinge is not None
    spatial, record, flanges = connection.hinge.spatial, connection.hinge.record, connection.hinge.flanges
    form, softening = FORMS[record.form], SOFTENING[record.softening_variable]
    if spatial is None:
        plain = replace(
            _component(connection.free[0], record), flange=flanges.get(connection.hinge.axis, 0.0)
        )
        return SpatialHinge(joint, (plain,), form=form, softening=softening)
    surface = spatial.surface
    return SpatialHinge(
        joint,
        tuple(_part(spatial, part, flanges) for part in spatial.components),
        SpatialSurface(
            COUPLINGS[surface.coupling],
            surface.rows,
            surface.power,
            surface.torque_power,
            surface.torsion,
            surface.arm,
            surface.gains,
            surface.growth,
            surface.shortened_turn,
            surface.axisymmetric,
        ),
        FORMS[spatial.form],
        SOFTENING[spatial.softening_variable],
        spatial.fracture,
        spatial.shear_loss,
        spatial.round_shear,
        spatial.cross_softening,
        spatial.edge_relief,
    )


def _stilled(joint: SpatialHinge) -> SpatialHinge:
    """A joint of an elastic member with the dampers of a run with quasi-static stages."""
    parts = (replace(part, viscous_damping=STILL * part.viscous_damping) for part in joint.components)
    return replace(joint, components=tuple(parts))


def _part(
    spatial: SpatialHingeRecord, part: HingeComponent, flanges: Mapping[str, float]
) -> SpatialComponent:
    plain = replace(
        _component(int(part.freedom), part.record),
        softens=part.softens,
        flange=flanges.get(part.freedom.label, 0.0),
    )
    index, shift, worn = spatial.freedoms.index, part.shift, part.worn
    if shift is not None:
        plain = replace(plain, driver=index(shift.driver), shift=(shift.rotation, shift.share))
    if worn is not None:
        plain = replace(plain, driver=index(worn.driver), worn=(worn.rotation, worn.share))
    if part.spread is not None:
        both = part.spread
        plain = replace(plain, positive_spread=both.lengthening, negative_spread=both.shortening)
    return plain


def _component(freedom: int, record: HingeRecord) -> SpatialComponent:
    return SpatialComponent(freedom, **hinge_constants(record))


def _loads(structure: Structure, linkage: Linkage, duration: float) -> Iterator[SpatialLoad]:
    for load in applied_loads(structure, linkage.node_body, duration):
        point, none = np.asarray(structure.nodes[load.node], float), np.zeros(3)
        kind, along = divmod(FREEDOMS.index(load.freedom), 3)
        unit = np.eye(3)[along]
        force, moment = (none, unit) if kind else (unit, none)
        yield SpatialLoad(load.body, point, force, moment, load.times, load.values)
