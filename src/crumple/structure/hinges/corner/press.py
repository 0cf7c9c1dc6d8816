"""Compression of a mitred corner that bends in space: what its fold about the tension flange leaves.

In a plane a corner turns about its tension flange (slip): with the arm a of the fold and the half depth d

    |M| + int_0^N a dN <= M(theta),    a/d = b (1 - exp(-theta/theta_1)) + (1 - b) min(1, N/(n N_y)).

In space the hinge has one surface for slip and three rotations.  Its capacity in compression alone follows
with M = 0 and N >= n N_y,

    N(theta) = (M(theta)/d + (1 - b) n N_y/2)/(1 - b exp(-theta/theta_1)),

at most the force that folds the walls.  M is the mean of the moments that open and that close the corner:
with no moment it may turn either way, and a corner and its mirror image carry the same.  With the shares n of
N, m of the moment in the plane, m_a and t of those across it, the surface is

    (|n| + |m|)^2 + m_a^2 + t^2 = 1.

Slip u and rotation share one measure of softening, max(M(0) theta, w N(0) u).  The weight w is the largest
with which the slip of a corner that turns under N(theta), u = int M/N dtheta, never leads: else a corner that
turns would soften by its slip, twice as fast as in its plane.  Limits: no force: the ellipsoid of the corner;
no moments: N.  Derived here from the corner's law in its plane.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from crumple.hinge import Coupling, Freedom, HingeComponent, HingeRecord, SpatialHingeRecord
from crumple.hinge.record.spatial_record import HingeSurface
from crumple.numeric.arrays import Floats
from crumple.section import Section
from crumple.structure.hinges.corner.slip import fold_share, pressed_slip
from crumple.structure.hinges.corners import Corner

POWER = 16.0
"""Power of the norm of the rows: corners of the polygon are rounded by 4 %."""
DIRECTIONS = 5
"""Rows for a quarter of the circle of both moments."""


def with_corner_press(
    record: SpatialHingeRecord, corner: Corner, section: Section, squash: float, straight: HingeRecord
) -> SpatialHingeRecord:
    """Record of a corner's hinge with slip and three rotations.

    Parameters
    ----------
    record
        It is returned as it is with other components, or a coupling other than the ellipsoid.
    corner, section
        Where; rectangular tubes have a fold about the tension flange.
    squash
        Force at which all walls yield [N].
    straight
        Record in the corner's plane of walls that do not come to lie on each other, as under a force alone.

    References
    ----------
    docs/theory/mitred_corner.md.  Verified in tests/unit/structure/hinges/test_corner_shortening.py.
    """
    parts = {component.freedom: component for component in record.components}
    in_plane = Freedom[corner.axis.upper()]
    if record.surface.coupling is not Coupling.ELLIPSOID or section.kind != "rectangular_tube":
        return record
    if {*parts} != {Freedom.AXIAL, Freedom.X, Freedom.Y, Freedom.Z}:
        return record
    arm = 0.5 * (section.bending_depth(corner.axis) - section.thickness)
    pressed = pressed_slip(parts[Freedom.AXIAL].record, straight, arm, squash, fold_share(corner, section))

    def own(component: HingeComponent) -> HingeComponent:
        if component.freedom is not Freedom.AXIAL:
            return component
        spread = component.spread
        # the corner folds before its members yield in compression
        pulled = spread and replace(spread, shortening=(np.zeros(0), np.zeros(0)))
        return replace(component, record=pressed.record, spread=pulled, softens=pressed.weight)

    order = record.freedoms
    columns = [order.index(Freedom.AXIAL), order.index(in_plane), order.index(Freedom[corner.across.upper()])]
    rows = np.zeros((len(_ROWS), len(order)))
    rows[:, columns] = _ROWS
    surface = HingeSurface(
        Coupling.SECTION, rows, POWER, torsion=order.index(Freedom.X), error=2.0 ** (1.0 / POWER) - 1.0
    )
    return replace(record, components=tuple(map(own, record.components)), surface=surface)


def _rows() -> Floats:
    """Linear forms in the shares n, m and m_a."""
    found: list[tuple[float, float, float]] = []
    for turn in np.linspace(0.0, 0.5 * math.pi, DIRECTIONS).tolist():
        c, s = math.cos(turn), math.sin(turn)
        signs = (
            [(1.0, 1.0), (-1.0, 1.0)] if turn == 0.0 else [(1.0, 1.0), (-1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)]
        )
        found += [(c, c * plane, s * across) for plane, across in signs]
    rows = np.array(found)
    # each share alone reaches 1
    return np.asarray(rows / (np.abs(rows) ** POWER).sum(axis=0) ** (1.0 / POWER), np.float64)


_ROWS = _rows()
