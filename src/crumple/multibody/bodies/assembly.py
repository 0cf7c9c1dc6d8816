"""Members cut at their hinges, and the rigid parts that result: all pieces that are joined rigidly."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from crumple.cancelling import go_on
from crumple.errors import InputError, Problem
from crumple.multibody.bodies.rigid import RigidMass, combined, lump_mass, piece_mass
from crumple.structure import Joint, PlacedHinge, Structure


@dataclass(frozen=True)
class Piece:
    """Part of a member between two cuts; ``body`` is its rigid body (-1: ground)."""

    member: str
    start: float
    end: float
    body: int


@dataclass(frozen=True)
class Cut:
    """Hinge or joint between two rigid parts: the number of the part on its first and on its second side."""

    first: int
    second: int
    hinge: PlacedHinge | None = None
    joint: str | None = None


@dataclass
class Assembly:
    """Pieces and nodes while they are being joined: each has a number, and `root` gives its rigid part."""

    structure: Structure
    parent: list[int] = field(default_factory=list)
    pieces: dict[str, list[tuple[float, float, int]]] = field(default_factory=dict)
    node: dict[str, int] = field(default_factory=dict)
    cuts: list[Cut] = field(default_factory=list)

    def new(self) -> int:
        """Number of a new piece that is not yet joined to anything."""
        self.parent.append(len(self.parent))
        return len(self.parent) - 1

    def root(self, i: int) -> int:
        """The rigid part to which a piece belongs."""
        while self.parent[i] != i:
            self.parent[i] = self.parent[self.parent[i]]
            i = self.parent[i]
        return i

    def join(self, a: int, b: int) -> None:
        """Join two rigid parts into one."""
        self.parent[self.root(b)] = self.root(a)

    def masses(self) -> dict[int, RigidMass]:
        """Mass of every rigid part that has a piece or a lumped mass."""
        parts: dict[int, list[RigidMass]] = defaultdict(list)
        for name, cuts in self.pieces.items():
            for start, end, i in cuts:
                go_on()
                parts[self.root(i)].append(piece_mass(self.structure, name, start, end))
        for mass in self.structure.masses.values():
            parts[self.root(self.node[mass.node])].append(lump_mass(self.structure, mass))
        return {part: combined(of) for part, of in parts.items()}

    def moving_cuts(self) -> list[Cut]:
        """Cuts between different rigid parts.

        Raises
        ------
        InputError
            If both sides of one belong to the same part.
        """
        found = []
        for cut in self.cuts:
            first, second = self.root(cut.first), self.root(cut.second)
            if first == second:
                raise idle(self.structure, cut.hinge, cut.joint)
            found.append(Cut(first, second, cut.hinge, cut.joint))
        return found


def assemble(structure: Structure, hinges: tuple[PlacedHinge, ...]) -> Assembly:
    """Cut members at their hinges, and join the pieces that meet rigidly at nodes and spot welds."""
    assembly = Assembly(structure)
    assembly.node = {node: assembly.new() for node in structure.nodes}
    jointed = {(joint.node, joint.member): name for name, joint in structure.joints.items()}
    by_member: dict[str, list[PlacedHinge]] = defaultdict(list)
    for hinge in sorted(hinges, key=lambda hinge: hinge.station):
        by_member[hinge.member].append(hinge)
    for name, member in structure.members.items():
        go_on()
        length = structure.frame_of(name).length
        stations = [0.0, *(hinge.station for hinge in by_member[name]), length]
        pieces = [(a, b, assembly.new()) for a, b in pairwise(stations)]
        assembly.pieces[name] = pieces
        for node, end in zip(member.nodes, (pieces[0][2], pieces[-1][2]), strict=True):
            joint = jointed.get((node, name))
            if joint is None:
                assembly.join(assembly.node[node], end)
            else:
                assembly.cuts.append(Cut(assembly.node[node], end, joint=joint))
        for hinge, (a, b) in zip(by_member[name], pairwise(pieces), strict=True):
            assembly.cuts.append(Cut(a[2], b[2], hinge=hinge))
    for name, welds in structure.spot_welds.items():
        for place in welds.places(structure.frame_of(welds.members[0])) if len(welds.members) == 2 else ():
            _refuse_beside(structure, name, place)
            assembly.join(*(_piece_at(assembly, member, place) for member in welds.members))
    return assembly


def _refuse_beside(structure: Structure, name: str, place: NDArray[np.float64]) -> None:
    """Refuse a spot weld [m] farther from a member's outline, or from its ends, than both walls are thick."""
    members = structure.spot_welds[name].members
    both = sum(structure.section_of(member).thickness for member in members)
    for member in members:
        frame, outline = structure.frame_of(member), structure.section_of(member).outer_outline()
        low, high = np.array([0.0, *outline.min(axis=0)]), np.array([frame.length, *outline.max(axis=0)])
        local = frame.axes @ (place - frame.origin)
        beside = float(np.linalg.norm(np.maximum(low - local, local - high).clip(0.0)))
        if beside > both:
            at = ", ".join(f"{1e3 * float(value):.6g}" for value in place)
            what, came = (
                f"member '{member}' does not reach the spot at ({at}) mm",
                f"{1e3 * beside:.3g} mm away",
            )
            todo = "correct the places of the spots, or of the members"
            allowed = f"at most {1e3 * both:.3g} mm, both thicknesses"
            raise InputError(Problem(what, came, allowed, todo, f"spot_welds.{name}"))


def _piece_at(assembly: Assembly, member: str, place: NDArray[np.float64]) -> int:
    """Number of the piece of a member nearest to a place [m]."""
    frame = assembly.structure.frame_of(member)
    station = float((place - frame.origin) @ frame.x)
    return next((i for _, end, i in assembly.pieces[member] if station < end), assembly.pieces[member][-1][2])


def joint_of(structure: Structure, cut: Cut) -> Joint | None:
    """The joint of a cut; None for a hinge."""
    return None if cut.joint is None else structure.joints[cut.joint]


def idle(structure: Structure, hinge: PlacedHinge | None, joint: str | None) -> InputError:
    """Reason why a hinge or joint has no effect: its sides move as one, or not at all."""
    if hinge is not None:
        came = f"hinge {hinge.name} of member {hinge.member}"
        what = "this hinge are fixed or rigidly connected elsewhere, so it cannot rotate"
        where = f"members.{hinge.member}.hinges"
    else:
        came = f"joint {joint} of member {structure.joints[str(joint)].member}"
        what, where = (
            "this joint are fixed or rigidly connected elsewhere, so it cannot move",
            f"joints.{joint}",
        )
    return InputError(
        Problem(
            f"both sides of {what}",
            came,
            "hinges and joints between parts that can move against each other",
            "remove it, put hinges into the parallel load path, or let the members bend "
            "(analysis.multibody.members: elastic)",
            where,
        )
    )
