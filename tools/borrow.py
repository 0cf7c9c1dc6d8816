"""Let another virtual environment see the packages of this one: `python tools/borrow.py ENVIRONMENT`.

A path file names the folder of this environment's packages.  Path files inside that folder are not
followed, so an editable install of Crumple here stays invisible there.
"""

from __future__ import annotations

import subprocess
import sys
import sysconfig
from pathlib import Path

python = Path(sys.argv[1]) / "bin" / "python"
code = "import sysconfig; print(sysconfig.get_path('purelib'))"
theirs = subprocess.run([python, "-c", code], check=True, capture_output=True, text=True).stdout.strip()
Path(theirs, "borrowed.pth").write_text(sysconfig.get_path("purelib") + "\n", encoding="utf-8")
