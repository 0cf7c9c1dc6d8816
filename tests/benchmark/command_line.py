"""Whole-process times of the command line, warm: best and median of several runs.

Bounds: `crumple --help` below 0.2 s, `crumple run` of the first example, with files and report, below 2 s.
"""

from __future__ import annotations

import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

EXAMPLE = Path(__file__).parents[2] / "examples" / "01_tube_bending.yaml"
CASES = {
    "python -c pass": (["-c", "pass"], 10, None),
    "crumple --help": (["-m", "crumple", "--help"], 10, 0.2),
    "crumple check": (["-m", "crumple", "check", str(EXAMPLE)], 5, None),
    "crumple run": (["-m", "crumple", "run", str(EXAMPLE), "--out"], 5, 2.0),
}


def seconds(arguments: list[str], folder: str) -> float:
    """Wall time of one process."""
    whole = [sys.executable, *arguments, *([folder] if arguments[-1] == "--out" else [])]
    begin = time.perf_counter()
    subprocess.run(whole, check=True, stdout=subprocess.DEVNULL)
    return time.perf_counter() - begin


def main() -> int:
    """Print a line per case; the number of cases whose median passes its bound."""
    missed = 0
    with tempfile.TemporaryDirectory() as folder:
        for name, (arguments, repeats, bound) in CASES.items():
            seconds(arguments, folder)
            times = [seconds(arguments, folder) for _ in range(repeats)]
            median = statistics.median(times)
            late = bound is not None and median > bound
            missed += late
            allowed = "" if bound is None else f"   bound {bound:g} s{', MISSED' if late else ''}"
            print(f"{name:16}  best {min(times):6.3f} s   median {median:6.3f} s{allowed}")
    return missed


if __name__ == "__main__":
    sys.exit(main())
