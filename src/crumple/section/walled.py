"""A section made of walls: everything that `Section` offers, and properties of its walls."""

from __future__ import annotations

import math
from functools import cached_property
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from crumple.errors import InputError, Problem
from crumple.numeric.arrays import Floats
from crumple.section.geometry.assembly import skeleton_of
from crumple.section.geometry.plates import plates_of
from crumple.section.geometry.skeleton import Complexes, Skeleton
from crumple.section.properties.polygons import above, equal_level
from crumple.section.properties.properties import SectionProperties, properties_of
from crumple.section.properties.shear_area import shear_area_of
from crumple.section.section import Axis, ByAxis, checked_axis, in_mm
from crumple.section.wall import Wall, Weld

if TYPE_CHECKING:
    from crumple.material import Material

# Width over thickness of a flat above which plate formulas are not confirmed by tests.
SLENDER_HELD, SLENDER_FREE = 500.0, 60.0


class WalledSection(ByAxis):
    """Base of sections that consist of walls; a subclass is a frozen dataclass with ``kind`` and `walls`.

    The origin of the `Section` methods is the centroid.  Axes may be "y", "z" or an angle from y towards z
    [rad].  Bending about an axis that is not principal means: curvature about that axis alone, as in a member
    whose neighbours hold it.

    Raises
    ------
    InputError
        With everything that is wrong with the walls.
    """

    kind: ClassVar[str] = "walls"

    def __post_init__(self) -> None:
        # refuse at once what cannot be a section
        _ = self.skeleton

    if TYPE_CHECKING:
        # fields in one subclass, worked out from dimensions in the others
        @property
        def walls(self) -> tuple[Wall, ...]:
            """The walls; coordinates of the section's own description."""
            ...

        @property
        def thickness(self) -> float:
            """Wall thickness [m]."""
            ...

    @property
    def welds(self) -> tuple[Weld, ...]:
        """Lines of spot welds."""
        return ()

    @property
    def title(self) -> str:
        """One line for people."""
        return f"section of {len(self.walls)} walls"

    @cached_property
    def skeleton(self) -> Skeleton:
        """Graph of the walls in the coordinates of `walls`."""
        return skeleton_of(self.walls, self.welds)

    @cached_property
    def properties(self) -> SectionProperties:
        """Properties of the plain geometry, whatever the metals."""
        ones = np.ones(len(self.skeleton.pieces))
        return properties_of(self.skeleton, ones, ones)

    def transformed(self, material: Material) -> SectionProperties:
        """Properties in which walls of other metals count by their moduli over those of a material."""
        return properties_of(self.skeleton, *self._relative_moduli(material))

    def _relative_moduli(self, material: Material) -> tuple[Floats, Floats]:
        """Young's and shear modulus of each edge over those of a material."""
        metals = self.metals(material)
        stretch = np.array([metal.youngs_modulus for metal in metals]) / material.youngs_modulus
        shear = np.array([metal.shear_modulus for metal in metals]) / material.shear_modulus
        return stretch, shear

    def metals(self, material: Material) -> list[Material]:
        """Metal of each edge of the skeleton; ``material`` where the wall names none."""
        own = [wall.material or material for wall in self.walls]
        return [own[number] if number >= 0 else material for number in self.skeleton.wall.tolist()]

    @cached_property
    def warnings(self) -> tuple[str, ...]:
        """Sentences on walls outside the range in which plate formulas were tested."""
        sentences = []
        for plate in plates_of(self.walls, self.skeleton):
            limit = SLENDER_HELD if plate.held == 2 else SLENDER_FREE
            if plate.width > limit * plate.thickness:
                edges = "both edges supported" if plate.held == 2 else "one edge free"
                sentences.append(
                    f"{plate.name}: a flat of {in_mm(plate.width)} is {plate.width / plate.thickness:.0f} "
                    f"times as wide as thick, with {edges}; plate formulas are supported up to {limit:g}"
                )
        return tuple(sentences)

    @property
    def area(self) -> float:
        """Area of the metal [m^2], exact."""
        return self.properties.area

    @property
    def torsion_constant(self) -> float:
        """Torsion constant of the mid-lines [m^4]: cells by Bredt, and L t^3/3 of every wall."""
        return self.properties.torsion_constant

    @property
    def warping_constant(self) -> float:
        """Warping constant about the shear centre [m^6]."""
        return self.properties.warping_constant

    @property
    def shear_centre(self) -> tuple[float, float]:
        """Shear centre (y, z) from the centroid [m], of the mid-lines."""
        return self.properties.shear_centre

    def shear_area(self, axis: Axis | float, material: Material) -> float:
        """Shear area for bending about an axis [m^2], of the mid-lines; other metals by their moduli."""
        stretch, shear = self._relative_moduli(material)
        return shear_area_of(self.skeleton, stretch, shear, angle_of(axis))

    def second_moment(self, axis: Axis | float) -> float:
        """Second moment of area about an axis through the centroid [m^4], exact."""
        return self.properties.second_moment(angle_of(axis))

    def elastic_section_modulus(self, axis: Axis | float) -> float:
        """Second moment over the distance of the extreme fibre [m^3]."""
        return self.second_moment(axis) / max(self.extent(axis))

    def plastic_section_modulus(self, axis: Axis | float) -> float:
        """Sum of the absolute first moments on both sides of the equal-area axis [m^3], exact."""
        angle, polygons = angle_of(axis), self.centred_polygons
        ones = np.ones(len(polygons))
        level = equal_level(polygons, ones, angle, self.area / 2.0)
        # about the centroid the parts above and below have opposite first moments
        part = above(polygons, np.array([angle]), np.array([level]))
        return 2.0 * float(part.height.sum())

    def extent(self, axis: Axis | float) -> tuple[float, float]:
        """How far the metal reaches from the centroid on the two sides of an axis [m].

        First the side that positive bending stretches: +z for y, -y for z.
        """
        turn = np.exp(-1j * angle_of(axis))
        heights = [(self.surface * turn).imag]
        rays, centres, radii = self._arcs
        if centres.size:
            # an arc reaches furthest where its normal stands on the axis, if that lies between its ends
            for up in (1j / turn, -1j / turn):
                within = ((rays[:, 0].conj() * up).imag * (rays[:, 1].conj() * up).imag <= 0.0) & (
                    (rays.sum(axis=1).conj() * up).real > 0.0
                )
                heights.append(((centres + radii * up) * turn).imag[within])
        height = np.concatenate(heights)
        return float(height.max()), float(-height.min())

    @cached_property
    def _arcs(self) -> tuple[Complexes, Complexes, Floats]:
        """Of each arc the unit rays to its ends, its centre and its outer radius."""
        arcs = [piece for piece in self.skeleton.pieces if piece.radius]
        ends = [[(point - arc.centre) / arc.radius for point in (arc.start, arc.end)] for arc in arcs]
        centres = np.array([arc.centre for arc in arcs], complex)
        radii = np.array([arc.radius + arc.thickness / 2.0 for arc in arcs])
        return np.array(ends, complex).reshape(-1, 2), centres - self._centroid, radii

    def flange_width(self, axis: Axis | float) -> float:
        """Outer width along an axis [m]."""
        return sum(self.extent(angle_of(axis) - math.pi / 2.0))

    def bending_depth(self, axis: Axis | float) -> float:
        """Outer depth across an axis [m]."""
        return sum(self.extent(axis))

    def mass_per_length(self, density: float) -> float:
        """Mass per length [kg/m]; a density [kg/m^3] for the walls that name no metal."""
        own = [wall.material.density if wall.material else density for wall in self.walls]
        each = np.array([own[number] if number >= 0 else 0.0 for number in self.skeleton.wall.tolist()])
        return float(each @ self.skeleton_areas)

    def outline(self) -> Floats:
        """Mid-line (y, z) [m], shape (n, 2): once around, so open walls are passed on both sides."""
        skeleton = self.skeleton
        face = min(skeleton.faces, key=lambda one: sum((0.5 - (h & 1)) * skeleton.sweep[h >> 1] for h in one))
        nodes = [skeleton.nodes[skeleton.ends[half >> 1, half & 1]] for half in face]
        return _pairs(np.array(nodes)[::-1] - self._centroid)

    def outer_outline(self) -> Floats:
        """Polygon of the outer surface (y, z) [m], shape (n, 2); welded sheets show as slits."""
        return _pairs(self.skeleton.contours[0] - self._centroid)

    def inner_outlines(self) -> list[Floats]:
        """Polygons of the surfaces of the cells (y, z) [m], counter-clockwise."""
        return [_pairs(contour - self._centroid) for contour in self.skeleton.contours[1:]]

    def inner_outline(self) -> Floats:
        """Polygon of the surface of the largest cell, or no points, shape (n, 2)."""
        outlines = self.inner_outlines()
        return max(outlines, key=_enclosed) if outlines else np.empty((0, 2))

    @cached_property
    def centred_polygons(self) -> Complexes:
        """Metal of each edge about the centroid, shape (m, k), complex y + i z [m]."""
        return np.asarray(self.skeleton.polygons - self._centroid)

    @cached_property
    def skeleton_areas(self) -> Floats:
        """Area of metal of each edge [m^2], shape (m,)."""
        following = np.roll(self.centred_polygons, -1, axis=1)
        return np.asarray((self.centred_polygons.conj() * following).imag.sum(axis=1) / 2.0)

    @cached_property
    def surface(self) -> Complexes:
        """All corner points of the surface about the centroid, complex [m]."""
        return np.concatenate(self.skeleton.contours) - self._centroid

    @property
    def _centroid(self) -> complex:
        return complex(*self.properties.centroid)


def angle_of(axis: Axis | float) -> float:
    """Angle of an axis from y towards z [rad].

    Raises
    ------
    InputError
        If it is a name that is neither "y" nor "z", or an angle that is not finite.
    """
    if isinstance(axis, str):
        return 0.0 if checked_axis(axis) == "y" else math.pi / 2.0
    if not math.isfinite(axis):
        raise InputError(Problem("the angle of the axis is not finite", f"{axis:g} rad", "an angle"))
    return float(axis)


def _pairs(points: Complexes) -> Floats:
    return np.column_stack([points.real, points.imag])


def _enclosed(outline: Floats) -> float:
    y, z = outline.T
    return float(y @ np.roll(z, -1) - z @ np.roll(y, -1)) / 2.0
