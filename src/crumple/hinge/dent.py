"""Dents that an obstacle presses into the wall of a tube.

Unknown: the force F on a pole or ball across a tube over the depth d of the dent, and the share of the
plastic moment M_p that the dented section keeps.  s is the flow stress, t the wall.

Round tube of the diameter D and the mean radius R under a pole or ball of the radius r, x = r t/D^2:

    F = (1/2 + sqrt(x)) 4 s t^1.5 sqrt(2 pi d/3)

Where a chord replaces the arc 2 beta that is dented, and carries nothing,

    m_0(d) = cos(beta/2) - sin(beta)/2,    cos(beta) = 1 - d/R

of M_p are left; and the middle line moves by (R/pi) (sin(beta) - beta cos(beta)) in the mean.  A wide pole
presses a long and flat dent, which goes on carrying a share: m = 1 - exp(-7 x) (1 - m_0).  Pole and beam
carry the same force, so the dent grows until F = m M_p a + b, with a, b from the spans of the tube and the
moments at their ends.  The factors with x are fitted to tubes in shells.

Rectangular tube of width b and depth h along the force, under a pole:

    F = min(0.15 E t d, f(d/h) s t^2)

with the rise and f of shells of four tubes on a rigid floor (`RISE`, `CRUSHED`); m = exp(-2.8 d/h) is the
moment of two slowly pressed tubes in shells over the depth of their dents.  The middle line moves by
d (b + h/2)/(2 (b + h)) in the mean, if the upper half of the webs shortens evenly.  A ball of radius R first
dishes the wall between the webs,

    F = 3 s t d,    d < d_w = R - sqrt(R^2 - (b/2)^2),

until it meets the webs, which then fold as under a pole from there on, F(d - d_w), at no less than F(d_w).
The dish takes no more than 27 s t^2, at which webs begin to fold.  A tube of cells is dented
cell by cell: h is the depth of one in f, which goes on into the next one (`NEXT_CELL`), and the force has the
factor w/2, w the number of webs along it, inner ones by the square of their wall.

Range, sources and comparison with shells: docs/theory/dents.md.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from crumple.material import Material
from crumple.numeric.arrays import Floats
from crumple.numeric.monotone_root import rising_root
from crumple.section import CircularTube, RectangularTube

CRUSHED = (
    (0.0, 0.02, 0.03, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5),
    (27.0, 27.0, 31.0, 30.0, 27.0, 26.0, 34.0, 40.0, 40.0),
)
"""Depth of a dent in a rectangular tube over its own depth, and force over flow stress and wall squared."""
NEXT_CELL = (
    (0.6, 0.75, 0.9, 1.5, 1.75),
    (46.0, 51.0, 78.0, 82.0, 105.0),
)
"""The same of tubes of several cells along the force, over the depth of a cell: mean of four in shells."""
SHARP, WIDER, FLATTER = 0.5, 1.0, 7.0
"""Round tubes: force under a sharp edge over that of the formula, and what a wide pole adds per sqrt(x); and
decrease per x of the logarithm of what a dent takes of the moment."""
DISHED, LEAST_BALL = 3.0, 0.55
"""Force of a ball over flow stress, wall and depth, while it dishes a wall; and its least radius over the
width of that wall: smaller ones go between the webs."""
RISE = 0.15
"""Force of its first rise over Young's modulus, wall and depth."""
WEAKENS = 2.8
"""Decrease of the logarithm of the moment of a rectangular tube over the depth of a dent, over its own."""
SAMPLES = 41
"""Depths at which a force is given; they lie closer where it rises like a root."""
SHALLOWEST = 1e-5
"""Depth up to which a force is constant [m]: roots begin at zero."""
COMPARED_ROUND, COMPARED = 0.3, 0.5
"""Depth of a dent over that of its section, round or rectangular, up to which shells were compared."""
JAMMED, JAMS_WITHIN = 50.0, 1e-2
"""Factor on the force where walls meet, and in what share of the deepest dent they do."""


@dataclass(frozen=True, eq=False)
class Dent:
    """Force of a dent over its depth, straight between points, (n,).

    Attributes
    ----------
    depth, force
        [m], [N]; from the deepest dent on, walls meet.
    moves
        Mean displacement of the walls of the section at each depth [m].
    compared
        Depth up to which it was compared with shells [m].
    takes
        What the dent takes of the moment under this obstacle, over what it takes under a sharp edge [-].
    """

    depth: Floats
    force: Floats
    moves: Floats
    compared: float
    takes: float = 1.0

    def at(self, depth: Floats) -> Floats:
        """Force [N] at some depths [m]."""
        return np.interp(depth, self.depth, self.force)

    def absorbed(self, depth: Floats) -> Floats:
        """Work [J] up to some depths [m], not beyond the last point."""
        work = np.append(0.0, np.cumsum(np.diff(self.depth) * (self.force[1:] + self.force[:-1]) / 2.0))
        piece = np.clip(np.searchsorted(self.depth, depth) - 1, 0, self.depth.size - 2)
        into = depth - self.depth[piece]
        return np.asarray(work[piece] + into * (self.force[piece] + self.at(depth)) / 2.0)


class Cells(NamedTuple):
    """Cells of a tube along a force, and webs along it, inner ones by the square of their wall."""

    along: int
    webs: float


ONE_CELL = Cells(1, 2.0)


class Striker(NamedTuple):
    """Radius of the pole or ball that strikes a tube [m], and whether it is a ball."""

    radius: float
    is_ball: bool = False


def dent_of(
    section: CircularTube | RectangularTube,
    material: Material,
    depth: float,
    striker: Striker,
    cells: Cells = ONE_CELL,
) -> Dent:
    """Dent of a tube.

    Parameters
    ----------
    section, material
        Of the tube.
    depth
        Of the section along the force [m].
    striker
        What strikes it.
    cells
        Of a rectangular tube.
    """
    takes = 1.0
    stress, wall = material.flow_stress, section.thickness
    deepest = depth - (cells.along + 1.0) * wall
    depths = deepest * np.linspace(0.0, 1.0, SAMPLES) ** 2
    if isinstance(section, CircularTube):
        blunt = striker.radius * wall / depth**2
        forces = dent_force(np.maximum(depths, SHALLOWEST), wall, stress) * (SHARP + WIDER * math.sqrt(blunt))
        takes = math.exp(-FLATTER * blunt)
        moves = round_walls_move(depths, (depth - wall) / 2.0)
    else:
        width = section.width + section.depth - depth
        dish = min(dish_of(width, striker), deepest)
        into = np.maximum(depths - dish, SHALLOWEST)
        curve = np.hstack([CRUSHED, NEXT_CELL]) if cells.along > 1 else np.array(CRUSHED)
        folds = stress * wall**2 * np.interp(into * cells.along / depth, *curve)
        forces = np.minimum(RISE * material.youngs_modulus * wall * into, folds) * cells.webs / 2.0
        # a dish stays as strong as it was, at most as strong as webs that begin to fold
        dished = DISHED * wall * np.clip(depths, SHALLOWEST, dish) if dish > 0.0 else 0.0 * depths
        dished = stress * np.minimum(dished, CRUSHED[1][0] * wall**2 * cells.webs / 2.0)
        forces = np.where(depths < dish, dished, np.maximum(dished, forces))
        moves = depths * (width + depth / 2.0) / (2.0 * (width + depth))
    return Dent(
        np.append(depths, (1.0 + JAMS_WITHIN) * deepest),
        np.append(forces, JAMMED * forces[-1]),
        np.append(moves, moves[-1]),
        depth * (COMPARED_ROUND if isinstance(section, CircularTube) else COMPARED),
        takes,
    )


def dish_of(width: float, striker: Striker) -> float:
    """Depth [m] at which a ball meets the webs beside a wall of a width [m]; 0 of a pole."""
    ball = striker.radius
    return ball - math.sqrt(ball**2 - (width / 2.0) ** 2) if striker.is_ball else 0.0


def dent_force(depth: Floats, thickness: float, stress: float) -> Floats:
    """Formula for dents of some depths [m] in a round tube with a wall [m] and a flow stress [Pa]; [N]."""
    return 4.0 * stress * thickness * np.sqrt(2.0 * np.pi * thickness * depth / 3.0)


def denting_force(section: RectangularTube, material: Material) -> float:
    """Largest force [N] with which a pole dents a rectangular tube up to a twentieth of its depth."""
    return max(CRUSHED[1][:4]) * material.flow_stress * section.thickness**2


def left_by_dent(
    section: CircularTube | RectangularTube, dent: float, depth: float, takes: float = 1.0
) -> float:
    """Share of the plastic moment that a dent leaves.

    Parameters
    ----------
    section
        Of the tube.
    dent, depth
        Of the dent, at most to the middle, and of the section along the force [m].
    takes
        As in `Dent`.
    """
    if isinstance(section, RectangularTube):
        return math.exp(-WEAKENS * dent / depth)
    half_arc = math.acos(1.0 - 2.0 * dent / (depth - section.thickness))
    return 1.0 - takes * (1.0 - math.cos(half_arc / 2.0) + math.sin(half_arc) / 2.0)


def round_walls_move(depth: Floats, radius: float) -> Floats:
    """Mean displacement [m] of the middle line of a round tube of a mean radius [m] with dents [m]."""
    cosine = 1.0 - np.minimum(depth / radius, 2.0)
    half_arc = np.arccos(cosine)
    return np.asarray(radius / np.pi * (np.sin(half_arc) - half_arc * cosine))


def left_in_bending(
    section: CircularTube | RectangularTube,
    dent: Dent,
    depth: float,
    moment: float,
    spans: tuple[float, float],
    held: tuple[float, float],
) -> float:
    """Share of the plastic moment that is left where a force dents and bends a tube.

    Parameters
    ----------
    section, dent
        The tube, and its dent.
    depth
        Of the section along the force [m].
    moment
        Its plastic moment M_p [N m].
    spans
        Distances of the force from what holds the tube on both sides [m].
    held
        Share of M_p that is carried there, 0 to 1 each.

    Returns
    -------
    float
        That of a dent to the middle of the section, if the tube bends no earlier.
    """
    here = sum(1.0 / span for span in spans)
    there = sum(carries / span for carries, span in zip(held, spans, strict=True))

    def too_strong(deep: float) -> float:
        bends = moment * (left_by_dent(section, deep, depth, dent.takes) * here + there)
        return float(dent.at(np.asarray(deep))) - bends

    deepest = (depth - section.thickness) / 2.0
    return left_by_dent(section, rising_root(too_strong, 0.0, deepest, 0.0), depth, dent.takes)
