"""Cost per hinge and step in a chain of 10 to 10 000 hinges: flat within 1.5.

The chain of model M2 turns as one about its root, whose hinge slides; all others are locked. Steps of
0.1 ms, two passes each, one thread; the best of several repetitions.
"""

from __future__ import annotations

import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2]))

from tests.support.multibody.chains import MASS_PER_LENGTH, PAYLOAD, bar, hinge, started

from crumple._core.planar.simulation import Simulation, TreeModel

NUMBERS = (10, 100, 1000, 10_000)
HINGE_STEPS = 40_000
FLAT = 1.5


def chain(number: int) -> Simulation:
    """Chain of bars of 0.1 m with the mass at its tip."""
    length = 0.1 * number
    inertia = MASS_PER_LENGTH * length**3 / 3 + PAYLOAD * length**2
    bodies, hinges = [], []
    for i in range(number):
        payload = PAYLOAD if i == number - 1 else 0.0
        bodies.append(bar(0.1, payload, (0.1 if i else 0.0, 0.0), i - 1))
        hinges.append(hinge(i, inertia * (300.0 if i else 100.0)))
    return started(TreeModel(tuple(bodies), tuple(hinges)), [15.0] + [0.0] * (number - 1))


def seconds(number: int) -> float:
    """Per hinge and step."""
    simulation = chain(number)
    steps = max(2, HINGE_STEPS // number)
    found = []
    for _ in range(7):
        begin = time.perf_counter()
        for _ in range(steps):
            if not simulation.step(1e-4):
                raise RuntimeError("a step did not converge")
        found.append((time.perf_counter() - begin) / steps / number)
    return min(found)


def main() -> int:
    """Print the table; 1 if it is not flat."""
    costs = {number: seconds(number) for number in NUMBERS}
    for number, cost in costs.items():
        print(f"{number:6d} hinges   {cost * 1e9:7.1f} ns per hinge and step")
    spread = max(costs.values()) / min(costs.values())
    print(f"largest over smallest {spread:.2f}, bound {FLAT}" + (" MISSED" if spread > FLAT else ""))
    return int(spread > FLAT)


if __name__ == "__main__":
    sys.exit(main())
