"""A tube of example 01 that folds about -y at a known place by a known angle, as a shell run would give it.

Rings every 10 mm.  Within the fold the sections turn linearly from 0 to the angle; beyond it they are
carried rigidly.  Plastic strain lies in the fold alone and grows with the angle; the work is a constant
moment times it.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from crumple.analysis import load
from crumple.errors import Status
from crumple.result import Channel, Provenance, Result, States

EXAMPLE = Path(__file__).parents[3] / "examples" / "01_tube_bending.yaml"
LENGTH, SPACING = 1.0, 0.01  # [m]
MOMENT = 1200.0  # [N m]
CORNERS = np.array([[1, 1], [-1, 1], [-1, -1], [1, -1]]) * (0.0475 / 2, 0.0225 / 2)


def analysis():
    return load(EXAMPLE)


def angle_over_time(time, largest=0.6, rest=0.08):
    """Rises like a braked swing until it rests."""
    t = np.minimum(time / rest, 1.0)
    return largest * (2 * t - t * t)


def folded_states(times, folds, turned=None):
    """Shapes with folds (start, end, angles over time); `turned` rotates everything in space."""
    turned = np.eye(3) if turned is None else turned
    stations = np.linspace(0.0, LENGTH, round(LENGTH / SPACING) + 1)
    points = np.array([[x, y, z] for x in stations for y, z in CORNERS])
    n = len(stations)
    i, j = np.divmod(np.arange(4 * (n - 1)), 4)
    k = (j + 1) % 4
    quads = np.stack([4 * i + j, 4 * i + k, 4 * i + 4 + k, 4 * i + 4 + j], axis=1)
    middles = (stations[1:] + stations[:-1]) / 2
    moved, strain = [], []
    for row in range(len(times)):
        share = [np.clip((stations - a) / (b - a), 0, 1) * angles[row] for a, b, angles in folds]
        theta = np.sum(share, axis=0)
        along = np.stack([np.cos(theta), np.zeros(n), np.sin(theta)], axis=1)
        steps = (along[1:] + along[:-1]) / 2 * np.diff(stations)[:, None]
        centres = np.concatenate([np.zeros((1, 3)), np.cumsum(steps, axis=0)])
        up = np.stack([-np.sin(theta), np.zeros(n), np.cos(theta)], axis=1)
        across = np.array([0.0, 1.0, 0.0])
        rings = centres[:, None] + CORNERS[None, :, :1] * across + CORNERS[None, :, 1:] * up[:, None]
        moved.append(rings.reshape(-1, 3))
        inside = [((middles > a) & (middles < b)) * abs(angles[row]) / (b - a) for a, b, angles in folds]
        strain.append(np.repeat(0.01 * np.sum(inside, axis=0), 4))
    points, moved = points @ turned.T, np.array(moved) @ turned.T
    return States(
        points=points,
        quads=quads,
        member=np.zeros(len(points), dtype=np.int64),
        station=np.repeat(stations, 4),
        contour=np.tile(np.arange(4), n),
        member_names=("tube",),
        times=np.asarray(times),
        displacement=moved - points,
        cell_data={"plastic_strain": np.array(strain)},
    )


def folded_result(folds=None, *, largest=0.6, moment_channel=False, contact=0.0, **changes):
    """A shell-like result; by default one fold from 10 to 40 mm."""
    time = np.linspace(0.0, 0.1, 201)
    shown = np.linspace(0.0, 0.1, 101)
    angle = angle_over_time(time, largest)
    if folds is None:
        folds = [(0.01, 0.04, angle_over_time(shown, largest))]
    work = MOMENT * sum(np.interp(time, shown, np.abs(angles)) for _, _, angles in folds)
    columns = [
        ("energy.kinetic", "J", work[-1] - work),
        ("energy.elastic", "J", np.zeros_like(time)),
        ("energy.dissipated", "J", work),
        ("energy.contact", "J", contact * work),
    ]
    if moment_channel:
        columns.append(("hinge.root.moment", "N*m", np.where(angle > 0, -MOMENT, 0.0)))
    fields = {
        "status": Status.COMPLETE,
        "reason": "",
        "fidelity": "shell",
        "title": "folded",
        "time": time,
        "channels": {name: Channel(name, unit, values) for name, unit, values in columns},
        "hinges": {},
        "states": folded_states(shown, folds),
        "energy_residual": 1e-4,
        "solve_seconds": 20.0,
        "warnings": (),
        "assumptions": (),
        "provenance": Provenance(version="0.1.0", input_hash="0" * 64),
    }
    return Result(**{**fields, **changes})
