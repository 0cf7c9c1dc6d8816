"""Studies: many runs of one base input, a table of their rows, and what it says.

`LoadedStudy` reads a study file, `run_study` solves it, `study_of` does the same with a function in place of
a structure.  Rows are kept in SQLite, so that an interrupted study goes on where it was.
"""

from crumple.study.answer import Answer
from crumple.study.running import check_study, run_study, study_of
from crumple.study.study_file import (
    Constraint,
    Distribution,
    LoadedStudy,
    Method,
    Objective,
    Response,
    Study,
    Variable,
)
from crumple.study.table import Table

__all__ = [
    "Answer",
    "Constraint",
    "Distribution",
    "LoadedStudy",
    "Method",
    "Objective",
    "Response",
    "Study",
    "Table",
    "Variable",
    "check_study",
    "run_study",
    "study_of",
]
