"""Rigid pieces of members and lumped masses: mass, centre of mass and inertia in space, and their sums."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from crumple.numeric.arrays import Floats
from crumple.section import Section
from crumple.structure import Frame, Mass, Structure
from crumple.structure.remembered import remembered


@dataclass(frozen=True, eq=False)
class RigidMass:
    """Mass properties at the start, world axes.

    Attributes
    ----------
    mass
        [kg].
    centre
        Centre of mass [m], (3,); without meaning where the mass is zero.
    inertia
        Tensor about the centre [kg m^2], (3, 3).
    """

    mass: float
    centre: Floats
    inertia: Floats


NOTHING = RigidMass(0.0, np.zeros(3), np.zeros((3, 3)))
"""A piece without length."""


def combined(parts: list[RigidMass]) -> RigidMass:
    """One rigid body made of several (parallel axis theorem)."""
    parts = [part for part in parts if part is not NOTHING]
    if len(parts) == 1:
        return parts[0]
    mass = sum(part.mass for part in parts)
    if mass == 0.0:
        return RigidMass(0.0, np.zeros(3), sum((part.inertia for part in parts), np.zeros((3, 3))))
    centre = sum((part.mass * part.centre for part in parts), np.zeros(3)) / mass
    inertia, unit = np.zeros((3, 3)), np.eye(3)
    for part in parts:
        arm = part.centre - centre
        inertia += part.inertia + part.mass * (arm @ arm * unit - arm[:, None] * arm)
    return RigidMass(mass, centre, inertia)


def piece_mass(structure: Structure, member: str, start: float, end: float) -> RigidMass:
    """Mass of a member between two stations [m]: a uniform bar with its section's own rotary inertia."""
    if start == end:
        return NOTHING
    material = structure.material_of(member)
    return _bar(structure.frame_of(member), structure.section_of(member), material.density, start, end)


# needed by every stage of lowering
@remembered(4096)
def _bar(frame: Frame, section: Section, density: float, start: float, end: float) -> RigidMass:
    length = end - start
    mass = section.mass_per_length(density) * length
    about_y, about_z = (density * length * section.second_moment(axis) for axis in ("y", "z"))
    slender = mass * length**2 / 12
    local = np.array([about_y + about_z, slender + about_y, slender + about_z])
    centre, inertia = frame.position((start + end) / 2), (frame.axes.T * local) @ frame.axes
    centre.flags.writeable = inertia.flags.writeable = False
    return RigidMass(mass, centre, inertia)


def lump_mass(structure: Structure, mass: Mass) -> RigidMass:
    """Mass properties of a lumped mass at its centre."""
    centre = np.asarray(structure.nodes[mass.node], float) + np.asarray(mass.offset)
    return RigidMass(mass.mass, centre, np.diag(mass.rotary_inertia))
