"""Crash analysis at the concept stage: plastic-hinge multibody and explicit shells from one description.

The public names below are looked up on first access, so that `import crumple` costs nothing.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

__version__ = "0.1.0"

if TYPE_CHECKING:
    from crumple.analysis import Analysis, check, load, loads
    from crumple.analysis.solve import solve
    from crumple.errors import CrumpleError, InputError, Problem, Status
    from crumple.hinge import build_law
    from crumple.material import Material
    from crumple.report import write_report
    from crumple.result import Result
    from crumple.section import CircularTube, RectangularTube
    from crumple.structure import MultibodySettings, Outputs, Structure
    from crumple.units import format_quantity, parse_quantity

_ROOMS = {
    "Analysis": "analysis",
    "CircularTube": "section",
    "CrumpleError": "errors",
    "InputError": "errors",
    "Material": "material",
    "MultibodySettings": "structure",
    "Outputs": "structure",
    "Problem": "errors",
    "RectangularTube": "section",
    "Result": "result",
    "Status": "errors",
    "Structure": "structure",
    "build_law": "hinge",
    "check": "analysis",
    "format_quantity": "units",
    "load": "analysis",
    "loads": "analysis",
    "parse_quantity": "units",
    "solve": "analysis",
    "write_report": "report",
}

__all__ = [
    "Analysis",
    "CircularTube",
    "CrumpleError",
    "InputError",
    "Material",
    "MultibodySettings",
    "Outputs",
    "Problem",
    "RectangularTube",
    "Result",
    "Status",
    "Structure",
    "__version__",
    "build_law",
    "check",
    "format_quantity",
    "load",
    "loads",
    "parse_quantity",
    "solve",
    "write_report",
]


def __getattr__(name: str) -> Any:
    if name in _ROOMS:
        return getattr(import_module(f"crumple.{_ROOMS[name]}"), name)
    raise AttributeError(f"module 'crumple' has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted({*globals(), *_ROOMS})
