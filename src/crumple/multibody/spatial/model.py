"""From a linkage to the spatial kernel's constants: bodies, joints, hinges, loads and driven supports."""

from __future__ import annotations

from collections.abc import Iterator

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
from crumple.hinge import Coupling, HingeRecord
from crumple.multibody.bodies.linkage import GROUND, Connection, Linkage
from crumple.multibody.bodies.sampled_functions import breaks_of, sampled, sampled_motion
from crumple.multibody.planar.model import FORMS, SOFTENING, stop_of
from crumple.structure import FREEDOMS, Structure

COUPLINGS = {
    Coupling.NONE: SurfaceCoupling.NONE,
    Coupling.ELLIPSOID: SurfaceCoupling.ELLIPSOID,
    Coupling.BALL: SurfaceCoupling.BALL,
    Coupling.SECTION: SurfaceCoupling.SECTION,
    Coupling.TENSION_FLANGE: SurfaceCoupling.TENSION_FLANGE,
}


def spatial_model(structure: Structure, linkage: Linkage, duration: float) -> SpatialModel:
    """Constants of the kernel's model, without obstacles.

    Parameters
    ----------
    structure, linkage
        What is solved.
    duration
        Functions of time are sampled over it [s].
    """
    x, y, z = structure.gravity
    return SpatialModel(
        bodies=tuple(SpatialBody(body.mass, body.inertia, body.centre) for body in linkage.bodies),
        joints=tuple(_joint(connection) for connection in linkage.connections),
        hinges=tuple(
            _hinge(i, connection)
            for i, connection in enumerate(linkage.connections)
            if connection.hinge is not None
        ),
        loads=tuple(_loads(structure, linkage, duration)),
        drives=tuple(drive for _, drive in support_drives(structure, linkage, duration)),
        gravity=(x, y, z),
        length=max(structure.frame_of(name).length for name in structure.members),
        breaks=breaks_of(structure, duration),
    )


def support_drives(
    structure: Structure, linkage: Linkage, duration: float
) -> Iterator[tuple[str, SpatialDrive]]:
    """Driven freedoms of supports, each with the support's name."""
    for i, connection in enumerate(linkage.connections):
        if connection.kind != "support":
            continue
        for freedom, function in structure.supports[connection.name].driven.items():
            times, _, rates = sampled_motion(function, duration)
            yield (
                connection.name,
                SpatialDrive(i, FREEDOMS.index(freedom), times, rates, float(function(0.0))),
            )


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
    spatial, record = connection.hinge.spatial, connection.hinge.record
    form, softening = FORMS[record.form], SOFTENING[record.softening_variable]
    if spatial is None:
        return SpatialHinge(joint, (_component(connection.free[0], record),), form=form, softening=softening)
    surface = spatial.surface
    return SpatialHinge(
        joint,
        tuple(_component(int(part.freedom), part.record) for part in spatial.components),
        SpatialSurface(
            COUPLINGS[surface.coupling],
            surface.rows,
            surface.power,
            surface.torque_power,
            surface.torsion,
            surface.arm,
        ),
        FORMS[spatial.form],
        SOFTENING[spatial.softening_variable],
        spatial.fracture,
    )


def _component(freedom: int, record: HingeRecord) -> SpatialComponent:
    return SpatialComponent(
        freedom=freedom,
        positive=(record.positive.rotation, record.positive.moment),
        negative=(record.negative.rotation, record.negative.moment),
        elastic_stiffness=record.elastic_stiffness,
        regularisation_rate=record.regularisation_rate,
        rate_reference=record.rate_reference,
        rate_exponent=record.rate_exponent,
        viscous_damping=record.viscous_damping,
        stop_positive=stop_of(record.stop_positive),
        stop_negative=stop_of(record.stop_negative),
    )


def _loads(structure: Structure, linkage: Linkage, duration: float) -> Iterator[SpatialLoad]:
    for load in structure.loads:
        body = linkage.node_body[load.node]
        if body == GROUND:
            continue
        point = np.asarray(structure.nodes[load.node], float)
        for along, axis in enumerate("xyz"):
            unit, none = np.eye(3)[along], np.zeros(3)
            force, moment = getattr(load.force, axis), getattr(load.moment, axis)
            if force is not None:
                yield SpatialLoad(body, point, unit, none, *sampled(force, duration))
            if moment is not None:
                yield SpatialLoad(body, point, none, unit, *sampled(moment, duration))
