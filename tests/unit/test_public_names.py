"""Public names: each resolves, and importing the package imports nothing heavy."""

from __future__ import annotations

import subprocess
import sys
from importlib.metadata import version

import pytest

import crumple

HEAVY = ("numpy", "pydantic", "pint", "h5py", "matplotlib", "scipy", "pandas", "ruamel.yaml", "jinja2")


@pytest.mark.parametrize("name", crumple.__all__)
def test_resolves(name: str) -> None:
    assert getattr(crumple, name) is not None
    assert name in dir(crumple)


def test_version_is_that_of_the_package() -> None:
    assert crumple.__version__ == version("crumple")


def test_unknown_name() -> None:
    with pytest.raises(AttributeError, match="no attribute 'nothing'"):
        _ = crumple.nothing


@pytest.mark.parametrize("code", ["import crumple", "import crumple.cli.main"])
def test_imports_nothing_heavy(code: str) -> None:
    check = f"import sys; {code}; print([name for name in {HEAVY} if name in sys.modules])"
    done = subprocess.run([sys.executable, "-c", check], check=True, capture_output=True, text=True)
    assert done.stdout.strip() == "[]"
