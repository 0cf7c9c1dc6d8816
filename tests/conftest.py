"""What all tests share: repeatable random input, and figures that verification tests record."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from hypothesis import settings

# the same examples in every run; a slow machine is no failure
settings.register_profile("repeatable", derandomize=True, deadline=None, database=None)
settings.load_profile("repeatable")

_FIGURES = pytest.StashKey[list[dict[str, Any]]]()

RecordFigure = Callable[..., None]
VERIFICATION = "tests/verification/"
_PROPERTY = "verification"


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--figures", metavar="FILE", help="write figures and outcomes of the verification tests")
    parser.addoption("--sites", metavar="FILE", help="write the refusals of the code that were reached")


def pytest_configure(config: pytest.Config) -> None:
    target = config.getoption("--figures")
    if target and not hasattr(config, "workerinput"):
        config.pluginmanager.register(_Figures(Path(target)))
    if config.getoption("--sites"):
        from tests.fuzz.sites import Recorder

        config.pluginmanager.register(Recorder(config))


@pytest.fixture
def record_figure(request: pytest.FixtureRequest) -> RecordFigure:
    """Record a figure for docs/verification.md and require it to meet its tolerance.

    ``record_figure(name, value, expected, tolerance, unit="", relative=False)``: the tolerance is absolute
    in the unit of the value, or a fraction of the expected value with ``relative=True``.
    """
    figures = request.node.stash.setdefault(_FIGURES, [])

    def record(
        name: str, value: float, expected: float, tolerance: float, unit: str = "", *, relative: bool = False
    ) -> None:
        allowed = tolerance * abs(expected) if relative else tolerance
        met = bool(abs(value - expected) <= allowed)
        figures.append(
            {
                "name": name,
                "value": float(value),
                "expected": float(expected),
                "tolerance": float(tolerance),
                "relative": relative,
                "unit": unit,
                "passed": met,
            }
        )
        assert met, f"{name}: got {value!r}, expected {expected!r} within {allowed:g} {unit}"

    return record


@pytest.hookimpl(hookwrapper=True)
def pytest_runtest_makereport(item: pytest.Item, call: pytest.CallInfo[None]) -> Iterator[None]:
    outcome = yield
    report = outcome.get_result()  # type: ignore[attr-defined]
    if item.nodeid.startswith(VERIFICATION) and (report.when == "call" or not report.passed):
        doc = getattr(getattr(item, "module", None), "__doc__", "") or ""
        found = {"name": item.name, "doc": doc, "figures": item.stash.get(_FIGURES, [])}
        report.user_properties.append((_PROPERTY, found))


class _Figures:
    """Writes what the reports of verification tests carry, from whichever process they come."""

    def __init__(self, target: Path) -> None:
        self._target = target
        self._modules: dict[str, dict[str, Any]] = {}

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        for name, found in report.user_properties:
            if name == _PROPERTY:
                fresh = {"doc": found["doc"], "outcomes": {}, "figures": []}
                module = self._modules.setdefault(report.nodeid.partition("::")[0], fresh)
                module["outcomes"][found["name"]] = report.outcome
                module["figures"] += found["figures"]

    def pytest_sessionfinish(self) -> None:
        self._target.parent.mkdir(parents=True, exist_ok=True)
        text = json.dumps(dict(sorted(self._modules.items())), indent=1)
        self._target.write_text(text, encoding="utf-8")
