"""Sections of flat plates, any shape and axis: compressed plates fold, the section stays plane.

Unknown: M(theta).  The two halves turn about the line of no stress at the height c.  What lies above yields
in tension.  Of a compressed fibre at the distance d = c - z a plate of thickness t carries the share n of its
yield force; w is the width of the plate that is compressed,

    n = sqrt(1 + k^2) - k,      k = k_0 + (theta d w (s_y/(e_1 E))^q/(S t^2))^p,

    k_0 = c_b (1 - n_b^2)/(2 n_b),      S = sum of S_e over its two edges.

n is that of a strip with three hinge lines, whose k is its bow over its thickness; the bow of a strip of
length w that is shortened by theta d grows as sqrt(theta d w), which is p = 1/2.  n_b is the share that
buckling leaves at yield (effective width), in the stress of the section that has not folded.  S_e stands for
how an edge holds the plate: free (0), a bend to a plate that has a free edge itself, a bend to another one,
a junction of three or more.  c follows from no axial force, M is the moment of the stresses.

S_e, p, c_b and q are fitted to shells: docs/theory/folded_plates.md.  Limits: theta -> 0 without buckling is
the plastic moment; n -> 0 leaves the plates above c.  Force falls as c grows, so that c is unique.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from crumple.material import Material
from crumple.numeric.arrays import Floats
from crumple.section.capacity.buckling import (
    held_coefficient,
    outstand_coefficient,
    plate_stress,
    width_factor,
)
from crumple.section.capacity.capacity import moment_capacity
from crumple.section.geometry.assembly import skeleton_of
from crumple.section.geometry.plates import Plate, plates_of
from crumple.section.geometry.skeleton import Skeleton
from crumple.section.walled import WalledSection

YIELD_STRAIN = 1.5e-3
"""e_1 [-]."""
FLAT = 1e-6
"""Difference of the heights of its edges over the width of a plate up to which it lies along the axis."""
_HALVINGS = 40
_POINTS, _WEIGHTS = np.polynomial.legendre.leggauss(10)
_PLACES, _PARTS = 0.5 * (1.0 + _POINTS), 0.5 * _WEIGHTS


class Constants(NamedTuple):
    """Fitted constants [-].

    S_e of bends to plates with a free edge, of other bends and of junctions; p of plates that both edges
    hold, and of others; c_b and q.
    """

    lip: float
    bend: float
    junction: float
    power: float
    free_power: float
    buckling: float
    strain: float


class Strip(NamedTuple):
    """A plate.

    Heights of its lower and upper edge [m], width [m], yield force [N], S t^2/(s_y/(e_1 E))^q [m^2], p and
    k_0 [-].
    """

    low: float
    high: float
    width: float
    force: float
    stout: float
    power: float
    bowed: float


@dataclass(frozen=True)
class FoldingPlates:
    """Plates of a section that bends with its lower side in compression.

    Attributes
    ----------
    strips
        Its plates; none if the walls are curved, or a single one lies along the axis.

    References
    ----------
    Derived here, constants fitted to shells.  docs/theory/folded_plates.md.
    Verified in tests/verification/profiles/test_folded_plates.py.
    """

    strips: tuple[Strip, ...]

    @classmethod
    def of(
        cls, section: WalledSection, material: Material, angle: float, constants: Constants, *, flows: bool
    ) -> FoldingPlates:
        """Plates of a section.

        Parameters
        ----------
        section, material
            Walls, and the metal of those without one of their own.
        angle
            Of the axis from y towards z [rad]; the side of negative height z cos - y sin is compressed.
        constants
            Fitted ones.
        flows
            Whether the metal is at its flow stress, as in folds; otherwise at yield.
        """
        walls = tuple(replace(wall, corner_radius=0.0) for wall in section.walls)
        skeleton = skeleton_of(walls, section.welds)
        plates = plates_of(walls, skeleton)
        metals = [
            wall.material or material for wall in (walls[skeleton.wall[one.edges[0]]] for one in plates)
        ]
        turn = complex(np.cos(angle), -np.sin(angle))
        ends = [_heights(one, turn) for one in plates]
        if len({height for pair in ends for height in pair}) < 2:
            return cls(())
        stresses = [one.flow_stress if flows else one.yield_stress for one in metals]
        areas = [one.width * one.thickness for one in plates]
        yields = [one.yield_stress * area for one, area in zip(metals, areas, strict=True)]
        neutral, plastic = _without_folds(ends, yields)
        # corners that are round, and walls that are not thin
        exact = moment_capacity(section, material, angle).plastic_moment / plastic
        strips = []
        for plate, pair, metal, stress, area in zip(plates, ends, metals, stresses, areas, strict=True):
            held = _held(plate, plates, skeleton, constants)
            strips.append(_strip(plate, pair, (exact * stress * area, held), metal, constants, neutral))
        return cls(tuple(sorted(strips)))

    def moment(self, rotation: Floats) -> Floats:
        """Moment [N m] at rotations [rad], shape (n,)."""
        low = np.full(rotation.shape, min(strip.low for strip in self.strips))
        high = np.full(rotation.shape, max(strip.high for strip in self.strips))
        for _ in range(_HALVINGS):
            middle = 0.5 * (low + high)
            stretched = self._forces(rotation, middle)[0] > 0.0
            low, high = np.where(stretched, middle, low), np.where(stretched, high, middle)
        return self._forces(rotation, 0.5 * (low + high))[1]

    def _forces(self, rotation: Floats, neutral: Floats) -> tuple[Floats, Floats]:
        """Axial force [N] and moment about the line of no stress [N m]."""
        force, moment = np.zeros_like(neutral), np.zeros_like(neutral)
        for strip in self.strips:
            span = strip.high - strip.low
            if span <= 0.0:
                depth = neutral - strip.low
                bow = rotation * np.maximum(depth, 0.0) * (strip.width / strip.stout)
                own = strip.force * np.where(depth > 0.0, -_left(strip.bowed + bow**strip.power), 1.0)
                force, moment = force + own, moment - own * depth
                continue
            cut = np.clip(neutral, strip.low, strip.high)
            above, below = (strip.high - cut) / span, (cut - strip.low) / span
            depths = neutral[:, None] - strip.low - (cut - strip.low)[:, None] * _PLACES
            bow = rotation * below * (strip.width / strip.stout)
            left = _left(strip.bowed + (bow[:, None] * np.maximum(depths, 0.0)) ** strip.power) * _PARTS
            force = force + strip.force * (above - below * left.sum(axis=1))
            arms = above * (0.5 * (cut + strip.high) - neutral) + below * (left * depths).sum(axis=1)
            moment = moment + strip.force * arms
        return force, moment


def _heights(plate: Plate, turn: complex) -> tuple[float, float]:
    """Heights of its start and end [m]; those of a plate along the axis differ by rounding alone."""
    first, last = (plate.start * turn).imag, (plate.end * turn).imag
    return (first, last) if abs(first - last) > FLAT * plate.width else (first, first)


def _strip(
    plate: Plate,
    ends: tuple[float, float],
    strengths: tuple[float, float],
    metal: Material,
    constants: Constants,
    neutral: float,
) -> Strip:
    force, held = strengths
    low, high = sorted(ends)
    strain = metal.yield_stress / (YIELD_STRAIN * metal.youngs_modulus)
    stout = held * plate.thickness**2 / strain**constants.strain
    bowed = constants.buckling * _bowed(plate, ends, metal, neutral)
    power = constants.power if plate.held == 2 else constants.free_power
    return Strip(low, high, plate.width, force, stout, power, bowed)


def _bowed(plate: Plate, ends: tuple[float, float], metal: Material, neutral: float) -> float:
    """Return k_0, which leaves what buckling does with stress linear from a line of no stress."""
    pressed = [neutral - height for height in ends]
    if max(pressed) <= 0.0 or plate.held == 0:
        return 0.0
    ratio = min(pressed) / max(pressed)
    if plate.held == 2:
        coefficient = held_coefficient(ratio)
    else:
        coefficient = outstand_coefficient(ratio, at_free_edge=pressed[1] >= pressed[0])
    stress = plate_stress(coefficient, plate.width, plate.thickness, metal)
    left = width_factor(stress / metal.yield_stress)
    return (1.0 - left**2) / (2.0 * left)


def _held(plate: Plate, plates: Sequence[Plate], skeleton: Skeleton, constants: Constants) -> float:
    """S of a plate; infinite of one that no other wall holds."""
    if plate.held == 0:
        return np.inf
    total = 0.0
    for end in (plate.start, plate.end):
        node = int(np.argmin(np.abs(skeleton.nodes - end)))
        others = [
            one for one in plates if one is not plate and min(abs(one.start - end), abs(one.end - end)) < 1e-9
        ]
        count = len(skeleton.stars[node])
        if count > 2:
            total += constants.junction
        elif count == 2:
            total += constants.lip if any(one.held == 1 for one in others) else constants.bend
    return total


def _without_folds(ends: Sequence[tuple[float, float]], forces: Sequence[float]) -> tuple[float, float]:
    """Height that halves the yield force [m], and the plastic moment about it [N m]."""
    at = np.array([sorted(pair) for pair in ends])
    span = np.maximum(at[:, 1] - at[:, 0], 1e-9 * np.ptp(at))
    force = np.array(forces)
    low, high = float(at.min()), float(at.max())
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        below = float(force @ np.clip((middle - at[:, 0]) / span, 0.0, 1.0))
        low, high = (middle, high) if below < 0.5 * float(force.sum()) else (low, middle)
    middle = 0.5 * (low + high)
    cut = np.clip(middle, at[:, 0], at[:, 1])
    arms = (at[:, 1] - cut) * (at[:, 1] + cut - 2.0 * middle) + (cut - at[:, 0]) * (
        2.0 * middle - cut - at[:, 0]
    )
    flat = np.abs(at[:, 0] - middle)
    return middle, float(force @ np.where(at[:, 1] > at[:, 0], arms / (2.0 * span), flat))


def _left(bow: Floats) -> Floats:
    """Share of its yield force that a strip carries whose k is given."""
    return np.asarray(1.0 / (np.sqrt(1.0 + bow**2) + bow))
