"""Moment in a fold: the result's own if there is one, else the moment conjugate to plastic work."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from crumple.numeric.arrays import Floats
from crumple.result import Result

WINDOW = np.radians(2.0)
"""Window of rotation [rad] over which work is divided by rotation: a few outputs, a small part of a fold."""
ELASTIC_WORK = 0.01
"""Share of the final plastic work below which a fold counts as elastic."""


@dataclass(frozen=True, eq=False)
class Bent:
    """Rotation [rad] and plastic work [J] of a fold over time [s], and its elastic stiffness [N m/rad].

    `axes` are the unit vectors, (n, 3), about which a hinge about two axes turned, else None.  `axis` is the
    axis of the hinge about which the rotation is, None where it is the angle about any.
    """

    times: Floats
    rotation: Floats
    work: Floats
    stiffness: float
    axes: Floats | None = None
    axis: str | None = None


def moment_in(result: Result, name: str, bent: Bent) -> tuple[Floats, str]:
    """Moment of a hinge by name, in the sense of the rotation [N m], and its origin in words."""
    if bent.axes is None:
        # of a hinge that also twists, the channel without an axis is the length of a vector
        own = f"hinge.{name}.moment.{bent.axis}"
        found = _histories(result, [own if own in result.channels else f"hinge.{name}.moment"], bent.times)
    else:
        found = _histories(result, [f"cut.{name}.moment.{axis}" for axis in "xyz"], bent.times)
    if found is not None:
        along = found[:, 0] if bent.axes is None else np.einsum("ti,ti->t", found, bent.axes)
        return along, "moment from the result"
    if not bent.work.any():
        return np.zeros_like(bent.times), "no moment available"
    return conjugate_moment(bent.rotation, bent.work, bent.stiffness), "moment conjugate to plastic work"


def _histories(result: Result, names: list[str], times: Floats) -> Floats | None:
    """Channels at given times, (n, k); None if one is missing or not finite."""
    found = [result.channels[name].values for name in names if name in result.channels]
    if len(found) < len(names) or not all(np.isfinite(values).all() for values in found):
        return None
    return np.stack([np.interp(times, result.time, values) for values in found], axis=1)


def conjugate_moment(rotation: Floats, work: Floats, stiffness: float) -> Floats:
    """Moment conjugate to plastic work: work over rotation across a window; elastic before it yields.

    Parameters
    ----------
    rotation
        [rad], (n,).
    work
        Plastic work, growing [J], (n,).
    stiffness
        Elastic, between the planes [N m/rad].

    Returns
    -------
    Floats
        [N m], (n,), with the sign of the rotation.  After the largest rotation the last value is kept.
    """
    side = float(np.sign(rotation[int(np.argmax(np.abs(rotation)))]) or 1.0)
    turned = np.maximum.accumulate(np.maximum(side * rotation, 0.0))
    grid, first = np.unique(turned, return_index=True)
    if grid.size < 3:
        return np.zeros_like(rotation)
    # work done until a rotation is first passed; the window shrinks at both ends
    done = work[np.append(first[1:] - 1, len(work) - 1)]
    low = np.clip(grid - WINDOW / 2, grid[0], grid[-1])
    high = np.clip(grid + WINDOW / 2, grid[0], grid[-1])
    slope = (np.interp(high, grid, done) - np.interp(low, grid, done)) / np.maximum(high - low, 1e-12)
    moment = np.interp(turned, grid, slope)
    elastic = work < ELASTIC_WORK * work[-1]
    return np.asarray(side * np.where(elastic, np.minimum(stiffness * side * rotation, moment.max()), moment))
