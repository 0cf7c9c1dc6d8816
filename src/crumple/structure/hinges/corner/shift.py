"""Shift of the yield set of a corner's hinge that bends in and out of the corner's plane."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from crumple.hinge import Coupling, Form, Freedom, HingeComponent, SpatialHingeRecord
from crumple.hinge.corner.shift import corner_shift
from crumple.hinge.record.spatial_record import Shift
from crumple.section import Section
from crumple.structure.hinges.corners import Corner

PLACES = np.radians(np.linspace(0.0, 90.0, 91))
"""Rotations at which the shift is given [rad]."""
TURNS = {Freedom.X, Freedom.Y, Freedom.Z}


def with_corner_shift(record: SpatialHingeRecord, corner: Corner, section: Section) -> SpatialHingeRecord:
    """Record of a corner's hinge with the shift of its set along the normal of the corner's plane.

    Parameters
    ----------
    record
        Its components: it is returned as it is unless they are the three rotations on an ellipsoid, and not
        regularised.
    corner, section
        Where, and its section: rectangular and round tubes have a shift, in the range of their estimates.

    References
    ----------
    docs/theory/mitred_corner.md.
    """
    able = record.surface.coupling is Coupling.ELLIPSOID and record.form is not Form.REGULARISED
    share = corner_shift(section, corner.angle)
    if share is None or not able or {*record.freedoms} != TURNS:
        return record
    shift = Shift(PLACES, -corner.sense * share(PLACES), Freedom[corner.across.upper()])

    def shifted(component: HingeComponent) -> HingeComponent:
        return replace(component, shift=shift) if component.freedom.label == corner.axis else component

    return replace(record, components=tuple(map(shifted, record.components)))
