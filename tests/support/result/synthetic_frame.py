"""Made-up results with many hinges, in the plane and in space, for what draws or stores results."""

from __future__ import annotations

import numpy as np
from tests.support.result.synthetic_tube import tube_result

from crumple.result import Channel, HingeSummary, States

PORTAL = (((0, 0, 0), (0, 0, 0.5)), ((0, 0, 0.5), (1, 0, 0.6)), ((1, 0, 0.6), (1, 0, 0)))
CUBE = tuple(
    (a, b)
    for a, b in (
        ((0, 0, 0), (0, 0, 1)), ((1, 0, 0), (1, 0, 1)), ((1, 1, 0), (1, 1, 1)), ((0, 1, 0), (0, 1, 1)),
        ((0, 0, 1), (1, 0, 1)), ((1, 0, 1), (1, 1, 1)), ((1, 1, 1), (0, 1, 1)), ((0, 1, 1), (0, 0, 1)),
    )
)  # fmt: skip


def frame_states(members, times, sway):
    """Square tubes along `members`, sheared sideways in proportion to their height."""
    points, quads, member, station, contour = [], [], [], [], []
    for index, (a, b) in enumerate(np.array(members, dtype=float)):
        axis = (b - a) / np.linalg.norm(b - a)
        side = np.cross(axis, [0.0, 1.0, 0.0] if abs(axis[1]) < 0.9 else [1.0, 0.0, 0.0])
        side /= np.linalg.norm(side)
        corners = [
            0.02 * (i * side + j * np.cross(axis, side)) for i, j in ((1, 1), (-1, 1), (-1, -1), (1, -1))
        ]
        for s in np.linspace(0.0, 1.0, 4):
            if s > 0:
                n = len(points)
                quads += [[n - 4 + j, n - 4 + (j + 1) % 4, n + (j + 1) % 4, n + j] for j in range(4)]
            points += [a + s * (b - a) + corner for corner in corners]
            member += [index] * 4
            station += [s * np.linalg.norm(b - a)] * 4
            contour += range(4)
    points = np.array(points)
    moved = np.zeros((len(times), len(points), 3))
    height = np.maximum(points[:, 2], 0.0)
    moved[:, :, 0] = sway * np.asarray(times)[:, None] / (max(times) or 1.0) * height**1.5
    moved[:, :, 2] = -0.3 * moved[:, :, 0] * height
    return States(
        points=points,
        quads=np.array(quads),
        member=np.array(member),
        station=np.array(station),
        contour=np.array(contour),
        member_names=tuple(f"member {i}" for i in range(len(members))),
        times=np.asarray(times, dtype=float),
        displacement=moved,
    )


def frame_result(members=PORTAL, n_hinges=4, sway=0.3, **changes):
    """A frame whose hinges soften while they turn, some of them back and forth."""
    time = np.linspace(0.0, 0.08, 321)
    channels, hinges = {}, {}
    spots = list(dict.fromkeys(point for member in members for point in member))
    for i in range(n_hinges):
        name = f"h{i}"
        theta = (0.5 - 0.3 * i / n_hinges) * np.sin(np.pi * time / (0.1 + 0.02 * i)) * (-1) ** i
        rate = np.gradient(theta, time)
        capacity = 1000 * (0.576 + 0.5 / np.sqrt(np.maximum(np.maximum.accumulate(np.abs(theta)), 0.05)))
        moment = capacity * np.sign(rate)
        energy = np.concatenate([[0], np.cumsum(0.5 * (moment[1:] + moment[:-1]) * np.diff(theta))])
        for quantity, unit, values in (
            ("rotation", "rad", theta), ("rotation_rate", "rad/s", rate), ("moment", "N*m", moment),
            ("energy", "J", energy),
        ):  # fmt: skip
            channels[f"hinge.{name}.{quantity}"] = Channel(f"hinge.{name}.{quantity}", unit, values)
        grid = np.linspace(0.0, 1.2, 50)
        curve = 1000 * (0.576 + 0.5 / np.sqrt(np.maximum(grid, 0.05)))
        hinges[name] = HingeSummary(
            rotation_max=float(np.abs(theta).max()),
            rotation_final=float(theta[-1]),
            time_of_rest=None if i == 0 else 0.01 * i,
            energy=float(energy[-1]),
            moment_max=float(np.abs(moment).max()),
            law="Kecman-type mechanism of a rectangular tube",
            source="Kecman 1983 (derived here and checked numerically)",
            form="set-valued",
            validity_rotation=0.2 + 0.15 * i,
            validity_basis="56 tests on 27 sections, up to the rotation at which the walls touch",
            envelope={"rotation": grid, "positive": curve, "negative": curve},
            position=tuple(float(x) for x in spots[i % len(spots)]),
        )
    total = sum(channel.values for name, channel in channels.items() if name.endswith(".energy"))
    energies = {
        "kinetic": total.max() * 1.1 - total,
        "elastic": 0 * total,
        "dissipated": total,
        "external_work": 0 * total,
        "residual": 1e-4 * np.sin(200 * time),
    }
    for name, values in energies.items():
        channels[f"energy.{name}"] = Channel(f"energy.{name}", "J", values)
    fields = {
        "time": time,
        "channels": channels,
        "hinges": hinges,
        "states": frame_states(members, np.linspace(0, 0.08, 5), sway),
        "title": "Frame swept sideways",
        "output_names": (),
        "energy_residual": 1e-7,
    }
    return tube_result(**{**fields, **changes})
