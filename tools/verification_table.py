"""Write docs/verification.md and its appendix from a test run.

    python tools/verification_table.py FIGURES.json docs

The figures come from `pytest --figures FILE`: for every module under tests/verification its docstring, the
outcome of each test, and what the tests recorded with `record_figure`.  The docstring of a module ends with a
line with the kinds of check it makes, and where each of them takes its expected values from:

    Kind: closed form; published.  Source: derived here; quoted.

Both lists have as many entries, in the same order.  A module without this line is refused.
"""

from __future__ import annotations

import json
import re
import sys
from pathlib import Path
from typing import Any

KINDS = {
    "closed form": "a formula or an exact solution",
    "independent calculation": "another calculation of the same quantity, made for this project",
    "published": "a figure or formula printed elsewhere",
    "other code": "the result of another program",
    "invariant": "something that must hold: conservation, symmetry, independence of mesh or step",
    "own past numbers": "a figure that this project has stated before; it shows a change, not an error",
}
SOURCES = {
    "derived here": (
        "not needed",
        "the expected value follows from a derivation in the test or in docs/theory",
    ),
    "run here": ("yes", "the other program was run for this project"),
    "read": ("yes", "the cited text or data was read"),
    "textbook": ("textbook", "a standard result, not taken from one text"),
    "quoted": ("no", "quoted by others or known from memory; the original was not seen"),
}
"""Text of the page for a source, and its meaning."""
LINE = re.compile(r"^Kind: (?P<kinds>[^.]+)\.\s+Source: (?P<sources>[^.]+)\.$", re.MULTILINE)

HEAD = """# Verification

This page is for a reader who doubts the results. It lists what has been verified, by which kind of check,
and whether the source of the expected values was seen. Every line is one file of tests, linked to the
section of the [appendix](verification_appendix.md) that describes it and lists its figures. Both pages are
written by `make verify` from the tests themselves; a change by hand is lost.

"Worst error" is the largest difference between a computed and an expected value, divided by the tolerance
of the test: below 1 the test passes. A value near 1 means that the tolerance is fully used, as with a
published figure that has few digits. A dash means that the tests of this file compare without recording
figures. What compares Crumple with its own past is in `tests/regression`, and here only where the page states
so.
"""
APPENDIX = """# Verification: all figures

This is the appendix of the [verification](verification.md), with the description and the figures of every
file of tests from the last complete run. Each row is one figure that a test requires: the test fails if the
difference exceeds the tolerance. The page is written by `make verify`; a change by hand is lost.
"""


def checks_of(path: str, doc: str) -> list[tuple[str, str]]:
    """Kinds of check of a module, each with its source, from the last line of its docstring."""
    found = LINE.search(doc)
    if found is None:
        raise SystemExit(
            f"{path}: its docstring lacks a line like 'Kind: closed form.  Source: derived here.'"
        )
    kinds, sources = ([part.strip() for part in found[name].split(";")] for name in ("kinds", "sources"))
    unknown = [word for word in kinds if word not in KINDS] + [
        word for word in sources if word not in SOURCES
    ]
    if unknown:
        raise SystemExit(f"{path}: {', '.join(unknown)}: allowed are {', '.join((*KINDS, *SOURCES))}")
    if len(kinds) != len(sources):
        raise SystemExit(f"{path}: {len(kinds)} kinds of check, {len(sources)} sources; one for each")
    return list(zip(kinds, sources, strict=True))


def title_of(doc: str) -> str:
    """First line of a docstring, without its full stop."""
    return doc.strip().partition("\n")[0].rstrip(".")


def share_of_tolerance(figure: dict[str, Any]) -> float:
    """Difference of a figure over what its test allows."""
    allowed = figure["tolerance"] * (abs(figure["expected"]) if figure["relative"] else 1.0)
    off = abs(figure["value"] - figure["expected"])
    return 0.0 if off == 0.0 else off / allowed if allowed > 0.0 else float("inf")


def worst(figures: list[dict[str, Any]]) -> str:
    """Largest difference over its tolerance, in words."""
    if not figures:
        return "-"
    share = max(map(share_of_tolerance, figures))
    return "below 0.01" if share < 0.01 else f"{share:.2f}"


def outcomes_of(module: dict[str, Any]) -> str:
    """How many tests passed, failed or were skipped."""
    outcomes = list(module["outcomes"].values())
    return ", ".join(f"{outcomes.count(kind)} {kind}" for kind in dict.fromkeys(sorted(outcomes)))


def anchor(title: str) -> str:
    """Link to a heading, as GitHub makes it."""
    return re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-")


def claim(path: str, module: dict[str, Any]) -> str:
    """One file of tests as a row of the first page."""
    checks = checks_of(path, module["doc"])
    title = title_of(module["doc"])
    seen = [SOURCES[source][0] for _, source in checks]
    cells = [
        f"[{title}](verification_appendix.md#{anchor(title)})",
        "; ".join(kind for kind, _ in checks),
        "; ".join(seen if len(set(seen)) > 1 else seen[:1]),
        worst(module["figures"]),
        outcomes_of(module),
    ]
    return "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |"


def first_page(modules: dict[str, dict[str, Any]]) -> str:
    """The page for a reader who doubts."""
    groups: dict[str, list[str]] = {}
    for path, module in sorted(modules.items()):
        groups.setdefault(Path(path).parent.name, []).append(claim(path, module))
    figures = [figure for module in modules.values() for figure in module["figures"]]
    failed = sum(not figure["passed"] for figure in figures)
    count = f"{len(modules)} files of tests record {len(figures)} figures; {failed or 'none'} of them "
    count += "is outside its tolerance." if failed <= 1 else "are outside their tolerance."
    head = "| Claim | Kind of check | Source seen | Worst error over tolerance | Tests |\n"
    tables = [
        f"## {name.capitalize()}\n\n{head}| --- | --- | --- | --- | --- |\n" + "\n".join(rows)
        for name, rows in groups.items()
    ]
    kinds = [f"- *{name}*: {meaning}." for name, meaning in KINDS.items()]
    seen: dict[str, list[str]] = {}
    for word, meaning in SOURCES.values():
        seen.setdefault(word, []).append(meaning)
    sources = [f"- *{word}*: {'; or '.join(meanings)}." for word, meanings in seen.items()]
    legend = ["**Kinds of check**", "\n".join(kinds), "**Source seen**", "\n".join(sources)]
    return "\n\n".join([HEAD.strip(), count, *legend, *tables]) + "\n"


def number(value: float) -> str:
    """Up to eight significant digits, without trailing zeros."""
    return f"{value:.8g}"


def row(figure: dict[str, Any]) -> str:
    """One figure as a row of the appendix."""
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
    body = LINE.sub("", module["doc"]).strip().partition("\n")[2].strip()
    checks = "; ".join(f"{kind} ({source})" for kind, source in checks_of(path, module["doc"]))
    paragraphs = [f"## {title_of(module['doc'])}", *([body] if body else [])]
    paragraphs.append(f"Checks: {checks}. `{path}`: {outcomes_of(module)}.")
    if module["figures"]:
        head = "| Figure | Computed | Expected | Tolerance | Met |\n| --- | --- | --- | --- | --- |\n"
        paragraphs.append(head + "\n".join(row(figure) for figure in module["figures"]))
    return "\n\n".join(paragraphs)


def main(source: str, folder: str) -> None:
    """Read the figures, write both pages."""
    modules = json.loads(Path(source).read_text(encoding="utf-8"))
    sections = [section(path, module) for path, module in sorted(modules.items())]
    pages = {
        "verification.md": first_page(modules),
        "verification_appendix.md": "\n\n".join([APPENDIX.strip(), *sections]) + "\n",
    }
    for name, text in pages.items():
        (Path(folder) / name).write_text(text, encoding="utf-8")
    count = sum(len(module["figures"]) for module in modules.values())
    print(f"{folder}: {len(sections)} files of tests, {count} figures")


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2])
