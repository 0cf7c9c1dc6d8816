"""Initial motion against supports: impulses and velocities along fixed degrees of freedom."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from crumple.errors import Problem
from crumple.numeric.arrays import Floats
from crumple.structure.keys.load import NodalImpulse
from crumple.structure.keys.motion import FREEDOMS, InitialVelocity
from crumple.structure.parts import StructureParts
from crumple.structure.schema.problems import Names

ROUNDING = 1e-9
"""Share of a velocity field's largest velocity below which a component is rounding."""


def start_problems(structure: StructureParts, known: Mapping[str, Names]) -> Iterator[Problem]:
    """Impulses and velocities at the start that a support absorbs."""
    yield from swallowed(structure, structure.impulses, structure.initial_velocity)


def swallowed(
    structure: StructureParts,
    impulses: Sequence[NodalImpulse],
    fields: Sequence[InitialVelocity],
    where: str = "",
) -> Iterator[Problem]:
    """Impulses, and velocities of nodes that are named, along freedoms that a support holds or drives.

    A field of members or of the whole structure may include a supported node: the run warns about the energy
    lost there, since the motion of the held part follows from the rest.

    Parameters
    ----------
    structure
        With its supports.
    impulses, fields
        At the start, or of a stage.
    where
        Path in front of theirs, such as ``analysis.stages[1].``.
    """
    for i, struck in enumerate(impulses):
        for key, values, freedoms in (
            ("impulse", struck.impulse, FREEDOMS[:3]),
            ("angular_impulse", struck.angular_impulse, FREEDOMS[3:]),
        ):
            for k, freedom in enumerate(freedoms):
                support = _holder(structure, struck.node, freedom)
                if values[k] and support:
                    came = f"{values[k]:g} N{' m' if freedom[0] == 'r' else ''} s"
                    place = f"{where}impulses[{i}].{key}[{k}]"
                    yield _nothing_moves("the impulse", struck.node, freedom, support, came, place)
    for i, field in enumerate(fields):
        for j, node in enumerate(field.nodes or ()):
            yield from _held_velocities(structure, field, node, f"{where}initial_velocity[{i}].nodes[{j}]")


def _held_velocities(
    structure: StructureParts, field: InitialVelocity, node: str, where: str
) -> Iterator[Problem]:
    if node not in structure.nodes:
        return
    spin, arm = _spin(field), np.subtract(structure.nodes[node], field.about)
    linear = np.asarray(field.translation, float) + np.cross(spin, arm)
    size = float(np.linalg.norm(field.translation) + np.linalg.norm(spin) * np.linalg.norm(arm))
    for values, least, freedoms, unit in (
        (linear, size, FREEDOMS[:3], "m/s"),
        (spin, float(np.linalg.norm(spin)), FREEDOMS[3:], "rad/s"),
    ):
        for k, freedom in enumerate(freedoms):
            support = _holder(structure, node, freedom)
            if support and abs(values[k]) > ROUNDING * least:
                came = f"{values[k]:g} {unit}"
                yield _nothing_moves("the velocity", node, freedom, support, came, where)


def _holder(structure: StructureParts, node: str, freedom: str) -> str:
    """Support that holds or drives a freedom of a node; empty where it is free."""
    return next(
        (
            name
            for name, support in structure.supports_at.get(node, ())
            if freedom in (*support.held, *support.driven)
        ),
        "",
    )


def _nothing_moves(what: str, node: str, freedom: str, support: str, came: str, where: str) -> Problem:
    return Problem(
        f"{what} is lost: the support '{support}' fixes {freedom} of node '{node}'",
        came,
        "0 along what is held or driven",
        "remove it, give another node, or free this one",
        where,
    )


def _spin(field: InitialVelocity) -> Floats:
    if field.axis is None:
        return np.zeros(3)
    axis = np.asarray(field.axis, float)
    return np.asarray(field.rotation * axis / np.linalg.norm(axis))
