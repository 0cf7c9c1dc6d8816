"""Every refusal of the code, and which of them were reached: `python -m tests.fuzz.sites REACHED...`.

A site is a call that makes a refusal: of one of `ERRORS`, or of a function of the package that returns one
or never returns, with no other site among its arguments.  Its name is made of file, function and message,
so it stays when lines move.  `Watch` notes sites exactly: by the positions of the calls on the stack when an
error is made.

`unreached.txt` lists the sites that `make test` does not reach, each under its reason.  `make test` writes
what it reached (`--sites`), and this module's check fails for a site that is neither reached nor listed and
for a line of the list that names no site.
"""

from __future__ import annotations

import ast
import gc
import json
import sys
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from functools import cache
from pathlib import Path
from types import CodeType
from typing import Any

import pydantic_core
import pytest
import typer

import crumple
from crumple.errors import InputError, Problem
from crumple.structure.schema import registered

PACKAGE = Path(crumple.__file__).parent
LIST = Path(__file__).parent / "unreached.txt"
ERRORS = {"Problem", "InputError", "QuantityError", "PydanticCustomError", "BadParameter"}
DEEPEST = 16
"""Callers that are looked at: a refusal may pass through as many functions that only word it."""
LONGEST = 90
"""Characters of a message in a name."""
End = tuple[str, int, int]
"""File in the package, last line and column of a call."""


class Watch:
    """Notes the sites of everything that refuses, from now on."""

    def __init__(self) -> None:
        self._seen: set[str] = set()
        self._given: set[str] = set()
        for kind in (Problem, InputError, typer.BadParameter):
            self._hook(kind)
        error = pydantic_core.PydanticCustomError

        def custom(*given: Any) -> Any:
            self._note()
            return error(*given)

        # `refuse` looks it up when it is called
        for module in (pydantic_core, registered):
            module.PydanticCustomError = custom  # type: ignore[attr-defined]

    def _hook(self, kind: Any) -> None:
        made = kind.__init__

        def noted(this: Any, *given: Any, **named: Any) -> None:
            self._note()
            made(this, *given, **named)

        kind.__init__ = noted

    def _note(self) -> None:
        frame, place, sites = sys._getframe(2), str(PACKAGE), _by_end()
        for _ in range(DEEPEST):
            if frame is None:
                break
            code = frame.f_code
            if code.co_filename.startswith(place):
                name = sites.get(_end(code, frame.f_lasti))
                if name is not None:
                    self._seen.add(name)
            frame = frame.f_back  # type: ignore[assignment]

    def new(self) -> set[str]:
        """Those that were not reported before."""
        new = self._seen - self._given
        self._given |= new
        return new


class Recorder:
    """Plugin of pytest that writes the sites reached by all its processes (`--sites FILE`)."""

    def __init__(self, config: Any) -> None:
        self._watch, self._config, self._reached = Watch(), config, REACHED

    def pytest_sessionfinish(self, session: Any) -> None:
        self._reached |= self._watch.new()
        if hasattr(self._config, "workeroutput"):
            self._config.workeroutput["sites"] = sorted(self._reached)
        else:
            path = Path(self._config.getoption("--sites"))
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(json.dumps(sorted(self._reached), indent=0), encoding="utf-8")

    @pytest.hookimpl(optionalhook=True)
    def pytest_testnodedown(self, node: Any) -> None:
        self._reached |= set(getattr(node, "workeroutput", {}).get("sites", ()))


REACHED: set[str] = set()
"""What workers of this process reached in other processes."""


@cache
def _end(code: CodeType, at: int) -> End:
    _, line, _, column = list(code.co_positions())[at // 2]
    return Path(code.co_filename).relative_to(PACKAGE).as_posix(), line or 0, column or 0


@cache
def sites() -> dict[str, str]:
    """Place (``file:line``) of every refusal, by its name."""
    return {name: f"{file}:{first}" for name, first, (file, *_) in _sites()}


@cache
def _by_end() -> dict[End, str]:
    return {end: name for name, _, end in _sites()}


@cache
def _sites() -> list[tuple[str, int, End]]:
    # the collector would look through all trees again and again, which takes as long as everything else
    gc.disable()
    try:
        return _found()
    finally:
        gc.enable()


def _found() -> list[tuple[str, int, End]]:
    trees = {
        path.relative_to(PACKAGE).as_posix(): ast.parse(path.read_text(encoding="utf-8"))
        for path in sorted(PACKAGE.rglob("*.py"))
    }
    nodes = {file: list(ast.walk(tree)) for file, tree in trees.items()}
    makers = {file: set(_makers(inside)) for file, inside in nodes.items()}
    public = {name for names in makers.values() for name in names if not name.startswith("_")}
    found, met = [], Counter[str]()
    for file, tree in trees.items():
        texts = _assigned(nodes[file])
        for function, node in _calls(tree, ERRORS | public | makers[file]):
            name = f"{file} {function}: {_message(node, texts)}"
            met[name] += 1
            if met[name] > 1:
                name += f" ({met[name]})"
            found.append((name, node.lineno, (file, node.end_lineno or 0, node.end_col_offset or 0)))
    return found


def _makers(nodes: Iterable[ast.AST]) -> Iterator[str]:
    """Functions that return an error, or never return."""
    for node in nodes:
        returns = node.returns if isinstance(node, ast.FunctionDef) else None
        if returns is not None and ast.unparse(returns) in {*ERRORS, "NoReturn"}:
            yield node.name  # type: ignore[attr-defined]


def _calls(tree: ast.AST, names: set[str], function: str = "module") -> list[tuple[str, ast.Call]]:
    """Calls of these functions with no other one among their arguments, and the function where they are."""
    found = []
    for node in ast.iter_child_nodes(tree):
        if isinstance(node, ast.FunctionDef | ast.ClassDef):
            found += _calls(node, names, node.name if function == "module" else f"{function}.{node.name}")
            continue
        inner = _calls(node, names, function)
        found += inner
        if isinstance(node, ast.Call) and not inner:
            called = node.func.id if isinstance(node.func, ast.Name) else getattr(node.func, "attr", "")
            if called in names:
                found.append((function, node))
    return found


def _message(node: ast.Call, texts: Sequence[tuple[str, int, ast.expr]]) -> str:
    """What is wrong: one of the first arguments, or what was assigned to it above; else the call itself."""
    text = ""
    # the first argument may be where it is
    for given in node.args[:2]:
        above = [
            value
            for name, line, value in texts
            if isinstance(given, ast.Name) and name == given.id and line <= node.lineno
        ]
        text = text if " " in text else _text(above[-1] if above else given)
    return " ".join((text if " " in text else ast.unparse(node)).split())[:LONGEST]


def _text(node: ast.expr) -> str:
    """The longest text in an expression, with {} for what is computed there."""
    texts = [""]
    for part in ast.walk(node):
        if isinstance(part, ast.JoinedStr):
            texts.append(
                "".join(
                    str(getattr(one, "value", "")) if isinstance(one, ast.Constant) else "{}"
                    for one in part.values
                )
            )
        elif isinstance(part, ast.Constant) and isinstance(part.value, str):
            texts.append(part.value)
    return max(texts, key=len)


def _assigned(nodes: Iterable[ast.AST]) -> list[tuple[str, int, ast.expr]]:
    """Name, line and value of the assignments, in order of lines."""
    found = []
    for node in nodes:
        if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name):
            found.append((node.targets[0].id, node.lineno, node.value))
        elif (
            isinstance(node, ast.Assign)
            and isinstance(node.targets[0], ast.Tuple)
            and isinstance(node.value, ast.Tuple)
        ):
            found += [
                (one.id, node.lineno, value)
                for one, value in zip(node.targets[0].elts, node.value.elts, strict=False)
                if isinstance(one, ast.Name)
            ]
    return sorted(found, key=lambda one: one[1])


def reasons(path: Path = LIST) -> dict[str, str]:
    """Reason of every site that is listed as not reached; lines of a reason begin with '#'."""
    found: dict[str, str] = {}
    reason, open_ = "", False
    for line in path.read_text(encoding="utf-8").splitlines():
        if line.startswith("#"):
            reason, open_ = (f"{reason} " if open_ else "") + line.removeprefix("#").strip(), True
        elif line.strip():
            found[line.strip()], open_ = reason, False
    return found


def report(reached: Iterable[str]) -> str:
    """What was reached and what not."""
    every, seen, known = sites(), set(reached), reasons()
    missed = [name for name in every if name not in seen]
    unlisted = [name for name in missed if name not in known]
    lines = [f"refusals in the code: {len(every)}, reached: {len(every) - len(missed)}"]
    lines += [
        f"neither reached nor listed: {len(unlisted)}",
        *(f"  {every[name]}  {name}" for name in unlisted),
    ]
    lines += [f"listed, but reached: {name}" for name in known if name in seen]
    return "\n".join(lines)


def wrong(reached: Iterable[str]) -> list[str]:
    """Sites that are neither reached nor listed, and lines of the list that name no site."""
    every, seen, known = sites(), set(reached), reasons()
    return [name for name in every if name not in seen | set(known)] + [
        one for one in known if one not in every
    ]


def main(paths: list[str]) -> int:
    """Print what the files with reached sites leave out; 1 if the list does not hold."""
    reached = {name for path in paths for name in json.loads(Path(path).read_text(encoding="utf-8"))}
    print(report(reached))
    for name in wrong(reached):
        print(f"wrong in {LIST.name}, or to be reached by a test: {name}")
    return int(bool(wrong(reached)))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
