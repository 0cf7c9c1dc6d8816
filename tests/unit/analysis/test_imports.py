"""Reading and checking input stays lean: what draws, stores or converts unusual units is not imported."""

import subprocess
import sys

HEAVY = ("pint", "h5py", "matplotlib", "scipy", "pandas", "jinja2", "crumple._core", "crumple.multibody")
SCRIPT = """
import sys
from crumple.analysis import load
load("examples/01_tube_bending.yaml")
print(*[name for name in {heavy!r} if name in sys.modules])
"""


def test_loading_an_input_file_imports_nothing_heavy():
    script = SCRIPT.format(heavy=HEAVY)
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert done.stdout.split() == []
