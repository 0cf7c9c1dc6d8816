"""The input file, and the solution of an analysis.

`load` reads an `Analysis` from a file, `solve` computes its `Result`, `canonical` and `input_hash` give its
form and SHA-256.  An `Analysis` has ``structure``, ``duration`` [s], ``title``, ``multibody`` (settings) and
``outputs``.
"""

from crumple.analysis.analysis import Analysis
from crumple.analysis.canonical import canonical, input_hash
from crumple.analysis.frames import solve_with_frames
from crumple.analysis.input_file import (
    FORMAT,
    InputFile,
    LoadedInput,
    check,
    load,
    load_input,
    load_text,
    loads,
)
from crumple.analysis.schema import json_schema
from crumple.analysis.solve import FIDELITIES, solve, with_law_range, with_modes

__all__ = [
    "FIDELITIES",
    "FORMAT",
    "Analysis",
    "InputFile",
    "LoadedInput",
    "canonical",
    "check",
    "input_hash",
    "json_schema",
    "load",
    "load_input",
    "load_text",
    "loads",
    "solve",
    "solve_with_frames",
    "with_law_range",
    "with_modes",
]
