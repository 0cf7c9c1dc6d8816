"""Sound calls of the private faces of the kernels, and the same with changed arguments.

Every call is made of a nested description (mappings, lists, tuples, arrays); edits change it as those of
input files are changed, so lengths, shapes, types, indices and numbers become what no model has.
"""

from __future__ import annotations

import time
from typing import Any

import numpy as np
from tests.fuzz.mutation import edited

from crumple._core import _kernels
from crumple._core.shell.build import built
from crumple._core.shell.model import Cut, RigidSet, Sheet, ShellMaterial, ShellModel, ShellSettings
from crumple._core.shell.simulation import ShellState

IDENTITY = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]
CURVES = {
    "positive_rotation": [0.0, 1.0],
    "positive_moment": [100.0, 60.0],
    "negative_rotation": [0.0, 1.0],
    "negative_moment": [100.0, 60.0],
    "elastic_stiffness": 1e4,
    "regularisation_rate": 0.05,
    "rate_reference": 10.0,
    "rate_exponent": 4.0,
    "viscous_damping": 0.0,
    "stop_positive": [0.5, 1e5, 1.5, 10.0, 0.01],
    "stop_negative": [],
}
PLANAR: dict[str, Any] = {
    "model": [
        np.array([-1, 0]),
        np.array([0, 0]),
        np.array([[0.0, 0.0, 0.5, 0.0, 1.0, 0.1], [1.0, 0.0, 0.5, 0.0, 1.0, 0.1]]),
        [0.0, 0.0],
        [{"dof": i, "form": i, "softening": i, "capacity_scale": 1.0, **CURVES} for i in range(2)],
        [(1, [1.0, 0.0], [0.0, 0.0, 1.0], [0.0, 1e-3], [0.0, 100.0])],
        [(1, [1.0, 0.0], [0.0, 1.0, 0.0], [0.0, 1e-3], [0.0, 0.0], [0.0, 0.0])],
        [],
        [],
        [0.0, -9.81],
        1.0,
        [1e-3],
        500.0,
    ],
    "simulation": [1e-3, 1e-9, 1e-3],
    "rates": [1.0, -1.0],
    "motion": [np.zeros((2, 3)), np.zeros((2, 3))],
    "run": [1e-3, 2e-3],
    "step": 1e-4,
    "many": [np.zeros(2, np.int64), 1e-3],
    "columns": [
        np.zeros((2, 2, 3)),
        np.zeros((2, 2, 3)),
        np.ones((2, 2)),
        np.ones((2, 1)),
        np.ones((2, 2, 4)),
        np.zeros((2, 2)),
    ],
    "settings": [1e-3, 1e-9, 1e-3, 1],
    "dof": 0,
}
COMPONENTS = [{"freedom": freedom, **CURVES} for freedom in (4, 5)]
SURFACE = {"coupling": 3, "rows": [1.0, 0.5, 0.5, 1.0], "power": 2.0, "torque_power": 2.0}
SURFACE |= {"torsion": -1, "axisymmetric": False, "arm": 0.0, "arm_gains": [], "arm_gain_shares": []}
SURFACE |= {"growth_rotation": [], "growth_share": [], "shortened_turn": 0.0}
SPATIAL: dict[str, Any] = {
    "model": {
        "mass": np.ones(2),
        "inertia": np.stack([np.eye(3)] * 2),
        "centre": np.array([[0.5, 0.0, 0.0], [1.5, 0.0, 0.0]]),
        "joints": [
            (-1, 0, [0.0] * 3, IDENTITY, [True] * 6, False),
            (0, 1, [1.0, 0.0, 0.0], IDENTITY, [True, True, True, True, False, False], False),
        ],
        "hinges": [],
        "drives": [(0, 2, [0.0, 1e-3], [0.0, 1.0], 0.0)],
        "cams": [(1, 0, 4, [0.0, 1.0], [0.01, 0.02])],
        "loads": [(1, [2.0, 0.0, 0.0], [0.0, 0.0, 10.0], [0.0] * 3, [0.0], [1.0])],
        "springs": [(-1, 1, [2.0, 0.0, 1.0], [2.0, 0.0, 0.0], 1e3, 1.0, 0.0)],
        "capsules": [
            (0, [0.0] * 3, [1.0, 0.0, 0.0], 0.02, 1e4, [([1.0, 0.0, 0.0], 0.01)]),
            (1, [1.1, 0.0, 0.0], [2.0, 0.0, 0.0], 0.02, np.inf, []),
        ],
        "obstacles": [],
        "contact": (0.1, 0.0),
        "pairs": [[0, 1]],
        "gravity": [0.0, 0.0, -9.81],
        "length": 1.0,
        "resolved_frequency": 500.0,
        "breaks": [1e-3],
    },
    "simulation": [1e-3, 1e-9, 1e-3],
    "motion": [np.zeros((2, 6)), np.zeros((2, 6))],
    "stage": [False, [0], [], []],
    "run": [1e-3, 2e-3],
    "step": 1e-4,
    "point": [{**SURFACE}, [1.0, 0.5], [2.0, 2.0]],
}
_X, _Y = np.meshgrid(0.01 * np.arange(3), 0.01 * np.arange(3))
SHELL: dict[str, Any] = {
    "model": {
        "position": np.c_[_X.ravel(), _Y.ravel(), 0.0 * _X.ravel()],
        "elements": np.array([[0, 1, 4, 3], [1, 2, 5, 4], [3, 4, 7, 6], [4, 5, 8, 7]]),
        "thickness": 1e-3,
        "velocity": np.zeros((9, 3)),
        "mass": np.zeros(9),
        "fixed": np.zeros((9, 6), bool),
        "sheet": 0,
    },
    "material": {"density": 7850.0, "youngs_modulus": 2.1e11, "poissons_ratio": 0.3, "yield_stress": 3e8},
    "sheet": {"material": 0, "points": 5, "lobatto": False},
    "settings": {"safety": 0.9, "self_contact": True, "contact_gap": 1e-3, "damping": 0.0},
    "rigid": {"nodes": np.array([0, 1]), "mass": 0.1},
    "cut": {"elements": np.array([0]), "nodes": np.array([1, 4])},
    "load": [8, 2, np.array([0.0, 1e-3]), np.array([0.0, 10.0])],
    "motion": [False, 5, 2, np.array([0.0, 1e-3]), np.array([0.0, 0.0])],
    "weld": [np.array([2, 6], np.uint32), np.array([1.0, 1.0]), 1, 1e4, 1e4],
    "with": [True, True, True, True, True],
    "advance": [2e-5, 20],
    "state": None,
}


def planar(edits: Any) -> None:
    """Tree kernel: one run, and two variants of it."""
    k, given = _kernels.planar, edited(PLANAR, edits)
    model = k.Model(*given["model"])
    run = k.Simulation(model, *given["simulation"])
    run.set_rates(given["rates"])
    run.set_motion(*given["motion"])
    run.effective_inertia(given["dof"])
    run.step(given["step"])
    run.run(given["run"], _patience())
    case_of, end = given["many"]
    k.solve_many([model], case_of, end, *given["columns"], *given["settings"], _patience())


def spatial(edits: Any) -> None:
    """Kernel in space: one run."""
    k, given = _kernels.spatial, edited(SPATIAL, edits)
    run = k.Simulation(given["model"], *given["simulation"])
    run.set_motion(*given["motion"])
    run.stage(*given["stage"])
    run.step(given["step"])
    run.run(given["run"], _patience())
    run.crushed()
    k.surface_point(*given["point"])


def shell(edits: Any) -> None:
    """Shell kernel: some steps, a checkpoint, and a state brought back from it with changed arrays."""
    given = edited(SHELL, edits)
    rigid, cut, load, motion, weld = given["with"]
    keys = dict(given["model"])
    if cut:
        keys["cuts"] = [Cut(**given["cut"])]
    if rigid:
        keys["rigid_sets"] = [RigidSet(**given["rigid"])]
    material, sheet = ShellMaterial(**given["material"]), Sheet(**given["sheet"])
    model = ShellModel(
        **keys, materials=[material], sheets=[sheet], settings=ShellSettings(**given["settings"])
    )
    core = built(model)
    if load:
        core.load(*given["load"])
    if motion:
        core.motion(*given["motion"])
    if weld:
        core.spot_weld(*given["weld"])
    _kernels.shell.Simulation(core, "").advance(given["advance"][0], 1.0, given["advance"][1], 1)
    state = ShellState(model)
    patience = _patience()
    state.advance(given["advance"][0], steps=given["advance"][1], cancel=lambda: not patience(None))
    if cut:
        state.cut(0)


def checkpoint(edits: Any) -> None:
    """A checkpoint of the shell kernel, changed: it is refused or the run goes on."""
    parts = SHELL["model"] | {"cuts": [Cut(**SHELL["cut"])], "rigid_sets": [RigidSet(**SHELL["rigid"])]}
    material, sheet = ShellMaterial(**SHELL["material"]), Sheet(**SHELL["sheet"])
    model = ShellModel(
        **parts, materials=[material], sheets=[sheet], settings=ShellSettings(**SHELL["settings"])
    )
    state = ShellState(model)
    state.advance(1e-5)
    other = ShellState(model)
    other.restore(edited(state.checkpoint(), edits))
    other.advance(1.2e-5, steps=20)


def _patience() -> Any:
    """Ends a run after half a second: a changed end may be far away."""
    end = time.monotonic() + 0.5
    return lambda _: time.monotonic() < end


CALLS = {"planar": planar, "spatial": spatial, "shell": shell, "checkpoint": checkpoint}
"""By room."""
