"""The thrown panel in CalculiX, as solid elements: figures for tests/verification/shell/test_panel.py.

``python -m tests.benchmark.foreign.calculix_panel FOLDER`` writes the decks of all meshes, runs ``ccx``
(Debian: calculix-ccx) on those that have no results yet, and writes the figures that the test keeps.

A quarter of the panel, C3D20R (20 nodes, reduced integration: two points per element through the wall),
implicit dynamics (``*DYNAMIC``, its own damping of -0.05), finite strains.  A hinged end is two equations per
pair of nodes at the same distance from the mid-surface: their displacements add to zero.  A rotating
wall does that exactly, and the membrane force is spread over the wall.  The border of the thrown part
lies in the middle of an element, so that the momentum is exact.
"""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from tests.support.shell.panel import (
    DENSITY,
    HALF_ANGLE,
    LENGTH,
    LOADED_LENGTH,
    POISSONS_RATIO,
    RADIUS,
    SPEED,
    WALL,
    YIELD_STRESS,
    YOUNGS_MODULUS,
)

KEPT = Path(__file__).parents[2] / "verification" / "shell" / "panel_reference.json"
UNIFORM = np.linspace(0.0, 1.0, 9)
# finer where the panel bends towards its end; loaded up to 13/16
FINE = np.array([0.0, 0.2, 0.4, 0.55, 0.675, 37 / 48, 41 / 48, 43 / 48, 0.9375, 0.96875, 1.0])
FINEST = np.array([0.0, 0.2, 0.4, 0.55, 0.65, 0.73, 0.78, 191 / 240, 199 / 240, 0.86, 0.9, 0.94, 0.97, 1.0])
MESHES = {
    "coarse": (UNIFORM, 7, 2, (2e-6, 1e-3)),
    "coarse, half the step": (UNIFORM, 7, 2, (1e-6, 0.5e-3)),
    "coarse, four through the wall": (UNIFORM, 7, 4, (2e-6, 0.5e-3)),
    "fine": (FINE, 15, 2, (2e-6, 1e-3)),
    "fine, four through the wall": (FINE, 15, 4, (2e-6, 0.4e-3)),
    "finest": (FINEST, 25, 2, (2e-6, 0.5e-3)),
}
"""Lines along the half length, elements around and through the wall, largest step and end [s]."""
# corners, then middles of sides, of CalculiX's brick, in half elements
BRICK = [(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (0, 0, 2), (2, 0, 2), (2, 2, 2), (0, 2, 2)]
BRICK += [(1, 0, 0), (2, 1, 0), (1, 2, 0), (0, 1, 0), (1, 0, 2), (2, 1, 2), (1, 2, 2), (0, 1, 2)]
BRICK += [(0, 0, 1), (2, 0, 1), (2, 2, 1), (0, 2, 1)]

Grid = dict[tuple[int, int, int], int]


def nodes(along: int, around: int, through: int) -> Grid:
    """Number of the node at half elements (i, j, k) along, around and through the wall."""
    sides = (range(2 * n + 1) for n in (along, around, through))
    i, j, k = np.meshgrid(*sides, indexing="ij")
    places = np.stack([i.ravel(), j.ravel(), k.ravel()], axis=1)
    places = places[(places % 2).sum(axis=1) <= 1]
    return {tuple(map(int, place)): n for n, place in enumerate(places, 1)}


def printed(grid: Grid, through: int) -> list[int]:
    """Corners of elements on the mid-surface: down the middle of the crown, then around the middle arc."""
    corners = {place: n for place, n in grid.items() if place[0] % 2 == place[1] % 2 == 0}
    crown = [n for (_, j, k), n in corners.items() if j == 0 and k == through]
    return crown + [n for (i, j, k), n in corners.items() if i == 0 < j and k == through]


def supports(
    grid: Grid, last: tuple[int, int, int]
) -> tuple[set[tuple[int, int]], list[tuple[int, int, int]]]:
    """Held freedoms (node, axis), and pairs (node, node, axis) whose displacements add to zero."""
    held, pairs = set(), []
    for (i, j, k), n in grid.items():
        clamped = j == last[1] or (i == last[0] and 2 * k == last[2])
        held |= {(n, axis) for axis in (1, 2, 3) if clamped}
        held |= {(n, axis) for axis, plane in ((1, i), (2, j)) if plane == 0}
    for (i, j, k), n in grid.items():
        if i == last[0] and 2 * k > last[2]:
            other = grid[i, j, last[2] - k]
            pairs += [(n, other, axis) for axis in (1, 2, 3) if (n, axis) not in held]
    return held, pairs


def deck(lines: np.ndarray, around: int, through: int, times: tuple[float, float]) -> Iterator[str]:
    """Lines of the input file."""
    along = len(lines) - 1
    last = (2 * along, 2 * around, 2 * through)
    grid = nodes(along, around, through)
    half = np.arange(last[0] + 1) / 2
    x = LENGTH / 2 * np.interp(half, np.arange(along + 1), lines)
    border = 2 * float(np.interp(LOADED_LENGTH, lines, np.arange(along + 1)))
    held, pairs = supports(grid, last)
    start = []
    yield "*NODE"
    for (i, j, k), n in grid.items():
        angle = HALF_ANGLE * j / last[1]
        r = RADIUS + WALL * (k / last[2] - 0.5)
        yield f"{n}, {x[i]:.10g}, {r * np.sin(angle):.10g}, {r * np.cos(angle):.10g}"
        loaded = np.prod(np.clip([(border - i + 1) / 2, (around - j + 1) / 2], 0.0, 1.0))
        speeds = ((2, -SPEED * loaded * np.sin(angle)), (3, -SPEED * loaded * np.cos(angle)))
        start += [f"{n}, {axis}, {v:.10g}" for axis, v in speeds if loaded and (n, axis) not in held]
    yield "*ELEMENT, TYPE=C3D20R, ELSET=WALL"
    corners = [place for place in grid if all(a % 2 == 0 and a < b for a, b in zip(place, last, strict=True))]
    for e, (i, j, k) in enumerate(corners, 1):
        brick = [str(grid[i + a, j + b, k + c]) for a, b, c in BRICK]
        yield f"{e}, " + ", ".join(brick[:10]) + ","
        yield ", ".join(brick[10:])
    yield f"*MATERIAL, NAME=METAL\n*ELASTIC\n{YOUNGS_MODULUS:.10g}, {POISSONS_RATIO}"
    yield f"*DENSITY\n{DENSITY}\n*PLASTIC\n{YIELD_STRESS:.10g}, 0."
    yield "*SOLID SECTION, ELSET=WALL, MATERIAL=METAL"
    yield "*EQUATION"
    yield from (f"2\n{n}, {axis}, 1., {other}, {axis}, 1." for n, other, axis in pairs)
    yield "*BOUNDARY"
    yield from (f"{n}, {axis}, {axis}, 0." for n, axis in sorted(held))
    yield "*INITIAL CONDITIONS, TYPE=VELOCITY"
    yield from start
    yield "*NSET, NSET=OUT"
    yield from (f"{n}," for n in printed(grid, through))
    step, end = times
    yield f"*STEP, NLGEOM, INC=100000\n*DYNAMIC\n{step:g}, {end:g}, {step / 100:g}, {step:g}"
    yield "*NODE PRINT, NSET=OUT\nU\n*EL PRINT, ELSET=WALL, TOTALS=ONLY\nELSE, ELKE\n*END STEP"


def results(path: Path) -> tuple[np.ndarray, np.ndarray, float]:
    """Times [s], lowerings of the printed nodes (times, nodes) [m], energy at the first time [J]."""
    times, lowerings, energy, kind = [], [], 0.0, ""
    for line in path.read_text(encoding="utf-8").splitlines():
        fields = line.split()
        if "time" in fields:
            kind = fields[0]
            if kind == "displacements":
                times.append(float(fields[-1]))
                lowerings.append([])
        elif fields and kind == "displacements":
            lowerings[-1].append(-float(fields[3]))
        elif fields and len(times) == 1:
            energy += 4 * float(fields[0])
    return np.array(times), np.array(lowerings), energy


def figures(lines: np.ndarray, around: int, end: float, path: Path) -> dict[str, object]:
    """What the test compares, in metres and seconds, rounded to seven digits; shapes are those at 0.4 ms."""
    time, down, energy = results(path)
    time, down = time[time < end + 1e-9], down[time < end + 1e-9]
    at = np.arange(0.0, end + 1e-9, 20e-6)
    zero = np.zeros((1, down.shape[1]))
    history = np.stack([np.interp(at, np.r_[0.0, time], w) for w in np.r_[zero, down].T])
    top = int(down[:, 0].argmax())
    return {
        "energy": round(energy, 2),
        "increments": len(time),
        "largest": round(float(down[top, 0]), 7),
        "time_of_largest": round(float(time[top]), 7),
        "deflection": np.round(history[0], 7).tolist(),
        "crown_at": np.round(LENGTH / 2 * lines, 7).tolist(),
        "crown": np.round(history[: len(lines), 20], 7).tolist(),
        "arc_at": np.round(HALF_ANGLE / around * np.arange(around + 1), 7).tolist(),
        "arc": np.round(np.r_[history[0, 20], history[len(lines) :, 20]], 7).tolist(),
    }


def main() -> None:
    folder = Path(sys.argv[1])
    version = subprocess.run(["ccx", "-v"], capture_output=True, text=True, check=False).stdout.split()[-1]
    meshes = {}
    for name, (lines, around, through, times) in MESHES.items():
        job = folder / name.replace(" ", "_").replace(",", "")
        if not job.with_suffix(".dat").exists():
            job.with_suffix(".inp").write_text("\n".join(deck(lines, around, through, times)) + "\n")
            with job.with_suffix(".log").open("w") as log:
                subprocess.run(["ccx", "-i", job.name], cwd=folder, stdout=log, check=True)
        mesh = {"elements": [len(lines) - 1, around, through], "largest_step": times[0], "every": 20e-6}
        meshes[name] = mesh | figures(lines, around, times[1], job.with_suffix(".dat"))
    kept = {"code": f"CalculiX {version}", "element": "C3D20R", "meshes": meshes}
    KEPT.write_text(json.dumps(kept, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
