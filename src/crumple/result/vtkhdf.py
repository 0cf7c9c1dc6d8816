"""The result file: a temporal VTKHDF UnstructuredGrid that ParaView opens, with the whole result beside it.

Two top-level groups.  `/VTKHDF` holds the deformed walls at every picture time, laid out by the VTKHDF
specification (version 2.0: `Steps` with offsets into flattened arrays).  The specification leaves other
top-level groups to the writer; `/crumple` holds what the grid cannot: channels, hinge summaries, provenance,
undeformed points.  What both need is stored once, in `/VTKHDF`.

Every array, the JSON text included, carries a Fletcher-32 checksum, and so does the file's own structure from
HDF5 1.10 on: a damaged file is refused and never misread.
"""

from __future__ import annotations

import io
import json
from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from crumple.errors import Status
from crumple.hinge.law_use import LawUse
from crumple.result.caution import Caution
from crumple.result.crush import CrumpledEnd, CrushSummary, DentedWall, StretchSummary
from crumple.result.format import FORMAT, former_names_note, present_name
from crumple.result.nearby import LawRange, modes_of
from crumple.result.result import (
    Channel,
    HingeSummary,
    Opening,
    Provenance,
    Result,
    StageSummary,
    States,
)
from crumple.result.scatter import judged_of, scatter_of

if TYPE_CHECKING:
    import h5py

FILE_NAME = "result.vtkhdf"
VTK_QUAD = 9

FieldNames: TypeAlias = dict[str, dict[str, str]]
"""For PointData and CellData: the name in the grid of each field, which may not hold slashes and points."""

_STILL_FIELDS = ("member", "station", "contour")
"""Point fields of `States` that do not change with time."""

_NOTHING = States(
    points=np.zeros((0, 3)),
    quads=np.zeros((0, 4), dtype=np.int64),
    member=np.zeros(0, dtype=np.int64),
    station=np.zeros(0),
    contour=np.zeros(0, dtype=np.int64),
    member_names=(),
    times=np.zeros(0),
    displacement=np.zeros((0, 0, 3)),
)
"""The grid of a result without states: a reader of VTKHDF still wants one."""


def write_vtkhdf(result: Result, path: Path) -> None:
    """Write the result file.

    Parameters
    ----------
    result
        Of either fidelity.  Without `states` the grid has no points and no steps.
    path
        Written in place; use `crumple.result.write` for a whole or absent file.
    """
    import h5py  # noqa: PLC0415  (0.1 s, and only needed here)

    # built in memory: a disk that fills while the library writes ends the process, a plain write only fails;
    # not by `get_file_image`, whose superblock has a wrong checksum before HDF5 2.0 (its issue 1915)
    content = io.BytesIO()
    with h5py.File(content, "w", libver=("v110", "v110")) as file:
        field_names = _write_grid(file.create_group("VTKHDF"), result.states or _NOTHING)
        _write_rest(file.create_group("crumple"), result, field_names)
    path.write_bytes(content.getbuffer())


def _write_grid(group: h5py.Group, states: States) -> FieldNames:
    """The grid: in every step the same cells over moved points; without steps the undeformed shape alone."""
    describe_grid(group)
    n_points, n_quads, n_steps = len(states.points), len(states.quads), len(states.times)
    moved = states.points + states.displacement if n_steps else states.points
    store_array(group, "NumberOfPoints", np.array([n_points]))
    store_array(group, "NumberOfCells", np.array([n_quads]))
    store_array(group, "NumberOfConnectivityIds", np.array([4 * n_quads]))
    store_array(group, "Points", moved.reshape(-1, 3))
    store_array(group, "Connectivity", states.quads.reshape(-1))
    store_array(group, "Offsets", 4 * np.arange(n_quads + 1))
    store_array(group, "Types", np.full(n_quads, VTK_QUAD, dtype=np.uint8))
    points = group.create_group("PointData")
    for name in _STILL_FIELDS:
        store_array(points, name, getattr(states, name))
    if not n_steps:
        return {}
    steps = write_steps(group, states.times, n_points)
    point_offsets = steps.create_group("PointDataOffsets")
    for name in _STILL_FIELDS:
        store_array(point_offsets, name, np.zeros(n_steps, dtype=np.int64))
    moving = {"displacement": states.displacement, **states.point_data}
    return {
        "PointData": write_fields(points, point_offsets, moving, n_points),
        "CellData": write_fields(
            group.create_group("CellData"), steps.create_group("CellDataOffsets"), states.cell_data, n_quads
        ),
    }


def describe_grid(group: h5py.Group) -> None:
    """Version and type of the grid, as the specification wants them."""
    group.attrs["Version"] = np.array([2, 0], dtype=np.int64)
    # a fixed-length ASCII string
    group.attrs["Type"] = np.bytes_(b"UnstructuredGrid")


def write_fields(
    group: h5py.Group, offsets: h5py.Group, fields: Mapping[str, NDArray[np.float64]], n: int
) -> dict[str, str]:
    """Fields that change with time, one step after the other; gives the name in the grid for each."""
    names = {}
    for name, values in fields.items():
        names[name] = plain = _field_name(name, group)
        store_array(group, plain, values.reshape(-1, *values.shape[2:]))
        store_array(offsets, plain, n * np.arange(len(values)))
    return names


def write_steps(group: h5py.Group, times: NDArray[np.float64], n_points: int) -> h5py.Group:
    """Times and offsets: one part, the same cells in every step, new points in each."""
    n_steps = len(times)
    still = np.zeros(n_steps, dtype=np.int64)
    steps = group.create_group("Steps")
    steps.attrs["NSteps"] = n_steps
    store_array(steps, "Values", times)
    store_array(steps, "PartOffsets", still)
    store_array(steps, "NumberOfParts", still + 1)
    store_array(steps, "PointOffsets", n_points * np.arange(n_steps))
    store_array(steps, "CellOffsets", still[:, None])
    store_array(steps, "ConnectivityIdOffsets", still[:, None])
    return steps


def _write_rest(group: h5py.Group, result: Result, field_names: FieldNames) -> None:
    group.attrs["format"] = FORMAT
    hinges = {name: asdict(hinge) for name, hinge in result.hinges.items()}
    envelopes = group.create_group("envelopes")
    for index, hinge in enumerate(hinges.values()):
        envelope = envelopes.create_group(str(index), track_order=True)
        for key, values in hinge.pop("envelope").items():
            store_array(envelope, key, values)
    channels = list(result.channels.items())
    text = {
        "status": result.status.name,
        "reason": result.reason,
        "fidelity": result.fidelity,
        "title": result.title,
        "energy_residual": result.energy_residual,
        "displacement_errors": dict(result.displacement_errors),
        "solve_seconds": result.solve_seconds,
        "warnings": result.warnings,
        "assumptions": result.assumptions,
        "output_names": result.output_names,
        "provenance": asdict(result.provenance),
        "collapse": [asdict(opening) for opening in result.collapse],
        "collapse_threshold": result.collapse_threshold,
        "channels": [[key, channel.name, channel.unit] for key, channel in channels],
        "hinges": hinges,
        "cautions": [asdict(caution) for caution in result.cautions],
        "stages": [asdict(stage) for stage in result.stages],
        "law_range": None if result.law_range is None else result.law_range.stored,
        "modes": None if result.modes is None else asdict(result.modes),
        "criteria": [asdict(criterion) for criterion in result.criteria],
        "scatter": None if result.scatter is None else asdict(result.scatter),
        "yielded": dict(result.yielded),
        "crumpled_ends": [asdict(end) for end in result.crumpled_ends],
        "dents": [asdict(dent) for dent in result.dents],
        "member_names": None if result.states is None else result.states.member_names,
        "fields": field_names,
    }
    store_array(group, "text", np.frombuffer(json.dumps(text, default=_plain).encode(), dtype=np.uint8))
    store_array(group, "time", result.time)
    values = [channel.values for _, channel in channels]
    store_array(group, "channels", np.array(values).reshape(len(channels), result.time.size))
    if result.states is not None:
        store_array(group, "points", result.states.points)


def store_array(group: h5py.Group, name: str, values: NDArray[Any]) -> h5py.Dataset:
    """Store an array with a checksum, compressed when it is large enough to gain."""
    if not values.size:
        return group.create_dataset(name, data=values)
    compress = (
        {"compression": "gzip", "compression_opts": 1, "shuffle": True} if values.nbytes > 65536 else {}
    )
    return group.create_dataset(name, data=values, chunks=True, fletcher32=True, **compress)


def _field_name(name: str, taken: h5py.Group) -> str:
    """Name without the slashes and points that the format cannot hold, and not taken yet."""
    plain = name.replace("/", "_").replace(".", "_") or "field"
    while plain in taken:
        plain += "_"
    return plain


def _plain(value: Any) -> Any:
    """What JSON cannot hold: NumPy numbers and arrays as Python's, anything else as its text."""
    return value.tolist() if hasattr(value, "tolist") else str(value)


def read_vtkhdf(file: h5py.File) -> Result:
    """Rebuild the result from an open file.

    Raises
    ------
    KeyError, ValueError, TypeError, OSError, RuntimeError
        When the file is not whole; `crumple.result.read` turns them into one clear message.
    """
    group = file["crumple"]
    text = json.loads(group["text"][...].tobytes())
    values = group["channels"][...]
    time = group["time"][...]
    if values.shape != (len(text["channels"]), len(time)):
        raise ValueError("channels and times do not match")
    channels = {
        present_name(key): Channel(present_name(name), unit, row)
        for (key, name, unit), row in zip(text["channels"], values, strict=True)
    }
    note = former_names_note(key for key, _, _ in text["channels"])
    hinges = {}
    for index, (name, hinge) in enumerate(text["hinges"].items()):
        envelope = {key: dataset[...] for key, dataset in group["envelopes"][str(index)].items()}
        # results of earlier versions have none
        crush, stretch, use = (hinge.pop(key, None) for key in ("crush", "stretch", "law_use"))
        hinges[name] = HingeSummary(
            **{**hinge, "position": tuple(hinge["position"]), "envelope": envelope},
            crush=None if crush is None else CrushSummary(**crush),
            stretch=None if stretch is None else StretchSummary(**stretch),
            law_use=None if use is None else LawUse(**use),
        )
    return Result(
        status=Status[text["status"]],
        channels=channels,
        hinges=hinges,
        time=time,
        states=None if text["member_names"] is None else _read_states(file, text),
        provenance=Provenance(**text["provenance"]),
        # results of earlier versions have none
        reason=text["reason"],
        fidelity=text["fidelity"],
        title=text["title"],
        energy_residual=text["energy_residual"],
        displacement_errors=text.get("displacement_errors", {}),
        solve_seconds=text["solve_seconds"],
        warnings=(*text["warnings"], *([note] if note else [])),
        assumptions=tuple(text["assumptions"]),
        output_names=tuple(map(present_name, text["output_names"])),
        # absent from files of versions that did not have them
        collapse=tuple(Opening(**opening) for opening in text.get("collapse", ())),
        collapse_threshold=text.get("collapse_threshold", 0.0),
        cautions=tuple(Caution(**caution) for caution in text.get("cautions", ())),
        stages=tuple(StageSummary(**stage) for stage in text.get("stages", ())),
        law_range=_law_range(text.get("law_range")),
        modes=modes_of(text.get("modes")),
        criteria=judged_of(text.get("criteria")),
        scatter=scatter_of(text.get("scatter")),
        crumpled_ends=tuple(CrumpledEnd(**end) for end in text.get("crumpled_ends", ())),
        dents=tuple(DentedWall(**dent) for dent in text.get("dents", ())),
        yielded={
            member: tuple((float(station), float(energy)) for station, energy in places)
            for member, places in text.get("yielded", {}).items()
        },
    )


def _law_range(text: Mapping[str, Any] | None) -> LawRange | None:
    if text is None:
        return None
    ranges = {name: (low, high) for name, (low, high) in text["ranges"].items()}
    return LawRange(ranges, text["bands"], tuple(text["without"]), tuple(text["failed"]))


def _read_states(file: h5py.File, text: Mapping[str, Any]) -> States:
    grid = file["VTKHDF"]
    reference = file["crumple/points"][...]
    quads = grid["Connectivity"][...].reshape(-1, 4)
    steps = grid.get("Steps")
    times = steps["Values"][...] if steps is not None else np.zeros(0)
    n_steps = len(times)
    point_data, cell_data = (
        {
            name: grid[kind][plain][...].reshape(n_steps, n, *grid[kind][plain].shape[1:])
            for name, plain in text["fields"].get(kind, {}).items()
        }
        for kind, n in (("PointData", len(reference)), ("CellData", len(quads)))
    )
    displacement = point_data.pop("displacement", np.zeros((n_steps, len(reference), 3)))
    still = {name: grid["PointData"][name][...] for name in _STILL_FIELDS}
    if any(len(values) != len(reference) for values in still.values()):
        raise ValueError("points and their fields do not match")
    return States(
        points=reference,
        quads=quads,
        member_names=tuple(text["member_names"]),
        times=times,
        displacement=displacement,
        point_data=point_data,
        cell_data=cell_data,
        **still,
    )
