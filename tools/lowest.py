"""Print the lowest versions that pyproject.toml allows, as constraints: `python tools/lowest.py`.

Users' dependencies and build requirements; a version without a wheel for this Python is left out, and named.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tomllib
from pathlib import Path

project = tomllib.loads((Path(__file__).parent.parent / "pyproject.toml").read_text())
# the constraints of make would contradict every lowest version
environment = {key: value for key, value in os.environ.items() if key != "PIP_CONSTRAINT"}
for requirement in [*project["project"]["dependencies"], *project["build-system"]["requires"]]:
    name, bound, version = requirement.partition(">=")
    if not bound or not version.replace(".", "").isdigit():
        sys.exit(f"pyproject.toml: {requirement!r} has no plain lower bound; write NAME>=VERSION")
    pin = f"{name}=={version}"
    command = [sys.executable, "-m", "pip", "install", "--dry-run", "--ignore-installed", "--quiet"]
    command += ["--only-binary=:all:", pin]
    found = subprocess.run(command, env=environment, capture_output=True, check=False)
    if found.returncode == 0:
        print(pin)
    else:
        python = f"{sys.version_info.major}.{sys.version_info.minor}"
        print(f"no wheels for {pin} with Python {python}: its newest version is taken", file=sys.stderr)
