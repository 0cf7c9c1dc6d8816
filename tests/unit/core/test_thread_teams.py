"""Teams of threads where the machine gives fewer than asked for, and where a process forks: the same bits.

Processes of their own lower their limit of address space until only some of the threads find room for stacks.
"""

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[3]
STACK, ROOM = 64 << 20, 160 << 20

SANITIZED = "san.so" in os.environ.get("LD_PRELOAD", "")
pytestmark = [
    pytest.mark.skipif(sys.platform != "linux", reason="reads /proc"),
    pytest.mark.skipif(SANITIZED, reason="sanitizers need the address space that is taken away here"),
]

LIMIT = f"""
import resource
def limit():
    used = int(open("/proc/self/statm").read().split()[0]) * resource.getpagesize()
    resource.setrlimit(resource.RLIMIT_AS, (used + {ROOM}, resource.RLIM_INFINITY))
"""
SHELL = """
from crumple._core.shell.simulation import ShellState
from tests.support.shell.sheets import bits, grid, model
sheet = model(*grid(100, 80))
one, many = ShellState(sheet), ShellState(sheet)
one.advance(1.0, steps=3)
limit()
many.advance(1.0, steps=3, threads=16)
assert bits(one) == bits(many)
"""
BATCH = """
import numpy as np
from crumple._core.planar.batch import solve_many
from crumple._core.variants import Variants
from tests.support.multibody.chains import m2
scale = np.linspace(0.5, 2.0, 400).repeat(4).reshape(400, 4)
variants = Variants((m2(4).model,), np.zeros(400, int), capacity_scale=scale)
one = solve_many(variants, 0.01)
limit()
many = solve_many(variants, 0.01, threads=16)
assert np.array_equal(one.pose, many.pose) and np.array_equal(one.outcome, many.outcome)
"""
FORK = """
import os
import signal
from crumple._core.shell.simulation import ShellState
from tests.support.shell.sheets import bits, grid, model
sheet = model(*grid(60, 60))
one, many = ShellState(sheet), ShellState(sheet)
one.advance(1.0, steps=3)
many.advance(1.0, steps=3, threads=3)
child = os.fork()
if child == 0:
    signal.alarm(60)  # waits for ever where it should not
one.advance(1.0, steps=3)
many.advance(1.0, steps=3, threads=3)
assert bits(one) == bits(many)
assert child == 0 or os.waitpid(child, 0)[1] == 0
"""


def own_stacks() -> None:
    import resource

    resource.setrlimit(resource.RLIMIT_STACK, (STACK, resource.getrlimit(resource.RLIMIT_STACK)[1]))


def run(script: str) -> None:
    done = subprocess.run(
        [sys.executable, "-c", script],
        cwd=ROOT,
        env={"MALLOC_ARENA_MAX": "1", "PYTHONPATH": str(ROOT)},
        preexec_fn=own_stacks,  # a thread's stack is as large as this limit
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize("script", [SHELL, BATCH], ids=["shell", "batch"])
def test_those_that_came_do_the_work(script):
    run(LIMIT + script)


def test_a_forked_process_has_a_team_of_its_own():
    run(FORK)
