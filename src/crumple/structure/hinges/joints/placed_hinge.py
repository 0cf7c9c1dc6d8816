"""One hinge of a structure with its law, at its place."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from crumple.hinge import Freedom, HingeLaw, HingeRecord, SpatialHingeRecord
from crumple.numeric.arrays import Floats
from crumple.section import Axis
from crumple.structure.hinges.places import HingePlace
from crumple.structure.hinges.runs.bars import is_closed
from crumple.structure.parts import StructureParts

NEARER = np.sqrt(0.5) * (1.0 - 1e-9)
"""Cosine of 45 degrees, with room for rounding: of two axes across a member the nearer one is within it."""


@dataclass(frozen=True, eq=False)
class PlacedHinge:
    """One hinge with its law, for the solvers.

    Attributes
    ----------
    name, member, station, axis
        As in `HingePlace`.
    position
        Where it lies at the start, global [m], shape (3,).
    direction
        Unit vector of its axis at the start, global, shape (3,); rotation is right-handed about it,
        second side relative to first.
    tributary_length
        Length of member [m] whose elastic bending about its axis it represents; 0 if other hinges do.
    law
        Formula with source and range.
    record
        The law as a record for the solver.
    spatial
        Of a hinge with several components, or one that breaks: all of them as the spatial stepper takes them;
        `axis`, `law` and `record` are then those of its first bending axis.  None for all others.
    axes
        Its x, y and z at the start as rows, (3, 3), of a hinge that has the axes of a corner; None: those of
        its member.
    laws
        Laws about its bending axes where there are several, by axis; empty: `law` alone.
    plastic
        False of an elastic joint: a point of a member that bends elastically alone.
    flanges
        Distances of the flanges about which it folds from the axis of the member [m], by bending axis:
        tension there works against the fold.  Empty: it does not.
    """

    name: str
    member: str
    station: float
    axis: Axis
    position: Floats
    direction: Floats
    tributary_length: float
    law: HingeLaw
    record: HingeRecord
    spatial: SpatialHingeRecord | None = None
    axes: Floats | None = None
    laws: Mapping[Axis, HingeLaw] = field(default_factory=dict)
    plastic: bool = True
    flanges: Mapping[str, float] = field(default_factory=dict)

    @property
    def only_twists(self) -> bool:
        """Whether it is an elastic joint for the twist of a member of an open section."""
        return not self.plastic and self.spatial is not None and self.spatial.freedoms == (Freedom.X,)


def position_of(structure: StructureParts, place: HingePlace, record: SpatialHingeRecord | None) -> Floats:
    """Where a hinge lies at the start, global [m], shape (3,).

    On the line of its member; one of an open section that twists, and keeps its length, lies beside it, on
    the shear centre: forces through the centroid twist the member, and its twist moves the centroid aside.
    """
    frame = structure.frame_of(place.member)
    freedoms = () if record is None else record.freedoms
    position, section = frame.position(place.station), structure.section_of(place.member)
    if Freedom.X not in freedoms or Freedom.AXIAL in freedoms or is_closed(section):
        return position
    from crumple.section.wall_section import walls_of  # noqa: PLC0415  (only open sections need walls)

    y, z = walls_of(section).shear_centre
    return np.asarray(position + y * frame.y + z * frame.z)


def direction_of(structure: StructureParts, place: HingePlace) -> Floats:
    """Axis of a hinge at the start, a unit vector.

    A round section has none of its own and takes the normal of the plane of bending.
    """
    axis = structure.frame_of(place.member).axis(place.axis)
    round_tube = structure.section_of(place.member).kind == "circular_tube"
    normal = structure.normal_of(place.member) if round_tube else None
    across = np.zeros(3) if normal is None else np.array(normal)
    along = float(across @ axis)
    # the given axis determines which of the two it is, and its sense
    if abs(along) <= NEARER:
        return axis
    return across if along > 0.0 else -across
