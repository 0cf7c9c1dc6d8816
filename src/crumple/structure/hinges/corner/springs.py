"""Elastic stiffness of a corner's hinge about the corner's own axes.

A length l of a member twists by l/(G J) times the torque about its own axis, which is at half the corner's
angle a to the tangent. So it adds cos^2(a/2) l/(G J) to the flexibility about the tangent and sin^2(a/2)
l/(G J) to that about the bisector. The product of both, which couples them, is left out: elastic members
twist in hinges and joints of their own, and these springs are for hinges of rigid ones.
"""

from __future__ import annotations

import math
from dataclasses import replace

from crumple.hinge import Form, HingeLaw, SpatialHingeRecord
from crumple.hinge.record.spatial_record import Freedom, HingeComponent
from crumple.material import Material
from crumple.section import Section
from crumple.structure.hinges.corners import Corner


def with_corner_springs(
    record: SpatialHingeRecord,
    corner: Corner,
    metal: tuple[Section, Material],
    length: float,
    tangent: HingeLaw | None,
) -> SpatialHingeRecord:
    """Record of a corner's hinge with its stiffness about the tangent and the bisector.

    Parameters
    ----------
    record
        Its components; those of a set-valued form have no stiffness.
    corner, metal
        Where, and its section and material.
    length
        Of member that twists elastically in this hinge [m].
    tangent
        Law about the tangent, with the stiffness of the corner's own; None: it has none.
    """
    if record.form is not Form.ELASTIC_PLASTIC:
        return record
    section, material = metal
    twist = length / (material.shear_modulus * section.torsion_constant)
    own = None if tangent is None else tangent.elastic_stiffness
    along, aside = math.cos(0.5 * corner.angle) ** 2, math.sin(0.5 * corner.angle) ** 2

    def sprung(component: HingeComponent) -> HingeComponent:
        if component.freedom is Freedom.X:
            flexibility = along * twist + (0.0 if own is None else 1.0 / own)
        elif component.freedom.label == corner.across:
            flexibility = aside * twist + 1.0 / component.record.elastic_stiffness
        else:
            return component
        return replace(component, record=replace(component.record, elastic_stiffness=1.0 / flexibility))

    return replace(record, components=tuple(map(sprung, record.components)))
