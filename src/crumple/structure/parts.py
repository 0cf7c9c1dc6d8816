"""The parts of a structure, each valid by itself, and what follows from them: what checks and hinges see."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence, Set
from contextlib import suppress
from functools import cached_property
from typing import Self, TypeVar

import numpy as np
from pydantic import BaseModel

from crumple.material import Material
from crumple.numeric.arrays import Floats
from crumple.registry.quantity import Acceleration, Position
from crumple.section import Axis, Section
from crumple.structure.geometry import Frame, are_level, frame_of, levelled, plane_normal
from crumple.structure.keys.joint import Joint
from crumple.structure.keys.law import LawKeys
from crumple.structure.keys.load import Load, Mass, NodalImpulse
from crumple.structure.keys.material import MaterialSpec
from crumple.structure.keys.member import Member, OnlyAutomatic
from crumple.structure.keys.motion import InitialVelocity, Support
from crumple.structure.keys.obstacles import MemberContact, ObstacleSpec
from crumple.structure.keys.section import SectionSpec
from crumple.structure.keys.spot_welds import SpotWelds
from crumple.structure.remembered import Kept
from crumple.structure.schema.mapping import FrozenMapping
from crumple.structure.schema.spec import Named, Spec
from crumple.structure.settings.stored_laws import LawsOrFolder

Part = TypeVar("Part")
Normal = tuple[float, float, float]

OF_ANY_STIFFNESS = frozenset({
    "section", "material", "rigidity", "shear area", "planar", "corners", "untreated corners", "T-joints",
    "framework", "held runs", "braced", "joint reach", "strikes joint", "struck places", "sound members",
})  # fmt: skip
"""Kinds of derived data that are the same whether members are rigid or elastic."""


def _by_node(parts: Iterable[tuple[str, Part]]) -> dict[str, list[Part]]:
    """Parts by the node at which each is."""
    found: dict[str, list[Part]] = {}
    for node, part in parts:
        found.setdefault(node, []).append(part)
    return found


def connected(members: Mapping[str, Sequence[str]]) -> list[list[str]]:
    """Members, given with their nodes and welds, in groups that share some."""
    groups: dict[str, list[str]] = {}
    at: dict[str, str] = {}
    for name, nodes in members.items():
        groups[name] = [name]
        for node in nodes:
            first = at.setdefault(node, name)
            if first != name and groups[first] is not groups[name]:
                groups[first].extend(groups[name])
                groups |= dict.fromkeys(groups[name], groups[first])
    return list({id(group): group for group in groups.values()}.values())


class StructureParts(Spec):
    """Nodes joined by members, held by supports, loaded by masses and motion; not yet checked as a whole.

    Every part is plain data in SI; ``section``, ``material`` and ``frame`` give what follows from it.
    """

    materials: Named[MaterialSpec] = FrozenMapping()
    """Materials by name."""
    sections: Named[SectionSpec] = FrozenMapping()
    """Cross-sections by name."""
    nodes: Named[Position] = FrozenMapping()
    """Positions by node name."""
    members: Named[Member] = FrozenMapping()
    """Members by name."""
    joints: Named[Joint] = FrozenMapping()
    """Joints between members' ends and their nodes, by name; every other end is joined rigidly."""
    spot_welds: Named[SpotWelds] = FrozenMapping()
    """Spot welds of members with members, or along the weld lines of members' own sections, by name."""
    hinges: OnlyAutomatic | None = None
    """`auto`: candidate hinges, wherever a fold can form, in every member that has no hinges of its own."""
    hinge_laws: Named[LawKeys] = FrozenMapping()
    """Hinge laws by name."""
    laws: LawsOrFolder | None = None
    """Store of laws from shells, a folder or a file: hinges without a law use those of their section and
    material, and mitred corners their own."""
    supports: Named[Support] = FrozenMapping()
    """Supports by name."""
    masses: Named[Mass] = FrozenMapping()
    """Lumped masses by name."""
    initial_velocity: tuple[InitialVelocity, ...] = ()
    """Velocity fields at the start; they add up."""
    impulses: tuple[NodalImpulse, ...] = ()
    """Impulses at the start."""
    loads: tuple[Load, ...] = ()
    """Forces and moments."""
    gravity: tuple[Acceleration, Acceleration, Acceleration] = (0.0, 0.0, 0.0)
    """Acceleration of free fall."""
    obstacles: Named[ObstacleSpec] = FrozenMapping()
    """What the structure can hit, by name."""
    member_contact: MemberContact | None = None
    """Contact of members with members that share no node; without it they pass through each other in the
    multibody model, while shells have `analysis.shell.self_contact`."""

    def with_elastic(self, members: Mapping[str, Member]) -> Self:
        """Copy with members that differ in nothing but in `elastic`, checked like any other part."""
        # pydantic's own copy, with what was worked out of nodes and supports
        changed = BaseModel.model_copy(self, update={"members": FrozenMapping(members)})
        # a cached property: as if the copy itself had been asked
        changed.__dict__["kept"] = self.kept.shared(OF_ANY_STIFFNESS)
        return changed

    def section_of(self, member: str) -> Section:
        """Cross-section of a member."""
        name = self.members[member].section
        return self.kept.once("section", name, lambda: self.sections[name].section(self.materials))

    def material_of(self, member: str) -> Material:
        """Material of a member."""
        name = self.members[member].material
        return self.kept.once("material", name, lambda: self.materials[name].material(name))

    def flexural_rigidity(self, member: str, axis: Axis) -> float:
        """Bending stiffness E I of a member about a section axis [N m^2], walls of other metals by theirs."""
        spec = self.members[member]
        made_of = (spec.section, spec.material, axis)
        return self.kept.once("rigidity", made_of, lambda: self._flexural_rigidity(member, axis))

    def _flexural_rigidity(self, member: str, axis: Axis) -> float:
        section, material = self.section_of(member), self.material_of(member)
        if any(wall.material is not None for wall in getattr(section, "walls", ())):
            from crumple.section import walls_of  # noqa: PLC0415  (tubes need none of it)

            angle = 0.0 if axis == "y" else math.pi / 2.0
            return material.youngs_modulus * walls_of(section).transformed(material).second_moment(angle)
        return material.youngs_modulus * section.second_moment(axis)

    def has_line(self, member: str) -> bool:
        """Whether a member's nodes exist and its axes are defined; always so in a sound structure."""
        if member not in self.members or not all(node in self.nodes for node in self.members[member].nodes):
            return False
        if member in self.kept.frames:
            return True
        try:
            self.frame_of(member)
        except ValueError:
            return False
        return True

    def is_whole(self, member: str) -> bool:
        """Whether a member's line, section and metals are there; always so in a sound structure."""
        if not self.has_line(member) or self.members[member].section not in self.sections:
            return False
        spec = self.members[member]
        metals = (spec.material, *self.sections[spec.section].named_materials().values())
        return all(metal in self.materials for metal in metals)

    def frame_of(self, member: str) -> Frame:
        """Origin, axes and length of a member at the start.

        Members of a structure in a plane lie in it exactly, however their coordinates are rounded: hinges
        whose axes were not quite parallel would lock a closed loop.
        """
        frames = self.kept.frames
        found: Frame | None = frames.get(member)
        if found is None:
            level = self.kept.once("level", "", self._is_level)
            found = frames.get(member) or self._own_frame_of(member)
            if not level:
                section = self.sections.get(self.members[member].section)
                is_round = section is not None and section.type == "circular_tube"
                found = levelled(found, np.array(self.bending_normal), is_round=is_round)
            frames[member] = found
        return found

    def _is_level(self) -> bool:
        """Whether the members' own axes, which are kept then, are those of a plane, or not nearly so."""
        normal = self.bending_normal
        if normal is None:
            return True
        own = {}
        for member, spec in self.members.items():
            if spec.section in self.sections and all(node in self.nodes for node in spec.nodes):
                with suppress(ValueError):
                    own[member] = self._own_frame_of(member)
        level = are_level(list(own.values()), np.array(normal))
        self.kept.frames.update(own if level else {})
        return level

    def _own_frame_of(self, member: str) -> Frame:
        spec = self.members[member]
        first, second = (self.nodes[name] for name in spec.nodes)
        return frame_of(first, second, up=spec.up, roll=spec.roll)

    @cached_property
    def kept(self) -> Kept:
        """Derived data that was computed before."""
        return Kept()

    @cached_property
    def supports_at(self) -> dict[str, list[tuple[str, Support]]]:
        """Supports and their names by their node."""
        return _by_node((support.node, (name, support)) for name, support in self.supports.items())

    @cached_property
    def masses_at(self) -> dict[str, list[Mass]]:
        """Lumped masses by their node."""
        return _by_node((mass.node, mass) for mass in self.masses.values())

    @cached_property
    def loaded_nodes(self) -> frozenset[str]:
        """Nodes that carry a mass, are supported, or take a load or an impulse.

        A section of members that ends there is held together by what acts on it: rigid, in shells and in
        multibody models.
        """
        acting = (self.masses.values(), self.supports.values(), self.loads, self.impulses)
        return frozenset(part.node for parts in acting for part in parts)

    @cached_property
    def joints_at(self) -> dict[str, list[Joint]]:
        """Joints by their node."""
        return _by_node((joint.node, joint) for joint in self.joints.values())

    @cached_property
    def members_at(self) -> dict[str, list[str]]:
        """Names of the members by the nodes at which they end."""
        return _by_node((node, name) for name, spec in self.members.items() for node in spec.nodes)

    @property
    def mass_of_members(self) -> float:
        """Mass of all members, without lumped masses [kg]."""
        return sum(
            self.section_of(name).mass_per_length(self.material_of(name).density) * self.frame_of(name).length
            for name in self.members
        )

    @cached_property
    def bending_normal(self) -> Normal | None:
        """Normal of the plane in which it bends; None if it is not determined."""
        return self._normal(list(self.members))

    def normal_of(self, member: str) -> Normal | None:
        """Normal of the plane in which the part bends that a member is connected to.

        Parts that nothing connects do not decide for each other; one without a plane of its own has that of
        the whole structure.
        """
        return self.part_normals.get(member) or self.bending_normal

    @cached_property
    def part_normals(self) -> dict[str, Normal | None]:
        """Normals of the parts by member, where there are several parts."""
        parts = self.separate_parts
        if len(parts) < 2:
            return {}
        return {name: normal for part in parts for normal in (self._normal(part),) for name in part}

    @cached_property
    def separate_parts(self) -> list[list[str]]:
        """Members in groups that nodes or spot welds connect."""
        joined = {name: [*member.nodes] for name, member in self.members.items()}
        for weld, spots in self.spot_welds.items():
            for name in joined.keys() & {*spots.members}:
                joined[name].append(f"spot_welds.{weld}")
        return connected(joined)

    def _normal(self, members: Sequence[str]) -> Normal | None:
        """Normal of the plane in which some of the members bend, which are connected to no others."""
        ends = dict.fromkeys(node for name in members for node in self.members[name].nodes)
        points = np.array([self.nodes[node] for node in ends if node in self.nodes], float)
        whole = len(members) == len(self.members)
        normal = plane_normal(points, self._turning_and_pushing(None if whole else {*ends, *members}))
        # a tuple: with a cached array two structures could not be compared
        return None if normal is None else (float(normal[0]), float(normal[1]), float(normal[2]))

    def _turning_and_pushing(self, names: Set[str] | None) -> Iterator[tuple[Floats, Floats]]:
        """Axis and direction of all that bends a straight structure, strongest reason first; zero: none.

        `names`: nodes and members of the part that is asked for; None: all.
        """

        def acts(*on: str) -> bool:
            return names is None or not names.isdisjoint(on)

        none = np.zeros(3)
        for field in self.initial_velocity:
            everywhere = field.nodes is None and field.members is None
            if not (everywhere or acts(*(field.nodes or ()), *(field.members or ()))):
                continue
            turns = field.axis is not None and field.rotation
            yield np.asarray(field.axis, float) if turns else none, np.asarray(field.translation, float)
        for impulse in self.impulses:
            if not acts(impulse.node):
                continue
            yield np.asarray(impulse.angular_impulse, float), np.asarray(impulse.impulse, float)
        for load in self.loads:
            if not acts(load.node):
                continue
            moment, force = (
                [getattr(part, axis) is not None for axis in "xyz"] for part in (load.moment, load.force)
            )
            yield np.array(moment, float), np.array(force, float)
        for support in self.supports.values():
            if not acts(support.node):
                continue
            turned, pushed = ([f"{kind}{axis}" in support.driven for axis in "xyz"] for kind in ("r", ""))
            yield np.array(turned, float), np.array(pushed, float)
        yield none, np.asarray(self.gravity, float)
