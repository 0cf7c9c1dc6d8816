"""Every section shape, one line each; command line, input file, reference and gallery follow from it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from crumple.registry.registry import Registry

if TYPE_CHECKING:
    from crumple.section.shapes.shape import Shape

SHAPES: Registry[Shape] = Registry(
    "section",
    {
        "rectangular_tube": "crumple.section.shapes.rectangular_tube:SHAPE",
        "square_tube": "crumple.section.shapes.square_tube:SHAPE",
        "circular_tube": "crumple.section.shapes.circular_tube:SHAPE",
        "channel": "crumple.section.shapes.channel:SHAPE",
        "angle": "crumple.section.shapes.angle:SHAPE",
        "hat": "crumple.section.shapes.hat:SHAPE",
        "closed_hat": "crumple.section.shapes.closed_hat:SHAPE",
        "multi_cell_tube": "crumple.section.shapes.multi_cell_tube:SHAPE",
    },
)
