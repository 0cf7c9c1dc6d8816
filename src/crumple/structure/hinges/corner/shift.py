"""How the set of a corner's hinge moves and shrinks while the corner turns in and out of its plane."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from crumple.hinge import Coupling, Form, Freedom, HingeComponent, SpatialHingeRecord
from crumple.hinge.corner.shift import corner_shift, worn_by_bisector
from crumple.hinge.record.spatial_record import DrivenShare
from crumple.section import Section
from crumple.structure.hinges.corners import Corner

PLACES = np.radians(np.linspace(0.0, 90.0, 91))
"""Rotations at which shares are given [rad]."""
TURNS = {Freedom.X, Freedom.Y, Freedom.Z}


def with_corner_shift(record: SpatialHingeRecord, corner: Corner, section: Section) -> SpatialHingeRecord:
    """Record of a corner's hinge whose set moves along the normal of its plane, and loses about the tangent.

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
    bisector = Freedom[corner.across.upper()]
    shift = DrivenShare(PLACES, -corner.sense * share(PLACES), bisector)
    worn = DrivenShare(PLACES, worn_by_bisector(PLACES), bisector)

    def driven(component: HingeComponent) -> HingeComponent:
        if component.freedom.label == corner.axis:
            return replace(component, shift=shift)
        return component if component.freedom is bisector else replace(component, worn=worn)

    return replace(record, components=tuple(map(driven, record.components)))
