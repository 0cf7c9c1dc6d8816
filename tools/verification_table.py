"""Write docs/verification.md from a test run: `python tools/verification_table.py FIGURES.json PAGE.md`.

The figures come from `pytest --figures FILE`: for every module under tests/verification its docstring
(source and figure), the outcome of each test, and what the tests recorded with `record_figure`.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

HEAD = """# Verification

Every source that Crumple is verified against, with the figures of the last complete run. This page is
written by `make verify` from the tests themselves; a change by hand is lost. Each row is one figure that a
test requires: the test fails when the difference passes the tolerance.

A closed form or an identity is reproduced to rounding or to the order of the method; a published figure to
the digits printed there. What compares Crumple with its own past is not here but in `tests/regression`.
"""


def number(value: float) -> str:
    """Up to eight significant digits, without trailing zeros."""
    return f"{value:.8g}"


def row(figure: dict[str, Any]) -> str:
    """One figure as a row of the table."""
    unit = f" {figure['unit']}" if figure["unit"] else ""
    tolerance = (
        f"{figure['tolerance'] * 100:.3g} %" if figure["relative"] else f"{figure['tolerance']:.3g}{unit}"
    )
    cells = [
        figure["name"],
        number(figure["value"]) + unit,
        number(figure["expected"]) + unit,
        tolerance,
        "yes" if figure["passed"] else "**no**",
    ]
    return "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |"


def section(path: str, module: dict[str, Any]) -> str:
    """One test file: what it stands on, its figures, its outcomes."""
    title, _, rest = module["doc"].strip().partition("\n")
    outcomes = list(module["outcomes"].values())
    count = ", ".join(f"{outcomes.count(kind)} {kind}" for kind in dict.fromkeys(sorted(outcomes)))
    paragraphs = [f"## {title.rstrip('.')}"]
    if rest.strip():
        paragraphs.append(rest.strip())
    paragraphs.append(f"`{path}`: {count}.")
    if module["figures"]:
        head = "| Figure | Got | Expected | Tolerance | Met |\n| --- | --- | --- | --- | --- |\n"
        paragraphs.append(head + "\n".join(row(figure) for figure in module["figures"]))
    return "\n\n".join(paragraphs)


def main(source: str, target: str) -> None:
    """Read the figures, write the page."""
    modules = json.loads(Path(source).read_text(encoding="utf-8"))
    sections = [section(path, module) for path, module in sorted(modules.items())]
    Path(target).write_text("\n\n".join([HEAD.strip(), *sections]) + "\n", encoding="utf-8")
    print(f"{target}: {len(sections)} sources, {sum(len(m['figures']) for m in modules.values())} figures")


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2])
