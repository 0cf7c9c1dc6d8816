"""Print the requirements of one extra of pyproject.toml, one per line: `python tools/extra.py test`.

`build` prints what a build needs, CMake and Ninja included where the machine has none.
"""

from __future__ import annotations

import shutil
import sys
import tomllib
from pathlib import Path

project = tomllib.loads((Path(__file__).parent.parent / "pyproject.toml").read_text(encoding="utf-8"))
name = sys.argv[1]
if name == "build":
    missing = [tool for tool in ("cmake", "ninja") if shutil.which(tool) is None]
    print("\n".join(project["build-system"]["requires"] + missing))
else:
    print("\n".join(project["project"]["optional-dependencies"][name]))
