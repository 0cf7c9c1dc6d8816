"""A law measured in a sub-model: plastic rotation, moment, and the work done so far.

In axial crushing shortening [m] stands for rotation, and force [N] for moment.

The histories of a shell run hold small vibrations.  They are averaged so that the work is kept: within each
interval of plastic rotation the moment of the law is the work done there over the interval.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from crumple.errors import InputError, Problem
from crumple.numeric.arrays import Floats

FIRST = 1e-3
"""Plastic rotation [rad] below which the section still yields through; the law is constant up to there."""
INTERVAL = float(np.deg2rad(0.5))
"""Plastic rotation over which the moment is averaged [rad]."""


@dataclass(frozen=True)
class LawCurve:
    """Moment of a fold against its plastic rotation.

    Attributes
    ----------
    rotation
        Plastic rotation [rad], strictly increasing from 0, (n,).
    moment
        Moment [N m], (n,).
    energy
        Plastic work up to each rotation [J], (n,).
    stiffness
        Elastic stiffness of the place itself, in addition to that of its members [N m/rad]; None: rigid.
    """

    rotation: Floats
    moment: Floats
    energy: Floats
    stiffness: float | None = None

    def with_stiffness(self, stiffness: float) -> LawCurve:
        """The same law with an elastic stiffness of its own [N m/rad]."""
        return replace(self, stiffness=stiffness)

    def energy_at(self, rotation: float) -> float:
        """Plastic work up to a rotation [rad]: linear between the points [J]."""
        return float(np.interp(rotation, self.rotation, self.energy))

    def moment_at(self, rotation: float) -> float:
        """Moment at a rotation [rad] [N m]."""
        return float(np.interp(rotation, self.rotation, self.moment))


def law_curve(
    rotation: Floats, moment: Floats, largest: float, *, first: float = FIRST, interval: float = INTERVAL
) -> LawCurve:
    """Law from histories of plastic rotation and moment.

    Parameters
    ----------
    rotation
        Plastic rotation of the fold at successive times [rad], (n,).
    moment
        Moment at these times [N m], (n,).
    largest
        Where the law ends [rad]; earlier where the histories end earlier.
    first, interval
        Rotation up to which the law is constant, and over which the moment is averaged [rad].

    Returns
    -------
    LawCurve
        Points at every interval, or closer in short histories.

    Raises
    ------
    InputError
        If nothing turned plastically.

    Notes
    -----
    Work over an interval of rotation over the interval gives the moment in its middle; the curve is straight
    between these, and constant from 0 to the first: so the energy of the law is the measured work to within
    the curvature of the moment over one interval.
    """
    reached = np.maximum.accumulate(np.maximum(rotation, 0.0))
    work = np.concatenate([[0.0], np.cumsum(0.5 * (moment[1:] + moment[:-1]) * np.diff(rotation))])
    end = min(float(reached[-1]), largest)
    if end < 10 * first:
        what, todo = "the sub-model did not turn plastically", "turn it further (--to)"
        raise InputError(
            Problem(what, f"{np.degrees(end):.3g} deg", f"{np.degrees(10 * first):.2g} deg", todo)
        )
    steps = np.linspace(first, end, max(int(np.ceil((end - first) / interval)), 4) + 1)
    new = np.concatenate([[True], np.diff(reached) > 0.0])
    done = np.interp(steps, reached[new], work[new])
    middle = 0.5 * (steps[1:] + steps[:-1])
    mean = np.diff(done) / np.diff(steps)
    points = np.concatenate([[0.0], middle, [end]])
    last = mean[-1] + (mean[-1] - mean[-2]) / 2
    moments = np.maximum(np.concatenate([mean[:1], mean, [last]]), 1e-6 * mean.max())
    energy = np.concatenate([[0.0], np.cumsum(0.5 * (moments[1:] + moments[:-1]) * np.diff(points))])
    return LawCurve(points, moments, energy)
