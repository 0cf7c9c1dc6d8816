"""Where the machine gives fewer threads than are asked for, those that came do the work, to the same bits.

A process of its own lowers its limit of address space so far that only some of the threads' stacks find room.
"""

import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
STACK, ROOM = 64 << 20, 160 << 20

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="reads /proc")

LIMIT = f"""
import resource
def limit():
    used = int(open("/proc/self/statm").read().split()[0]) * resource.getpagesize()
    resource.setrlimit(resource.RLIMIT_AS, (used + {ROOM}, resource.RLIM_INFINITY))
"""
SHELL = """
from crumple._core.shell import ShellState
from tests.unit.shell.sheets import bits, grid, model
sheet = model(*grid(100, 80))
one, many = ShellState(sheet), ShellState(sheet)
one.advance(1.0, steps=3)
limit()
many.advance(1.0, steps=3, threads=16)
assert bits(one) == bits(many)
"""
BATCH = """
import numpy as np
from crumple._core.batch import TreeVariants, solve_many
from tests.verification.chains import m2
scale = np.linspace(0.5, 2.0, 400).repeat(4).reshape(400, 4)
variants = TreeVariants((m2(4).model,), np.zeros(400, int), capacity_scale=scale)
one = solve_many(variants, 0.01)
limit()
many = solve_many(variants, 0.01, threads=16)
assert np.array_equal(one.pose, many.pose) and np.array_equal(one.outcome, many.outcome)
"""


def own_stacks() -> None:
    import resource

    resource.setrlimit(resource.RLIMIT_STACK, (STACK, resource.getrlimit(resource.RLIMIT_STACK)[1]))


@pytest.mark.parametrize("script", [SHELL, BATCH], ids=["shell", "batch"])
def test_those_that_came_do_the_work(script):
    done = subprocess.run(
        [sys.executable, "-c", LIMIT + script],
        cwd=ROOT,
        env={"MALLOC_ARENA_MAX": "1", "PYTHONPATH": str(ROOT)},
        preexec_fn=own_stacks,  # a thread's stack is as large as this limit
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
