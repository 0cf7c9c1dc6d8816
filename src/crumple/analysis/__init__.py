"""The input file and the one way from it to an answer.

`Analysis` has ``structure``, ``duration`` [s], ``title``, ``multibody`` (settings) and ``outputs``.
`load` reads one from a file, `canonical` and `input_hash` give its form and SHA-256.
"""

from crumple.analysis.analysis import Analysis
from crumple.analysis.canonical import canonical, input_hash
from crumple.analysis.input_file import FORMAT, InputFile, check, load, loads

__all__ = ["FORMAT", "Analysis", "InputFile", "canonical", "check", "input_hash", "load", "loads"]
