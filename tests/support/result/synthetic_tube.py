"""A tube thrown about its clamp, in closed form: one rigid bar, one hinge of constant moment.

I theta'' = -M until it rests: theta = w0 t - M t^2/(2 I), at rest at w0 I/M, turned by w0^2 I/(2 M).
It gives the rooms above the engine a result to work on, and the numbers that must come out.
"""

from __future__ import annotations

import numpy as np

from crumple.errors import Status
from crumple.result import Channel, HingeSummary, Provenance, Result, States

LENGTH = 1.0  # [m]
WIDTH, DEPTH = 0.050, 0.025  # [m]
INERTIA = 6.966622833  # of bar and payload about the clamp [kg m^2]
SPEED = 15.0  # at the start [rad/s]
MOMENT = 1500.0  # of the hinge [N m]

TIME_OF_REST = SPEED * INERTIA / MOMENT
ROTATION_MAX = SPEED**2 * INERTIA / (2 * MOMENT)
ENERGY = INERTIA * SPEED**2 / 2


def rotation(time):
    t = np.minimum(time, TIME_OF_REST)
    return SPEED * t - MOMENT * t * t / (2 * INERTIA)


def rotation_rate(time):
    return np.maximum(SPEED - MOMENT * time / INERTIA, 0.0)


def tube_states(times):
    """Walls of the tube at `times`: eight stations, four corners, turned rigidly about -y."""
    stations = np.linspace(0.0, LENGTH, 8)
    corners = np.array([[1, 1], [-1, 1], [-1, -1], [1, -1]]) * (WIDTH / 2, DEPTH / 2)
    points = np.array([[x, y, z] for x in stations for y, z in corners])
    quads = np.array(
        [
            [4 * i + j, 4 * i + (j + 1) % 4, 4 * i + 4 + (j + 1) % 4, 4 * i + 4 + j]
            for i in range(len(stations) - 1)
            for j in range(4)
        ]
    )
    theta = rotation(np.asarray(times))[:, None]
    x, z = points[:, 0], points[:, 2]
    # the first ring stays clamped
    turned = np.where(x > 0, 1.0, 0.0)
    displacement = np.zeros((len(times), len(points), 3))
    displacement[:, :, 0] = turned * (x * (np.cos(theta) - 1) - z * np.sin(theta))
    displacement[:, :, 2] = turned * (x * np.sin(theta) + z * (np.cos(theta) - 1))
    return States(
        points=points,
        quads=quads,
        member=np.zeros(len(points), dtype=np.int64),
        station=x.copy(),
        contour=np.tile(np.arange(4), len(stations)),
        member_names=("tube",),
        times=np.asarray(times, dtype=float),
        displacement=displacement,
        cell_data={"plastic.strain/mean": np.tile(np.linspace(0, 1, len(quads)), (len(times), 1))},
    )


def tube_channels(time):
    theta, rate = rotation(time), rotation_rate(time)
    dissipated = MOMENT * theta
    kinetic = INERTIA * rate**2 / 2
    moving = time <= TIME_OF_REST
    columns = [
        ("hinge.root.rotation", "rad", -theta),
        ("hinge.root.rotation_rate", "rad/s", -rate),
        ("hinge.root.plastic_rotation", "rad", -theta),
        ("hinge.root.moment", "N*m", np.where(moving, -MOMENT, 0.0)),
        ("hinge.root.capacity", "N*m", np.full_like(time, MOMENT)),
        ("hinge.root.energy", "J", dissipated),
        ("node.tip.displacement.x", "m", LENGTH * (np.cos(theta) - 1)),
        ("node.tip.displacement.z", "m", LENGTH * np.sin(theta)),
        ("node.tip.velocity.z", "m/s", LENGTH * rate * np.cos(theta)),
        ("energy.kinetic", "J", kinetic),
        ("energy.elastic", "J", np.zeros_like(time)),
        ("energy.dissipated", "J", dissipated),
        ("energy.external_work", "J", np.zeros_like(time)),
        ("energy.residual", "J", kinetic + dissipated - ENERGY),
    ]
    return {name: Channel(name, unit, values) for name, unit, values in columns}


def tube_result(**changes) -> Result:
    """The tube solved on 201 output times of 0.5 ms with six pictures; `changes` replaces fields."""
    time = np.linspace(0.0, 0.1, 201)
    channels = tube_channels(time)
    grid = np.linspace(0.0, 1.2, 25)
    hinge = HingeSummary(
        rotation_max=ROTATION_MAX,
        rotation_final=-ROTATION_MAX,
        time_of_rest=TIME_OF_REST,
        energy=ENERGY,
        moment_max=MOMENT,
        rotation_error=1e-5,
        law="Constant moment",
        source="chosen by the user",
        form="set-valued",
        validity_rotation=0.9,
        validity_basis="a constant moment has no evidence of its own; the range is chosen for this example",
        envelope={
            "rotation": grid,
            "positive": np.full_like(grid, MOMENT),
            "negative": np.full_like(grid, MOMENT),
        },
        position=(0.0125, 0.0, 0.0),
    )
    fields = {
        "status": Status.COMPLETE,
        "reason": "",
        "fidelity": "multibody",
        "title": "Steel tube thrown at 15 rad/s, bending about its weak axis",
        "time": time,
        "channels": channels,
        "hinges": {"root": hinge},
        "states": tube_states(np.linspace(0.0, 0.1, 6)),
        "energy_residual": float(np.abs(channels["energy.residual"].values).max() / ENERGY),
        "solve_seconds": 2.4e-5,
        "warnings": (),
        "assumptions": ("Members are rigid between hinges.", "Hinges turn about one axis."),
        "provenance": Provenance(
            version="0.1.0",
            input_hash="9f86d081884c7d659a2feaa0c55ad015a3bf4f1b2b0b822cd15d6c15b0f00a08",
            isa="x86-64-v3",
            threads=1,
            settings={"accuracy": 1e-3, "energy_residual_bound": 1e-3},
        ),
        "output_names": ("node.tip.displacement.z", "node.tip.velocity.z"),
    }
    return Result(**{**fields, **changes})
