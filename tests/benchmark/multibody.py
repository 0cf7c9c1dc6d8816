"""Time of the multibody kernel on models M1 and M2(10), 100 ms simulated, and the ratio to Exudyn 1.13.

Bounds: M1 at most 20 microseconds, M2(10) at most 0.3 ms at accuracy 1e-3, native solve alone (lowering
and histories aside). Best and median of many solves in this process; the true error is printed beside
each time. Exudyn is put into build/benchmark by pip, by this script alone; it solves the regularised law
(it has no set-valued one) with user functions evaluated in its own C++, with the fastest of a few
solvers whose true error is below 1e-3.
"""

from __future__ import annotations

import contextlib
import importlib
import io
import statistics
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT))

from tests.verification.chains import (  # noqa: E402
    MASS_PER_LENGTH,
    PAYLOAD,
    REGULARISED,
    SET_VALUED,
    bar,
    m1,
    m2,
)

PACKAGE = "exudyn==1.13.*"
TARGET = ROOT / "build" / "benchmark" / "exudyn"
END = np.array([0.1])
ACCURACY = 1e-3
REPEATS = 300
# model, form, figure (sum of rotations), bound on the best time [s]
CASES: dict[str, tuple[Callable[[int], Any], float, float | None]] = {
    "M1 set-valued": (lambda form: m1(ACCURACY, form, error=1e-5), 0.424127729101, 20e-6),
    "M1 regularised": (lambda form: m1(ACCURACY, form, error=1e-5), 0.424130871579, None),
    "M2(10) set-valued": (lambda form: m2(10, ACCURACY, form, error=1e-5), 0.6621342, 0.3e-3),
    "M2(10) regularised": (lambda form: m2(10, ACCURACY, form, error=1e-5), 0.6656451692, None),
    "M2(100) set-valued": (lambda form: m2(100, ACCURACY, form, error=1e-5), 0.5845621, None),
}


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


def exudyn() -> Any | None:
    """The package, installed if need be; None where that fails."""
    if not TARGET.exists():
        command = [
            sys.executable,
            "-m",
            "pip",
            "install",
            "--quiet",
            "--no-deps",
            "--target",
            str(TARGET),
            PACKAGE,
        ]
        if subprocess.run(command, check=False).returncode != 0:
            return None
    sys.path.append(str(TARGET))
    try:
        with contextlib.redirect_stdout(io.StringIO()):
            importlib.import_module("exudyn.utilities")
            return importlib.import_module("exudyn")
    except ImportError:
        return None


def foreign_model(exu: Any, number: int) -> tuple[Any, int]:
    """The chain as a kinematic tree of Exudyn (0: model M1), and its node."""
    items = importlib.import_module("exudyn.utilities")
    symbolic = importlib.import_module("exudyn.advancedUtilities").CreateSymbolicUserFunction
    length = 0.1 * number
    root = (MASS_PER_LENGTH * length**3 / 3 + PAYLOAD * length**2) / (MASS_PER_LENGTH / 3 + PAYLOAD)
    bodies, scales = [bar(1.0, PAYLOAD)], [1.0]
    if number:
        bodies = [bar(0.1, PAYLOAD if i == number - 1 else 0.0) for i in range(number)]
        scales = [root] + [0.8 * root * (1 - 0.1 * i / length) for i in range(1, number)]
    n = len(bodies)
    system = exu.SystemContainer().AddSystem()
    node = system.AddNode(
        items.NodeGenericODE2(
            referenceCoordinates=[0.0] * n,
            initialCoordinates=[0.0] * n,
            initialCoordinates_t=[15.0] + [0.0] * (n - 1),
            numberOfODE2Coordinates=n,
        )
    )
    offsets, centres = exu.Vector3DList(), exu.Vector3DList()
    inertias, turns = exu.Matrix3DList(), exu.Matrix3DList()
    for i, body in enumerate(bodies):
        offsets.Append([0.1 if i else 0.0, 0.0, 0.0])
        centres.Append([body.centre[0], 0.0, 0.0])
        inertias.Append(np.diag([1e-6, body.inertia, body.inertia]))
        turns.Append(np.eye(3))
    system.AddObject(
        items.ObjectKinematicTree(
            nodeNumber=node,
            jointTypes=[exu.JointType.RevoluteZ] * n,
            linkParents=list(range(-1, n - 1)),
            jointTransformations=turns,
            jointOffsets=offsets,
            linkInertiasCOM=inertias,
            linkCOMs=centres,
            linkMasses=[body.mass for body in bodies],
        )
    )
    ground = system.AddNode(items.NodePointGround())
    fixed = system.AddMarker(items.MarkerNodeCoordinate(nodeNumber=ground, coordinate=0))
    moment = moment_function(exu)
    for i in range(n):
        marker = system.AddMarker(items.MarkerNodeCoordinate(nodeNumber=node, coordinate=i))
        spring = items.CoordinateSpringDamper(
            markerNumbers=[fixed, marker], stiffness=scales[i], damping=0.05, springForceUserFunction=moment
        )
        number_of = system.AddObject(spring)
        function = symbolic(system, moment, "springForceUserFunction", number_of)
        system.SetObjectParameter(number_of, "springForceUserFunction", function)
    system.Assemble()
    return system, node


def moment_function(exu: Any) -> Callable[..., Any]:
    """The law in Exudyn's symbols: k is the scale, d the half-width of the ramp."""
    s = exu.symbolic

    def moment(*given: Any) -> Any:
        # system, time, item, rotation, rate, stiffness, damping, offset
        _, _, _, u, v, k, d, _ = given
        turned = s.abs(u)
        capacity = k * 1000 * (0.576 + 0.5 / s.sqrt(s.max(turned, 0.05)))
        ramp = s.sin(1.5707963267948966 * s.min(s.max(v / d, -1.0), 1.0))
        stop = k * s.max(0.0, 1e6 * (turned - 1.2) + 2e3 * s.sign(u) * v) * s.sign(u)
        return capacity * ramp + s.IfThenElse(turned > 1.2, stop, s.Real(0.0))

    return moment


def foreign_settings(exu: Any, steps: int) -> Any:
    """Silent; a damped integrator and full Newton, without which M2(10) does not converge."""
    settings = exu.SimulationSettings()
    integration = settings.timeIntegration
    integration.numberOfSteps, integration.endTime = steps, 0.1
    integration.verboseMode = integration.verboseModeFile = 0
    integration.newton.useModifiedNewton = False
    integration.generalizedAlpha.spectralRadius = 0.5
    settings.solution.file.write = False
    settings.show.statistics = settings.show.computationTime = False
    return settings


def foreign_time(exu: Any, number: int, figure: float) -> tuple[float, str, float] | None:
    """Best time [s] of Exudyn within the accuracy, how, and its error."""
    kinds = exu.DynamicSolverType
    tries = [(kinds.GeneralizedAlpha, 50), (kinds.GeneralizedAlpha, 200)]
    tries += [(kinds.ExplicitMidpoint, 100), (kinds.DOPRI5, 20)] if number == 0 else []
    found = []
    for kind, steps in tries:
        for _ in range(20 if number == 0 else 2):
            system, node = foreign_model(exu, number)
            settings = foreign_settings(exu, steps)
            begin = time.perf_counter()
            try:
                with contextlib.redirect_stdout(io.StringIO()):
                    system.SolveDynamic(settings, solverType=kind)
            except exu.SolverError:
                continue
            taken = time.perf_counter() - begin
            rotations = np.atleast_1d(system.GetNodeOutput(node, exu.OutputVariableType.Coordinates))
            error = float(rotations.sum() / figure - 1.0)
            if abs(error) <= ACCURACY:
                found.append((taken, f"{kind.name}, {steps} steps", error))
    return min(found) if found else None


def main() -> int:
    """Print the table; the number of bounds missed."""
    best = native()
    missed = sum(bound is not None and best[name] > bound for name, (_, _, bound) in CASES.items())
    exu = exudyn()
    if exu is None:
        print(f"{PACKAGE} could not be installed: no ratio")
        return missed
    for name, number in (("M1", 0), ("M2(10)", 10)):
        foreign = foreign_time(exu, number, CASES[f"{name} regularised"][1])
        if foreign is None:
            print(f"Exudyn {name}: no solver came within {ACCURACY:g}")
            continue
        taken, how, error = foreign
        print(f"Exudyn {exu.__version__} {name:6}  best {taken * 1e6:9.1f} us   error {error:+.1e}   ({how})")
        for form in ("regularised", "set-valued"):
            print(f"  ratio to Crumple, {form}: {taken / best[f'{name} {form}']:.0f}")
    return missed


if __name__ == "__main__":
    sys.exit(main())
