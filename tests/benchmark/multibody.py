"""Time of the multibody kernels on models M1 to M4 and frames, 100 ms simulated, and ratios to Exudyn 1.13.

Accuracy 1e-3, native solve alone (lowering and histories aside), one thread. Best and median of many
solves in this process; the true error of the sum of rotations is printed beside each time. Bounds: M1
20 us, M2(10) 0.3 ms, M2(100) 3 ms, a frame of 300 bodies with 100 loops 0.5 s. Exudyn solves the
regularised law with the fastest of a few solvers whose true error is below 1e-3; where it cannot be
installed, a line reports it and there is no ratio.
"""

from __future__ import annotations

import statistics
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT))

from tests.benchmark.foreign.exudyn_models import PACKAGE, best_time, exudyn  # noqa: E402
from tests.support.multibody import space_models  # noqa: E402
from tests.support.multibody.chains import REGULARISED, SET_VALUED, m1, m2, m3  # noqa: E402

END = np.array([0.1])
ACCURACY = 1e-3
REPEATS = 300
# model, figure (sum of rotations; M3 by runs at 1e-8), bound on the best time [s]
CASES: dict[str, tuple[Callable[[int], Any], float, float | None]] = {
    "M1 set-valued": (lambda form: m1(ACCURACY, form, error=1e-5), 0.424127729101, 20e-6),
    "M1 regularised": (lambda form: m1(ACCURACY, form, error=1e-5), 0.424130871579, None),
    "M2(10) set-valued": (lambda form: m2(10, ACCURACY, form, error=1e-5), 0.6621342, 0.3e-3),
    "M2(10) regularised": (lambda form: m2(10, ACCURACY, form, error=1e-5), 0.6656451692, None),
    "M2(100) set-valued": (lambda form: m2(100, ACCURACY, form, error=1e-5), 0.5845621, 3e-3),
    "M3 set-valued": (lambda form: m3(ACCURACY, form, error=1e-5), -0.52836756, None),
    "M3 regularised": (lambda form: m3(ACCURACY, form, error=1e-5), -0.52837003, None),
}
RATIOS = {"M1": 20.0, "M2(10)": 200.0, "M3": 30.0, "M4": 50.0}
"""Least ratio of Exudyn's time to that of the set-valued model."""


M4_FIGURE = 2.86792084
"""Sum of the angles of M4's hinges, regularised, at accuracy 1e-6; Exudyn: 2.86794 with 800 steps."""
FRAME_BOUND = 0.5
"""Time [s] for a frame of 300 bodies with 100 loops."""
FRAMES: dict[str, dict[str, Any]] = {
    "in its plane": {},
    "across it": {"velocity": (0.0, 10.0, 0.0)},
    "beams at odds": {"sway": (3.0, 3.0, 0.0)},
}
"""Starts of the tower of 100 storeys. Its plane has the bound; the others let all hinges go at once."""


def native() -> dict[str, float]:
    """Best time of every case [s]; prints a line each."""
    best: dict[str, float] = {}
    for name, (model, figure, bound) in CASES.items():
        form = SET_VALUED if "set-valued" in name else REGULARISED
        times, error = [], 0.0
        for _ in range(REPEATS if "100" not in name else REPEATS // 10):
            simulation = model(form)
            begin = time.perf_counter()
            simulation._kernel.run(END.tolist())
            times.append(time.perf_counter() - begin)
            error = float(simulation.q.sum() / figure - 1.0)
        best[name] = min(times)
        missed = ", MISSED" if bound is not None and min(times) > bound else ""
        allowed = "" if bound is None else f"   bound {bound * 1e6:g} us{missed}"
        middle = statistics.median(times)
        print(f"{name:20}  best {min(times) * 1e6:9.1f} us   median {middle * 1e6:9.1f} us   ", end="")
        print(f"error {error:+.1e}{allowed}")
    return best


def cube_in_space() -> dict[str, float]:
    """Best time [s] of model M4 in the spatial kernel in both forms; prints a line each."""
    best: dict[str, float] = {}
    for form, name in ((SET_VALUED, "M4 set-valued"), (REGULARISED, "M4 regularised")):
        times, steps, error = [], 0, 0.0
        for _ in range(5):
            simulation = space_models.m4(ACCURACY, form, error=1e-5)
            begin = time.perf_counter()
            run = simulation.run(END)
            times.append(time.perf_counter() - begin)
            steps = run.steps
            error = (
                float(np.linalg.norm(run.hinge.rotation[-1].reshape(-1, 3), axis=1).sum()) / M4_FIGURE - 1.0
            )
        best[name] = min(times)
        print(f"{name:20}  best {min(times) * 1e6:9.1f} us   {steps} steps   error {error:+.1e}")
    return best


def frames_in_space() -> int:
    """Print a line for every frame of 300 bodies; 1 if the one with a bound misses it."""
    missed = 0
    for name, start in FRAMES.items():
        times = []
        for _ in range(3 if name == "in its plane" else 1):
            simulation = space_models.tower(100, ACCURACY, error=1e-5, **start)
            begin = time.perf_counter()
            run = simulation.run(END)
            times.append(time.perf_counter() - begin)
        bound = ""
        if name == "in its plane":
            short = min(times) > FRAME_BOUND
            missed += short
            bound = f"   bound {FRAME_BOUND * 1e3:g} ms" + (", MISSED" if short else "")
        counts = f"{run.steps} + {run.rejected} steps, {run.solves} Newton solves"
        print(f"300 bodies, 100 loops, {name:15}  best {min(times) * 1e3:9.1f} ms   {counts}{bound}")
    return missed


def main() -> int:
    """Print the table; the number of bounds missed."""
    best = native()
    best |= cube_in_space()
    missed = frames_in_space() + sum(
        bound is not None and best[name] > bound for name, (_, _, bound) in CASES.items()
    )
    exu = exudyn()
    if exu is None:
        print(f"{PACKAGE} could not be installed: no ratio")
        return missed
    for name, least in RATIOS.items():
        figure = M4_FIGURE if name == "M4" else CASES[f"{name} regularised"][1]
        foreign = best_time(exu, name, figure, ACCURACY)
        if foreign is None:
            print(f"Exudyn {name}: no solver reached {ACCURACY:g}")
            continue
        taken, how, error = foreign
        print(f"Exudyn {exu.__version__} {name:6}  best {taken * 1e6:9.1f} us   error {error:+.1e}   ({how})")
        for form in ("regularised", "set-valued"):
            ratio = taken / best[f"{name} {form}"]
            short = form == "set-valued" and ratio < least
            missed += short
            print(f"  ratio to Crumple, {form}: {ratio:.0f}" + (f", bound {least:g} MISSED" if short else ""))
    return missed


if __name__ == "__main__":
    sys.exit(main())
