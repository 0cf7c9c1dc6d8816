"""Which refusals of the code a campaign reached, and which not.

A refusal is a call of `Problem`, `refuse` or a function whose name ends in `refusal`.  `Watch` notes who
builds them while a case runs; `refusal_sites` lists them from the source.
"""

from __future__ import annotations

import ast
import sys
from functools import cache
from pathlib import Path
from typing import Any

import pydantic_core

import crumple
from crumple.errors import Problem

PACKAGE = Path(crumple.__file__).parent
DEEPEST = 6
"""Callers that are noted: a refusal may pass through as many functions that only word it."""
Site = tuple[str, int]


class Watch:
    """Notes the callers of everything that refuses, from now on."""

    def __init__(self) -> None:
        self._seen: set[Site] = set()
        self._told: set[Site] = set()
        built, note = Problem.__init__, self._note

        def problem(self: Problem, *given: Any, **named: Any) -> None:
            note()
            built(self, *given, **named)

        error = pydantic_core.PydanticCustomError

        def custom(*given: Any) -> Any:
            note()
            return error(*given)

        Problem.__init__ = problem  # type: ignore[method-assign]
        # `refuse` looks it up when it is called
        pydantic_core.PydanticCustomError = custom  # type: ignore[assignment, misc]

    def _note(self) -> None:
        frame, place = sys._getframe(2), str(PACKAGE)
        for _ in range(DEEPEST):
            if frame is None:
                break
            code = frame.f_code
            if code.co_filename.startswith(place):
                self._seen.add((code.co_filename[len(place) + 1 :], frame.f_lineno))
            frame = frame.f_back  # type: ignore[assignment]

    def new(self) -> set[Site]:
        """Those that were not reported before."""
        new = self._seen - self._told
        self._told |= new
        return new


@cache
def refusal_sites() -> dict[str, list[tuple[int, int]]]:
    """First and last line of every refusal, by the file in the package."""
    sites: dict[str, list[tuple[int, int]]] = {}
    for path in sorted(PACKAGE.rglob("*.py")):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Call) and _refuses(node.func):
                name = path.relative_to(PACKAGE).as_posix()
                sites.setdefault(name, []).append((node.lineno, node.end_lineno or node.lineno))
    return sites


def _refuses(function: ast.expr) -> bool:
    name = function.id if isinstance(function, ast.Name) else getattr(function, "attr", "")
    return name in ("Problem", "refuse") or name.endswith("refusal")


def unreached(seen: set[Site]) -> tuple[int, list[str]]:
    """How many refusals there are, and those at none of the places seen, as ``file:line``."""
    every, missed = 0, []
    for name, spans in refusal_sites().items():
        lines = {line for file, line in seen if file == name}
        for first, last in spans:
            every += 1
            if not any(first <= line <= last for line in lines):
                missed.append(f"{name}:{first}")
    return every, missed
