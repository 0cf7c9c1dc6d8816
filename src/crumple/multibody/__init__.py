"""Structure to rigid bodies and plastic hinges, and the implicit stepper that moves them.

`solve_multibody(structure, run)` is the way in; `lower` shows the mechanism that a structure becomes.
"""

from crumple.multibody.bodies.assembly import Piece
from crumple.multibody.bodies.dead_centres import dead_centres
from crumple.multibody.bodies.linkage import Connection, Linkage, link
from crumple.multibody.bodies.mobility import notes
from crumple.multibody.checks.infinitesimal import infinitesimal
from crumple.multibody.checks.overlap import obstacle_overlap_warnings, overlap_warnings
from crumple.multibody.checks.struck import struck_cautions, struck_near_ends, swept_supports
from crumple.multibody.checks.stuck_drives import loose_drives, stuck_drives, stuck_note, with_drives_released
from crumple.multibody.checks.unheld import unheld_notes
from crumple.multibody.planar.mechanism import Link, Mechanism, lower
from crumple.multibody.planar.model import planar_initial_motion, tree_hinge, tree_model
from crumple.multibody.planar.plane import Plane
from crumple.multibody.run import Run
from crumple.multibody.solve import solve_multibody, solver_of
from crumple.multibody.timing import least_seconds, stepping_seconds
from crumple.multibody.variants.law_range import law_factors, law_range
from crumple.multibody.variants.modes import modes
from crumple.multibody.variants.sensitivity import Sensitivities, sensitivities
from crumple.multibody.variants.variants import OTHER_PARTS, VariantTable, solve_variants

__all__ = [
    "OTHER_PARTS",
    "Connection",
    "Link",
    "Linkage",
    "Mechanism",
    "Piece",
    "Plane",
    "Run",
    "Sensitivities",
    "VariantTable",
    "dead_centres",
    "infinitesimal",
    "law_factors",
    "law_range",
    "least_seconds",
    "link",
    "loose_drives",
    "lower",
    "modes",
    "notes",
    "obstacle_overlap_warnings",
    "overlap_warnings",
    "planar_initial_motion",
    "sensitivities",
    "solve_multibody",
    "solve_variants",
    "solver_of",
    "stepping_seconds",
    "struck_cautions",
    "struck_near_ends",
    "stuck_drives",
    "stuck_note",
    "swept_supports",
    "tree_hinge",
    "tree_model",
    "unheld_notes",
    "with_drives_released",
]
