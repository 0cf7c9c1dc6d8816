"""Obstacles and hinges of a scene as a temporal VTKHDF grid, which ParaView shows beside the walls."""

from __future__ import annotations

import io
import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from crumple.numeric.arrays import Floats
from crumple.numeric.rotation import turned, vector_quaternion
from crumple.report.scene.scene import Scene

if TYPE_CHECKING:
    import h5py

FILE = "surroundings.vtkhdf"
QUAD, VERTEX = 9, 1
"""Cell types of VTK."""
OBSTACLE, HINGE = 0, 1
"""Values of the field ``kind``."""


def write_surroundings(scene: Scene | None, folder: Path) -> None:
    """Write ``surroundings.vtkhdf``: obstacles as quadrilaterals and hinges as points, at every frame.

    Parameters
    ----------
    scene
        Its first model is written; without one the grid is empty.
    folder
        Of the results.
    """
    import h5py  # noqa: PLC0415  (0.1 s, and only needed here)

    header = json.loads(scene.header) if scene is not None else {"times": [], "models": [{}]}
    model = header["models"][0]
    obstacles, hinges = model.get("obstacles", []), model.get("hinges", [])
    content = io.BytesIO()
    with h5py.File(content, "w", libver=("v110", "v110")) as file:
        _write_grid(file.create_group("VTKHDF"), np.array(header["times"], float), obstacles, model)
        names = {"obstacles": [one["name"] for one in obstacles], "hinges": [one["name"] for one in hinges]}
        file.attrs["names"] = json.dumps(names)
    (folder / FILE).write_bytes(content.getbuffer())


def _write_grid(
    group: h5py.Group, times: Floats, obstacles: list[dict[str, Any]], model: dict[str, Any]
) -> None:
    from crumple.result.vtkhdf import describe_grid, store_array, write_fields, write_steps  # noqa: PLC0415

    hinges = model.get("hinges", [])
    moved = [_moved(one, len(times)) for one in obstacles]
    first = np.cumsum([0, *(points.shape[1] for points in moved)])
    quads = [np.array(one["quads"]) + start for one, start in zip(obstacles, first[:-1], strict=True)]
    flat = np.concatenate([*(q.reshape(-1) for q in quads), first[-1] + np.arange(len(hinges))])
    n_quads, n_hinges = sum(map(len, quads)), len(hinges)
    places = [np.array(hinge["place"])[:, None] for hinge in hinges]
    points = np.concatenate([np.zeros((len(times), 0, 3)), *moved, *places], axis=1)
    corners = np.concatenate([np.full(n_quads, 4), np.ones(n_hinges)])
    describe_grid(group)
    store_array(group, "NumberOfPoints", np.array([points.shape[1]]))
    store_array(group, "NumberOfCells", np.array([n_quads + n_hinges]))
    store_array(group, "NumberOfConnectivityIds", np.array([len(flat)]))
    store_array(group, "Points", points.reshape(-1, 3))
    store_array(group, "Connectivity", flat.astype(np.int64))
    store_array(group, "Offsets", np.concatenate([[0], np.cumsum(corners)]).astype(np.int64))
    store_array(group, "Types", np.repeat([QUAD, VERTEX], [n_quads, n_hinges]).astype(np.uint8))
    if not len(times):
        return
    steps = write_steps(group, times, points.shape[1])
    fields = _fields(model, [len(q) for q in quads], len(times))
    offsets = steps.create_group("CellDataOffsets")
    write_fields(group.create_group("CellData"), offsets, fields, n_quads + n_hinges)


def _moved(obstacle: dict[str, Any], frames: int) -> Floats:
    """Points of an obstacle at every frame [m], (frames, points, 3); see docs/scene.md."""
    points: Floats = np.array(obstacle["points"])[None] + np.array(obstacle["shift"])[:, None]
    if "angle" not in obstacle:
        return points
    about, axis = np.array(obstacle["about"]), np.array(obstacle["axis"])
    turns = [vector_quaternion(axis * angle) for angle in obstacle["angle"]]
    return np.stack([turned(turns[f], points[f] - about) + about for f in range(frames)])


def _fields(model: dict[str, Any], sizes: list[int], frames: int) -> dict[str, NDArray[Any]]:
    """Values of the cells at every frame: what it is and which, state of hinges, force on obstacles."""
    hinges, obstacles = model.get("hinges", []), model.get("obstacles", [])
    still = np.zeros((frames, sum(sizes)))
    kind = np.concatenate([np.full(sum(sizes), OBSTACLE), np.full(len(hinges), HINGE)])
    index = np.concatenate([np.repeat(np.arange(len(sizes)), sizes), np.arange(len(hinges))])
    fields = {
        name: np.tile(row, (frames, 1)).astype(float) for name, row in (("kind", kind), ("index", index))
    }
    for name in ("state", "rotation", "moment", "energy"):
        rows = [np.array(hinge.get(name, [np.nan] * frames), float)[:, None] for hinge in hinges]
        fields[name] = np.concatenate([still, *rows], axis=1)
    forces = {
        one["name"]: np.array(one["force"]) for one in model.get("forces", []) if one["on"] == "obstacle"
    }
    none = np.zeros((frames, 3))
    rows = [
        np.repeat(forces.get(one["name"], none)[:, None], size, axis=1)
        for one, size in zip(obstacles, sizes, strict=True)
    ]
    fields["force"] = np.concatenate([*rows, np.zeros((frames, len(hinges), 3))], axis=1)
    return fields
