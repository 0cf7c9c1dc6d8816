"""Twenty structures whose true errors are compared with the stated ones: ten to look at, ten held back.

Free frames on walls, poles and in corners, with friction; impacts that stick and slip; stops, rates and
hinges that share a rotation.  `case(name)` is the analysis.  Lengths in metres, SI units.
"""

from __future__ import annotations

from typing import Any

import numpy as np

import crumple
from crumple.multibody import Run
from crumple.multibody.solve import solve_multibody

Parts = dict[str, Any]

STEEL = {"youngs_modulus": 210e9, "poissons_ratio": 0.3, "density": 7850.0, "yield_stress": 300e6}
TUBE = {"type": "square_tube", "side": 0.03, "thickness": 0.0015}
DOWN = (0.0, 0.0, -9.81)


def frame(nodes: Parts, pairs: list[str], *, axes: list[str] | None = None, **more: Any) -> Parts:
    """Keys of a structure of tubes between the named nodes ("a-b"), automatic hinges at their ends."""
    members = {
        pair: {"nodes": tuple(pair.split("-")), "section": "tube", "material": "steel"} for pair in pairs
    }
    hinges: Any = "auto" if axes is None else {"axes": axes, "coupling": "ellipsoid"}
    materials, sections = {"steel": more.pop("steel", STEEL)}, {"tube": more.pop("tube", TUBE)}
    return {
        "materials": materials, "sections": sections, "nodes": nodes, "members": members, "hinges": hinges,
        **more,
    }  # fmt: skip


def ring(corners: int, radius: float, turn: float, *, height: float = 0.0) -> tuple[Parts, list[str]]:
    """Nodes and members of a polygon in the plane z = height, its first corner at the angle `turn` [rad]."""
    names = "abcdefgh"[:corners]
    angles = turn + 2 * np.pi * np.arange(corners) / corners
    nodes = {
        name: (float(radius * np.cos(t)), float(radius * np.sin(t)), height)
        for name, t in zip(names, angles, strict=True)
    }
    return nodes, [f"{a}-{b}" for a, b in zip(names, names[1:] + names[0], strict=True)]


def box(sides: tuple[float, float, float], turn: np.ndarray | None = None) -> tuple[Parts, list[str]]:
    """Nodes and members of a box around the origin, turned by a matrix (3, 3)."""
    turn = np.eye(3) if turn is None else turn
    nodes, pairs = {}, []
    for i in range(8):
        bits = np.array([i & 1, i >> 1 & 1, i >> 2 & 1])
        nodes[f"n{i}"] = tuple(map(float, turn @ ((bits - 0.5) * np.array(sides))))
        pairs += [f"n{i}-n{i | bit}" for bit in (1, 2, 4) if not i & bit]
    return nodes, pairs


def turned(*angles: float) -> np.ndarray:
    """Matrix (3, 3) of rotations about x, then y, then z [rad]."""
    (a, b, c), out = angles, np.eye(3)
    for k, t in enumerate((a, b, c)):
        i, j = [(1, 2), (2, 0), (0, 1)][k]
        one = np.eye(3)
        one[i, i] = one[j, j] = np.cos(t)
        one[j, i], one[i, j] = np.sin(t), -np.sin(t)
        out = one @ out
    return out


def wall(nodes: Parts, normal: tuple[float, float, float], *, gap: float, **more: Any) -> Parts:
    """A plane in front of the nodes, so far from the nearest that the walls of tubes have room."""
    n = np.array(normal) / np.linalg.norm(normal)
    least = min(float(n @ np.array(place)) for place in nodes.values())
    return {"type": "plane", "point": tuple(map(float, (least - gap) * n)), "normal": normal, **more}


def thrown(*velocity: float, spin: tuple[float, float, float] | None = None) -> list[Parts]:
    """Velocity of all [m/s], and a rotation about the origin [rad/s]."""
    fields: list[Parts] = [{"translation": velocity}]
    if spin is not None:
        rate = float(np.linalg.norm(spin))
        fields.append({"rotation": rate, "axis": tuple(s / rate for s in spin), "about": (0.0, 0.0, 0.0)})
    return fields


def load(node: str, mass: float, arm: float = 0.1) -> Parts:
    """A mass with the inertia of a ball of the radius `arm` [m]."""
    return {"node": node, "mass": mass, "rotary_inertia": (0.4 * mass * arm**2,) * 3}


def analysis(parts: Parts, duration: float, members: str = "rigid", *nodes: str) -> crumple.Analysis:
    """The analysis of the keys of a structure, without the runs that look for other mechanisms."""
    return crumple.Analysis(
        structure=crumple.Structure(**parts),
        duration=duration,
        multibody={"mechanism_check": "off", "members": members},
        outputs={"nodes": list(nodes), "every": duration / 200},
    )


# to look at


def ring_slides() -> crumple.Analysis:
    nodes, pairs = ring(4, 0.4, 0.25)
    parts = frame(nodes, pairs, masses={"m": load("a", 8.0)})
    parts["obstacles"] = {"wall": wall(nodes, (1, 0, 0), gap=0.02, friction=0.3)}
    return analysis({**parts, "initial_velocity": thrown(-9.0, 5.0, 0.0)}, 0.03, "rigid", "a", "c")


def ring_spins() -> crumple.Analysis:
    nodes, pairs = ring(5, 0.4, 0.1)
    parts = frame(nodes, pairs, masses={"m": load("b", 6.0)})
    parts["obstacles"] = {"wall": wall(nodes, (1, 0, 0), gap=0.02, friction=0.4)}
    motion = thrown(-8.0, 1.0, 0.0, spin=(0, 0, 12.0))
    return analysis({**parts, "initial_velocity": motion}, 0.03, "elastic", "a", "c")


def box_slides() -> crumple.Analysis:
    nodes, pairs = box((0.6, 0.5, 0.4), turned(0.3, 0.5, 0.2))
    parts = frame(nodes, pairs, axes=["y", "z"], masses={"m": load("n7", 15.0)})
    parts["obstacles"] = {"wall": wall(nodes, (1, 0, 0), gap=0.02, friction=0.3)}
    return analysis({**parts, "initial_velocity": thrown(-8.0, 4.0, 1.0)}, 0.03, "rigid", "n0", "n7")


def corner_piece_falls() -> crumple.Analysis:
    nodes = {"a": (0.5, 0.1, 0.05), "b": (0.0, 0.0, 0.0), "c": (0.0, 0.45, 0.25), "d": (-0.2, 0.1, 0.5)}
    parts = frame(nodes, ["a-b", "b-c", "b-d"], axes=["y", "z"], masses={"m": load("d", 10.0)}, gravity=DOWN)
    parts["obstacles"] = {"floor": wall(nodes, (0, 0, 1), gap=0.03, friction=0.5)}
    return analysis({**parts, "initial_velocity": thrown(1.5, 0.5, -5.0)}, 0.04, "elastic", "a", "d")


def ladder_on_pole() -> crumple.Analysis:
    nodes = {f"{side}{i}": (0.35 * s, 0.3 * i, 0.0) for side, s in (("l", 0), ("r", 1)) for i in range(4)}
    pairs = [f"{s}{i}-{s}{i + 1}" for s in "lr" for i in range(3)] + [f"l{i}-r{i}" for i in range(4)]
    parts = frame(nodes, pairs, masses={"m": load("r3", 8.0), "n": load("r0", 8.0)})
    pole = {"point": (-0.09, 0.55, 0.0), "axis": (0, 0, 1), "radius": 0.06, "friction": 0.3}
    parts["obstacles"] = {"pole": {"type": "cylinder", **pole}}
    return analysis({**parts, "initial_velocity": thrown(-8.0, 2.0, 0.0)}, 0.03, "rigid", "l1", "r3")


def tripod_drops() -> crumple.Analysis:
    nodes, _ = ring(3, 0.35, 0.3)
    nodes = {**nodes, "top": (0.03, -0.02, 0.6)}
    nodes["b"] = (*nodes["b"][:2], 0.06)
    parts = frame(nodes, ["a-top", "b-top", "c-top"], axes=["y", "z"], masses={"m": load("top", 40.0)})
    parts["obstacles"] = {"floor": wall(nodes, (0, 0, 1), gap=0.03, friction=0.5)}
    return analysis(
        {**parts, "gravity": DOWN, "initial_velocity": thrown(1.5, 0, -9.0)}, 0.04, "rigid", "top"
    )


def portal_struck() -> crumple.Analysis:
    nodes = {"p": (0, 0, 0), "a": (0, 0, 0.7), "b": (0.8, 0, 0.7), "q": (0.8, 0, 0)}
    supports = {"p": {"node": "p", "fix": "all"}, "q": {"node": "q", "fix": "all"}}
    parts = frame(nodes, ["p-a", "a-b", "b-q"], supports=supports)
    ball = {
        "point": (-0.13, 0.0, 0.55),
        "radius": 0.1,
        "friction": 0.3,
        "mass": 25.0,
        "velocity": (7.0, 0, 0),
    }
    return analysis({**parts, "obstacles": {"ball": {"type": "sphere", **ball}}}, 0.05, "elastic", "a", "b")


def ring_in_corner() -> crumple.Analysis:
    nodes, pairs = ring(6, 0.35, 0.13)
    parts = frame(nodes, pairs, masses={"m": load("a", 10.0)})
    walls = {"wall": wall(nodes, (1, 0, 0), gap=0.02, friction=0.3)}
    walls["side"] = wall(nodes, (0, 1, 0), gap=0.025, friction=0.2)
    return analysis(
        {**parts, "obstacles": walls, "initial_velocity": thrown(-7, -5, 0)}, 0.03, "rigid", "a", "d"
    )


def chain(form: Parts, rate: bool, duration: float, spin: float) -> crumple.Analysis:
    nodes = {"o": (0, 0, 0), "a": (0.4, 0, 0), "b": (0.7, 0, 0.2), "c": (1.1, 0, 0.1)}
    steel = {**STEEL, "yield_rate": {"type": "cowper-symonds", "D": 40.4, "q": 5.0}} if rate else STEEL
    parts = frame(nodes, ["o-a", "a-b", "b-c"], steel=steel, supports={"o": {"node": "o", "fix": "all"}})
    del parts["hinges"]
    law = {"type": "constant", "moment": 900.0, **form}
    for name, at in (("o-a", "o"), ("a-b", "a"), ("b-c", "b")):
        parts["members"][name]["hinges"] = [{"name": at, "at": at, "law": "law"}]
    parts["hinge_laws"] = {"law": law}
    parts["masses"] = {"m": load("c", 6.0)}
    parts["initial_velocity"] = [{"rotation": spin, "axis": (0, -1, 0)}]
    return analysis(parts, duration, "rigid", "c")


def chain_on_stops() -> crumple.Analysis:
    stops = {"rotation": 0.3, "stiffness": 2e4}
    return chain({"stops": stops, "form": "set-valued"}, True, 0.12, 14.0)


def frame_shared() -> crumple.Analysis:
    nodes = {"p": (0, 0, 0), "a": (0, 0, 0.5), "b": (0.25, 0, 0.5), "c": (0.5, 0, 0.5), "q": (0.5, 0, 0)}
    supports = {"p": {"node": "p", "fix": "all"}, "q": {"node": "q", "fix": "all"}}
    parts = frame(nodes, ["p-a", "a-b", "b-c", "c-q"], supports=supports, masses={"m": load("b", 20.0)})
    return analysis({**parts, "initial_velocity": [{"translation": (2, 0, -6)}]}, 0.05, "rigid", "a", "b")


# held back


def triangle_slides() -> crumple.Analysis:
    nodes, pairs = ring(3, 0.4, 0.4)
    parts = frame(nodes, pairs, masses={"m": load("a", 7.0)})
    parts["obstacles"] = {"wall": wall(nodes, (1, 0.2, 0), gap=0.03, friction=0.2)}
    return analysis({**parts, "initial_velocity": thrown(-10, 3, 0)}, 0.03, "rigid", "a", "b")


def hexagon_spins() -> crumple.Analysis:
    nodes, pairs = ring(6, 0.4, 0.2)
    parts = frame(nodes, pairs, masses={"m": load("c", 9.0)})
    parts["obstacles"] = {"wall": wall(nodes, (1, 0, 0), gap=0.02, friction=0.4)}
    motion = thrown(-8, -2, 0, spin=(0, 0, 8.0))
    return analysis({**parts, "initial_velocity": motion}, 0.03, "elastic", "c", "e")


def tetrahedron_drops() -> crumple.Analysis:
    base, pairs = ring(3, 0.4, 0.0)
    turn = turned(0.5, -0.3, 0.0)
    nodes = {name: tuple(map(float, turn @ np.array(at))) for name, at in {**base, "d": (0, 0, 0.55)}.items()}
    parts = frame(nodes, [*pairs, "a-d", "b-d", "c-d"], axes=["y", "z"], masses={"m": load("d", 40.0)})
    parts["obstacles"] = {"floor": wall(nodes, (0, 0, 1), gap=0.03, friction=0.3)}
    return analysis(
        {**parts, "gravity": DOWN, "initial_velocity": thrown(2, 1, -10)}, 0.04, "rigid", "d", "a"
    )


def cage_rolls() -> crumple.Analysis:
    nodes, pairs = box((0.8, 0.6, 0.7), turned(0.5, 0.1, 0.0))
    parts = frame(nodes, pairs, axes=["y", "z"], masses={"m": load("n0", 20.0), "n": load("n1", 20.0)})
    parts["obstacles"] = {"floor": wall(nodes, (0, 0, 1), gap=0.03, friction=0.6)}
    motion = thrown(0, 3, -5, spin=(-5.0, 0, 0))
    return analysis({**parts, "gravity": DOWN, "initial_velocity": motion}, 0.04, "rigid", "n0", "n7")


def t_frame_on_pole() -> crumple.Analysis:
    nodes = {"l": (0, -0.5, 0), "m": (0, 0, 0), "r": (0, 0.4, 0), "t": (0.6, 0.05, 0)}
    parts = frame(nodes, ["l-m", "m-r", "m-t"], masses={"m": load("t", 12.0), "n": load("l", 4.0)})
    pole = {"point": (-0.08, 0.18, 0.0), "axis": (0, 0, 1), "radius": 0.05, "friction": 0.25}
    parts["obstacles"] = {"pole": {"type": "cylinder", **pole}}
    return analysis({**parts, "initial_velocity": thrown(-7, 1, 0)}, 0.04, "elastic", "t", "l")


def ladder_in_corner() -> crumple.Analysis:
    turn = turned(0, 0, 0.3)
    flat = {f"{side}{i}": (0.35 * s, 0.35 * i, 0.0) for side, s in (("l", 0), ("r", 1)) for i in range(3)}
    nodes = {name: tuple(map(float, turn @ np.array(at))) for name, at in flat.items()}
    pairs = [f"{s}{i}-{s}{i + 1}" for s in "lr" for i in range(2)] + [f"l{i}-r{i}" for i in range(3)]
    parts = frame(nodes, pairs, masses={"m": load("r2", 25.0)})
    walls = {"wall": wall(nodes, (1, 0, 0), gap=0.02, friction=0.4)}
    walls["floor"] = wall(nodes, (0, 1, 0), gap=0.03, friction=0.3)
    return analysis(
        {**parts, "obstacles": walls, "initial_velocity": thrown(-8, -8, 0)}, 0.035, "rigid", "r2"
    )


def chair_drops() -> crumple.Analysis:
    nodes = {
        "a": (0.0, 0.0, 0.0), "b": (0.4, 0.0, 0.02), "c": (0.0, 0.4, 0.01), "d": (0.4, 0.4, 0.05),
        "A": (0.05, 0.05, 0.45), "B": (0.35, 0.05, 0.45), "C": (0.05, 0.35, 0.45), "D": (0.35, 0.35, 0.45),
    }  # fmt: skip
    pairs = ["a-A", "b-B", "c-C", "d-D", "A-B", "B-D", "D-C", "C-A"]
    parts = frame(nodes, pairs, axes=["y", "z"], masses={"m": load("A", 12.0), "n": load("D", 18.0)})
    parts["obstacles"] = {"floor": wall(nodes, (0, 0, 1), gap=0.03, friction=0.35)}
    return analysis(
        {**parts, "gravity": DOWN, "initial_velocity": thrown(2, 0.5, -5)}, 0.03, "elastic", "A", "D"
    )


def shoved_ring() -> crumple.Analysis:
    nodes, pairs = ring(4, 0.4, 0.5)
    parts = frame(nodes, pairs, masses={"m": load("b", 15.0), "n": load("d", 6.0)})
    rising = {"table": {"time": [0.0, 0.05], "value": [0.0, 0.2]}}
    across = {"table": {"time": [0.0, 0.05], "value": [0.0, 0.05]}}
    moving = wall(nodes, (1, 0, 0), gap=0.02, friction=0.5, motion={"x": rising, "y": across})
    walls = {"ram": moving, "rest": wall(nodes, (-1, 0, 0), gap=0.03, friction=0.3)}
    return analysis({**parts, "obstacles": walls}, 0.05, "rigid", "b", "d")


def springy_chain() -> crumple.Analysis:
    stops = {"rotation": 0.35, "stiffness": 3e4}
    return chain({"stops": stops, "form": "elastic-plastic", "elastic_stiffness": 3e4}, False, 0.12, 12.0)


def gate_struck() -> crumple.Analysis:
    nodes = {
        "p": (0, 0, 0),
        "a": (0, 0, 0.8),
        "b": (0.6, 0.1, 0.8),
        "q": (0.6, 0.1, 0),
        "t": (0.3, 0.05, 1.1),
    }
    supports = {"p": {"node": "p", "fix": "all"}, "q": {"node": "q", "fix": "all"}}
    steel = {**STEEL, "yield_rate": {"type": "cowper-symonds", "D": 40.4, "q": 5.0}}
    pairs = ["p-a", "a-t", "t-b", "b-q"]
    parts = frame(nodes, pairs, axes=["y", "z"], steel=steel, supports=supports)
    pole = {"point": (0.1, -0.12, 0.6), "axis": (1, 0, 0), "radius": 0.08, "friction": 0.4, "mass": 40.0}
    pole = {**pole, "velocity": (1.5, 6.0, 0.0), "guide": (0.2425, 0.9701, 0.0)}
    return analysis({**parts, "obstacles": {"pole": {"type": "cylinder", **pole}}}, 0.04, "elastic", "a", "t")


LOOKED_AT = (
    ring_slides, ring_spins, box_slides, corner_piece_falls, ladder_on_pole, tripod_drops, portal_struck,
    ring_in_corner, chain_on_stops, frame_shared,
)  # fmt: skip
HELD_BACK = (
    triangle_slides, hexagon_spins, tetrahedron_drops, cage_rolls, t_frame_on_pole, ladder_in_corner,
    chair_drops, shoved_ring, springy_chain, gate_struck,
)  # fmt: skip
CASES = {build.__name__: build for build in (*LOOKED_AT, *HELD_BACK)}


def case(name: str) -> crumple.Analysis:
    """The analysis of a structure of either half."""
    return CASES[name]()


def solved(name: str, accuracy: float, *, checks: bool = True) -> crumple.Result:
    """The result of a structure at an accuracy, with stated errors if `checks`."""
    asked = case(name)
    settings = asked.multibody.model_copy(update={"accuracy": accuracy})
    run = Run(asked.duration, asked.outputs.every, settings, asked.outputs, checks=checks)
    return solve_multibody(asked.structure, run)
