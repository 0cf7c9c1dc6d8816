"""Refuse packages that tests or checks use at a version that is not pinned: `python tools/pinned.py FILE`.

Looks at what Crumple and its extras need in this environment, and at what those need in turn.
"""

from __future__ import annotations

import sys
from importlib.metadata import PackageNotFoundError, distribution
from pathlib import Path

from packaging.requirements import Requirement
from packaging.utils import canonicalize_name


def needed(root: str) -> dict[str, str]:
    """Versions of all that is installed because of a requirement, by name."""
    versions: dict[str, str] = {}
    waiting, seen = [root], set()
    while waiting:
        requirement = Requirement(waiting.pop())
        name = canonicalize_name(requirement.name)
        for extra in ("", *requirement.extras):
            if (name, extra) in seen:
                continue
            seen.add((name, extra))
            try:
                found = distribution(name)
            except PackageNotFoundError:
                continue
            versions[name] = found.version
            for text in found.requires or []:
                marker = Requirement(text).marker
                if marker is None or marker.evaluate({"extra": extra}):
                    waiting.append(text)
    return versions


def pinned(path: Path) -> dict[str, str]:
    """Exact versions of a constraints file that hold for this Python, by name."""
    lines = [line for line in path.read_text().splitlines() if line and not line.startswith("#")]
    pins = [Requirement(line) for line in lines]
    held = [pin for pin in pins if pin.marker is None or pin.marker.evaluate()]
    return {canonicalize_name(pin.name): str(pin.specifier).removeprefix("==") for pin in held}


pins = pinned(Path(sys.argv[1]))
versions = needed("crumple[test,check]")
problems = [
    f"{name} {version} is installed, {sys.argv[1]} has {pins.get(name, 'no version')}"
    for name, version in sorted(versions.items())
    if name != "crumple" and pins.get(name) != version
]
print("\n".join(problems) or f"pinned: all {len(versions) - 1} packages are at their versions")
sys.exit(bool(problems))
