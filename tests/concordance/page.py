"""docs/concordance.md: how far the fast answer agrees with the shells, by model, family and figure."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from tests.concordance.judging import Verdict
from tests.concordance.ranking import ranking
from tests.concordance.suite import CASES, COARSER, FINER, IMPERFECTION, NOT_FINER, RANKED

from crumple.comparison.measure.decisive import SPREADS, TARGETS
from crumple.portable import write_text

HEAD = f"""# Concordance of multibody models and shells

Written by `make concordance`; what is measured and how it is judged: [theory](theory/concordance.md).

Every structure of the halves was solved by shells on three meshes: that of its input, one with elements
in the folds {FINER:g} times as long (not the layouts, nor {", ".join(NOT_FINER)}), and one with
elements {COARSER:g} times as long, which was also solved with an imperfection of
{100 * IMPERFECTION:g} % of the wall. These results are stored in `tests/concordance/shells` with their
provenance; the finest mesh is the reference. The multibody models are solved again whenever this page is
written. A figure is *right* if its error is within the target or within {SPREADS:g} times the spread of the
shells: the larger of the difference of the two finest meshes and that of the imperfection. Errors are
relative to the shells' value, or to 5 % of the largest value of the structure if that is more. A run that is
refused or does not complete is wrong in every figure. The *judged-by* half was fixed before any model was
changed because of this suite; frames at walls came later, and were divided by lot before any was solved.
"""
HEADS = {
    "judged-by": "## Judged-by half\n",
    "tuned-on": "## Tuned-on half\n",
    "drawn later": """## Frames drawn later

Drawn by a program and solved by shells on one mesh, with 4.6 elements or more along half a fold, without and
with an imperfection of 5 % of the wall: their spread is what this changes. They are only counted: no model
was changed because of one of them.
""",
    "drawn": """## Drawn frames

Drawn by the same program from another seed, and solved and judged in the same way. They may be looked at.
""",
}


RANGES = f"""## Ranges from the laws

A run states a [range](theory/measured_curves.md) from the bands of its laws: all low, all high, and low and
high in turns. Of displacements at the end (elastic members), layouts left out: how many are within
{100 * TARGETS["displacement"]:.0f} % of the shells' value, and for how many this value lies in the range. A
law without a band keeps its values. Runs that are refused or do not complete have no range and do not count.
"""


def write_page(verdicts: Sequence[Verdict], path: Path, *, whole: bool) -> None:
    """Write the page; of a part of the suite, print it only."""
    text = page(verdicts)
    if whole:
        write_text(path, text)
    else:
        print(text)


def page(verdicts: Sequence[Verdict]) -> str:
    """Markdown of all verdicts."""
    structures = [v for v in verdicts if v.case not in RANKED]
    parts = [HEAD]
    for half, head in HEADS.items():
        own = [v for v in structures if v.case.half == half]
        if own:
            parts += [head, _summary(own), _structures(own)]
    if any(v.ranges for v in structures):
        parts += [RANGES, _ranges(structures)]
    ranked = [v for v in verdicts if v.case in RANKED]
    if ranked:
        parts += ["## Ranking of layouts\n", _ranking(ranked)]
    parts += [_left_out({v.case.name for v in verdicts})]
    return "\n".join(part for part in parts if part)


def _models(verdicts: Sequence[Verdict]) -> dict[str, list[Verdict]]:
    return {
        model: [v for v in verdicts if v.model == model] for model in dict.fromkeys(v.model for v in verdicts)
    }


def _summary(verdicts: Sequence[Verdict]) -> str:
    """Share of right structures and of right figures, median and worst error, by model and kind."""
    lines = [
        "| Model | Figure | Target | Structures right | Figures right | Median error | Worst error |",
        "| --- | --- | --- | --- | --- | --- | --- |",
    ]
    for model, own in _models(verdicts).items():
        for kind, target in TARGETS.items():
            having = [v for v in own if kind in v.figures]
            figures = [figure for v in having for figure in v.figures[kind]]
            if not figures:
                continue
            right = sum(v.right(kind) for v in having)
            errors = [figure.error for figure in figures]
            lines.append(
                f"| {model} | {kind} | {100 * target:.0f} % | {right} of {len(having)} "
                f"| {sum(f.right for f in figures)} of {len(figures)} "
                f"| {_percent(float(np.median(errors)))} | {_percent(max(errors))} |"
            )
        orders = [v.order for v in own if not math.isnan(v.order)]
        times = [v.measures.seconds for v in own if v.measures is not None]
        shells = sum(v.shells.reference.seconds for v in own)
        lines.append(
            f"| {model} | order of opening |  |  |  | {_percent(float(np.median(orders)))} alike | |"
            if orders
            else f"| {model} | order of opening |  |  |  |  |  |"
        )
        lines.append(
            f"| {model} | processor time |  |  |  | {1e3 * float(np.median(times)):.0f} ms "
            f"| {max(times):.1f} s; shells together {shells / max(sum(times), 1e-9):.0f} times as long |"
        )
    return "\n".join(lines) + "\n"


def _structures(verdicts: Sequence[Verdict]) -> str:
    """Worst error of each structure by kind; wrong ones are bold."""
    kinds = list(TARGETS)
    lines = [
        "Worst error of each structure; bold: not within what is allowed.\n",
        "| Structure | Model | " + " | ".join(kinds) + " | Residual | Note |",
        "| --- " * (len(kinds) + 4) + "|",
    ]
    for verdict in verdicts:
        cells = [
            ""
            if kind not in verdict.figures
            else _percent(verdict.worst(kind))
            if verdict.right(kind)
            else f"**{_percent(verdict.worst(kind))}**"
            for kind in kinds
        ]
        residual = verdict.measures.energy.get("residual") if verdict.measures is not None else None
        lines.append(
            f"| {verdict.case.name} | {verdict.model} | {' | '.join(cells)} "
            f"| {'' if residual is None else f'{residual:.1e}'} | {verdict.reason[:100]} |"
        )
    return "\n".join(lines) + "\n"


def _ranges(verdicts: Sequence[Verdict]) -> str:
    """Displacements within the target and within their range, by half."""
    lines = [
        "| Half | Displacements | Within the target | In the range | Either | Median width of the range |",
        "| --- | --- | --- | --- | --- | --- |",
    ]
    for half in HEADS:
        rows = [row for v in verdicts if v.case.half == half for row in v.ranges]
        if rows:
            near, inside = sum(row.near for row in rows), sum(row.inside for row in rows)
            either = sum(row.near or row.inside for row in rows)
            width = _percent(float(np.median([row.width for row in rows])))
            lines.append(f"| {half} | {len(rows)} | {near} | {inside} | {either} | {width} |")
    return "\n".join(lines) + "\n"


def _ranking(verdicts: Sequence[Verdict]) -> str:
    lines = [
        "| Ranked by | tau-b | 95 % interval | Pairs told apart | Median error of intrusion |",
        "| --- | --- | --- | --- | --- |",
    ]
    models = _models(verdicts)
    first = next(iter(models.values()))
    shells = np.array([_intrusion(v.shells.reference.extents) for v in first])
    spreads = np.array([_spread(v) for v in first])
    mass = np.array([-v.case.analysis().structure.mass_of_members for v in first])
    rows = {"mass alone": mass}
    for model, own in models.items():
        rows[model] = np.array(
            [
                _intrusion(v.measures.extents) if v.measures is not None and v.measures.complete else math.inf
                for v in own
            ]
        )
    for name, values in rows.items():
        found = ranking(shells, spreads, values)
        error = "" if name == "mass alone" else _percent(float(np.median(np.abs(values / shells - 1.0))))
        lines.append(
            f"| {name} | {found.tau:.2f} | {found.low:.2f} to {found.high:.2f} | {found.pairs} | {error} |"
        )
    return "\n".join(lines) + "\n"


def _intrusion(extents: dict[str, float]) -> float:
    return max(extents.values(), default=math.inf)


def _spread(verdict: Verdict) -> float:
    return max(
        abs(_intrusion(one.extents) - _intrusion(other.extents))
        for one, other in verdict.shells.pairs
        if one.complete and other.complete
    )


def _left_out(judged: set[str]) -> str:
    missing = [name for name in CASES if name not in judged]
    return f"Without shell results, and not judged: {', '.join(missing)}.\n" if missing else ""


def _percent(value: float) -> str:
    return "failed" if math.isinf(value) else "" if math.isnan(value) else f"{100 * value:.1f} %"
