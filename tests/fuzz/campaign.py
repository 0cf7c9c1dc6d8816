"""A campaign: many cases of every kind, a table of what came of them, and every finding made small.

Cases come in chunks with a seed each, so that a campaign of any length can be had again and a finding does
not end it.  A finding is shrunk within its chunk and saved; the same one found later counts, but is not
shrunk again.
"""

from __future__ import annotations

import math
import pickle
import time
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from hypothesis import HealthCheck, Phase, given, seed, settings
from tests.fuzz.sites import report
from tests.fuzz.strategies import cases
from tests.fuzz.worker import Case, Outcome, Worker

SHARES = {"bytes": 0.08, "input": 0.3, "solve": 0.05, "shell": 0.05, "law": 0.08, "curve": 0.08}
SHARES |= {"restart": 0.04, "kernel": 0.12, "call": 0.1, "command": 0.04, "variants": 0.03, "result": 0.03}
"""Of all cases, by kind."""
CHUNK = 200
"""Cases that share a seed."""


@dataclass
class Tally:
    """What came of the cases of a campaign.

    Attributes
    ----------
    tried, accepted, refused, found
        Numbers by kind.
    messages
        Numbers of refusals by kind and message.
    findings
        Smallest case and its outcome, by what was found.
    sites
        Refusals of the code that were reached.
    slowest
        Wall time of the slowest case by kind [s].
    """

    tried: Counter[str] = field(default_factory=Counter)
    accepted: Counter[str] = field(default_factory=Counter)
    refused: Counter[str] = field(default_factory=Counter)
    found: Counter[str] = field(default_factory=Counter)
    messages: Counter[tuple[str, str]] = field(default_factory=Counter)
    findings: dict[str, tuple[Case, Outcome]] = field(default_factory=dict)
    sites: set[str] = field(default_factory=set)
    slowest: dict[str, float] = field(default_factory=dict)

    def note(self, case: Case, outcome: Outcome, seconds: float) -> None:
        """Count a case."""
        self.tried[case.kind] += 1
        self.accepted[case.kind] += outcome.accepted
        self.found[case.kind] += bool(outcome.finding)
        self.slowest[case.kind] = max(self.slowest.get(case.kind, 0.0), seconds)
        if outcome.message:
            self.refused[case.kind] += 1
            self.messages[case.kind, outcome.message] += 1

    def table(self, messages: int = 12) -> str:
        """As text."""
        lines = [f"{'kind':10}{'cases':>8}{'accepted':>10}{'refused':>9}{'findings':>10}{'slowest, s':>12}"]
        for kind, n in self.tried.items():
            share = f"{100 * self.accepted[kind] / n:.0f} %"
            lines.append(
                f"{kind:10}{n:8}{share:>10}{self.refused[kind]:9}{self.found[kind]:10}{self.slowest[kind]:12.2f}"
            )
        for kind in self.tried:
            own = Counter({text: n for (of, text), n in self.messages.items() if of == kind})
            lines += [f"\nrefusals of {kind}: {len(own)} different"]
            lines += [f"{n:8}  {text}" for text, n in own.most_common(messages)]
        lines += ["", report(self.sites)]
        lines += [f"\nfindings: {len(self.findings)}", *(f"  {one}" for one in self.findings)]
        return "\n".join(lines)


def attack(kind: str, number: int, of_seed: int, worker: Worker, tally: Tally) -> None:
    """Try so many cases of a kind; a finding that is new is made small."""
    target: list[str] = []
    smallest: list[tuple[Case, Outcome]] = []

    @seed(of_seed)
    @settings(
        max_examples=number,
        derandomize=False,
        database=None,
        deadline=None,
        report_multiple_bugs=False,
        suppress_health_check=list(HealthCheck),
        phases=(Phase.generate, Phase.shrink),
    )
    @given(cases(kind))
    def one(case: Case) -> None:
        begin = time.monotonic()
        outcome = worker.run(case)
        tally.sites |= outcome.sites
        if not target:
            tally.note(case, outcome, time.monotonic() - begin)
        new = outcome.finding not in tally.findings and (not target or outcome.finding == target[0])
        if outcome.finding and new:
            target[:] = [outcome.finding]
            smallest[:] = [(case, outcome)]
            raise AssertionError(outcome.finding)

    try:
        one()
    except Exception:
        # a finding that does not come again is one too; anything else is a defect of the campaign
        if not target:
            raise
        tally.findings[target[0]] = smallest[0]


def campaign(
    number: int,
    first_seed: int = 0,
    shares: Mapping[str, float] = SHARES,
    *,
    folder: Path | None = None,
    longest: float = math.inf,
) -> Tally:
    """Try at least so many cases, `shares` of each kind; findings are written into the folder.

    No chunk begins after the wall time `longest` [s].
    """
    begin = time.monotonic()
    tally, total = Tally(), sum(shares.values())
    wanted = {kind: round(number * share / total) for kind, share in shares.items()}
    with Worker() as worker:
        chunk = 0
        while time.monotonic() - begin <= longest and any(
            tally.tried[kind] < n for kind, n in wanted.items()
        ):
            for place, (kind, n) in enumerate(wanted.items()):
                left = n - tally.tried[kind]
                if left <= 0 or time.monotonic() - begin > longest:
                    continue
                known = len(tally.findings)
                attack(kind, min(left, CHUNK), 1000 * (first_seed + chunk) + place, worker, tally)
                if folder is not None and len(tally.findings) > known:
                    _save(folder, len(tally.findings), *list(tally.findings.values())[-1])
            chunk += 1
    return tally


def _save(folder: Path, number: int, case: Case, outcome: Outcome) -> None:
    """A finding: what was found, the smallest case as text, and as `--again` takes it."""
    folder.mkdir(parents=True, exist_ok=True)
    name = folder / f"{number:03}-{case.kind}"
    text = f"{outcome.finding}\n\n{outcome.detail}\n\n{case.payload!r}\n"
    if isinstance(case.payload, str):
        text += f"\n{case.payload}"
    name.with_suffix(".txt").write_text(text, encoding="utf-8", errors="backslashreplace")
    name.with_suffix(".case").write_bytes(pickle.dumps(case))
