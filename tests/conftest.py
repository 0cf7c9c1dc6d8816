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
_MODULES = pytest.StashKey[dict[str, dict[str, Any]]]()

RecordFigure = Callable[..., None]


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--figures", metavar="FILE", help="write figures and outcomes of the verification tests")
    parser.addoption("--sites", metavar="FILE", help="write the refusals of the code that were reached")


def pytest_configure(config: pytest.Config) -> None:
    config.stash[_MODULES] = {}
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
    if report.when != "call" and report.passed:
        return
    path = Path(str(item.path)).relative_to(item.config.rootpath).as_posix()
    module = item.config.stash[_MODULES].setdefault(
        path,
        {"doc": getattr(getattr(item, "module", None), "__doc__", "") or "", "outcomes": {}, "figures": []},
    )
    module["outcomes"][item.name] = report.outcome
    module["figures"] += item.stash.get(_FIGURES, [])


def pytest_sessionfinish(session: pytest.Session) -> None:
    target = session.config.getoption("--figures")
    if target:
        modules = {
            path: module
            for path, module in sorted(session.config.stash[_MODULES].items())
            if path.startswith("tests/verification/")
        }
        Path(target).parent.mkdir(parents=True, exist_ok=True)
        Path(target).write_text(json.dumps(modules, indent=1), encoding="utf-8")
