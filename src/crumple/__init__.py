"""Crash analysis at the concept stage: plastic-hinge multibody and explicit shells from one description.

The public names below are looked up on first access, so that `import crumple` costs nothing.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from crumple.version import __version__

if TYPE_CHECKING:
    from crumple.analysis import Analysis, check, load, loads
    from crumple.analysis.solve import solve
    from crumple.errors import CrumpleError, InputError, Problem, Status
    from crumple.hinge import build_axial_law, build_law, build_torsion_law, read_law, write_law
    from crumple.material import Material, grade, grade_material, grades
    from crumple.report import write_report
    from crumple.result import Result
    from crumple.section import (
        Angle,
        Channel,
        CircularTube,
        ClosedHat,
        Hat,
        MultiCellTube,
        RectangularTube,
        Wall,
        WallSection,
        Weld,
        fitted_interaction,
        moment_capacity,
        plastic_interaction,
        square_tube,
    )
    from crumple.structure import MultibodySettings, Outputs, Structure
    from crumple.units import format_quantity, parse_quantity

_ROOMS = {
    "Analysis": "analysis",
    "Angle": "section",
    "Channel": "section",
    "CircularTube": "section",
    "ClosedHat": "section",
    "CrumpleError": "errors",
    "Hat": "section",
    "InputError": "errors",
    "Material": "material",
    "MultiCellTube": "section",
    "MultibodySettings": "structure",
    "Outputs": "structure",
    "Problem": "errors",
    "RectangularTube": "section",
    "Result": "result",
    "Status": "errors",
    "Structure": "structure",
    "Wall": "section",
    "WallSection": "section",
    "Weld": "section",
    "build_axial_law": "hinge",
    "build_law": "hinge",
    "build_torsion_law": "hinge",
    "check": "analysis",
    "fitted_interaction": "section",
    "format_quantity": "units",
    "grade": "material",
    "grade_material": "material",
    "grades": "material",
    "load": "analysis",
    "loads": "analysis",
    "moment_capacity": "section",
    "parse_quantity": "units",
    "plastic_interaction": "section",
    "read_law": "hinge",
    "solve": "analysis",
    "square_tube": "section",
    "write_law": "hinge",
    "write_report": "report",
}

__all__ = [
    "Analysis",
    "Angle",
    "Channel",
    "CircularTube",
    "ClosedHat",
    "CrumpleError",
    "Hat",
    "InputError",
    "Material",
    "MultiCellTube",
    "MultibodySettings",
    "Outputs",
    "Problem",
    "RectangularTube",
    "Result",
    "Status",
    "Structure",
    "Wall",
    "WallSection",
    "Weld",
    "__version__",
    "build_axial_law",
    "build_law",
    "build_torsion_law",
    "check",
    "fitted_interaction",
    "format_quantity",
    "grade",
    "grade_material",
    "grades",
    "load",
    "loads",
    "moment_capacity",
    "parse_quantity",
    "plastic_interaction",
    "read_law",
    "solve",
    "square_tube",
    "write_law",
    "write_report",
]


def __getattr__(name: str) -> Any:
    if name in _ROOMS:
        return getattr(import_module(f"crumple.{_ROOMS[name]}"), name)
    raise AttributeError(f"module 'crumple' has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted({*globals(), *_ROOMS})
