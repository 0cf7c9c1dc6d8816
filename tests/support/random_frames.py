"""Random frames with stated distributions, for campaigns: how many of them does the engine solve?

`frame(seed, index)` is the case `index` of a campaign; it is drawn from `default_rng([seed, index])` alone,
so every case can be had again by its two numbers. A draw that the checks of the input refuse, or whose
driven supports rigid parts cannot follow, is drawn again, from the same stream, at most `MOST_DRAWS` times.

Distributions ("one of" is uniform; all choices are independent unless stated otherwise)

- space: 60 % in the plane y = 0 (all that moves and loads it too), 40 % in space
- members: 2 to 15, uniform; a tree grown member by member from a random earlier node
- directions: 35 % on a lattice of 0.4 m (square corners, regular loops); else any direction, 0.2 to 1.0 m
  long, 25 % of them straight on from the member that they grow from (collinear)
- loops: 60 % of frames; up to a third of the members join two nodes that are there already
- sections: one to three of square, rectangular, circular tube, closed hat (25 to 80 mm; 1 to 3 mm)
- metal: yield 200 to 600 MPa
- hinges: 22 % `auto` everywhere, 6 % `auto` with spacing, 40 % one axis at ends, 17 % several axes at ends,
  15 % all of these mixed, and bars; at ends: each end of a member with probability 0.6
- laws: constant, softening or hardening table, kecman (rectangular tubes); form 70 % set-valued, 20 %
  elastic-plastic, 10 % regularised; softening variable one of three; stops 20 %
- supports: 0 to 3 nodes (10, 35, 35, 20 %); 40 % all, 25 % pin, 35 % single freedoms; 8 % driven in one
- joints: 25 % of frames, one or two ends, any type
- masses: 75 % of frames, 1 to 3 nodes, 0.5 to 40 kg, 20 % with an offset, 20 % with rotary inertia
- obstacles: 45 % of frames one, 15 % two: plane, cylinder or sphere; 50 % fixed, else driven at a speed or
with
  a mass; friction 0 (40 %) or to 0.6, restitution 0 (60 %) or to 0.8; 15 % contact between members
- gravity: 50 %
- motion: 85 % a velocity of all, some members or some nodes, 1 to 15 m/s and 50 % up to 15 rad/s; 25 % an
  impulse; 15 % a force (constant, step, or table)
- stages: 4 % a second dynamic stage with an impulse; 3 % a quasi-static push, if a support is driven
- duration: 10 to 60 ms
"""

from __future__ import annotations

import contextlib
from typing import Any

import numpy as np
from tests.support.random_parts import Dice, Parts

import crumple
from crumple.errors import InputError
from crumple.multibody import Run, link, solver_of, stuck_drives

SEEDS = {"campaign": 20_240_901, "held_out": 731_993}
"""Seeds of the campaigns: the first is worked on; the second is looked at when the work is done."""
MOST_DRAWS = 40
PITCH = 0.4
NEAR = 0.12
AXES = np.eye(3)
FREEDOMS = ("x", "y", "z", "rx", "ry", "rz")
JOINTS = ("revolute", "universal", "spherical", "prismatic", "cylindrical", "planar")


def frame(seed: int, index: int) -> crumple.Analysis:
    """The case `index` of the campaign `seed`.

    Raises
    ------
    RuntimeError
        If none of `MOST_DRAWS` draws is a sound input.
    """
    rng = np.random.default_rng([seed, index])
    for _ in range(MOST_DRAWS):
        with contextlib.suppress(InputError):
            analysis = crumple.Analysis(title=f"frame {seed}/{index}", **Draw(rng).analysis())
            check(analysis)
            return analysis
    raise RuntimeError(f"no sound input in {MOST_DRAWS} draws of frame {seed}/{index}")


def check(analysis: crumple.Analysis) -> None:
    """Refuse what the solver refuses before its first step: bodies without inertia, hinges that join a part
    with itself."""
    duration = analysis.duration or sum(stage.duration for stage in analysis.stages)
    solver = solver_of(
        analysis.structure,
        Run(duration, duration, analysis.multibody, analysis.outputs, stages=tuple(analysis.stages)),
    )
    if not solver.moving:
        raise InputError("nothing can move")
    if stuck_drives(analysis.structure, link(analysis.structure, solver.hinges)):
        raise InputError("a driven support that rigid parts cannot follow")


class Draw(Dice):
    """One draw: the parts of an analysis."""

    def __init__(self, rng: np.random.Generator) -> None:
        super().__init__(rng)
        self.lattice = self.chance(0.35)

    def analysis(self) -> Parts:
        """Keys of `crumple.Analysis`."""
        points, pairs = self.line()
        self.points = {f"n{i}": tuple(map(float, point)) for i, point in enumerate(points)}
        self.pairs = {f"b{i}": (f"n{a}", f"n{b}") for i, (a, b) in enumerate(pairs)}
        sections = {f"s{i}": self.section() for i in range(self.rng.integers(1, 4))}
        laws = {f"l{i}": self.law() for i in range(3)}
        laws["ball"] = {"type": "constant", "moment": float(10.0 ** self.rng.uniform(2.0, 3.7))}
        supports, masses = self.supports(), self.masses()
        self.held = {support["node"] for support in supports.values()}
        self.carrying = self.held | {mass["node"] for mass in masses.values()}
        members, everywhere = self.members(sections)
        structure = {
            "materials": {"metal": self.metal()},
            "sections": sections,
            "nodes": self.points,
            "members": members,
            "hinge_laws": laws,
            "joints": self.joints(),
            "supports": supports,
            "masses": masses,
            "initial_velocity": [self.velocity()] if self.chance(0.85) else [],
            "impulses": [self.impulse()] if self.chance(0.25) else [],
            "loads": [self.load()] if self.chance(0.15) else [],
            "gravity": (0.0, 0.0, -9.81) if self.chance(0.5) else (0.0, 0.0, 0.0),
            "obstacles": self.obstacles(),
        }
        if everywhere is not None:
            structure["hinges"] = everywhere
        if self.chance(0.15):
            structure["member_contact"] = self.touch()
        duration = float(self.rng.uniform(0.01, 0.06))
        parts: Parts = {"multibody": {"mechanism_check": "off"}, "outputs": {"nodes": list(self.points)[:3]}}
        stages = self.stages(structure, duration)
        if stages:
            parts["stages"] = stages
        return {"structure": crumple.Structure(**structure), "duration": duration, **parts}

    # the line of the frame

    def line(self) -> tuple[list[np.ndarray], list[tuple[int, int]]]:
        """Nodes and the pairs of them that members join."""
        count = int(self.rng.integers(2, 16))
        loops = int(self.rng.integers(0, count // 3 + 1)) if self.chance(0.6) else 0
        points, pairs = [np.zeros(3)], []
        while len(pairs) < count - loops:
            start = int(self.rng.integers(len(points)))
            before = [pair for pair in pairs if pair[1] == start]
            point = points[start] + self.way(points, before)
            if min(np.linalg.norm(point - other) for other in points) > NEAR:
                pairs.append((start, len(points)))
                points.append(point)
        for _ in range(20 * loops):
            a, b = sorted(map(int, self.rng.integers(0, len(points), 2)))
            apart = np.linalg.norm(points[a] - points[b])
            if a != b and (a, b) not in pairs and apart < 1.5 and len(pairs) < count:
                pairs.append((a, b))
        return points, pairs

    def way(self, points: list[np.ndarray], before: list[tuple[int, int]]) -> np.ndarray:
        """Where a new member leads."""
        if self.lattice:
            axis = self.pick(0, 2) if self.planar else self.pick(0, 1, 2)
            return PITCH * self.pick(-1.0, 1.0) * AXES[axis]
        length = self.rng.uniform(0.2, 1.0)
        if before and self.chance(0.25):
            straight = points[before[0][1]] - points[before[0][0]]
            return length * straight / np.linalg.norm(straight)
        return length * self.direction()

    # what members are

    def members(self, sections: Parts) -> tuple[Parts, Parts | str | None]:
        """Members, and the hinges of all that have none of their own."""
        kind = str(
            self.rng.choice(
                ["auto", "spaced", "one", "several", "mixed"],
                p=[0.22, 0.06, 0.40, 0.17, 0.15],
            )
        )
        members = {}
        law = self.law_of(*sections.values())
        for name, nodes in self.pairs.items():
            own = str(self.pick("auto", "one", "several", "none", "bars")) if kind == "mixed" else kind
            section = self.pick(*sections)
            member: Parts = {"nodes": nodes, "section": section, "material": "metal"}
            if self.planar:
                member["up"] = (0.0, 1.0, 0.0)
            if own in ("one", "several"):
                member["hinges"] = self.ends(name, nodes, own == "several", sections[section])
            elif own == "auto" and kind == "mixed":
                member["hinges"] = {"law": self.law_of(sections[section])}
            elif own == "bars":
                member["bars"] = {
                    "number": int(self.rng.integers(2, 6)),
                    "law": self.law_of(sections[section]),
                }
            members[name] = member
        return members, {"auto": {"law": law}, "spaced": {"law": law, "spacing": 0.2}}.get(kind)

    def law_of(self, *sections: Parts) -> str:
        """A law that suits the sections."""
        own = ["l0", "l1", "l2", "constant"]
        if all(section["type"] in ("square_tube", "rectangular_tube") for section in sections):
            own += ["kecman", "kecman"]
        return str(self.pick(*own))

    def ends_of(self, node: str) -> int:
        """How many members end there."""
        return sum(node in nodes for nodes in self.pairs.values())

    def ends(self, name: str, nodes: tuple[str, str], several: bool, section: Parts) -> list[Parts]:
        hinges = []
        for node in nodes:
            # beyond a hinge at a bare end there would be nothing
            if not self.chance(0.6) or (self.ends_of(node) == 1 and node not in self.carrying):
                continue
            hinge: Parts = {"name": f"{name}-{node}", "at": node}
            if self.chance(0.5):
                hinge["offset"] = float(self.rng.uniform(0.0, 0.04))
            if self.chance(0.8) or section["type"] not in ("square_tube", "rectangular_tube"):
                hinge["law"] = self.law_of(section)
            if several:
                hinge |= self.pick(
                    {"axes": ("y", "z"), "coupling": self.pick("ellipsoid", "none", "section")},
                    {"axes": ("x", "y", "z"), "coupling": self.pick("ellipsoid", "none", "section")},
                    {"axes": ("y", "z"), "axial": True, "coupling": self.pick("ellipsoid", "section")},
                    {"axes": ("y", "z"), "coupling": "ball", "law": "ball"},
                )
            hinges.append(hinge)
        return hinges

    def joints(self) -> Parts:
        if not self.chance(0.25):
            return {}
        joints = {}
        for name in self.some(self.pairs, 2):
            kind, node = self.pick(*JOINTS), self.pick(*self.pairs[name])
            if self.ends_of(node) == 1:
                continue
            joint: Parts = {"node": node, "member": name, "type": kind}
            if kind == "universal":
                joint |= {"axis": (0.0, 1.0, 0.0), "second": (1.0, 0.0, 0.0)}
            elif kind != "spherical":
                joint["axis"] = (0.0, 1.0, 0.0) if self.chance(0.5) else tuple(map(float, self.direction()))
            joints[f"j-{name}"] = joint
        return joints

    # how it is held, and what it carries

    def supports(self) -> Parts:
        count = min(int(self.rng.choice(4, p=[0.1, 0.35, 0.35, 0.2])), len(self.points) - 1)
        supports = {}
        for i in self.rng.permutation(len(self.points))[:count]:
            draw = self.rng.random()
            fix: Any = "all" if draw < 0.4 else "pin" if draw < 0.65 else self.freedoms()
            support: Parts = {"node": f"n{i}", "fix": fix}
            if self.chance(0.08):
                freedom = self.pick("x", "z") if self.planar else self.pick("x", "y", "z")
                way, time = float(self.rng.uniform(-0.1, 0.1)), float(self.rng.uniform(0.005, 0.03))
                support["motion"] = {freedom: {"step": {"x0": 0.0, "h0": 0.0, "x1": time, "h1": way}}}
                if isinstance(fix, tuple):
                    support["fix"] = tuple(f for f in fix if f != freedom)
            supports[f"at-n{i}"] = support
        return supports

    def freedoms(self) -> tuple[str, ...]:
        return tuple(FREEDOMS[i] for i in sorted(self.rng.permutation(6)[: int(self.rng.integers(1, 4))]))

    def masses(self) -> Parts:
        masses = {}
        for node in self.some(self.points, 3) if self.chance(0.75) else []:
            mass: Parts = {"node": node, "mass": float(np.exp(self.rng.uniform(np.log(0.5), np.log(40.0))))}
            if self.chance(0.2):
                mass["offset"] = self.vector(0.0, 0.1)
            if self.chance(0.2):
                mass["rotary_inertia"] = (0.02, 0.02, 0.02)
            masses[f"on-{node}"] = mass
        return masses

    # what moves it

    def velocity(self) -> Parts:
        field: Parts = {"translation": self.vector(1.0, 15.0)}
        if self.chance(0.5):
            axis = (0.0, 1.0, 0.0) if self.planar else tuple(map(float, self.direction()))
            field |= {"rotation": float(self.rng.uniform(-15.0, 15.0)), "axis": axis}
        of = self.pick("all", "members", "nodes")
        if of == "members":
            field["members"] = self.some(self.pairs, 4)
        elif of == "nodes":
            field["nodes"] = self.some(self.loose, 4)
        return field

    @property
    def loose(self) -> list[str]:
        """Nodes that no support holds."""
        return sorted(set(self.points) - self.held)

    def impulse(self) -> Parts:
        return {"node": self.pick(*self.loose), "impulse": self.vector(1.0, 60.0)}

    def load(self) -> Parts:
        size = float(self.rng.uniform(-3e3, 3e3))
        function = self.pick(
            size,
            {"step": {"x0": 0.0, "h0": 0.0, "x1": 0.01, "h1": size}},
            {"table": {"time": [0.0, 0.005, 0.01, 0.1], "value": [0.0, size, 0.0, 0.0]}},
        )
        axis = self.pick("x", "z") if self.planar else self.pick("x", "y", "z")
        return {"node": self.pick(*self.points), "force": {axis: function}}

    def obstacles(self) -> Parts:
        count = int(self.rng.choice(3, p=[0.4, 0.45, 0.15]))
        return {f"ob{i}": self.obstacle() for i in range(count)}

    def obstacle(self) -> Parts:
        """Beside the frame, a little aside, moving towards it if it moves."""
        points = np.array(list(self.points.values()))
        way, radius = self.direction(), float(self.rng.uniform(0.05, 0.25))
        aside = np.cross(way, self.direction()) if not self.planar else np.array([-way[2], 0.0, way[0]])
        reach = float(np.max((points - points[0]) @ way)) + float(self.rng.uniform(0.06, 0.3))
        spread = float(np.ptp((points - points[0]) @ aside))
        shape = self.pick("plane", "cylinder", "sphere")
        place = points.mean(axis=0)
        place += way * (reach - (place - points[0]) @ way + (0.0 if shape == "plane" else radius))
        place += aside * spread * float(self.rng.uniform(-0.4, 0.4))
        obstacle: Parts = {"type": shape, "point": tuple(map(float, place)), **self.touch()}
        if shape == "plane":
            obstacle["normal"] = tuple(map(float, -way))
        else:
            obstacle["radius"] = radius
        if shape == "cylinder":
            axis = np.array([0.0, 1.0, 0.0]) if self.planar else np.cross(way, self.direction())
            obstacle["axis"] = tuple(map(float, axis))
        moves = self.pick("fixed", "fixed", "driven", "mass")
        if moves != "fixed":
            obstacle["velocity"] = tuple(map(float, -way * self.rng.uniform(1.0, 12.0)))
        if moves == "mass":
            obstacle["mass"] = float(np.exp(self.rng.uniform(np.log(1.0), np.log(300.0))))
        return obstacle

    def stages(self, structure: Parts, duration: float) -> list[Parts]:
        """None in most cases; else what the start gives belongs to the first stage."""
        draw = self.rng.random()
        if draw < 0.04:
            first = {key: structure.pop(key) for key in ("initial_velocity", "impulses")}
            return [
                {"name": "first", "duration": duration / 2.0, **first},
                {"name": "second", "duration": duration / 2.0, "impulses": [self.impulse()]},
            ]
        driven = any(support.get("motion") for support in structure["supports"].values())
        if draw < 0.07 and driven:
            for key in ("initial_velocity", "impulses"):
                structure.pop(key)
            return [{"name": "push", "kind": "quasi-static", "duration": duration}]
        return []
