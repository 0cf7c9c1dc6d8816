"""Speed of the shell kernels per element-step, never part of the default run.

``python tests/benchmark/shell_speed.py [isa ...]``: a uniform tube of 5 mm elements thrown against its
clamp, after yielding has spread, without and with self-contact, on one thread and two; then longer tubes of
up to 500 000 elements, early in their motion, with the memory that each element takes; last the folded tube
of examples/07_axial_crush.yaml after 8 ms.  What the machine does undisturbed: the same steps are repeated
and the least times are taken, of every few of them where two runs are compared.
"""

from __future__ import annotations

import resource
import sys
import time
from pathlib import Path

import numpy as np

from crumple._core.shell.simulation import (
    Element,
    RigidSet,
    ShellMaterial,
    ShellModel,
    ShellSettings,
    ShellState,
)
from crumple.analysis import load
from crumple.shell.model.model import lower

EXAMPLES = Path(__file__).parents[2] / "examples"

FLOOR = 14.0
"""ns per element-step: 0.73 kflop and 1.1 kB at the rates of one AVX-512 core."""


def tube(nx: int = 200, **settings: object) -> ShellModel:
    """50 x 25 x 2.65 mm, 5 mm elements, 28 around."""
    b, h, ny, nz = 47.35e-3, 22.35e-3, 10, 4
    rim = [(-b / 2 + b * i / ny, -h / 2) for i in range(ny)] + [
        (b / 2, -h / 2 + h * i / nz) for i in range(nz)
    ]
    rim += [(-y, -z) for y, z in rim]
    x = np.array([(0.005 * i, *p) for i in range(nx + 1) for p in rim])
    i, j = np.divmod(np.arange(nx * len(rim)), len(rim))
    k = (j + 1) % len(rim)
    quads = np.stack(
        [i * len(rim) + j, (i + 1) * len(rim) + j, (i + 1) * len(rim) + k, i * len(rim) + k], axis=1
    )
    fixed = np.zeros((len(x), 6), dtype=bool)
    fixed[: len(rim)] = True
    omega = np.array([0.0, -15.0, 0.0])
    return ShellModel(
        position=x,
        elements=quads,
        thickness=2.65e-3,
        materials=[ShellMaterial(7850.0, 210e9, 0.3, yield_stress=488e6)],
        fixed=fixed,
        velocity=np.cross(omega, x),
        spin=np.broadcast_to(omega, x.shape),
        rigid_sets=[RigidSet(np.arange(nx * len(rim), len(x)), mass=6.0)],
        settings=ShellSettings(**settings),  # type: ignore[arg-type]
    )


def rate(state: ShellState, threads: int, steps: int = 200, repeats: int = 12) -> float:
    """Least wall time per element-step [ns]."""
    best = np.inf
    for _ in range(repeats):
        start = time.perf_counter()
        state.advance(1.0, steps=steps, threads=threads)
        best = min(best, time.perf_counter() - start)
    return best / steps / len(state.model.elements) * 1e9


def rates(states: dict[str, ShellState], repeats: int = 20) -> dict[tuple[str, int], float]:
    """ns per element-step of every state on one thread and on two, by name and threads.

    Each repeats the same 400 steps, searches of contact among them, in windows of ten, turn by turn.
    """
    saved = {name: state.checkpoint() for name, state in states.items()}
    least: dict[tuple[str, int], np.ndarray] = {}
    for _ in range(repeats):
        for name, state in states.items():
            for threads in (1, 2):
                state.restore(saved[name])
                wall = np.zeros(40)
                for i in range(len(wall)):
                    start = time.perf_counter()
                    state.advance(1.0, steps=10, threads=threads)
                    wall[i] = time.perf_counter() - start
                least[name, threads] = np.minimum(wall, least.get((name, threads), wall))
    return {key: wall.mean() / 10 / len(states[key[0]].model.elements) * 1e9 for key, wall in least.items()}


def contact(isa: str) -> None:
    """Print what a second thread gains, and what self-contact costs."""
    states = {name: ShellState(tube(self_contact=name == "on"), isa=isa) for name in ("off", "on")}
    for state in states.values():
        state.advance(0.01, threads=2)
    found = rates(states)
    for name, state in states.items():
        one, two = found[name, 1], found[name, 2]
        print(
            f"{state.isa}, self-contact {name}: {one:.1f} ns ({one / found['off', 1]:.2f}x without), "
            f"two threads {two:.1f} ns ({one / two:.2f}x), {one / FLOOR:.1f} times the floor"
        )


def crush(isa: str) -> None:
    """Print the rate where walls fold upon each other and everything yields."""
    given = load(EXAMPLES / "07_axial_crush.yaml")
    state = ShellState(lower(given.structure, given.shell, given.outputs, stage=given.stages[0]).model, isa)
    state.advance(0.008, threads=2)
    found = rates({"crush": state}, repeats=10)
    one, two = found["crush", 1], found["crush", 2]
    print(
        f"{state.isa}, axial crush, {state.touching_nodes} of {len(state.position)} nodes touch: "
        f"{one:.1f} ns, two threads {two:.1f} ns ({one / two:.2f}x)"
    )


def elements(isa: str) -> None:
    """Print what the other element and the warping terms cost over the default, on one thread."""
    warped = {"warping_correction": True, "drill_stiffness": 0.01}
    default = 0.0
    for name, settings in (
        ("belytschko-tsay", {}),
        ("belytschko-tsay, warping terms", warped),
        ("stabilised", {"element": Element.STABILISED}),
        ("stabilised, warping terms", {"element": Element.STABILISED, **warped}),
    ):
        state = ShellState(tube(**settings), isa=isa)
        state.advance(0.01, threads=2)
        one = rate(state, 1)
        default = default or one
        print(f"{name}: {one:.1f} ns ({one / default:.2f}x the default)")


def scaling(isa: str) -> None:
    """Print how the rate on one thread and the memory grow with the mesh."""
    smallest = 0.0
    for nx in (200, 1000, 4000, 17857):
        model = tube(nx, self_contact=False)
        before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
        state = ShellState(model, isa=isa)
        state.advance(1.0, steps=50, threads=2)
        one = rate(state, 1, steps=max(5, 40_000 // nx), repeats=8)
        smallest = smallest or one
        memory = (resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before) / len(model.elements)
        size = f", {memory:.2f} kB an element" if nx > 1000 else ""
        print(f"{len(model.elements)} elements: {one:.1f} ns ({one / smallest:.2f}x the smallest){size}")


def main() -> None:
    for isa in sys.argv[1:] or [""]:
        contact(isa)
        elements(isa)
        scaling(isa)
        crush(isa)


if __name__ == "__main__":
    main()
