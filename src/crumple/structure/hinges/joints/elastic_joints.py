"""Joints of a bar besides its hinges: points at which it bends, twists and yields."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import pairwise

from crumple import hinge
from crumple.hinge import ConstantLaw, Coupling, Form, Freedom, HingeComponent, HingeRecord
from crumple.section import Axis, half_fold_length
from crumple.structure.hinges.corner_laws import corner_laws, corner_name
from crumple.structure.hinges.elastic_members import yielding_record
from crumple.structure.hinges.joints.placed_hinge import PlacedHinge, direction_of, position_of
from crumple.structure.hinges.joints.twisting_stretches import twisting_stretches
from crumple.structure.hinges.places import HingePlace, member_hinge_places
from crumple.structure.hinges.runs.bars import rigid_along
from crumple.structure.hinges.runs.straight_runs import StraightRun
from crumple.structure.hinges.shares import (
    SAME_PLACE,
    AxisShares,
    HingeShares,
    axes_of,
    between_joints,
    joint_lengths,
    joint_twists,
    twists_as_one,
    warping_span,
)
from crumple.structure.hinges.spatial_hinges import BENDING, beside_shear, twist_component
from crumple.structure.parts import StructureParts

FIRM = 100.0
"""Capacity of an elastic joint over the largest capacity of its bar's hinges: no impact reaches it, and
tolerances relative to the largest capacity stay small."""
NEARLY = 0.7
"""Cosine between a section axis and a corner's normal from which the member bends about this axis there."""


def elastic_joints(
    structure: StructureParts, bar: StraightRun, own: list[PlacedHinge], about: dict[Axis, AxisShares]
) -> list[PlacedHinge]:
    """Joints of a bar besides its hinges: points at which it bends and twists elastically.

    Those of an elastic bar yield as its section does; the others have no plastic law.

    Parameters
    ----------
    structure, bar
        As of `bar_of`.
    own, about
        Hinges of its members, and how these share its bending.
    """
    lengths = joint_lengths(about, SAME_PLACE * bar.length)
    if not lengths:
        return []
    twisted = joint_twists(structure, bar, [along for along, _ in lengths])
    by_member: dict[str, list[tuple[float, dict[Axis, float]]]] = defaultdict(list)
    for along, by_axis in lengths:
        by_member[bar.member_at(along)].append((along, by_axis))
    beside = _Beside(
        structure,
        bar,
        own,
        {axis: shares.free for axis, shares in about.items()},
        {axis: [along for along, by_axis in lengths if axis in by_axis] for axis in about},
    )
    found = []
    for member, joints in by_member.items():
        stretch = bar.stretches[member]
        for i, (along, by_axis) in enumerate(joints if stretch.forward else joints[::-1], 1):
            # no name of the input has a blank
            name = f"{member} elastic" if len(joints) == 1 else f"{member} elastic {i}"
            records = {axis: beside.record(axis, along, length) for axis, length in sorted(by_axis.items())}
            components = [HingeComponent(BENDING[axis], record) for axis, record in records.items()]
            if along in twisted:
                components.append(beside.twist(along, twisted[along], records))
            place = HingePlace(name, member, stretch.station(along), min(records), None, f"members.{member}")
            found.append(_placed(structure, place, components, by_axis[place.axis]))
    if twists_as_one(structure, bar):
        hinges = (bar.stretches[one.member].along(one.station) for one in own)
        found.extend(beside.twist_of_all(sorted([*(along for along, _ in lengths), *hinges])))
    return found


def _placed(
    structure: StructureParts, place: HingePlace, components: list[HingeComponent], length: float
) -> PlacedHinge:
    coupling = Coupling.ELLIPSOID if structure.members[place.member].elastic else Coupling.NONE
    record = components[0].record
    several = len(components) > 1 or components[0].freedom is Freedom.X
    spatial = hinge.spatial_record(components, coupling=coupling) if several else None
    if spatial is not None and coupling is Coupling.ELLIPSOID:
        metal = structure.section_of(place.member), structure.material_of(place.member)
        spatial = beside_shear(spatial, *metal)
    return PlacedHinge(
        name=place.name,
        member=place.member,
        station=place.station,
        axis=place.axis,
        position=position_of(structure, place, spatial),
        direction=direction_of(structure, place),
        tributary_length=length,
        law=ConstantLaw(float(record.positive.moment.max())),
        record=record,
        spatial=spatial,
        plastic=False,
    )


@dataclass(frozen=True)
class _Beside:
    """A bar and its hinges, beside which its joints lie; which of its ends carry no moment, by axis."""

    structure: StructureParts
    bar: StraightRun
    own: list[PlacedHinge]
    free: Mapping[Axis, tuple[bool, bool]]
    joints: Mapping[Axis, list[float]]

    def twist(self, along: float, length: float, bending: dict[Axis, HingeRecord]) -> HingeComponent:
        """Twist of a joint that stands for a length of the bar [m]: it yields as it bends."""
        metal = self.structure.section_of(self.bar.first), self.structure.material_of(self.bar.first)
        firm = any(self._beyond_a_fold(axis, along) for axis in bending)
        first = next(iter(bending.values()))
        shares = HingeShares({}, 1.0, length, length, length, *warping_span(self.structure, self.bar))
        return twist_component(first, metal, shares, firm=FIRM if firm else 1.0)

    def twist_of_all(self, points: list[float]) -> Iterator[PlacedHinge]:
        """Joints that only twist, of a bar of an open section; each has its part of the length of the bar.

        They lie in the middle of its stretches and at its ends, between the points at which it bends [m].
        """
        structure, bar = self.structure, self.bar
        gaps = [(a + b) / 2.0 for a, b in pairwise(points) if b - a > SAME_PLACE * bar.length]
        metal = structure.section_of(bar.first), structure.material_of(bar.first)
        like = yielding_record(structure, bar.first, "y", bar.length, bar.length)
        found = []
        for stretch in twisting_stretches(structure, bar, gaps):
            inside = [at for at in gaps if stretch.start < at < stretch.end]
            middle = 0.5 * (stretch.start + stretch.end)
            # two may be equally near but for rounding: then the first
            nearest = min(inside, key=lambda at: (round(abs(at - middle) / bar.length, 9), at))
            places = sorted({nearest, *({gaps[0], gaps[-1]} & set(inside))})
            found += [(at, length, stretch) for at, length in stretch.shared(places)]
        for i, (along, length, stretch) in enumerate(found, 1):
            shares = HingeShares({}, 1.0, length, length, length, stretch.span, stretch.held_ends)
            twist = twist_component(like, metal, shares)
            member = bar.member_at(along)
            station = bar.stretches[member].station(along)
            # no name of the input has a blank
            place = HingePlace(f"{member} twist {i}", member, station, "y", None, f"members.{member}")
            yield _placed(structure, place, [twist], 0.0)

    def record(self, axis: Axis, along: float, length: float) -> HingeRecord:
        """Record of a joint that stands for a length of the bar [m].

        One between an end that carries a moment and the fold there, or in a rigid joint, does not yield: the
        hinge stands for the fold of all that lies beyond it. Nor does one whose walls are all in a fold.
        Walls that yielded there without folding would carry its largest moment whatever the rotation.
        """
        elastic = self.structure.members[self.bar.first].elastic
        yields = self._yields(axis, along) if elastic and not self._beyond_a_fold(axis, along) else 0.0
        if yields > 0.0:
            return yielding_record(self.structure, self.bar.first, axis, length, yields)
        strongest = max(
            (float(curve.moment.max()) for h in self.own for curve in (h.record.positive, h.record.negative)),
            default=float(
                yielding_record(self.structure, self.bar.first, axis, length, length).positive.moment.max()
            ),
        )
        stiffness = self.structure.flexural_rigidity(self.bar.first, axis) / length
        law = ConstantLaw(FIRM * strongest)
        return hinge.record_of(law, form=Form.ELASTIC_PLASTIC, elastic_stiffness=stiffness)

    def _yields(self, axis: Axis, along: float) -> float:
        """Length that yields at a joint [m]: half way to the joints beside it, without what is in folds."""
        folds, joints = self._folded(axis), self.joints[axis]
        first, last = between_joints(self.structure, self.bar)
        low = max([first, *(end for start, end in folds if start + end <= 2.0 * along)])
        high = min([last, *(start for start, end in folds if start + end > 2.0 * along)])
        for other in joints:
            between = sorted((other, along))
            if other != along and not any(2.0 * between[0] < a + b <= 2.0 * between[1] for a, b in folds):
                half = (other + along) / 2.0
                low, high = (max(low, half), high) if other < along else (low, min(high, half))
        rigid = rigid_along(self.structure, self.bar)
        return high - low - sum(max(0.0, min(b, high) - max(a, low)) for a, b in rigid)

    def _folded(self, axis: Axis) -> list[tuple[float, float]]:
        """Stretches of the bar whose plastic bending is part of the rotation of a fold [m].

        Two half folds, beside a clamp or joint from there on; at a corner one side of the section.
        """
        section = self.structure.section_of(self.bar.first)
        half, side = half_fold_length(section, axis), section.bending_depth(axis)
        first, last = between_joints(self.structure, self.bar)
        corners = self._folds_at_corners(axis)
        found = [(at - side, at + side) for at in corners]
        for fold in self.own:
            at = self.bar.stretches[fold.member].along(fold.station)
            if not _bends_about(fold, axis):
                continue
            if at in (0.0, self.bar.length):
                found.append((at - side, at + side))
            elif at - first < 2.0 * half:
                found.append((first, first + 2.0 * half))
            elif last - at < 2.0 * half:
                found.append((last - 2.0 * half, last))
            else:
                found.append((at - half, at + half))
        return found

    def _beyond_a_fold(self, axis: Axis, along: float) -> bool:
        """Whether a place lies in a rigid joint, or between an end and a hinge less than one fold away.

        Towards an end without a moment the moment falls, and walls yield less than at the hinge.  The hinge
        of a corner counts in both of its members.  Of a bar without hinges no place does: nothing else stands
        for its folds.
        """
        at_corners = self._folds_at_corners(axis)
        if not self.own and not at_corners:
            return False
        first, last = between_joints(self.structure, self.bar)
        if not first < along < last and (first > 0.0 or last < self.bar.length):
            return True
        own = (
            self.bar.stretches[hinge.member].along(hinge.station)
            for hinge in self.own
            if _bends_about(hinge, axis)
        )
        folds = [*own, *at_corners]
        if not folds or min(folds) <= along <= max(folds):
            return False
        after = along > max(folds)
        if self.free[axis][after]:
            return False
        nearest = max(folds) if after else min(folds)
        fold = 2.0 * half_fold_length(self.structure.section_of(self.bar.first), axis)
        return abs(along - nearest) <= fold

    def _folds_at_corners(self, axis: Axis) -> list[float]:
        """Places of the corners at the ends of the bar whose hinges are in the other member [m]."""
        found = []
        for (member, node), along in zip(self.bar.ends, (0.0, self.bar.length), strict=True):
            known = corner_laws(self.structure).get(node)
            if known is None or known[0].first == member:
                continue
            corner, _ = known
            places = member_hinge_places(self.structure, corner.first)
            several = any(place.name == corner_name(node) and len(axes_of(place)) > 1 for place in places)
            frame = self.structure.frame_of(member)
            across = frame.y if axis == "y" else frame.z
            if several or abs(float(across @ corner.normal)) > NEARLY:
                found.append(along)
        return found


def _bends_about(hinge: PlacedHinge, axis: Axis) -> bool:
    if hinge.spatial is None:
        return hinge.axis == axis
    return any(component.freedom is BENDING[axis] for component in hinge.spatial.components)
