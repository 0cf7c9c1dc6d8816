"""Elastic flexibility that each hinge of a bar represents, axis by axis, and the bar's elastic joints."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Literal, get_args

from crumple.errors import InputError
from crumple.hinge.measured.library import is_of_joint
from crumple.hinge.torsion.warping import HeldEnds
from crumple.section import Axis, half_fold_length
from crumple.structure.hinges.corner.across import ACROSS
from crumple.structure.hinges.corner_laws import MITRED, corner_laws, corner_name, turned_corner
from crumple.structure.hinges.corners import corners
from crumple.structure.hinges.elastic_members import joint_stations, segments_of, shear_stretch
from crumple.structure.hinges.flexibility import flexibility, tributary_lengths
from crumple.structure.hinges.joint_reach import joint_reach
from crumple.structure.hinges.places import HingePlace, law_of, law_spec, member_hinge_places
from crumple.structure.hinges.runs.bars import is_closed, rigid_along, welded_to_another
from crumple.structure.hinges.runs.ends import SAME_DIRECTION
from crumple.structure.hinges.runs.straight_runs import StraightRun
from crumple.structure.keys.motion import FREEDOMS
from crumple.structure.parts import StructureParts

Spring = Literal["none", "given", "auto"]
"""Whether a hinge bends elastically about an axis, and whether by a stiffness of its own or the member's."""
AXES: tuple[Axis, ...] = get_args(Axis)
SAME_PLACE = 1e-2 / 6.0
"""Distance of joints about two axes that are one, over the length of their bar: a hundredth of a segment
of the six of an elastic one. Its bending about the second axis is wrong by about such a share."""


@dataclass(frozen=True)
class HingeShares:
    """Lengths of a bar [m] that a hinge stands for.

    Attributes
    ----------
    bending
        In elastic bending, by axis.
    axial, twist
        In elastic lengthening, and in elastic twist.
    stretch
        Of the law of axial folding: the part of the bar that folds.  Of a hinge that shortens the whole
        bar, else what is nearer to it than to the others.
    twisted
        Of the law of twist: one fold where joints twist besides, else as `stretch`.
    span, held_ends
        Length of the bar that twists, and which of its ends cannot warp.
    """

    bending: Mapping[Axis, float] = field(default_factory=dict)
    axial: float = 1.0
    twist: float = 1.0
    stretch: float = 1.0
    twisted: float = 1.0
    span: float = 1.0
    held_ends: HeldEnds = "both"


@dataclass(frozen=True)
class AxisShares:
    """How the hinges of a bar share its bending about one axis.

    Attributes
    ----------
    lengths
        By hinge [m]; one that takes no part has none.
    joints
        Distance from the bar's start and length [m] of the elastic joints that it needs in addition.
    elastic
        Whether the model has these joints: whether a hinge takes its stiffness from the bar.
    rigid
        Whether no hinge is elastic about the axis; lengths and joints are then those that the elastic form
        would have.
    free
        Whether the bar's first and last end carry no moment about the axis.
    """

    lengths: Mapping[str, float]
    joints: tuple[tuple[float, float], ...]
    elastic: bool
    rigid: bool
    free: tuple[bool, bool] = (False, False)


def bar_shares(
    structure: StructureParts, bar: StraightRun, free: Callable[[Axis], tuple[bool, bool]]
) -> tuple[dict[str, HingeShares], dict[Axis, AxisShares]]:
    """Shares of each hinge of a bar by name, and those about each bending axis.

    Parameters
    ----------
    structure
        Its members and laws.
    bar
        As of `bar_of`.
    free
        Whether the bar's first and second end carry no moment about an axis.
    """
    places, length, rigid = places_along(structure, bar), bar.length, rigid_along(structure, bar)
    name = bar.first
    about = {axis: _about(structure, bar, places, axis, (rigid, free)) for axis in AXES}
    found = {axis: shares for axis, shares in about.items() if shares is not None}

    def along(takes_part: Callable[[HingePlace], bool]) -> dict[str, float]:
        own = [place for place in places if takes_part(place)]
        if not own:
            return {}
        lengths = tributary_lengths([place.station for place in own], length, rigid)
        return {place.name: share for place, share in zip(own, lengths, strict=True)}

    axial = along(lambda place: place.keys.axial is not None)
    # the hinge of a corner lies at a node, where loads and obstacles act on either side of it
    at_nodes = {corner_name(node) for node in bar.nodes if node in corner_laws(structure)} if axial else ()
    inside = along(lambda place: place.name in axial and place.name not in at_nodes) if at_nodes else None
    if inside:
        axial = dict.fromkeys(axial, _fold(structure, name)) | inside
    # the hinge of a corner has part of the twist of a rigid member; elastic ones twist on their own
    rigid_member = not segments_of(structure, bar)
    twist = along(
        lambda place: _twists(structure, place) or (rigid_member and "x" in (place.keys.axes or ()))
    )
    between = joint_twists(structure, bar, [at for at, _ in joint_lengths(found, SAME_PLACE * length)])
    if twist and between:
        twist = _beside(twist, places, between, (length, rigid))
    nearest = along(lambda place: True) if len(places) != 1 else {places[0].name: length}
    # folds along the axis begin at the weakest hinge and go on next to each other up to the joints
    nearest |= dict.fromkeys(axial, _between_joints(structure, bar, rigid) if axial else 0.0)
    twisted = nearest
    if between:
        twisted = {hinge: min(stretch, _fold(structure, name)) for hinge, stretch in nearest.items()}
    whole: tuple[float, HeldEnds] = warping_span(structure, bar) if twist else (length, "both")
    return {
        place.name: HingeShares(
            {
                axis: shares.lengths[place.name]
                for axis, shares in found.items()
                if place.name in shares.lengths
            },
            axial.get(place.name, 1.0),
            twist.get(place.name, 1.0),
            nearest[place.name],
            twisted[place.name],
            *whole,
        )
        for place in places
    }, found


def places_along(structure: StructureParts, bar: StraightRun) -> list[HingePlace]:
    """Hinges of a bar, along it; their stations count from its start."""
    if not bar.between:
        return member_hinge_places(structure, bar.first)
    found = [
        replace(place, station=stretch.along(place.station))
        for name, stretch in bar.stretches.items()
        for place in member_hinge_places(structure, name)
    ]
    return sorted(found, key=lambda place: place.station)


def _fold(structure: StructureParts, name: str) -> float:
    """Length of the longest bending fold of a member [m]."""
    return 2.0 * max(half_fold_length(structure.section_of(name), axis) for axis in AXES)


def _between_joints(
    structure: StructureParts, bar: StraightRun, rigid: tuple[tuple[float, float], ...]
) -> float:
    """Length of a bar [m] that is neither in the rigid joints at its ends nor rigid by itself."""
    first, last = between_joints(structure, bar)
    return last - first - sum(max(0.0, min(b, last) - max(a, first)) for a, b in rigid)


def between_joints(structure: StructureParts, bar: StraightRun) -> tuple[float, float]:
    """Ends of what lies between the rigid joints at the ends of a bar [m]."""
    first, last = (joint_reach(structure, *end) for end in bar.ends)
    return first, bar.length - last


def twists_as_one(structure: StructureParts, bar: StraightRun) -> bool:
    """Whether an elastic bar of an open section has a joint for its twist, besides hinges that only bend.

    Its twist goes with warping, which is a matter of all of its length: a hinge that bends at one end must
    not take it all, as it would on the interaction of its section.
    """
    if not segments_of(structure, bar):
        return False
    keys = [place.keys for place in places_along(structure, bar)]
    several = any(one.axes for one in keys) and not any("x" in (one.axes or ()) for one in keys)
    if not several or is_closed(structure.section_of(bar.first)):
        return False
    return not any(welded_to_another(structure, name) for name in bar.stretches)


def warping_span(structure: StructureParts, bar: StraightRun) -> tuple[float, HeldEnds]:
    """Length of a bar that twists [m], and which of its ends cannot warp: where anything else is at the node.

    In shells such a node holds all walls of the end as one rigid body.
    """
    held = [node in structure.loaded_nodes or len(structure.members_at[node]) > 1 for node in bar.nodes]
    span = bar.length - sum(b - a for a, b in rigid_along(structure, bar))
    ends: tuple[HeldEnds, ...] = ("none", "one", "both")
    return span, ends[sum(held)]


def _beside(
    own: dict[str, float],
    places: Sequence[HingePlace],
    joints: Mapping[float, float],
    bar: tuple[float, tuple[tuple[float, float], ...]],
) -> dict[str, float]:
    """Lengths of the hinges that twist beside joints that do."""
    stations = [place.station for place in places if place.name in own]
    points = sorted([*stations, *joints])
    lengths = dict(zip(points, tributary_lengths(points, *bar), strict=True))
    return {name: lengths[at] for name, at in zip(own, stations, strict=True)}


def _twists(structure: StructureParts, place: HingePlace) -> bool:
    """Whether a hinge turns about the axis of its member; that of a corner turns about its tangent."""
    axes = place.keys.axes or ()
    return "x" in axes and turned_corner(structure, place.name, axes) is None


def joint_twists(structure: StructureParts, bar: StraightRun, joints: Sequence[float]) -> dict[float, float]:
    """Length of a bar [m] that each of its joints stands for in twist, by their distance from its start [m].

    An elastic bar whose hinges twist, or would but for corners at its ends, twists at every joint if its
    metal hardens, since its walls then yield over a length.  Else it twists at its hinges, or, if none of
    these does, at the joint nearest its middle; of two that are equally near, at the first.
    """
    if not joints or not segments_of(structure, bar):
        return {}
    own = [place.station for place in places_along(structure, bar) if _twists(structure, place)]
    if not own and not _between_corners(structure, bar):
        return {}
    length, rigid = bar.length, rigid_along(structure, bar)
    if structure.material_of(bar.first).hardening is not None:
        points = sorted([*own, *joints])
        lengths = dict(zip(points, tributary_lengths(points, length, rigid), strict=True))
        return {at: lengths[at] for at in joints}
    # two may be equally near but for rounding: then the first
    middle = min(joints, key=lambda at: (round(abs(at / length - 0.5), 9), at))
    return {} if own else {middle: length - sum(b - a for a, b in rigid)}


def _between_corners(structure: StructureParts, bar: StraightRun) -> bool:
    """Whether an end of a bar is a corner whose hinge twists about its tangent."""
    known = corners(structure)
    ends = [known[node] for node in bar.nodes if node in known]
    hosts = [place for end in ends for place in member_hinge_places(structure, end.first)]
    return any("x" in (place.keys.axes or ()) and not _twists(structure, place) for place in hosts)


def joint_lengths(about: dict[Axis, AxisShares], near: float) -> list[tuple[float, dict[Axis, float]]]:
    """Places of joints along a bar, with the length that each stands for about its axes [m].

    Joints about two axes that are nearer to each other than `near` are one, at the first: a body between
    them would have no mass to speak of.
    """
    along = sorted(
        (station, axis, length)
        for axis, shares in about.items()
        if shares.elastic
        for station, length in shares.joints
    )
    found: list[tuple[float, dict[Axis, float]]] = []
    for station, axis, length in along:
        if found and station - found[-1][0] < near and axis not in found[-1][1]:
            found[-1][1][axis] = length
        else:
            found.append((station, {axis: length}))
    return found


def axes_of(place: HingePlace) -> tuple[Axis, ...]:
    """Bending axes of a hinge."""
    return place.keys.bending or (place.axis,)


def about_axis(place: HingePlace, axis: Axis) -> HingePlace:
    """The hinge with the law of one of its bending axes."""
    return place if axis == place.axis else replace(place, axis=axis, law=place.keys.law_about(axis))


def _about(
    structure: StructureParts,
    bar: StraightRun,
    places: Sequence[HingePlace],
    axis: Axis,
    ends: tuple[tuple[tuple[float, float], ...], Callable[[Axis], tuple[bool, bool]]],
) -> AxisShares | None:
    """Shares about an axis: of elastic hinges and the bar's joints, or of all where none is elastic."""
    # the spring of a corner adds to the flexibility of the members
    about = [place for place in places if axis in axes_of(place)]
    bent = segments_of(structure, bar) > 0
    if not bent and not about:
        return None
    own = [place for place in about if not _of_corner(structure, place, axis)]
    between: tuple[float, ...] = ()
    if bent:
        others = tuple([place.station for place in places if axis not in axes_of(place)])
        between = joint_stations(structure, bar, axis, tuple([place.station for place in own]), others)
    if not own and not between:
        return None
    seen: dict[int, Spring] = {}
    springs: list[Spring] = []
    for place in own:
        # the hinges between the equal bars of a member have one and the same keys
        if id(place.keys) not in seen:
            seen[id(place.keys)] = _spring(structure, about_axis(place, axis))
        springs.append(seen[id(place.keys)])
    elastic = [place for place, spring in zip(own, springs, strict=True) if spring != "none"]
    points = elastic or own
    together = sorted([*((place.station, place.name) for place in points), *((at, "") for at in between)])
    rigid, free = ends
    shear = shear_stretch(structure, bar, axis) if bent else 0.0
    stations = tuple([at for at, _ in together])
    shared = flexibility(stations, bar.length, rigid, free(axis), shear)
    found = list(zip(together, shared.lengths, strict=True))
    lengths = {name: length for (_, name), length in found if name}
    joints = (*((at, length) for (at, name), length in found if not name), *shared.joints)
    bends, no_spring = "auto" in springs or bool(between), not elastic and not between
    return AxisShares(lengths, joints, bends, no_spring, free(axis))


def _of_corner(structure: StructureParts, place: HingePlace, axis: Axis) -> bool:
    about = about_axis(place, axis)
    try:
        spec = law_spec(structure, about)
        if spec.type in (MITRED, ACROSS):
            return True
        return spec.type == "file" and is_of_joint(law_of(structure, about))
    except InputError:
        # reported when the hinge is built
        return False


def _spring(structure: StructureParts, place: HingePlace) -> Spring:
    try:
        spec = law_spec(structure, place)
        if spec.form != "elastic-plastic":
            return "none"
        own = spec.elastic_stiffness != "auto" or law_of(structure, place).elastic_stiffness is not None
    except InputError:
        # reported when the hinge is built
        return "none"
    return "given" if own else "auto"


def moment_free_ends(structure: StructureParts) -> Callable[[str, Axis], tuple[bool, bool]]:
    """For a member and an axis: whether its first and second end carry no bending moment about it.

    An end is free where no other member is joined rigidly, no support holds or drives the rotation, and no
    rotary inertia and no moment acts, or where a spherical joint is.  A member that spot welds join to
    another counts as free at both ends: its end moments are not known, and its parts cannot move relative to
    each other.
    """
    freed = {(joint.member, joint.node) for joint in structure.joints.values() if joint.type == "spherical"}
    joined = Counter(
        node for name, spec in structure.members.items() for node in spec.nodes if (name, node) not in freed
    )
    bent = {mass.node for mass in structure.masses.values() if any(mass.rotary_inertia) or any(mass.offset)}
    bent |= {
        load.node for load in structure.loads if any(getattr(load.moment, axis) is not None for axis in "xyz")
    }
    bent |= {impulse.node for impulse in structure.impulses if any(impulse.angular_impulse)}
    welded = {
        name for welds in structure.spot_welds.values() if len(welds.members) == 2 for name in welds.members
    }

    def turns(node: str, member: str, axis: Axis) -> bool:
        supports = structure.supports_at.get(node)
        if not supports:
            return True
        about = structure.frame_of(member).axis(axis)
        held = {freedom for _, support in supports for freedom in (*support.held, *support.driven)}
        turned = [i for i, freedom in enumerate(FREEDOMS[3:]) if freedom in held]
        return not any(abs(float(about[i])) > SAME_DIRECTION for i in turned)

    def free(member: str, axis: Axis) -> tuple[bool, bool]:
        first, second = (
            member in welded
            or (member, node) in freed
            or (joined[node] == 1 and node not in bent and turns(node, member, axis))
            for node in structure.members[member].nodes
        )
        return first, second

    return free
