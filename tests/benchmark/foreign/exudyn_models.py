"""Models M1 to M4 in Exudyn, the fastest open multibody code found, for ratios within one run.

Exudyn is put into build/benchmark by pip.  It has no set-valued law: it solves the regularised one,
with user functions that it evaluates in its own C++.  M1 and M2 are kinematic trees in its fewest
coordinates; M3 is three rigid bodies in the plane with revolute joints, M4 eight in space with
spherical ones.
"""

from __future__ import annotations

import contextlib
import importlib
import io
import math
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from tests.support.multibody import space_models
from tests.support.multibody.chains import MASS_PER_LENGTH, PAYLOAD, bar

PACKAGE = "exudyn==1.13.*"
TARGET = Path(__file__).parents[3] / "build" / "benchmark" / "exudyn"
PORTAL = [(0.0, 0.0), (0.0, 0.5), (1.0, 0.6), (1.0, 0.0)]
"""Joints of M3."""
LUMP, SPEED = 20.0, 10.0


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


def chain(exu: Any, number: int) -> tuple[Any, list[int]]:
    """The chain as a kinematic tree (0: model M1), and its node."""
    items = importlib.import_module("exudyn.utilities")
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
    for i in range(n):
        marker = system.AddMarker(items.MarkerNodeCoordinate(nodeNumber=node, coordinate=i))
        add_hinge(exu, system, [fixed, marker], scales[i])
    system.Assemble()
    return system, [node]


def add_hinge(exu: Any, system: Any, markers: list[int], scale: float) -> None:
    """The law between two rotations."""
    items = importlib.import_module("exudyn.utilities")
    symbolic = importlib.import_module("exudyn.advancedUtilities").CreateSymbolicUserFunction
    moment = moment_function(exu)
    spring = items.CoordinateSpringDamper(
        markerNumbers=markers, stiffness=scale, damping=0.05, springForceUserFunction=moment
    )
    number = system.AddObject(spring)
    function = symbolic(system, moment, "springForceUserFunction", number)
    system.SetObjectParameter(number, "springForceUserFunction", function)


def portal(exu: Any) -> tuple[Any, list[int]]:
    """Model M3 and its nodes."""
    items = importlib.import_module("exudyn.utilities")
    system = exu.SystemContainer().AddSystem()
    ground = system.AddObject(items.ObjectGround())
    earth = system.AddNode(items.NodePointGround())
    fixed = system.AddMarker(items.MarkerNodeCoordinate(nodeNumber=earth, coordinate=0))
    nodes, turns, ends = [], [fixed], [[system.AddMarker(items.MarkerBodyPosition(bodyNumber=ground))]]
    rates = [-SPEED / 0.5, 0.0, -SPEED / 0.6]
    for k, rate in enumerate(rates):
        (x0, y0), (x1, y1) = PORTAL[k], PORTAL[k + 1]
        length = math.hypot(x1 - x0, y1 - y0)
        own = MASS_PER_LENGTH * length
        velocity = SPEED if k == 1 else SPEED / 2
        nodes.append(
            system.AddNode(
                items.NodeRigidBody2D(
                    referenceCoordinates=[(x0 + x1) / 2, (y0 + y1) / 2, math.atan2(y1 - y0, x1 - x0)],
                    initialVelocities=[velocity, 0.0, rate],
                )
            )
        )
        body = system.AddObject(
            items.ObjectRigidBody2D(
                physicsMass=own + (LUMP if k == 1 else 0.0),
                physicsInertia=own * length**2 / 12,
                nodeNumber=nodes[-1],
            )
        )
        places = [[-length / 2, 0.0, 0.0], [length / 2, 0.0, 0.0]]
        ends.append(
            [system.AddMarker(items.MarkerBodyPosition(bodyNumber=body, localPosition=p)) for p in places]
        )
        turns.append(system.AddMarker(items.MarkerNodeCoordinate(nodeNumber=nodes[-1], coordinate=2)))
    foot = system.AddMarker(items.MarkerBodyPosition(bodyNumber=ground, localPosition=[*PORTAL[3], 0.0]))
    pairs = [(ends[0][0], ends[1][0]), (ends[1][1], ends[2][0]), (ends[2][1], ends[3][0]), (ends[3][1], foot)]
    for pair in pairs:
        system.AddObject(items.RevoluteJoint2D(markerNumbers=list(pair)))
    for k in range(4):
        add_hinge(exu, system, [turns[k], turns[(k + 1) % 4]], 0.5)
    system.Assemble()
    return system, nodes


def cube(exu: Any) -> tuple[Any, list[int]]:
    """Model M4 and its nodes."""
    items = importlib.import_module("exudyn.utilities")
    symbolic = importlib.import_module("exudyn.advancedUtilities").CreateSymbolicUserFunction
    model, motion = space_models.m4_parts()
    system = exu.SystemContainer().AddSystem()
    ground = system.AddObject(items.ObjectGround())
    nodes, bodies = [], []
    for body, (*omega, vx, vy, vz) in zip(model.bodies, motion, strict=True):
        turn = items.AngularVelocity2EulerParameters_t(omega, [1, 0, 0, 0])
        nodes.append(
            system.AddNode(
                items.NodeRigidBodyEP(
                    referenceCoordinates=[*body.centre, 1, 0, 0, 0], initialVelocities=[vx, vy, vz, *turn]
                )
            )
        )
        inertia = items.RigidBodyInertia(mass=body.mass, inertiaTensor=np.array(body.inertia)).GetInertia6D()
        bodies.append(
            system.AddObject(items.ObjectRigidBody(mass=body.mass, inertia=inertia, nodeNumber=nodes[-1]))
        )
    moment = ball_moment_function(exu)
    for joint in model.joints:
        ends = []
        for number in (joint.first, joint.second):
            point = joint.position - (model.bodies[number].centre if number >= 0 else 0.0)
            body = bodies[number] if number >= 0 else ground
            ends.append(system.AddMarker(items.MarkerBodyRigid(bodyNumber=body, localPosition=list(point))))
        system.AddObject(items.SphericalJoint(markerNumbers=ends))
        spring = items.RigidBodySpringDamper(
            markerNumbers=ends, stiffness=np.eye(6), damping=np.eye(6), useIntrinsicFormulation=True
        )
        hinge = system.AddObject(spring)
        function = symbolic(system, moment, "springForceTorqueUserFunction", hinge)
        system.SetObjectParameter(hinge, "springForceTorqueUserFunction", function)
    system.Assemble()
    return system, nodes


def ball_moment_function(exu: Any) -> Callable[..., Any]:
    """The law of M4's ball hinges, which stay below their stops."""
    s = exu.symbolic

    def law(turned: Any, rate: Any) -> Any:
        capacity = 250 * (0.576 + 0.5 / s.sqrt(s.max(s.sqrt(turned * turned), 0.05)))
        speed = s.sqrt(rate * rate)
        ramp = s.sin(1.5707963267948966 * s.min(speed / 0.05, 1.0))
        share = capacity * ramp / s.max(speed, 1e-12)
        return s.Vector([0, 0, 0, share * rate[0], share * rate[1], share * rate[2]])

    # the package counts the arguments
    return lambda system, t, item, u, turned, v, rate, k, d, axes0, axes1, offset: law(turned, rate)


def moment_function(exu: Any) -> Callable[..., Any]:
    """The law in Exudyn's symbols: k is the scale, d the half-width of the ramp."""
    s = exu.symbolic

    def law(u: Any, v: Any, k: Any, d: Any) -> Any:
        turned = s.abs(u)
        capacity = k * 1000 * (0.576 + 0.5 / s.sqrt(s.max(turned, 0.05)))
        ramp = s.sin(1.5707963267948966 * s.min(s.max(v / d, -1.0), 1.0))
        stop = k * s.max(0.0, 1e6 * (turned - 1.2) + 2e3 * s.sign(u) * v) * s.sign(u)
        return capacity * ramp + s.IfThenElse(turned > 1.2, stop, s.Real(0.0))

    # the package counts the arguments
    return lambda system, time, item, u, v, k, d, offset: law(u, v, k, d)


def foreign_settings(exu: Any, steps: int, modified: bool) -> Any:
    """Silent; a damped integrator and full Newton, without which M2(10) does not converge (M4 is faster)."""
    settings = exu.SimulationSettings()
    integration = settings.timeIntegration
    integration.numberOfSteps, integration.endTime = steps, 0.1
    integration.verboseMode = integration.verboseModeFile = 0
    integration.newton.useModifiedNewton = modified
    integration.generalizedAlpha.spectralRadius = 0.5
    settings.solution.file.write = False
    settings.show.statistics = settings.show.computationTime = False
    return settings


def rotation_of(name: str, exu: Any, system: Any, nodes: list[int]) -> float:
    """Sum of the hinges' rotations at the end, of M4 their angles."""
    if name == "M4":
        turns = [
            np.reshape(system.GetNodeOutput(node, exu.OutputVariableType.RotationMatrix), (3, 3))
            for node in nodes
        ]
        turns.append(np.eye(3))  # the ground is number -1
        joints = space_models.m4_parts()[0].joints
        traces = [np.trace(turns[joint.first].T @ turns[joint.second]) for joint in joints]
        return float(sum(math.acos(min(1.0, (trace - 1.0) / 2.0)) for trace in traces))
    coordinates = [
        np.atleast_1d(system.GetNodeOutput(node, exu.OutputVariableType.Coordinates)) for node in nodes
    ]
    if name != "M3":
        return float(coordinates[0].sum())
    left, top, right = (values[2] for values in coordinates)
    # A: left, B: top - left, C: right - top, and D: right
    return float(left + (top - left) + (right - top) + right)


def best_time(exu: Any, name: str, figure: float, accuracy: float) -> tuple[float, str, float] | None:
    """Shortest time [s] of the solvers that come within the accuracy, how, and the error."""
    kinds = exu.DynamicSolverType
    tries = [(kinds.GeneralizedAlpha, steps) for steps in (50, 100, 200, 400)]
    if name == "M4":
        tries = [(kinds.GeneralizedAlpha, steps) for steps in (400, 800, 1600)]
    tries += [(kinds.ExplicitMidpoint, 100), (kinds.DOPRI5, 20)] if name == "M1" else []
    builders: dict[str, Callable[[], tuple[Any, list[int]]]] = {
        "M1": lambda: chain(exu, 0),
        "M2(10)": lambda: chain(exu, 10),
        "M3": lambda: portal(exu),
        "M4": lambda: cube(exu),
    }
    found = []
    for kind, steps in tries:
        for _ in range(2 if name in ("M2(10)", "M4") else 20):
            system, nodes = builders[name]()
            settings = foreign_settings(exu, steps, modified=name == "M4")
            begin = time.perf_counter()
            try:
                with contextlib.redirect_stdout(io.StringIO()):
                    system.SolveDynamic(settings, solverType=kind)
            except exu.SolverError:
                continue
            taken = time.perf_counter() - begin
            error = rotation_of(name, exu, system, nodes) / figure - 1.0
            if abs(error) <= accuracy:
                found.append((taken, f"{kind.name}, {steps} steps", error))
    return min(found) if found else None
