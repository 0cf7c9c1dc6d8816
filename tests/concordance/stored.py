"""Shell results of the suite: solved once, stored as figures with their provenance."""

from __future__ import annotations

import json
import time
from dataclasses import dataclass
from hashlib import sha256
from pathlib import Path
from typing import Any

from tests.concordance.suite import Case

from crumple.analysis import Analysis, solve
from crumple.comparison import with_frames
from crumple.comparison.measure.measures import Measures, measure
from crumple.portable import write_text

FOLDER = Path(__file__).parent / "shells"


@dataclass(frozen=True)
class ShellResults:
    """Figures of the shell runs of a structure, by the name of the run; None: it has no such run."""

    nominal: Measures
    coarse: Measures | None = None
    imperfect: Measures | None = None
    fine: Measures | None = None

    @property
    def reference(self) -> Measures:
        """Run with the finest mesh."""
        return self.nominal if self.fine is None else self.fine

    @property
    def pairs(self) -> tuple[tuple[Measures, Measures], ...]:
        """Runs that differ in the mesh, the two finest ones, and in the imperfection."""
        if self.imperfect is None:
            return ()
        if self.coarse is None:
            return ((self.imperfect, self.nominal),)
        meshes = (self.nominal, self.coarse) if self.fine is None else (self.fine, self.nominal)
        return (meshes, (self.imperfect, self.coarse))


def missing(case: Case) -> list[str]:
    """Shell runs of a structure that are not stored, or were made of another input."""
    stored = _stored(case)
    return [
        name
        for name, analysis in case.shell_runs().items()
        if stored.get(name, {}).get("provenance", {}).get("source") != _source(case, analysis)
    ]


def solve_missing(case: Case) -> list[str]:
    """Solve and store what is missing, run by run, so that an interrupted command goes on where it was."""
    runs, done = case.shell_runs(), []
    for name in missing(case):
        entry = _solved(case, runs[name])
        stored = _stored(case) | {name: entry}
        text = json.dumps({key: stored[key] for key in runs if key in stored}, indent=1)
        FOLDER.mkdir(exist_ok=True)
        write_text(_file(case), text + "\n")
        done.append(f"{case.name} {name}: {entry['status']}, {entry['seconds']:.1f} s")
    return done


def read(case: Case) -> ShellResults | None:
    """Stored figures of a structure; None if a run is missing or out of date."""
    if missing(case):
        return None
    stored = _stored(case)
    measures = {
        name: Measures(**{key: value for key, value in entry.items() if key != "provenance"})
        for name, entry in stored.items()
    }
    return ShellResults(**measures)


def _source(case: Case, analysis: Analysis) -> str:
    """Hash of the text of an input and of the shell settings of a run; keys that are new change nothing."""
    settings = analysis.shell.model_dump(exclude_defaults=True, mode="json")
    return sha256((case.text + json.dumps(settings, sort_keys=True)).encode()).hexdigest()


def _solved(case: Case, analysis: Analysis) -> dict[str, Any]:
    begin = time.process_time()
    result = solve(with_frames(analysis), "shell", 1)
    measures = measure(result, analysis.structure, time.process_time() - begin)
    provenance = {
        "version": result.provenance.version,
        "source": _source(case, analysis),
        "shell": analysis.shell.model_dump(exclude_defaults=True, mode="json"),
        "elements": 0 if result.states is None else len(result.states.quads),
    }
    return to_json(measures) | {"provenance": provenance}


def to_json(measures: Measures) -> dict[str, Any]:
    """Numbers with six digits, which is finer than any mesh."""

    def short(value: Any) -> Any:
        if isinstance(value, float):
            return float(f"{value:.6g}")
        if isinstance(value, dict):
            return {key: short(item) for key, item in value.items()}
        return [short(item) for item in value] if isinstance(value, list) else value

    return {key: short(value) for key, value in vars(measures).items()}


def _file(case: Case) -> Path:
    return FOLDER / f"{case.name}.json"


def _stored(case: Case) -> dict[str, Any]:
    return dict(json.loads(_file(case).read_text("utf-8"))) if _file(case).exists() else {}
