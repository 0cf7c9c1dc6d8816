"""Properties of a section of walls, for one metal or relative to a reference metal.

Area and second moments are those of the exact solid (mitred corners, arcs to order x^4 of half a chord's
angle, within 0.01 %).  Torsion constant, shear centre and warping are those of the mid-lines.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from crumple.numeric.arrays import Floats
from crumple.section.geometry.skeleton import Skeleton
from crumple.section.properties.polygons import moments
from crumple.section.properties.torsion import torsion_of
from crumple.section.wall import Point


@dataclass(frozen=True)
class SectionProperties:
    """Properties; with several metals every edge counts by its modulus over that of the reference.

    Attributes
    ----------
    area
        [m^2]
    centroid
        (y, z) in the coordinates of the walls [m].
    second_moment_y, second_moment_z, product_moment
        About axes through the centroid: of z^2, of y^2, of y z [m^4].
    principal_angle
        Direction of the axis of the largest second moment, from y towards z, in (-pi/2, pi/2] [rad].
    principal_moments
        Largest and smallest second moment [m^4].
    torsion_constant
        [m^4]
    shear_centre
        (y, z) from the centroid [m].
    warping_constant
        About the shear centre: of the mid-line and, in thin open walls that meet in one point the only part,
        across the walls [m^6].
    midline_warping_constant
        Of the mid-line alone, as tables give it [m^6].
    """

    area: float
    centroid: Point
    second_moment_y: float
    second_moment_z: float
    product_moment: float
    principal_angle: float
    principal_moments: tuple[float, float]
    torsion_constant: float
    shear_centre: Point
    warping_constant: float
    midline_warping_constant: float

    def second_moment(self, angle: float) -> float:
        """Second moment about the axis at an angle from y towards z [m^4]."""
        c, s = math.cos(angle), math.sin(angle)
        return c * c * self.second_moment_y + s * s * self.second_moment_z - 2.0 * s * c * self.product_moment


def properties_of(skeleton: Skeleton, stretch: Floats, shear: Floats) -> SectionProperties:
    """Properties from a graph.

    Parameters
    ----------
    skeleton
        Graph of the section.
    stretch, shear
        Young's and shear modulus of each edge over those of the reference metal, shape (m,); ones for the
        plain geometry.
    """
    parts = moments(skeleton.polygons - skeleton.middle)
    area, sy, sz, yy, zz, yz = (float(stretch @ part) for part in parts)
    y, z = sy / area, sz / area
    iy, iz, iyz = zz - area * z * z, yy - area * y * y, yz - area * y * z
    middle, radius = (iy + iz) / 2.0, math.hypot((iy - iz) / 2.0, iyz)
    # equal within rounding: every axis is principal, y as good as any
    angle = math.atan2(-2.0 * iyz, iy - iz) / 2.0 if radius > 1e-9 * middle else 0.0
    torsion = torsion_of(skeleton, stretch, shear)
    centroid = skeleton.middle + complex(y, z)
    shear_centre = torsion.shear_centre - centroid
    return SectionProperties(
        area,
        (centroid.real, centroid.imag),
        iy,
        iz,
        iyz,
        angle if angle > -math.pi / 2.0 + 1e-9 else angle + math.pi,
        (middle + radius, middle - radius),
        torsion.constant,
        (shear_centre.real, shear_centre.imag),
        torsion.warping_constant + torsion.wall_warping_constant,
        torsion.warping_constant,
    )
