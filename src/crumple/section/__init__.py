"""What the cross-section is: its walls, and the properties, capacities and interaction that follow from them.

The names of sections made of walls are looked up on first access: tubes need none of them.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from crumple.section.fold import half_fold_length
from crumple.section.section import AXES, Axis, Section
from crumple.section.shapes.circular_tube import CircularTube
from crumple.section.shapes.rectangular_tube import RectangularTube

if TYPE_CHECKING:
    from crumple.section.capacity.bending_curve import bending_moment
    from crumple.section.capacity.capacity import MomentCapacity, moment_capacity
    from crumple.section.capacity.interaction import PlasticInteraction, plastic_interaction
    from crumple.section.capacity.interaction_fit import InteractionFit, fitted_interaction
    from crumple.section.properties.properties import SectionProperties
    from crumple.section.shapes.built_up import ClosedHat, MultiCellTube
    from crumple.section.shapes.open_sections import Angle, Channel, Hat
    from crumple.section.wall import Wall, Weld
    from crumple.section.wall_section import WallSection, outline_section, square_tube, walls_of
    from crumple.section.walled import WalledSection

_FILES = {
    "Angle": "shapes.open_sections",
    "Channel": "shapes.open_sections",
    "ClosedHat": "shapes.built_up",
    "Hat": "shapes.open_sections",
    "InteractionFit": "capacity.interaction_fit",
    "MomentCapacity": "capacity.capacity",
    "MultiCellTube": "shapes.built_up",
    "PlasticInteraction": "capacity.interaction",
    "SectionProperties": "properties.properties",
    "Wall": "wall",
    "WallSection": "wall_section",
    "WalledSection": "walled",
    "Weld": "wall",
    "bending_moment": "capacity.bending_curve",
    "fitted_interaction": "capacity.interaction_fit",
    "moment_capacity": "capacity.capacity",
    "outline_section": "wall_section",
    "plastic_interaction": "capacity.interaction",
    "square_tube": "wall_section",
    "walls_of": "wall_section",
}

__all__ = [
    "AXES",
    "Angle",
    "Axis",
    "Channel",
    "CircularTube",
    "ClosedHat",
    "Hat",
    "InteractionFit",
    "MomentCapacity",
    "MultiCellTube",
    "PlasticInteraction",
    "RectangularTube",
    "Section",
    "SectionProperties",
    "Wall",
    "WallSection",
    "WalledSection",
    "Weld",
    "bending_moment",
    "fitted_interaction",
    "half_fold_length",
    "moment_capacity",
    "outline_section",
    "plastic_interaction",
    "square_tube",
    "walls_of",
]


def __getattr__(name: str) -> Any:
    if name in _FILES:
        return getattr(import_module(f"crumple.section.{_FILES[name]}"), name)
    raise AttributeError(f"module 'crumple.section' has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted({*globals(), *_FILES})
