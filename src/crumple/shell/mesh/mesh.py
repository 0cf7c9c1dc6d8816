"""Members as quadrilaterals along their mid-lines, triangles where they get coarser, joined at the nodes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from crumple.errors import InputError, Problem
from crumple.numeric.arrays import Floats, Integers
from crumple.shell.checks.refusals import refuse_sizes, refuse_waves
from crumple.shell.mesh.bays import Bays, Levels, bays_of, coarse_rings, left_out, levels_of, without_points
from crumple.shell.mesh.contour import Contour, contour_of
from crumple.shell.mesh.cut_ends import CutEnd, cut_ends_of
from crumple.shell.mesh.imperfection import offsets
from crumple.shell.mesh.joints import SHEARED_LENGTH, Joint, Kind, ends_of, joints_of, welded_joints
from crumple.shell.mesh.round_rings import with_rings_alike
from crumple.shell.mesh.stations import Sizes, Zone, stations
from crumple.shell.mesh.tees import Seam, Tee, branch_contour, seam_of, shared_nodes
from crumple.structure import Frame, Outputs, ShellSettings, Structure, member_hinge_places

MOST_ELEMENTS = 5_000_000
"""Elements of one mesh; more is a mistake in the input and would fill the memory."""
FINE_SIDES = 2.0
"""Reach of the fine mesh where none is given, over the largest side of the section: folds lie within one."""


@dataclass(frozen=True, eq=False)
class Tube:
    """Mesh of one member.

    Attributes
    ----------
    frame, contour
        Axes at the start, and the divided section.
    stations
        Of the rings along the member [m], (rings,); a mitre's slant is not counted.
    nodes
        Node of each ring and contour point, (rings, points); a coarse ring has every node twice.
    bays
        Elements, bay after bay, in points of this array.
    first_element
        Number of its first element.
    """

    frame: Frame
    contour: Contour
    stations: Floats
    nodes: Integers
    bays: Bays
    first_element: int

    @property
    def last_ring(self) -> int:
        """Number of the last ring, and of rows of elements along the member."""
        return len(self.stations) - 1

    @property
    def thickness(self) -> Floats:
        """Of its elements [m]."""
        return np.asarray(self.contour.thickness[self.bays.side])

    def ring_at(self, station: float) -> int:
        """Ring nearest to a station [m]."""
        return int(np.argmin(np.abs(self.stations - station)))

    def bay(self, ring: int) -> Integers:
        """Elements between a ring and the next, (sides,)."""
        return self.elements_between(ring, ring + 1)

    def elements_between(self, first: int, last: int) -> Integers:
        """Elements between two rings."""
        return self.first_element + np.arange(self.bays.start[first], self.bays.start[last])


@dataclass(frozen=True, eq=False)
class Mesh:
    """Nodes and elements of a structure.

    Attributes
    ----------
    position
        Nodes [m], (n, 3): those of walls, then points of ends cut back at joints, then one reference node per
        rigid body at its structure node.
    quads
        Corners, (m, 4), counter-clockwise seen from outside; a triangle repeats its third.
    tubes
        By member.
    joints
        By node.
    reference
        Reference node by node name.
    cut_ends
        What obstacles touch where members are cut back; empty without obstacles.
    """

    position: Floats
    quads: Integers
    tubes: dict[str, Tube]
    joints: dict[str, Joint]
    reference: dict[str, int]
    cut_ends: tuple[CutEnd, ...]

    @property
    def walls(self) -> int:
        """Number of nodes in walls."""
        return len(self.position) - len(self.reference) - sum(len(end.nodes) for end in self.cut_ends)

    @property
    def triangles(self) -> NDArray[np.bool_]:
        """Whether an element is a triangle, (m,)."""
        return np.asarray(self.quads[:, 2] == self.quads[:, 3])

    def end_ring(self, member: str, second: bool) -> Integers:
        """Nodes of a member's last ring at its first or second node, (points,)."""
        return np.asarray(self.tubes[member].nodes[-1 if second else 0])

    def place_of(self, element: int) -> str:
        """Where an element lies, in words."""
        for name, tube in self.tubes.items():
            own = element - tube.first_element
            if 0 <= own < tube.bays.start[-1]:
                ring = int(np.searchsorted(tube.bays.start, own, side="right")) - 1
                side = int(tube.bays.side[own])
                middle = (tube.stations[ring] + tube.stations[ring + 1]) / 2
                return f"member {name}, {1e3 * middle:.4g} mm from its first node, side {side} of the section"
        return "no member"


def clamped_nodes(mesh: Mesh) -> Integers:
    """Nodes of the sections at clamps."""
    rings = [
        mesh.end_ring(end.member, end.second)
        for joint in mesh.joints.values()
        if joint.kind is Kind.CLAMPED
        for end in joint.ends
    ]
    return np.unique(np.concatenate([np.zeros(0, dtype=np.int64), *rings]))


def mesh_of(structure: Structure, settings: ShellSettings, outputs: Outputs | None = None) -> Mesh:
    """Mesh a structure.

    Parameters
    ----------
    structure
        Sound.
    settings
        Sizes.
    outputs
        Requests for stations at which rings must lie.

    Raises
    ------
    InputError
        If a member cannot be meshed, by name.
    """
    refuse_sizes(structure, settings)
    size = settings.fine_size or settings.element_size
    contours = {name: contour_of(structure.section_of(name), size) for name in structure.members}
    contours = with_rings_alike(structure, contours, ends_of(structure))
    tees: dict[str, Tee] = {}
    if settings.t_joints == "welded":
        tees, contours = welded_joints(structure, contours, size)
    joints = joints_of(structure, contours, tees)
    rings = {
        name: _rings(structure, name, settings, joints, outputs or Outputs()) for name in structure.members
    }
    seams = {}
    for node, tee in tees.items():
        seams[node] = seam_of(structure, tee, contours[tee.before], rings)
        contours[tee.branch.member] = branch_contour(structure, tee, seams[node])
    if tees:
        # the same stations: what changed is where branches are divided
        joints = joints_of(structure, contours, tees)
    _check_number(contours, rings)
    refuse_waves(settings, contours, rings)
    welded = {name for tee in tees.values() for name in (tee.before, tee.after, tee.branch.member)}
    halved = {name: _halved(settings, contours[name], at, whole=name in welded) for name, at in rings.items()}
    parts = _Parts(contours, joints, rings, halved, seams)
    return _joined(structure, parts, imperfection=settings.imperfection, size=size)


@dataclass(frozen=True, eq=False)
class _Parts:
    """Divided sections, joints, stations of rings, their levels, and seams of welded branches."""

    contours: dict[str, Contour]
    joints: dict[str, Joint]
    rings: dict[str, Floats]
    halved: dict[str, Levels]
    seams: dict[str, Seam]


def _rings(
    structure: Structure, member: str, settings: ShellSettings, joints: dict[str, Joint], outputs: Outputs
) -> Floats:
    """Stations of one member's rings."""
    length = structure.frame_of(member).length
    cut = [_cut_of(joints, structure, member, second) for second in (False, True)]
    ends = (cut[0], length - cut[1])
    if ends[1] - ends[0] < settings.element_size / 2:
        what, came = (
            "this member has no length left between its joints",
            f"{1e3 * (ends[1] - ends[0]):.4g} mm",
        )
        todo = "make it longer, or use smaller elements"
        raise InputError(Problem(what, came, "at least one element", todo, f"members.{member}"))
    asked = [
        station
        for rotation in outputs.section_rotations.values()
        if rotation.member == member
        for station in (rotation.start, rotation.end)
    ]
    for joint in joints.values():
        asked += joint.tee.stations(member, length) if joint.tee is not None else []
    asked += [at for part in structure.members[member].rigid_parts(length) for at in part]
    fine = settings.fine_size or settings.element_size
    sizes = Sizes(settings.element_size, fine, settings.growth)
    return stations(ends, asked, _fine_zones(structure, member, settings, joints, ends), sizes)


def _halved(settings: ShellSettings, contour: Contour, at: Floats, *, whole: bool) -> Levels:
    """How often the section is divided half as finely at every ring; never in members of welded joints."""
    if whole or settings.coarse_sections == "off" or settings.fine_size is None:
        return np.zeros(len(at), dtype=np.int64)
    return coarse_rings(at, settings.fine_size, len(levels_of(contour)) - 1)


def _fine_zones(
    structure: Structure, member: str, settings: ShellSettings, joints: dict[str, Joint], ends: Zone
) -> list[Zone]:
    """Stretches with fine elements: at held and joined ends, at hinge places, and where requested."""
    if settings.fine_size is None:
        return []
    reach = settings.fine_length
    if reach is None:
        reach = FINE_SIDES * float(np.ptp(structure.section_of(member).outer_outline(), axis=0).max())
    held = {support.node for support in structure.supports.values()}
    centres = [
        end
        for node, end in zip(structure.members[member].nodes, ends, strict=True)
        if node in held or len(joints[node].ends) > 1
    ]
    centres += [place.station for place in member_hinge_places(structure, member)]
    centres += [place.at for place in settings.fine_at if place.member == member]
    return [(centre - reach, centre + reach) for centre in centres]


def _cut_of(joints: dict[str, Joint], structure: Structure, member: str, second: bool) -> float:
    joint = joints[structure.members[member].nodes[int(second)]]
    at = next(i for i, end in enumerate(joint.ends) if end.member == member and end.second == second)
    return joint.cut[at]


def _check_number(contours: dict[str, Contour], rings: dict[str, Floats]) -> None:
    number = sum(len(contours[name].sides) * (len(rings[name]) - 1) for name in rings)
    if number > MOST_ELEMENTS:
        what, todo = "the mesh has too many elements", "give a larger element_size"
        allowed = f"at most {MOST_ELEMENTS}"
        raise InputError(Problem(what, str(number), allowed, todo, "analysis.shell.element_size"))


def _joined(structure: Structure, parts: _Parts, *, imperfection: float, size: float) -> Mesh:
    """Nodes numbered member by member; a mitre's second end and a welded branch take nodes that are there."""
    contours, joints, halved = parts.contours, parts.joints, parts.halved
    positions: list[Floats] = []
    quads: list[Integers] = []
    tubes: dict[str, Tube] = {}
    count = elements = 0
    branches = {joint.tee.branch.member for joint in joints.values() if joint.tee is not None}
    for name in sorted(structure.members, key=lambda one: one in branches):
        frame, around = structure.frame_of(name), len(contours[name].points)
        numbers = np.full((len(parts.rings[name]), around), -1, dtype=np.int64)
        points = _points(structure, name, contours[name].points, parts.rings[name], joints)
        if imperfection:
            points = points + offsets(contours[name], len(points), imperfection, len(tubes)) @ frame.axes[1:]
        for second in (False, True):
            shared = _shared(structure, parts, tubes, name, second)
            if shared is not None:
                numbers[-1 if second else 0] = shared
        new = (numbers < 0) & ~left_out(contours[name], halved[name])
        numbers[new] = count + np.arange(int(new.sum()))
        count += int(new.sum())
        positions.append(points[new])
        numbers = without_points(numbers, contours[name], halved[name])
        bays = bays_of(contours[name], halved[name])
        tubes[name] = Tube(frame, contours[name], parts.rings[name], numbers, bays, elements)
        quads.append(numbers.reshape(-1)[bays.corners])
        elements += len(quads[-1])
    cut_ends: tuple[CutEnd, ...] = ()
    if structure.obstacles:
        cut_ends, points_there = cut_ends_of(structure, contours, joints, size, count)
        positions += points_there
    count += sum(len(end.nodes) for end in cut_ends)
    bodies = [node for node, joint in joints.items() if joint.is_body]
    reference = {node: count + i for i, node in enumerate(bodies)}
    positions += [np.asarray(structure.nodes[node], float)[None] for node in bodies]
    return Mesh(np.concatenate(positions), np.concatenate(quads), tubes, joints, reference, cut_ends)


def _points(structure: Structure, member: str, ring: Floats, at: Floats, joints: dict[str, Joint]) -> Floats:
    """Positions of one member's nodes [m], (rings, points, 3), slanted towards mitres."""
    frame = structure.frame_of(member)
    along = np.repeat(at[:, None], len(ring), axis=1)
    for second in (False, True):
        joint = joints[structure.members[member].nodes[int(second)]]
        if joint.kind not in (Kind.MITRED, Kind.WELDED):
            continue
        which = next(i for i, end in enumerate(joint.ends) if end.member == member and end.second == second)
        slant = joint.slant[which]
        distance = at[-1] - at if second else at - at[0]
        reach = max(SHEARED_LENGTH * float(np.abs(slant).max()), 1e-12)
        fade = np.maximum(1.0 - distance / reach, 0.0)[:, None]
        along = along + (-fade * slant if second else fade * slant)
    points: Floats = frame.origin + along[..., None] * frame.x + (ring @ frame.axes[1:])[None]
    return points


def _shared(
    structure: Structure, parts: _Parts, tubes: dict[str, Tube], member: str, second: bool
) -> Integers | None:
    """Nodes of an end that another member's mesh has made already; None: its own."""
    joint = parts.joints[structure.members[member].nodes[int(second)]]
    if joint.kind not in (Kind.MITRED, Kind.WELDED):
        return None
    mine = next(i for i, end in enumerate(joint.ends) if end.member == member and end.second == second)
    if mine == 2:
        return shared_nodes(parts.seams[joint.node], {name: tube.nodes for name, tube in tubes.items()})
    other = joint.ends[1 - mine]
    if other.member not in tubes:
        return None
    ring = tubes[other.member].nodes[-1 if other.second else 0]
    # match gives the first end's point of each of the second's
    order = joint.match if mine == 1 else np.argsort(joint.match)
    return np.asarray(ring[order])
