"""What the cross-section is: outline of walls and the properties that follow from it."""

from crumple.section.circular_tube import CircularTube
from crumple.section.fold import half_fold_length
from crumple.section.rectangular_tube import RectangularTube
from crumple.section.section import AXES, Axis, Section

__all__ = ["AXES", "Axis", "CircularTube", "RectangularTube", "Section", "half_fold_length"]
