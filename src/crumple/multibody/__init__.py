"""Structure to rigid bodies and plastic hinges, and the implicit stepper that moves them.

`solve_multibody(structure, run)` is the way in; `lower` shows the mechanism that a structure becomes.
"""

from crumple.multibody.assembly import Piece
from crumple.multibody.mechanism import Link, Mechanism, lower
from crumple.multibody.model import start_of, tree_hinge, tree_model
from crumple.multibody.plane import Plane
from crumple.multibody.solve import Run, solve_multibody
from crumple.multibody.timing import stepping_seconds
from crumple.multibody.variants import VariantTable, solve_variants

__all__ = [
    "Link",
    "Mechanism",
    "Piece",
    "Plane",
    "Run",
    "VariantTable",
    "lower",
    "solve_multibody",
    "solve_variants",
    "start_of",
    "stepping_seconds",
    "tree_hinge",
    "tree_model",
]
