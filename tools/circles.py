"""Refuse modules that import each other in a circle: `python tools/circles.py [src/PACKAGE]`.

Every import counts, also one inside a function and one for type checking alone: such a circle runs, but no
part of it can be read, tested or moved without the rest.  The package's own `__init__` is left out: it offers
names from everywhere, and nothing imports it.
"""

from __future__ import annotations

import ast
import sys
from collections.abc import Iterator, Mapping
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

ROOT = Path(__file__).parent.parent
PACKAGE = ROOT / "src" / "crumple"


def modules_of(package: Path) -> dict[str, Path]:
    """Files of a package by the name of their module."""
    found = {}
    for path in sorted(package.rglob("*.py")):
        parts = path.relative_to(package.parent).with_suffix("").parts
        found[".".join(parts[:-1] if parts[-1] == "__init__" else parts)] = path
    return found


def imports_of(path: Path, name: str, modules: Mapping[str, Path]) -> Iterator[str]:
    """Modules of the package that a module imports, wherever in its file."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names if alias.name in modules)
        elif isinstance(node, ast.ImportFrom):
            package = name if path.name == "__init__.py" else name.rpartition(".")[0]
            above = package.split(".")[: len(package.split(".")) - node.level + 1] if node.level else []
            source = ".".join([*above, *([node.module] if node.module else [])])
            for alias in node.names:
                full = f"{source}.{alias.name}"
                if full in modules or source in modules:
                    yield full if full in modules else source


def circle(package: Path) -> list[str]:
    """One circle of imports in a package, its first module also last; empty without any."""
    modules = modules_of(package)
    graph = {
        name: {other for other in imports_of(path, name, modules) if other != name}
        for name, path in modules.items()
        if name != package.name
    }
    try:
        TopologicalSorter(graph).prepare()
    except CycleError as error:
        # what imports comes first
        return list(reversed(error.args[1]))
    return []


def main(package: Path = PACKAGE) -> int:
    """Print a circle, if there is one; it decides the exit code."""
    found = circle(package)
    print("circle of imports: " + " -> ".join(found) if found else "circles: no module imports itself")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(*map(Path, sys.argv[1:])))
