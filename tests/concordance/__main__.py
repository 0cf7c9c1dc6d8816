"""Command line of the suite."""

from __future__ import annotations

import argparse
from pathlib import Path

from tests.concordance.judging import judged
from tests.concordance.models import MODELS
from tests.concordance.page import write_page
from tests.concordance.stored import solve_missing
from tests.concordance.suite import CASES


def main() -> None:
    """Solve the shells that are missing, or judge the multibody models by them."""
    parser = argparse.ArgumentParser(prog="python -m tests.concordance", description=main.__doc__)
    parser.add_argument("task", choices=("shells", "judge"))
    parser.add_argument("names", nargs="*", metavar="NAME", help="structures; all without")
    parser.add_argument("--models", default=",".join(MODELS), help="names separated by commas")
    parser.add_argument("--page", type=Path, default=Path("docs/concordance.md"))
    given = parser.parse_args()
    if unknown := [name for name in given.names if name not in CASES]:
        parser.error(f"unknown structures {', '.join(unknown)}; known are {', '.join(CASES)}")
    if unknown := [name for name in given.models.split(",") if name not in MODELS]:
        parser.error(f"unknown models {', '.join(unknown)}; known are {', '.join(MODELS)}")
    cases = [CASES[name] for name in given.names or CASES]
    if given.task == "shells":
        for case in cases:
            for line in solve_missing(case):
                print(line, flush=True)
        return
    verdicts = judged(cases, given.models.split(","), print)
    write_page(verdicts, given.page, whole=not given.names)


if __name__ == "__main__":
    main()
