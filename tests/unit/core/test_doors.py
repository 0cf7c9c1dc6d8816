"""The kernels' doors: indices, lengths, codes and numbers that cannot be are errors, never a crash.

Each call is made in a process that is forked off: a crash would end this one.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys

import pytest

SHELL = """
import numpy as np, threading
from crumple._core.shell.build import built, kernel
from crumple._core.shell.simulation import *
x, y = np.meshgrid(0.01 * np.arange(4), 0.01 * np.arange(4))
place = np.c_[x.ravel(), y.ravel(), 0 * x.ravel()]
corner = np.array([[i + 4 * j for j in range(3) for i in range(3)]]).T
quads = corner + np.array([0, 1, 5, 4])
steel = [ShellMaterial(density=7850, youngs_modulus=2.1e11, poissons_ratio=0.3)]
def model(**keys):
    keys = dict(position=place, elements=quads, thickness=1e-3, materials=steel, sheets=[Sheet(0)]) | keys
    return ShellModel(**keys)
def advanced(core):
    return kernel.Simulation(core, "").advance(1e-6, 1.0, 100, 1)
far, times, values = np.array([10**6]), np.array([0.0]), np.array([1.0])
one, two = far.astype(np.uint32), np.array([0, 1], np.uint32)
none = np.zeros(3), np.zeros(6), 0, np.zeros(0)
"""
PLANAR = """
import numpy as np
from crumple._core import _kernels
k = _kernels.planar
body = np.array([[0.0, 0, 0, 0, 1, 1]])
one = (np.array([-1]), np.array([0]), body, [0.0], [], [], [], [], [], [0.0, 0.0], 1.0, [], 500.0)
def changed(index, value):
    return k.Model(*one[:index], value, *one[index + 1:])
run = k.Simulation(k.Model(*one), 1e-3, 1e-9, 1e-3)
many = lambda models, *rest: k.solve_many(models, np.zeros(1, np.int64), 1e-3, *6 * [None], *rest)
"""
SPATIAL = """
import numpy as np
from crumple._core import _kernels
k = _kernels.spatial
lists = ("joints", "hinges", "drives", "cams", "loads", "springs", "capsules", "obstacles", "pairs")
def model(**keys):
    body = dict(mass=np.ones(1), inertia=np.eye(3)[None], centre=np.zeros((1, 3)), contact=(0.0, 0.0))
    body |= {name: [] for name in lists} | dict(gravity=[0.0, 0.0, 0.0], length=1.0, breaks=[])
    return body | dict(resolved_frequency=500.0) | keys
def run(**keys):
    return k.Simulation(model(**keys), 1e-3, 1e-9, 1e-3)
held = (-1, 0, [0.0] * 3, list(np.eye(3).ravel()), [True] * 6, False)
pinned = (-1, 0, [0.0] * 3, list(np.eye(3).ravel()), [True] * 3 + [False] * 3, False)
surface = dict(coupling=3, rows=[1.0] * 5, power=2.0, torque_power=2.0, torsion=-1, arm=0.0)
surface |= dict(axisymmetric=False, arm_gains=[], arm_gain_shares=[], growth_rotation=[], growth_share=[])
surface |= dict(shortened_turn=0.0)
nan = float("nan")
"""
CALLS = {
    SHELL: [
        "advanced(built(model(elements=quads + 100)))",
        "advanced(built(model(elements=quads - 5)))",
        "advanced(built(model(elements=quads[:, :3])))",
        "ShellState(model(cuts=[Cut(elements=far, nodes=far)])).cut(0)",
        "ShellState(model(cuts=[Cut(elements=np.array([0]), nodes=far)])).cut(0)",
        "ShellState(model(cuts=[Cut(elements=np.array([0]), nodes=far[:0])])).cut(0)",
        "ShellState(model()).cut(5)",
        "ShellState(model()).cut(-1)",
        "core = built(model()); core.load(0, 99, times, values); advanced(core)",
        "core = built(model()); core.load(0, -100000, times, values); advanced(core)",
        "core = built(model()); core.load(10**6, 0, times, values); advanced(core)",
        "core = built(model()); core.motion(False, 0, 99999999, times, values); advanced(core)",
        "core = built(model()); core.motion(True, 3, 0, times, values); advanced(core)",
        "core = built(model()); core.spot_weld(two, np.ones(2), 7, 1.0, 1.0); advanced(core)",
        "core = built(model()); core.sheet(7, 5, False); advanced(core)",
        "core = built(model()); core.rigid_set(one, 0.0, *none); advanced(core)",
        "advanced(None)",
        "ShellState(model())._core.element_slot(10**7)",
        "ShellState(model())._core.point_slot(-1)",
        "thickness_rule(-1)",
        "thickness_rule(0)",
        "thickness_rule(11)",
        "thickness_rule(1, True)",
        "ShellState(model()).advance(float('nan'))",
        "ShellState(model()).advance(1e-6, steps=-1)",
        "ShellState(model()).deform(place, place, place, 0.0)",
        "ShellState(model()).deform(place[:3], place, place, 1.0)",
        "touching = model(settings=ShellSettings(self_contact=True))\n"
        "ShellState(touching).restore(ShellState(touching).checkpoint() | {'contact': np.zeros(5)})",
        "ShellState(model()).restore(ShellState(model(position=2 * place)).checkpoint())",
        "ShellState(model()).restore(ShellState(model()).checkpoint() | {'marks': np.zeros(3)})",
        "kernel.Simulation.__new__(kernel.Simulation).advance(1.0, 1.0, 1, 1)",
        "state = ShellState(model())\n"
        "work = threading.Thread(target=state.advance, args=(1.0,), daemon=True)\n"
        "work.start()\n"
        "while work.is_alive(): state.position; state.energies",
    ],
    PLANAR: [
        "run.effective_inertia(10**6)",
        "run.effective_inertia(-1)",
        "changed(5, [(0, [0.0])])",
        "changed(5, [(5, [0.0, 0.0], [0.0, 1.0, 0.0], [0.0], [1.0])])",
        "changed(5, [(0, [0.0, 0.0], [0.0, 1.0, 0.0], [0.0], [float('nan')])])",
        "changed(6, [(0, [0.0, 0.0], [0.0, 1.0, 0.0], [0.0], [1.0])])",
        "changed(7, [(0,)])",
        "changed(8, [(0, -1)])",
        "changed(8, [(0, 9, [0.0, 0.0], [0.0, 0.0])])",
        "changed(9, [])",
        "changed(9, [float('nan'), 0.0])",
        "changed(10, -1.0)",
        "changed(3, [float('inf')])",
        "changed(11, [float('nan')])",
        "changed(11, [1e-3, float('inf')])",
        "changed(11, [2e-3, 1e-3])",
        "changed(11, [1e-3, 1e-3])",
        "changed(12, 0.0)",
        "changed(12, float('nan'))",
        "changed(0, np.array([2**40]))",
        "changed(1, np.array([7]))",
        "changed(2, np.array([[0.0, 0, 0, 0, float('nan'), 1]]))",
        "changed(3, [])",
        "changed(4, [{}])",
        "run.run([3.0, 1.0])",
        "run.run([float('nan')])",
        "run.run([])",
        "run.step(float('nan'))",
        "run.step(-1.0)",
        "run.set_rates([])",
        "run.set_motion(np.zeros((2, 3)), np.zeros((2, 3)))",
        "k.Simulation(k.Model(*one), float('nan'), 1e-9, 1e-3)",
        "k.Simulation(k.Model(*one), 1e-3, -1.0, 1e-3)",
        "many([None], 1e-3, 1e-9, 1e-3, 1)",
        "many([], 1e-3, 1e-9, 1e-3, 1)",
        "run.run([1.0], lambda time: run.run([2.0]))",
        "run.run([1.0], 7)",
    ],
    SPATIAL: [
        "run(joints=[(0,)])",
        "run(joints=[(7, 0, *held[2:])])",
        "run(joints=[held[:2] + ([0.0],) + held[3:]])",
        "run(drives=[(3, 0, [0.0], [1.0], 0.0)])",
        "run(joints=[held], drives=[(0, 77, [0.0], [1.0], 0.0)])",
        "run(joints=[held], cams=[(0, 0)])",
        "run(joints=[held], cams=[(3, 0, 4, [0.0], [0.1])])",
        "run(joints=[held], cams=[(0, 4, 5, [0.0], [0.1])])",
        "run(joints=[held], cams=[(0, 0, 4, [0.0], [0.1])])",
        "run(joints=[pinned], cams=[(0, 0, 77, [0.0], [0.1])])",
        "run(joints=[pinned], cams=2 * [(0, 0, 4, [0.0], [0.1])])",
        "run(joints=[pinned], cams=[(0, 0, 4, [0.0], [nan])])",
        "run(loads=[(0, [0.0] * 3, [0.0] * 3)])",
        "run(springs=[(0, -1, [0.0] * 3, [0.0] * 3, 1.0)])",
        "run(capsules=[(0, [0.0] * 3)])",
        "run(pairs=[[0]])",
        "run(pairs=[[0, 1, 2]])",
        "run(mass=np.ones(2))",
        "run(breaks=[nan])",
        "run(breaks=[2e-3, 1e-3])",
        "run(gravity=[nan, 0.0, 0.0])",
        "run(length=float('inf'))",
        "run(joints=[held]).stage(False, [], [], [(4, 1.0, 0, 3, [-1, -1], [[], []])])",
        "run(joints=[held]).stage(False, [], [], [(4, 1.0, 9, 3, [-1, -1], [[0.0] * 3] * 2)])",
        "run(joints=[held]).stage(False, [], [], [(4, 1.0, 0, 6, [-1, -1], [[0.0] * 3] * 2)])",
        "run(joints=[held]).stage(False, [], [], [(4, nan, 0, 3, [-1, -1], [[0.0] * 3] * 2)])",
        "run(joints=[held]).stage(False, [5], [], [])",
        "run().stage(False, [], [], [(0,)])",
        "k.Simulation(model(), nan, nan, nan)",
        "run().run([nan])",
        "run().step(0.0)",
        "run().set_motion(np.zeros((3, 6)), np.zeros((3, 6)))",
        "k.HingeElement({})",
        "k.surface_point(surface, [1.0] * 5, [0.0] * 25)",
        "k.surface_point(surface, [], [])",
        "k.surface_point(surface, [1.0], [])",
        "k.surface_gauge(surface, [1.0] * 9)",
        "case = k.Case(model()); case.add_stage(nan, False, [], [], [])",
    ],
}  # fmt: skip
SOUND = {
    SHELL: "advanced(built(model()))",
    PLANAR: "run.run([1e-3])",
    SPATIAL: "run(joints=[held]).run([1e-3])",
}
RUNNER = """
import json, os, sys
def tried(call):
    reading, writing = os.pipe()
    child = os.fork()
    if child == 0:
        message, code = "", 0
        try:
            exec(call, globals())
        except Exception as error:
            message, code = type(error).__name__ + ": " + str(error), 1
        os.write(writing, message.encode()[:1000])
        os._exit(code)
    os.close(writing)
    status = os.waitpid(child, 0)[1]
    message = os.read(reading, 2000).decode()
    os.close(reading)
    return os.waitstatus_to_exitcode(status), message
print(json.dumps([tried(call) for call in json.load(sys.stdin)]))
"""


@pytest.mark.skipif(not hasattr(os, "fork"), reason="every call is made in a process that is forked off")
@pytest.mark.parametrize("room", CALLS, ids=["shell", "planar", "spatial"])
def test_what_cannot_be_is_refused_and_crashes_nothing(room: str) -> None:
    alone = os.environ | {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
    words = [sys.executable, "-c", room + RUNNER]
    calls = [SOUND[room], *CALLS[room]]
    done = subprocess.run(
        words,
        input=json.dumps(calls),
        env=alone,
        stdout=subprocess.PIPE,
        text=True,
        check=True,
        timeout=100,
    )
    outcomes = dict(zip(calls, json.loads(done.stdout), strict=True))
    # so that the others are refused for what is wrong in them
    assert outcomes.pop(SOUND[room]) == [0, ""]
    # a negative code is the signal of a crash; without an exception it is 0
    assert {call: code for call, (code, _) in outcomes.items() if code != 1} == {}
    assert [call for call, (_, message) in outcomes.items() if not message.partition(": ")[2]] == []
