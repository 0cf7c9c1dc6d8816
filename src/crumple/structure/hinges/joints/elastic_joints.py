"""Joints of a member besides its hinges: points at which it bends, twists and yields."""

from __future__ import annotations

from crumple import hinge
from crumple.hinge import ConstantLaw, Coupling, Form, HingeComponent, HingeRecord
from crumple.section import Axis, half_fold_length
from crumple.structure.hinges.corner_laws import corner_laws, corner_name
from crumple.structure.hinges.elastic_members import yielding_record
from crumple.structure.hinges.joint_reach import joint_reach
from crumple.structure.hinges.joints.placed_hinge import PlacedHinge, direction_of
from crumple.structure.hinges.places import HingePlace, member_hinge_places
from crumple.structure.hinges.shares import SAME_PLACE, AxisShares, axes_of, joint_lengths, joint_twists
from crumple.structure.hinges.spatial_hinges import BENDING, twist_component
from crumple.structure.parts import StructureParts

FIRM = 100.0
"""Capacity of an elastic joint over the largest capacity of its member's hinges: no impact reaches it, and
tolerances relative to the largest capacity stay small."""
NEARLY = 0.7
"""Cosine between a section axis and a corner's normal from which the member bends about this axis there."""


def elastic_joints(
    structure: StructureParts, member: str, own: list[PlacedHinge], about: dict[Axis, AxisShares]
) -> list[PlacedHinge]:
    """Joints of a member besides its hinges: points at which it bends and twists elastically.

    Those of an elastic member yield as its section does; the others have no plastic law.
    """
    lengths = joint_lengths(about, SAME_PLACE * structure.frame_of(member).length)
    twisted = joint_twists(structure, member, [station for station, _ in lengths])
    found = []
    for i, (station, by_axis) in enumerate(lengths, 1):
        # no name of the input has a blank
        name = f"{member} elastic" if len(lengths) == 1 else f"{member} elastic {i}"
        records = {
            axis: _joint_record(structure, member, axis, (station, length), own)
            for axis, length in sorted(by_axis.items())
        }
        first = min(records)
        place = HingePlace(name, member, station, first, None, f"members.{member}")
        components = [HingeComponent(BENDING[axis], record) for axis, record in records.items()]
        if station in twisted:
            components.append(_twist(structure, member, (station, twisted[station]), records, own))
        coupling = Coupling.ELLIPSOID if structure.members[member].elastic else Coupling.NONE
        found.append(
            PlacedHinge(
                name=name,
                member=member,
                station=station,
                axis=first,
                position=structure.frame_of(member).position(station),
                direction=direction_of(structure, place),
                tributary_length=by_axis[first],
                law=ConstantLaw(float(records[first].positive.moment.max())),
                record=records[first],
                spatial=hinge.spatial_record(components, coupling=coupling) if len(components) > 1 else None,
                plastic=False,
            )
        )
    return found


def _twist(
    structure: StructureParts,
    member: str,
    place: tuple[float, float],
    bending: dict[Axis, HingeRecord],
    own: list[PlacedHinge],
) -> HingeComponent:
    """Twist of a joint at a station that stands for a length [m] of its member: it yields as it bends."""
    station, length = place
    metal = structure.section_of(member), structure.material_of(member)
    firm = any(_beyond_a_fold(structure, member, axis, station, own) for axis in bending)
    first = next(iter(bending.values()))
    return twist_component(first, metal, length, firm=FIRM if firm else 1.0)


def _joint_record(
    structure: StructureParts, member: str, axis: Axis, place: tuple[float, float], own: list[PlacedHinge]
) -> HingeRecord:
    """Record of a joint at a station that stands for a length [m] of its member.

    One between an end and the fold there, or in a rigid joint, does not yield: the hinge stands for the fold
    of all that lies beyond it. Walls that yielded there without folding would carry its largest moment
    whatever the rotation.
    """
    station, length = place
    if structure.members[member].elastic and not _beyond_a_fold(structure, member, axis, station, own):
        return yielding_record(structure, member, axis, length)
    strongest = max(
        (float(curve.moment.max()) for h in own for curve in (h.record.positive, h.record.negative)),
        default=float(yielding_record(structure, member, axis, length).positive.moment.max()),
    )
    stiffness = structure.flexural_rigidity(member, axis) / length
    law = ConstantLaw(FIRM * strongest)
    return hinge.record_of(law, form=Form.ELASTIC_PLASTIC, elastic_stiffness=stiffness)


def _beyond_a_fold(
    structure: StructureParts, member: str, axis: Axis, station: float, own: list[PlacedHinge]
) -> bool:
    """Whether a station lies in a rigid joint, or between an end and a hinge less than one fold away.

    The hinge of a corner counts in both of its members.  Of a member without hinges no station does: nothing
    else stands for its folds.
    """
    at_corners = _folds_at_corners(structure, member, axis)
    if not own and not at_corners:
        return False
    first, second = (joint_reach(structure, member, node) for node in structure.members[member].nodes)
    if not first < station < structure.frame_of(member).length - second and (first or second):
        return True
    folds = [*(hinge.station for hinge in own if _bends_about(hinge, axis)), *at_corners]
    if not folds or min(folds) <= station <= max(folds):
        return False
    nearest = min(folds) if station < min(folds) else max(folds)
    return abs(station - nearest) <= 2.0 * half_fold_length(structure.section_of(member), axis)


def _folds_at_corners(structure: StructureParts, member: str, axis: Axis) -> list[float]:
    """Stations of the corners at the ends of a member whose hinges are in the other member [m]."""
    frame = structure.frame_of(member)
    found = []
    for node, station in zip(structure.members[member].nodes, (0.0, frame.length), strict=True):
        known = corner_laws(structure).get(node)
        if known is None or known[0].first == member:
            continue
        corner, _ = known
        places = member_hinge_places(structure, corner.first)
        several = any(place.name == corner_name(node) and len(axes_of(place)) > 1 for place in places)
        across = frame.y if axis == "y" else frame.z
        if several or abs(float(across @ corner.normal)) > NEARLY:
            found.append(station)
    return found


def _bends_about(hinge: PlacedHinge, axis: Axis) -> bool:
    if hinge.spatial is None:
        return hinge.axis == axis
    return any(component.freedom is BENDING[axis] for component in hinge.spatial.components)
