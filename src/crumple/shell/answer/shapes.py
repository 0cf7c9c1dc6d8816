"""Stored shapes of a shell run: walls with displacement, plastic strain, thickness and stress."""

from __future__ import annotations

import numpy as np

from crumple._core.shell.simulation import ShellState
from crumple.numeric.arrays import Floats, Integers
from crumple.result import States
from crumple.shell.answer.record import Record
from crumple.shell.mesh.mesh import Mesh

CELL_FIELDS = ("plastic_strain", "plastic_work", "thickness", "von_mises")
"""Largest equivalent plastic strain through the thickness [-], plastic work of the element [J], thickness
[m], largest Mises stress [Pa]."""


def shape_of(state: ShellState, mesh: Mesh) -> dict[str, Floats]:
    """Shape now: displacement (points, 3), and one value per element of every cell field."""
    node = _point_nodes(mesh)
    x, y, xy = (state.point_field(f"stress_{axes}") for axes in ("x", "y", "xy"))
    mises = np.sqrt(np.maximum(x * x + y * y - x * y + 3.0 * xy * xy, 0.0))
    return {
        "time": np.array(state.time),
        "displacement": (state.position - mesh.position)[node],
        "plastic_strain": state.point_field("plastic_strain").max(axis=1),
        "plastic_work": state.element_field("plastic_energy"),
        "thickness": state.element_field("thickness"),
        "von_mises": mises.max(axis=1),
    }


def states_of(mesh: Mesh, record: Record) -> States | None:
    """Stored shapes of a run; every member has all its rings, those that two share twice."""
    if "time" not in record.shapes:
        return None
    shapes = {name: np.array(values) for name, values in record.shapes.items()}
    quads, member, station, contour, count = [], [], [], [], 0
    for which, tube in enumerate(mesh.tubes.values()):
        rings, around = tube.nodes.shape
        quads.append(count + tube.bays.corners)
        member.append(np.full(rings * around, which))
        station.append(np.repeat(tube.stations, around))
        contour.append(np.tile(np.arange(around), rings))
        count += rings * around
    return States(
        points=mesh.position[_point_nodes(mesh)],
        quads=np.concatenate(quads),
        member=np.concatenate(member).astype(np.int64),
        station=np.concatenate(station),
        contour=np.concatenate(contour).astype(np.int64),
        member_names=tuple(mesh.tubes),
        times=shapes["time"],
        displacement=shapes["displacement"],
        cell_data={name: shapes[name] for name in CELL_FIELDS},
    )


def _point_nodes(mesh: Mesh) -> Integers:
    """Mesh node of every stored point, member by member."""
    return np.concatenate([tube.nodes.reshape(-1) for tube in mesh.tubes.values()])
