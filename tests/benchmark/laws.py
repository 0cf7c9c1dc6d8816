"""How long a law takes: one evaluation, one building, and the import of the section room.

A law must answer in less than a millisecond: sampling evaluates it some ten times on arrays.
"""

from __future__ import annotations

import subprocess
import sys
import time

import numpy as np

from crumple.hinge import build_axial_law, build_law, build_torsion_law
from crumple.material import Material
from crumple.section import Channel, CircularTube, ClosedHat, RectangularTube

STEEL = Material("steel", 210e9, 0.3, 7850.0, 355e6)
TUBE, SQUARE = RectangularTube(0.05, 0.025, 0.00265), RectangularTube(0.04, 0.04, 0.002)
BENDING = [
    ("constant", TUBE, "y"),
    ("kecman", TUBE, "y"),
    ("wierzbicki", SQUARE, "y"),
    ("oblique", TUBE, "y"),
    ("circular", CircularTube(0.05, 0.002), "y"),
    ("folded_profile", Channel(0.04, 0.08, 0.002), "z"),
]
AXIAL = [
    ("square", SQUARE),
    ("superfolding", TUBE),
    ("circular", CircularTube(0.05, 0.002)),
    ("top_hat", ClosedHat(0.05, 0.04, 0.0015, 0.018)),
]
IMPORT = "import time, numpy; t = time.perf_counter(); import crumple.section; print(time.perf_counter() - t)"


def best(function, repeats: int = 20) -> float:
    """Shortest of several runs [ms]."""
    times = []
    for _ in range(repeats):
        start = time.perf_counter()
        function()
        times.append(time.perf_counter() - start)
    return 1e3 * min(times)


if __name__ == "__main__":
    rotations = np.linspace(0.0, 1.0, 10)
    slow = []
    for name, section, axis in BENDING:
        law = build_law(name, section, STEEL, axis)
        one = best(lambda law=law: law.moment_capacity(0.2))
        ten = best(lambda law=law: law.moment_capacity(rotations))
        built = best(lambda n=name, s=section, a=axis: build_law(n, s, STEEL, a), 5)
        print(f"{name:<16} one rotation {one:6.3f} ms   ten {ten:6.3f} ms   built in {built:7.3f} ms")
        slow += [name] if max(one, ten) > 1.0 else []
    torsion = build_torsion_law("square_tube", SQUARE, STEEL, 0.5, decay=0.3)
    print(f"{'square_tube':<16} one twist    {best(lambda: torsion.moment_capacity(0.2)):6.3f} ms")
    for name, section in AXIAL:
        built = best(lambda n=name, s=section: build_axial_law(n, s, STEEL))
        print(f"{name:<16} axial, built and answered in {built:6.3f} ms")
        slow += [name] if built > 1.0 else []
    imported = min(
        float(
            subprocess.run([sys.executable, "-c", IMPORT], capture_output=True, text=True, check=True).stdout
        )
        for _ in range(3)
    )
    print(f"import of crumple.section after numpy: {1e3 * imported:.1f} ms")
    if slow or imported > 0.05:
        raise SystemExit(f"too slow: {slow}, import {1e3 * imported:.1f} ms")
