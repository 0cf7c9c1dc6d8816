"""What the cross-section is: its walls, and the properties, capacities and interaction that follow from them.

Names are looked up on first access: `crumple --help` needs none of them, and tubes none of walls.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from crumple.section.capacity.bending_curve import bending_moment
    from crumple.section.capacity.capacity import MomentCapacity, moment_capacity
    from crumple.section.capacity.interaction import PlasticInteraction, plastic_interaction
    from crumple.section.capacity.interaction_fit import InteractionFit, fitted_interaction
    from crumple.section.fold import fold_distance, half_fold_length
    from crumple.section.properties.properties import SectionProperties
    from crumple.section.section import AXES, Axis, Section
    from crumple.section.shapes.angle import Angle
    from crumple.section.shapes.channel import Channel
    from crumple.section.shapes.circular_tube import CircularTube
    from crumple.section.shapes.closed_hat import ClosedHat
    from crumple.section.shapes.hat import Hat
    from crumple.section.shapes.multi_cell_tube import MultiCellTube
    from crumple.section.shapes.rectangular_tube import RectangularTube
    from crumple.section.shapes.square_tube import square_tube
    from crumple.section.wall import Wall, Weld
    from crumple.section.wall_section import WallSection, outline_section, walls_of
    from crumple.section.walled import WalledSection

_FILES = {
    "AXES": "section",
    "Angle": "shapes.angle",
    "Axis": "section",
    "Channel": "shapes.channel",
    "CircularTube": "shapes.circular_tube",
    "ClosedHat": "shapes.closed_hat",
    "Hat": "shapes.hat",
    "InteractionFit": "capacity.interaction_fit",
    "MomentCapacity": "capacity.capacity",
    "MultiCellTube": "shapes.multi_cell_tube",
    "PlasticInteraction": "capacity.interaction",
    "RectangularTube": "shapes.rectangular_tube",
    "Section": "section",
    "SectionProperties": "properties.properties",
    "Wall": "wall",
    "WallSection": "wall_section",
    "WalledSection": "walled",
    "Weld": "wall",
    "bending_moment": "capacity.bending_curve",
    "fitted_interaction": "capacity.interaction_fit",
    "fold_distance": "fold",
    "half_fold_length": "fold",
    "moment_capacity": "capacity.capacity",
    "outline_section": "wall_section",
    "plastic_interaction": "capacity.interaction",
    "square_tube": "shapes.square_tube",
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
    "fold_distance",
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
