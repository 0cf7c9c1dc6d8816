"""Largest bending moment of any section of walls: plates that buckle, axial force, both senses.

Unknown: M at given N, curvature about a held axis.  Three values lie side by side, all about the centroid
of the whole metal, tension positive, positive sense stretching the side of positive height:

    elastic     linear stress, first fibre at yield, no buckling
    plastic     every fibre at yield, sigma = sigma_y sign(height - c)
    effective   linear stress, first fibre at yield, of plates only what buckling leaves at that stress

The line of stress is swept from all compressed to all stretched, one edge always at yield; the axial force
grows along the sweep, and bisection finds the given one: that is the iterated neutral axis.  With r the
smallest buckling stress over compression among the plates,

    M = M_effective + (M_plastic - M_effective) g,     g = 0 for r <= 1,  r - 1,  1 for r >= 2

which is continuous, since no plate is reduced where r >= 2.21.  Limits: stout walls give the plastic moment,
slender ones the effective one.  Not here: bends that move (lips, distortion of open sections), lateral
buckling of the member, curved walls (taken as not buckling), the pitch of spot welds.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from crumple.errors import InputError, Problem
from crumple.material import Material
from crumple.numeric.arrays import Floats
from crumple.numeric.monotone_root import rising_root
from crumple.section.capacity.buckling import Carried, held_plate, outstand
from crumple.section.geometry.plates import Plate, plates_of
from crumple.section.properties.polygons import above, equal_level, moments
from crumple.section.section import Axis, Section
from crumple.section.wall_section import walls_of
from crumple.section.walled import WalledSection, angle_of

BASIS = (
    "effective widths of the cold-formed steel rules as widely quoted, the standards themselves not read; "
    "their buckling coefficients checked by Rayleigh-Ritz; plastic and elastic moments exact; "
    "the step between proposed here"
)


@dataclass(frozen=True)
class LostPart:
    """Part of a plate that buckling relieves: its name, and its ends (y, z) in the walls' coordinates [m]."""

    plate: str
    start: tuple[float, float]
    end: tuple[float, float]


@dataclass(frozen=True)
class MomentCapacity:
    """Largest moment of a section in one sense about one axis, and how it came about.

    Attributes
    ----------
    moment
        [N m], in the requested sense; negative if the axial force alone bends further than that.
    elastic_moment, plastic_moment, effective_moment
        First yield without buckling, full plasticity, first yield with effective widths [N m].
    cross_moment
        About the axis a quarter turn on (z for y), needed to hold the curvature to the axis, at the effective
        moment [N m].
    buckling_ratio
        Smallest buckling stress over compression among the plates, infinite where none is compressed.
    governing
        That plate; empty where none is compressed.
    lost
        Parts of plates that carry nothing at the effective moment.
    neutral_axis
        Height of no stress over the centroid at the effective moment [m].
    axis, sense, axial_force
        As requested: angle from y towards z [rad], +1 or -1, tension positive [N].
    warnings
        What the formulas do not cover in this section.
    basis
        Where the rules come from.
    """

    moment: float
    elastic_moment: float
    plastic_moment: float
    effective_moment: float
    cross_moment: float
    buckling_ratio: float
    governing: str
    lost: tuple[LostPart, ...]
    neutral_axis: float
    axis: float
    sense: int
    axial_force: float
    warnings: tuple[str, ...] = ()
    basis: str = BASIS

    @property
    def regime(self) -> str:
        """How the moment came about, in words."""
        if self.buckling_ratio >= 2.0:
            return "plastic: no plate buckles before the whole section yields"
        if self.buckling_ratio <= 1.0:
            return f"effective: {self.governing} buckles before yield"
        return f"between effective and plastic: {self.governing} buckles near yield"


def moment_capacity(
    section: Section,
    material: Material,
    axis: Axis | float = "y",
    *,
    sense: int = 1,
    axial_force: float = 0.0,
) -> MomentCapacity:
    """Largest bending moment about an axis.

    Parameters
    ----------
    section
        Tube or section of walls.
    material
        Metal of the walls that name none: moduli and yield stress are used.
    axis
        "y", "z" or an angle from y towards z [rad]: direction of the moment vector and of the curvature.
    sense
        +1 stretches the side of positive height z cos(angle) - y sin(angle), -1 the other one.
    axial_force
        At the centroid, tension positive [N].

    Returns
    -------
    MomentCapacity
        Moment with the values that led to it.

    Raises
    ------
    InputError
        If the axial force is more than the section carries, or the sense is neither +1 nor -1.

    References
    ----------
    docs/theory/moment_capacity.md.  Verified in tests/verification/section/test_section_moment_capacity.py.
    """
    if sense not in (1, -1):
        raise InputError(Problem("the sense is neither +1 nor -1", f"{sense!r}", "1 or -1", "", "sense"))
    walled = walls_of(section)
    angle = angle_of(axis)
    bending = _Bending(walled, material, angle if sense > 0 else angle + math.pi)
    low, high = bending.state(0.0, buckling=True).force, bending.state(2.0, buckling=True).force
    if not low <= axial_force <= high:
        raise InputError(
            Problem(
                "the axial force is more than the section carries",
                f"{axial_force:.6g} N",
                f"{low:.6g} N (compression) to {high:.6g} N (tension)",
                "give a smaller force or a larger section",
                "axial_force",
            )
        )
    effective = bending.at_force(axial_force, buckling=True)
    elastic = bending.at_force(axial_force, buckling=False)
    plastic = bending.plastic_moment(axial_force)
    share = min(max(effective.ratio - 1.0, 0.0), 1.0)
    slope = effective.slope
    return MomentCapacity(
        effective.moment + (plastic - effective.moment) * share,
        elastic.moment,
        plastic,
        effective.moment,
        effective.cross * (1.0 if sense > 0 else -1.0),
        effective.ratio,
        effective.governing,
        effective.lost,
        math.copysign(1.0, sense) * -effective.middle / slope if slope else math.inf,
        angle,
        sense,
        axial_force,
        (*walled.warnings, *_open_warnings(walled, bending.plates)),
    )


def _open_warnings(section: WalledSection, plates: list[Plate]) -> list[str]:
    sentences = []
    if not section.skeleton.cells:
        sentences.append("open section: it may distort or buckle laterally before it reaches this moment")
    if any(plate.held == 0 for plate in plates):
        sentences.append("a flat without support by another wall: its buckling as a member is not checked")
    arcs = [piece for piece in section.skeleton.pieces if piece.radius > 10.0 * piece.thickness]
    if arcs:
        slender = max(arc.radius / arc.thickness for arc in arcs)
        sentences.append(f"curved walls (radius up to {slender:.0f} thicknesses) are assumed not to buckle")
    return sentences


class _State(NamedTuple):
    """A linear stress and its resultants: middle + slope * height [Pa, Pa/m] in the reference metal."""

    force: float
    moment: float
    cross: float
    middle: float
    slope: float
    ratio: float = math.inf
    governing: str = ""
    lost: tuple[LostPart, ...] = ()


class _Bending:
    """A section turned so that it bends about the horizontal, stretched above."""

    def __init__(self, section: WalledSection, material: Material, angle: float) -> None:
        self.section, self.angle = section, angle
        self.metals = section.metals(material)
        self.stretch = np.array([metal.youngs_modulus for metal in self.metals]) / material.youngs_modulus
        self.yields = np.array([metal.yield_stress for metal in self.metals])
        self.turn = complex(math.cos(angle), -math.sin(angle))
        self.polygons = section.centred_polygons * self.turn
        self.top, self.bottom = section.extent(angle)
        self.plates = plates_of(section.walls, section.skeleton)

    @cached_property
    def _sums(self) -> tuple[float, float, float, float, float]:
        """Weighted integrals of 1, h, h^2, u, u h, with u along and h across the axis."""
        parts = moments(self.polygons)
        pick = (parts.area, parts.z, parts.zz, parts.y, parts.yz)
        area, h, hh, u, uh = (float(self.stretch @ part) for part in pick)
        return area, h, hh, u, uh

    @cached_property
    def _reach(self) -> tuple[Floats, Floats]:
        """Lowest and highest height of each edge [m]; welds have no metal and bound nothing."""
        height = np.clip(self.polygons.imag, -self.bottom, self.top)
        return height.min(axis=1), height.max(axis=1)

    @cached_property
    def _ends(self) -> list[tuple[float, float, float, float]]:
        """Of each plate: place along and height of its two ends [m]."""
        centre = complex(*self.section.properties.centroid)
        turned = [((p.start - centre) * self.turn, (p.end - centre) * self.turn) for p in self.plates]
        return [(a.real, a.imag, b.real, b.imag) for a, b in turned]

    def state(self, sweep: float, *, buckling: bool) -> _State:
        """One edge at yield: 0 all compressed, 1 bent with both edges at yield, 2 all stretched."""
        bottom, top = (-1.0, 2.0 * sweep - 1.0) if sweep <= 1.0 else (2.0 * sweep - 3.0, 1.0)
        slope = (top - bottom) / (self.top + self.bottom)
        middle = bottom + slope * self.bottom
        scale = self._scale(middle, slope, {})
        middle, slope = middle * scale, slope * scale
        carried: list[Carried] = []
        # a free edge that buckling takes away does not yield: what is left is brought to yield, twice
        for _ in range(2 if buckling else 0):
            carried = [
                self._carried(*pair, middle, slope) for pair in zip(self.plates, self._ends, strict=True)
            ]
            scale = self._scale(middle, slope, self._cut_edges(carried))
            middle, slope = middle * scale, slope * scale
        area, h, hh, u, uh = self._sums
        whole = _State(
            middle * area + slope * h, middle * h + slope * hh, middle * u + slope * uh, middle, slope
        )
        return self._without_lost(whole, carried) if buckling else whole

    def _scale(self, middle: float, slope: float, cut: dict[int, tuple[float, float]]) -> float:
        """Factor on a line of stress that brings the first fibre to yield; of cut edges only what is left."""
        low, high = self._reach
        if cut:
            low, high = low.copy(), high.copy()
            for edge, (lower, upper) in cut.items():
                low[edge], high[edge] = max(low[edge], lower), min(high[edge], upper)
        stress = np.maximum(np.abs(middle + slope * low), np.abs(middle + slope * high))
        return 1.0 / float((stress / self._limit)[high >= low].max())

    @cached_property
    def _limit(self) -> Floats:
        """Stress of the reference metal at which each edge yields [Pa], infinite for welds."""
        metal = self.section.skeleton.thickness > 0.0
        return np.where(metal, self.yields / self.stretch, np.inf)

    def _cut_edges(self, carried: list[Carried]) -> dict[int, tuple[float, float]]:
        """Heights between which edges remain whose free end buckling takes away; crossed if nothing does."""
        cut = {}
        for plate, (u0, h0, u1, h1), part in zip(self.plates, self._ends, carried, strict=True):
            if part.end <= part.start or part.end < plate.width or plate.held != 1:
                continue
            beside = abs(u1 - u0) / plate.width * plate.thickness / 2.0
            left = h0 + (h1 - h0) * part.start / plate.width
            for k, edge in enumerate(plate.edges):
                if plate.stops[k] >= part.start:
                    cut[edge] = (math.inf, -math.inf)
                elif plate.stops[k + 1] > part.start:
                    cut[edge] = (min(h0, left) - beside, max(h0, left) + beside)
        return cut

    def _without_lost(self, state: _State, carried: list[Carried]) -> _State:
        force, moment, cross, middle, slope, ratio, governing, _ = state
        lost = []
        for plate, ends, part in zip(self.plates, self._ends, carried, strict=True):
            if part.ratio < ratio:
                ratio, governing = part.ratio, plate.name
            if part.end <= part.start:
                continue
            for n, m, c in self._strips(plate, ends, part, middle, slope):
                force, moment, cross = force - n, moment - m, cross - c
            along = (plate.end - plate.start) / plate.width
            points = [plate.start + along * distance for distance in (part.start, part.end)]
            lost.append(LostPart(plate.name, *((point.real, point.imag) for point in points)))
        return _State(force, moment, cross, middle, slope, ratio, governing, tuple(lost))

    def _carried(
        self, plate: Plate, ends: tuple[float, float, float, float], middle: float, slope: float
    ) -> Carried:
        if plate.held == 0:
            return Carried(math.inf, 0.0, 0.0)
        factor = float(self.stretch[plate.edges[0]])
        metal = self.metals[plate.edges[0]]
        first, last = (-factor * (middle + slope * height) for height in (ends[1], ends[3]))
        # beyond a cut edge the line of stress passes yield: the plate itself does not
        most = min(1.0, metal.yield_stress / max(first, last, 1e-300))
        first, last = most * first, most * last
        reduce = held_plate if plate.held == 2 else outstand
        return reduce(plate.width, plate.thickness, first, last, metal)

    def _strips(
        self,
        plate: Plate,
        ends: tuple[float, float, float, float],
        carried: Carried,
        middle: float,
        slope: float,
    ) -> list[tuple[float, float, float]]:
        """Force, moment and cross moment of the parts that buckling takes away."""
        u0, h0, u1, h1 = ends
        du, dh = (u1 - u0) / plate.width, (h1 - h0) / plate.width
        strips = []
        for k, edge in enumerate(plate.edges):
            start, end = max(carried.start, plate.stops[k]), min(carried.end, plate.stops[k + 1])
            if end <= start:
                continue
            t, length, at = float(self.section.skeleton.thickness[edge]), end - start, (start + end) / 2.0
            u, h, area = u0 + du * at, h0 + dh * at, t * length * float(self.stretch[edge])
            hh = h * h + (dh * length) ** 2 / 12.0 + (du * t) ** 2 / 12.0
            uh = u * h + du * dh * (length * length - t * t) / 12.0
            strips.append(
                (
                    area * (middle + slope * h),
                    area * (middle * h + slope * hh),
                    area * (middle * u + slope * uh),
                )
            )
        return strips

    def at_force(self, force: float, *, buckling: bool) -> _State:
        """Line of stress that carries an axial force, by bisection of the sweep."""
        total = float(self.yields @ self.section.skeleton_areas)

        def missing(sweep: float) -> float:
            return self.state(sweep, buckling=buckling).force - force

        return self.state(rising_root(missing, 0.0, 2.0, 1e-13 * total), buckling=buckling)

    def plastic_moment(self, force: float) -> float:
        """Moment with every fibre at yield at an axial force."""
        total = float(self.yields @ self.section.skeleton_areas)
        level = equal_level(self.polygons, self.yields, 0.0, (total + force) / 2.0)
        part = above(self.polygons, np.zeros(1), np.array([level])).height[0]
        return float(self.yields @ (2.0 * part - moments(self.polygons).z))
