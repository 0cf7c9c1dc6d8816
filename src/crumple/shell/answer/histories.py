"""From the record of a shell run to named channels."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from crumple.numeric.arrays import Floats
from crumple.numeric.ranking import largest_first
from crumple.numeric.rotation import continuous, relative_rotation, rotation_vector
from crumple.result import Channel
from crumple.result.channels import channel, channels_along
from crumple.shell.answer.hinge_histories import hinge_channels
from crumple.shell.answer.record import ENERGIES, IMPULSE, Record, Sampler, slope
from crumple.shell.answer.weld_histories import weld_channels
from crumple.structure import Outputs, Structure

CHANNEL_NAMES = {"plastic": "dissipated"}
"""Names of the energies where the stepper's differ from the result's."""


def channels_of(structure: Structure, sampler: Sampler, record: Record, outputs: Outputs) -> list[Channel]:
    """Every channel of the run, at the times of the record; requested ones come last."""
    return [
        *hinge_channels(sampler, record),
        *energy_channels(record),
        *cut_channels(sampler, record),
        *obstacle_channels(structure, record),
        *weld_channels(structure, sampler.case, record),
        *node_channels(sampler, record, outputs),
        *section_channels(structure, sampler, record, outputs),
        *distance_channels(structure, sampler, record, outputs),
        *clearance_channels(sampler, record),
    ]


def energy_channels(record: Record) -> Iterator[Channel]:
    """Ledger: kinetic + elastic + dissipated + hourglass + contact + damping - work - start = residual."""
    energy = record["energy"]
    for i, name in enumerate(ENERGIES):
        if name in ("damping", "eroded") and not energy[:, i].any():
            continue
        yield channel(f"energy.{CHANNEL_NAMES.get(name, name)}", energy[:, i].copy())


def cut_channels(sampler: Sampler, record: Record) -> Iterator[Channel]:
    """Force and moment in each hinge's cut, and of the structure on each support."""
    zones, supports = sampler.case.zones, sampler.case.supports
    names = [*(f"cut.{zone.place.name}" for zone in zones), *(f"support.{name}" for name in supports)]
    for k, (name, cut) in enumerate(zip(names, [*[None] * len(zones), *supports.values()], strict=True)):
        force, moment, centre = np.split(record["cut"][:, k], 3, axis=1)
        if cut is not None and cut.about is not None:
            about = cut.about if cut.stays else cut.about + centre - centre[0]
            moment = moment + np.cross(centre - about, force)
        yield from channels_along(f"{name}.force", force)
        yield from channels_along(f"{name}.moment", moment)


def obstacle_channels(structure: Structure, record: Record) -> Iterator[Channel]:
    """Displacement and velocity of obstacles, and the structure's mean force on each since the last output.

    Contact forces are spikes of single nodes; their mean keeps the impulse.
    """
    time = record["time"]
    for k, name in enumerate(structure.obstacles):
        rows = record["obstacle"][:, k]
        steps = np.maximum(np.diff(time), np.finfo(float).tiny)[:, None]
        force = np.concatenate([rows[:1, 8:11], np.diff(rows[:, IMPULSE], axis=0) / steps])
        fields = {"force": force, "displacement": rows[:, :3], "velocity": rows[:, 3:6]}
        for quantity, values in fields.items():
            yield from channels_along(f"obstacle.{name}.{quantity}", values)


def node_channels(sampler: Sampler, record: Record, outputs: Outputs) -> Iterator[Channel]:
    """Displacement, velocity, mean acceleration between outputs, and rotation of nodes, in global axes."""
    for name in outputs.nodes:
        motion = record["node"][:, sampler.nodes.index(name)]
        velocity = motion[:, 1]
        fields = {
            "displacement": motion[:, 0],
            "velocity": velocity,
            "acceleration": slope(velocity, record["time"]),
            "rotation": continuous(rotation_vector(motion[:, 3:])),
            "rotation_rate": motion[:, 2],
        }
        for quantity, values in fields.items():
            yield from channels_along(f"node.{name}.{quantity}", values)


def ring_history(sampler: Sampler, record: Record, member: str, ring: int) -> Floats:
    """Rotation of one section from the start over time, (n, 3, 3)."""
    return record["ring"][:, sampler.rings.index((member, ring))]


def section_channels(
    structure: Structure, sampler: Sampler, record: Record, outputs: Outputs
) -> Iterator[Channel]:
    """Rotation of one station of a member against another about the hinges' axis, else the larger."""
    for name, asked in outputs.section_rotations.items():
        tube = sampler.case.mesh.tubes[asked.member]
        first, last = (
            ring_history(sampler, record, asked.member, tube.ring_at(station))
            for station in (asked.start, asked.end)
        )
        axes = {zone.place.axis for zone in sampler.case.zones if zone.place.member == asked.member}
        turned = {axis: relative_rotation(first, last, tube.frame.axis(axis)) for axis in ("y", "z")}
        axis = (
            axes.pop()
            if len(axes) == 1
            else largest_first({axis: float(np.abs(turned[axis]).max()) for axis in turned})[0]
        )
        yield Channel(name, "rad", turned[axis])


def distance_channels(
    structure: Structure, sampler: Sampler, record: Record, outputs: Outputs
) -> Iterator[Channel]:
    """Change of the distance between two nodes: negative where they come nearer."""
    for name, asked in outputs.distances.items():
        first, last = (
            np.asarray(structure.nodes[node], float) + record["node"][:, sampler.nodes.index(node), 0]
            for node in (asked.start, asked.end)
        )
        apart = np.linalg.norm(last - first, axis=1)
        before = np.subtract(structure.nodes[asked.end], structure.nodes[asked.start])
        yield Channel(name, "m", apart - float(np.linalg.norm(before)))


def clearance_channels(sampler: Sampler, record: Record) -> Iterator[Channel]:
    """Least distance between a space that moves with a member and the others, negative inside."""
    for k, space in enumerate(sampler.case.spaces):
        yield Channel(space.name, "m", record["clearance"][:, k].copy())
