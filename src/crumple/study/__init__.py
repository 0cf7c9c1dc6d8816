"""Studies: many runs of one base input, a table of their rows, and what it says.

`LoadedStudy` reads a study file, `run_study` solves it, `study_of` does the same with a function in place of
a structure.  Rows are kept in SQLite, so that an interrupted study goes on where it was.
"""

from crumple.analysis.distribution import Distribution
from crumple.study.answer import Answer
from crumple.study.running import check_study, run_part, run_study, study_of
from crumple.study.scatter import with_uncertainty
from crumple.study.study_file import (
    Constraint,
    LoadedStudy,
    Method,
    Objective,
    Response,
    Study,
    Variable,
)
from crumple.study.table import Table
from crumple.study.target import LoadedTarget, Ranked, TargetFile, check_target, is_target, run_target

__all__ = [
    "Answer",
    "Constraint",
    "Distribution",
    "LoadedStudy",
    "LoadedTarget",
    "Method",
    "Objective",
    "Ranked",
    "Response",
    "Study",
    "Table",
    "TargetFile",
    "Variable",
    "check_study",
    "check_target",
    "is_target",
    "run_part",
    "run_study",
    "run_target",
    "study_of",
    "with_uncertainty",
]
