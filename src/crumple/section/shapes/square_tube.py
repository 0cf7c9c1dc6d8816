"""Rectangular tube with equal sides."""

from __future__ import annotations

from crumple.registry.quantity import NonNegativeLength, PositiveLength
from crumple.section.shapes.rectangular_tube import RectangularTube
from crumple.section.shapes.shape import Example, Shape


def square_tube(
    side: PositiveLength, thickness: PositiveLength, corner_radius: NonNegativeLength = 0.0
) -> RectangularTube:
    """Square tube.

    Parameters
    ----------
    side
        Outer dimension along local y and z [m].
    thickness
        Wall thickness, less than half the side [m].
    corner_radius
        Outer corner radius [m].
    """
    return RectangularTube(side, side, thickness, corner_radius)


SHAPE = Shape(square_tube, (Example("40x2 mm"),))
