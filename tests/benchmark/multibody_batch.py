"""Variants of model M2(10) in a plane and of the cube frame M4 in space per second, on one thread and on two.

100 ms simulated at accuracy 1e-3. Capacities of all hinges and the speed at the start vary by 10 % from
variant to variant. Bound: 10 000 a second of M2(10) on two threads; M4 has none. Beside the wall's time
stands the processor's, which other work on the machine does not stretch.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

sys.path.insert(0, str(Path(__file__).parents[2]))

from tests.support.multibody.chains import m2
from tests.support.multibody.space_models import m4_parts

from crumple._core.planar import batch
from crumple._core.spatial import batch as space_batch
from crumple._core.variants import Variants

COUNT, SPACE_COUNT, BOUND, REPEATS = 4000, 400, 10_000, 5


def chains() -> Variants:
    """The chain turning as one, hinges and speed varied."""
    model = m2(10, error=1e-5).model
    rng = np.random.default_rng(1)
    places = np.array([0.1 * i + body.centre[0] for i, body in enumerate(model.bodies)])
    rate = 15.0 * rng.uniform(0.9, 1.1, (COUNT, 1))
    velocity = np.zeros((COUNT, 10, 3))
    velocity[:, :, 0], velocity[:, :, 2] = rate, rate * places
    return Variants(
        [model],
        np.zeros(COUNT, np.int64),
        velocity,
        capacity_scale=rng.uniform(0.9, 1.1, (COUNT, 10)),
    )


def frames() -> Variants:
    """The frame with its ring thrown, hinges and speed varied."""
    model, velocity = m4_parts(error=1e-4)
    rng = np.random.default_rng(1)
    return Variants(
        [space_batch.StagedModel(model, (space_batch.SpatialStage(0.1),))],
        np.zeros(SPACE_COUNT, np.int64),
        velocity * rng.uniform(0.9, 1.1, (SPACE_COUNT, 1, 1, 1)),
        capacity_scale=rng.uniform(0.9, 1.1, (SPACE_COUNT, len(model.hinges))),
    )


def rates(name: str, count: int, solve: Callable[[int], NDArray[np.int64]]) -> dict[int, float]:
    """Variants per second by number of threads, printed; `solve(threads)` gives the outcomes."""
    best = {}
    for threads in (1, 2):
        walls, processors = [], []
        for _ in range(REPEATS):
            begin, used = time.perf_counter(), time.process_time()
            outcome = solve(threads)
            walls.append(time.perf_counter() - begin)
            processors.append(time.process_time() - used)
            if outcome.any():
                raise RuntimeError("a variant did not reach its end")
        best[threads] = count / min(walls)
        core = min(processors) / count * 1e6
        print(
            f"{name}   {threads} thread(s)   {best[threads]:8.0f} variants/s   {core:6.0f} us of a core each"
        )
    return best


def main() -> int:
    """Print the rates; 1 if the bound is missed."""
    plane, space = chains(), frames()
    best = rates("M2(10)", COUNT, lambda n: batch.solve_many(plane, 0.1, 1e-3, threads=n).outcome)
    rates("M4    ", SPACE_COUNT, lambda n: space_batch.solve_many(space, 1e-3, threads=n).outcome)
    missed = best[2] < BOUND
    print(f"bound {BOUND} a second of M2(10) on two threads" + (" MISSED" if missed else ""))
    return int(missed)


if __name__ == "__main__":
    sys.exit(main())
