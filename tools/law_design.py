"""Design of the library of bending laws of tubes: which tubes are solved, fixed before anything is solved.

A tube without corner radii, at rest, is described by dimensionless coordinates:

    rectangular   a/t, b/t (flange width and depth over wall), s_y/E, h
    round         D/t, s_y/E, h

with h the true stress at a plastic strain of 0.1 over the yield stress.  Bending about the other axis is the
same with a and b exchanged.  The range is given by slenderness max(a, b)/t and ratio a/b.

Training points are a Sobol sequence, pushed towards the ends of the range (there a regression extrapolates),
on a coarse mesh; some of them are solved on the nominal mesh too.  Round tubes with hardening are another
Sobol sequence, on the nominal mesh only.  Metals that harden strongly, and thicker round tubes, came later: a
third sequence, on the coarse mesh.  Held-out points are uniform random numbers from seeds of their own, on
the nominal mesh.  Nobody chooses anything by the latter.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from scipy.stats import qmc

from crumple.material import Material
from crumple.material.hardening.swift import Swift
from crumple.numeric.arrays import Floats
from crumple.section import CircularTube, RectangularTube, Section

Kind = Literal["rectangular_tube", "circular_tube"]
Role = Literal["training", "earlier", "former", "mesh", "hardened", "strong", "held-out", "check"]

SLENDERNESS = (15.0, 60.0)
"""Larger side, or diameter, over wall."""
RATIO = (0.6, 2.5)
"""Flange width over depth."""
THICKEST = 18.5
"""Larger side over wall from which rectangular tubes have laws: of thicker ones some fold elsewhere."""
DEEPEST = 0.7
"""Flange width over depth from which they have laws, for the same reason."""
YIELD_STRAIN = (0.0012, 0.004)
"""Yield stress over Young's modulus."""
HARDENING = (1.0, 1.8)
"""Stress at a plastic strain of 0.1 over the yield stress, of the points but strong ones."""
STRONGEST = 2.4
"""The largest one of strong points."""
THICKEST_ROUND = 12.0
"""Diameter over wall of the thickest round strong points."""
WITHOUT_HARDENING = 0.4
"""Share of the points without hardening: an edge of the range, and the most frequent case."""
PRESTRAIN = 0.01
"""Of the power law (Swift) that stands for all hardening curves."""
COARSE, NOMINAL = 4.0, 8.0
"""Elements along half a fold."""
TRAINING = {"rectangular_tube": 20, "circular_tube": 8}
FORMER = {"rectangular_tube": 10, "circular_tube": 4}
"""Points that were held out on the coarse mesh; their errors are known, so they are training points now."""
HARDENED = {"rectangular_tube": 0, "circular_tube": 8}
"""Points with hardening that are solved on the nominal mesh only: most others have none."""
LEAST_HARDENED = 1.2
"""Their least stress at a plastic strain of 0.1 over the yield stress."""
STRONG = {"rectangular_tube": 6, "circular_tube": 7}
"""Points on the coarse mesh with a hardening from `LEAST_STRONG` to `STRONGEST`."""
LEAST_STRONG = 1.7
HELD_OUT = {"rectangular_tube": 3, "circular_tube": 1}
LATER_HELD_OUT = {"rectangular_tube": 0, "circular_tube": 4}
"""More of them, with a hardening that is uniform over its whole range."""
STRONG_HELD_OUT = {"rectangular_tube": 1, "circular_tube": 2}
"""Held-out points with a hardening from `HARDENING[1]` to `STRONGEST`."""
MESH: dict[str, tuple[tuple[Role, int], ...]] = {
    "rectangular_tube": (
        *(("training", 0), ("training", 12), ("training", 5), ("training", 17), ("training", 18)),
        *(("training", 2), ("former", 1), ("training", 10), ("training", 3), ("training", 9)),
        ("former", 7),
    ),
    "circular_tube": (("training", 0), ("training", 2), ("training", 5), ("training", 4)),
}
"""Points that are solved on the nominal mesh too: spread over the range, in the order of solution."""
EARLIER = {
    "rectangular_tube": (
        (16.542128, 1.395201, 0.002517, 1.0, 4.0),
        (39.539026, 2.381398, 0.003703, 1.099355, 4.0),
        (20.593631, 0.738616, 0.001275, 1.626949, 4.0),
        (33.899856, 2.138716, 0.00117, 1.660499, 4.0),
        (16.542128, 1.286818, 0.002517, 1.0, 5.0),
        (39.539026, 2.365405, 0.003703, 1.099355, 5.0),
        (33.899856, 2.09293, 0.00117, 1.660499, 5.0),
        (59.069669, 0.956596, 0.002784, 1.0, 5.0),
        (72.037218, 1.80896, 0.001827, 1.311784, 5.0),
        (15.223145, 2.499439, 0.001745, 1.0, 5.0),
    ),
    "circular_tube": (
        (30.839545, 1.0, 0.002187, 1.0, 4.0),
        (30.839545, 1.0, 0.002187, 1.0, 5.0),
        (72.702487, 1.0, 0.001809, 1.723438, 5.0),
    ),
}
"""More training points: slenderness, ratio, yield strain, hardening, elements along half a fold.

They are those of first designs, of wider ranges, that were given up for their cost before any held-out point
was solved."""
CHECK = {"rectangular_tube": ((25.0, 1.0, 350e6 / 210e9, 1.0, NOMINAL),), "circular_tube": ()}
"""Held out on the nominal mesh: the tube 50x50x2 mm with 350 MPa."""
SEED, LATER_SEED, FORMER_SEED, STRONG_SEED = 20261, 20262, 20260, 20264
"""Of the held-out points, of the later ones, of those that were held out before, and of the strong ones."""
WALL = 1e-3
"""Thickness of every tube that is solved [m]; only ratios matter."""
YOUNGS_MODULUS = 210e9


@dataclass(frozen=True)
class Point:
    """One tube.

    Attributes
    ----------
    name
        Of its file.
    kind, role
        Shape, and what it serves for.
    slenderness, ratio
        Larger side (diameter) over wall, and flange width over depth; 1 for a round tube.
    yield_strain, hardening
        Yield stress over Young's modulus, and stress at a plastic strain of 0.1 over the yield stress.
    elements
        Along half a fold.
    """

    name: str
    kind: Kind
    role: Role
    slenderness: float
    ratio: float
    yield_strain: float
    hardening: float
    elements: float

    @property
    def sides(self) -> tuple[float, float]:
        """Flange width and depth over wall."""
        return self.slenderness * min(self.ratio, 1.0), self.slenderness / max(self.ratio, 1.0)

    @property
    def section(self) -> Section:
        """Tube, to be bent about y."""
        if self.kind == "circular_tube":
            return CircularTube(self.slenderness * WALL, WALL)
        width, depth = self.sides
        return RectangularTube(width * WALL, depth * WALL, WALL)

    @property
    def material(self) -> Material:
        """Steel with Swift's power law, or perfectly plastic."""
        stress = self.yield_strain * YOUNGS_MODULUS
        exponent = math.log(self.hardening) / math.log(1.0 + 0.1 / PRESTRAIN)
        hardening = Swift(stress, PRESTRAIN, exponent) if self.hardening > 1.0 else None
        return Material("metal", YOUNGS_MODULUS, 0.3, 7850.0, stress, hardening=hardening)


def points() -> tuple[Point, ...]:
    """All points in the order in which they are solved: whatever is finished covers the range evenly."""
    return tuple(point for _, point in sorted(_numbered(), key=lambda pair: pair[0]))


def _numbered() -> Iterator[tuple[float, Point]]:
    for kind in TRAINING:
        training, former = list(_training(kind)), list(_former(kind))
        earlier = [
            Point(f"{kind}-earlier-{number:02d}", kind, "earlier", *place)
            for number, place in enumerate(EARLIER[kind])
        ]
        own = {"training": training, "former": former}
        mesh = [_on_nominal_mesh(own[role][number], place) for place, (role, number) in enumerate(MESH[kind])]
        check = [
            Point(f"{kind}-check-{number:02d}", kind, "check", *place)
            for number, place in enumerate(CHECK[kind])
        ]
        coarse = ((earlier, 0.0), (training, 0.0), (former, 0.0), (list(_strong(kind)), 0.0))
        nominal = (mesh, list(_held_out(kind)), check, list(_hardened(kind)))
        for group, begin in (*coarse, *((each, 1.0) for each in nominal)):
            for number, point in enumerate(group):
                yield begin + (number + 0.5) / len(group), point


def _training(kind: Kind) -> Iterator[Point]:
    unit = qmc.Sobol(4, scramble=True, seed=1 if kind == "rectangular_tube" else 2).random_base2(6)
    for number, place in enumerate(unit[: TRAINING[kind]]):
        yield _point(kind, "training", number, 0.5 - 0.5 * np.cos(math.pi * place[:3]), place[3])


def _hardened(kind: Kind) -> Iterator[Point]:
    unit = qmc.Sobol(3, scramble=True, seed=3).random_base2(4)
    shares = 0.5 - 0.5 * np.cos(math.pi * unit[: HARDENED[kind]])
    for number, (slenderness, strain, rise) in enumerate(shares):
        hardening = LEAST_HARDENED + (HARDENING[1] - LEAST_HARDENED) * rise
        one = _point(kind, "hardened", number, np.array([slenderness, 0.0, strain]), 0.0)
        yield replace(one, hardening=float(np.round(hardening, 6)), elements=NOMINAL)


def _strong(kind: Kind) -> Iterator[Point]:
    unit = qmc.Sobol(4, scramble=True, seed=4 if kind == "rectangular_tube" else 5).random_base2(3)
    for number, place in enumerate(0.5 - 0.5 * np.cos(math.pi * unit[: STRONG[kind]])):
        yield _strong_point(f"{kind}-strong-{number:02d}", kind, "strong", place, LEAST_STRONG)


def _strong_point(name: str, kind: Kind, role: Role, place: Floats, least: float) -> Point:
    round_tube = kind == "circular_tube"
    slenderness = _between((THICKEST_ROUND if round_tube else THICKEST, SLENDERNESS[1]), place[0])
    ratio = 1.0 if round_tube else _between((DEEPEST, RATIO[1]), place[1])
    hardening = float(np.round(least + (STRONGEST - least) * place[3], 6))
    return Point(name, kind, role, slenderness, ratio, _between(YIELD_STRAIN, place[2]), hardening, COARSE)


def _former(kind: Kind) -> Iterator[Point]:
    random = np.random.default_rng([FORMER_SEED, len(kind)])
    for number, place in enumerate(random.uniform(size=(FORMER[kind], 4))):
        yield _point(kind, "former", number, place[:3], place[3])


def _held_out(kind: Kind) -> Iterator[Point]:
    """Uniform in the range of the laws, on the nominal mesh."""
    slenderness = (THICKEST, SLENDERNESS[1]) if kind == "rectangular_tube" else SLENDERNESS
    first = np.random.default_rng([SEED, len(kind)]).uniform(size=(HELD_OUT[kind], 4))
    later = np.random.default_rng([LATER_SEED, len(kind)]).uniform(size=(LATER_HELD_OUT[kind], 4))
    # past the share without hardening, so that it is uniform
    later[:, 3] = WITHOUT_HARDENING + (1.0 - WITHOUT_HARDENING) * later[:, 3]
    for number, place in enumerate(np.concatenate([first, later])):
        one = _point(kind, "held-out", number, place[:3], place[3])
        ratio = 1.0 if kind == "circular_tube" else _between((DEEPEST, RATIO[1]), place[1])
        yield replace(one, slenderness=_between(slenderness, place[0]), ratio=ratio, elements=NOMINAL)
    strong = np.random.default_rng([STRONG_SEED, len(kind)]).uniform(size=(STRONG_HELD_OUT[kind], 4))
    for number, place in enumerate(strong, len(first) + len(later)):
        one = _strong_point(f"{kind}-held-out-{number:02d}", kind, "held-out", place, HARDENING[1])
        yield replace(one, elements=NOMINAL)


def _point(kind: Kind, role: Role, number: int, place: Floats, hardening: float) -> Point:
    rise = max(hardening - WITHOUT_HARDENING, 0.0) / (1.0 - WITHOUT_HARDENING)
    return Point(
        f"{kind}-{role}-{number:02d}",
        kind,
        role,
        _between(SLENDERNESS, place[0]),
        1.0 if kind == "circular_tube" else _between(RATIO, place[1]),
        _between(YIELD_STRAIN, place[2]),
        float(np.round(HARDENING[0] + (HARDENING[1] - HARDENING[0]) * rise, 6)),
        COARSE,
    )


def _between(ends: tuple[float, float], share: float) -> float:
    return float(np.round(ends[0] * (ends[1] / ends[0]) ** share, 6))


def _on_nominal_mesh(point: Point, number: int) -> Point:
    return replace(point, name=f"{point.kind}-mesh-{number:02d}", role="mesh", elements=NOMINAL)
