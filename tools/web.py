"""Make the scripts of all pages from `web/`: `python tools/web.py`.

With `--check` it tells whether they are up to date.

Needs Node with npm, which only developers of the page have; the packages are those of the lock file, and none
of their own scripts is run.
"""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parent.parent
WEB, SOURCE = ROOT / "web", ROOT / "src" / "crumple"
PAGE, REPORT = SOURCE / "app" / "page", SOURCE / "report"
MADE = {
    "app": PAGE / "app.js",
    "codemirror": PAGE / "vendor" / "codemirror.min.js",
    "viewer": REPORT / "templates" / "viewer.js",
    "explore": REPORT / "templates" / "explore.js",
    "study": REPORT / "templates" / "study.js",
    "page": REPORT / "templates" / "page.js",
    "three": REPORT / "vendor" / "three.min.js",
}
"""Files by the script of `web/package.json` that prints them."""


def npm(*arguments: str) -> str:
    """Run npm and give what it printed."""
    command = [shutil.which("npm") or "npm", *arguments]
    return subprocess.run(
        command, cwd=WEB, check=True, stdout=subprocess.PIPE, text=True, encoding="utf-8"
    ).stdout


def packages_missing() -> str:
    """Install the packages of the lock file, and tell why that failed; empty if it did not."""
    try:
        npm("ci", "--ignore-scripts", "--silent", "--no-audit", "--no-fund")
    except subprocess.CalledProcessError:
        return "npm could not install the packages"
    return ""


def main() -> int:
    """Write the files, or name those that differ; a check without Node or its packages is left out."""
    check = "--check" in sys.argv[1:]
    missing = "npm is missing" if shutil.which("npm") is None else packages_missing()
    if missing:
        print(f"web: {missing}, the page's scripts were not made again")
        return 0 if check else 1
    npm("run", "--silent", "check")
    stale = []
    for script, path in MADE.items():
        text = npm("run", "--silent", script)
        if check and path.read_text(encoding="utf-8") != text:
            stale.append(path.relative_to(ROOT).as_posix())
        elif not check:
            path.write_text(text, encoding="utf-8", newline="\n")
    print(f"web: run `make web`, out of date: {', '.join(stale)}" if stale else "web: scripts are up to date")
    return 1 if stale else 0


if __name__ == "__main__":
    sys.exit(main())
