"""Loads and prescribed motions as the stepper takes them: piecewise linear in time."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from crumple._core.shell.simulation import NodalLoad, PrescribedVelocity
from crumple.function import TimeFunction
from crumple.numeric.arrays import Floats
from crumple.shell.mesh.mesh import Mesh
from crumple.shell.model.bodies import Body, body_numbers
from crumple.structure import Stage, Structure

SAMPLING = 1e-5
"""Error of a sampled function of time, relative to its largest value; far below that of the mesh."""
AT_REST = np.zeros(1)
"""Rate of what a stage does not drive."""
BEFORE = 1e-6
"""Share of an interval before its end at which the slope towards the end is taken."""


def loads_of(structure: Structure, mesh: Mesh, stage: Stage, begin: float) -> Iterator[NodalLoad]:
    """Forces and moments of a stage on the reference nodes; those on a clamp do nothing."""
    for load in structure.loads:
        if load.node not in mesh.reference:
            continue
        for kind, components in (("", load.force), ("r", load.moment)):
            for axis in "xyz":
                function = getattr(components, axis)
                if function is not None:
                    times, values = sampled(function, stage.duration)
                    yield NodalLoad(mesh.reference[load.node], kind + axis, begin + times, values)


def motions_of(
    structure: Structure, bodies: tuple[Body, ...], stage: Stage, begin: float
) -> Iterator[PrescribedVelocity]:
    """Prescribed velocities of the rigid bodies; those that the stage does not drive stay where they are."""
    number = body_numbers(bodies)
    for name, support in structure.supports.items():
        runs = stage.drive is None or name in stage.drive
        for freedom, function in support.driven.items():
            times, rates = (
                velocity_of(function, stage.duration, begin) if runs else (AT_REST + begin, AT_REST)
            )
            yield PrescribedVelocity(number[support.node], freedom, times, rates, rigid_set=True)


def sampled(function: TimeFunction, duration: float) -> tuple[Floats, Floats]:
    """Times [s] and values between which straight lines follow the function."""
    coarse = np.abs(function(np.linspace(0.0, duration, 257)))
    return function.sampled(0.0, duration, max(SAMPLING * float(coarse.max()), 1e-12))


def velocity_of(function: TimeFunction, duration: float, begin: float = 0.0) -> tuple[Floats, Floats]:
    """Rate of a function that counts from `begin` [s], piecewise linear with jumps at kinks.

    Returns
    -------
    times, rates
        Each time of the samples but the ends twice; the integral meets the function at every one of them.
    """
    at, value = sampled(function, duration)
    step = np.diff(at)
    left, right = function.derivative(at[:-1]), function.derivative(at[1:] - BEFORE * step)
    shift = np.diff(value) / step - (left + right) / 2
    at = begin + at
    # a jump takes the smallest time difference of a floating-point number
    ends = np.append(np.nextafter(at[1:-1], 0.0), at[-1:])
    times = np.column_stack([at[:-1], ends]).reshape(-1)
    return times, np.column_stack([left + shift, right + shift]).reshape(-1)
