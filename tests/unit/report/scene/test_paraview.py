"""The grid of obstacles and hinges holds what the scene holds, at every frame, laid out as VTK reads it."""

import json

import h5py
import numpy as np
import pytest
from tests.support.result.synthetic_tube import tube_result
from tests.unit.report.scene.test_scene import INPUT

from crumple.analysis import loads, solve_with_frames
from crumple.report import ReportInput, write_report
from crumple.report.scene.paraview import FILE, HINGE, OBSTACLE, write_surroundings
from crumple.result import read, write


@pytest.fixture(scope="module", name="folder")
def _folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("paraview")
    analysis = loads(INPUT)
    result, frames = solve_with_frames(analysis)
    write_report(result, ReportInput(structure=analysis.structure), folder, frames=frames)
    write(result, folder)
    return folder


def step(grid, name, k):
    """Values of one step of points or of a field of the cells."""
    if name == "Points":
        count, start = grid["NumberOfPoints"][0], grid["Steps/PointOffsets"][k]
        return grid["Points"][start : start + count]
    count, start = grid["NumberOfCells"][0], grid[f"Steps/CellDataOffsets/{name}"][k]
    return grid[f"CellData/{name}"][start : start + count]


def test_it_holds_obstacles_and_hinges_at_every_frame(folder):
    scene = json.loads((folder / "scene.json").read_text())
    (model,) = scene["models"]
    with h5py.File(folder / FILE) as file:
        grid = file["VTKHDF"]
        np.testing.assert_array_equal(grid["Steps/Values"][...], scene["times"])
        names = json.loads(file.attrs["names"])
        assert names["obstacles"] == [one["name"] for one in model["obstacles"]]
        first = sum(len(one["points"]) for one in model["obstacles"])
        quads = sum(len(one["quads"]) for one in model["obstacles"])
        for k in range(len(scene["times"])):
            assert step(grid, "Points", k)[first:].tolist() == [h["place"][k] for h in model["hinges"]]
            for name in ("state", "rotation", "energy"):
                assert step(grid, name, k)[quads:].tolist() == [h[name][k] for h in model["hinges"]]
        kinds = [OBSTACLE] * quads + [HINGE] * len(model["hinges"])
        assert step(grid, "kind", 0).tolist() == kinds
        assert grid["Types"][...].tolist() == [9] * quads + [1] * len(model["hinges"])
        assert np.diff(grid["Offsets"][...]).tolist() == [4] * quads + [1] * len(model["hinges"])
        assert grid["NumberOfConnectivityIds"][0] == len(grid["Connectivity"]) == grid["Offsets"][-1]


def test_obstacles_move_as_described(folder):
    """The plate has turned by 30 degrees about y through (0, 0, 2 m); the pole comes 0.1 m along -x."""
    model = json.loads((folder / "scene.json").read_text())["models"][0]
    plate = len(model["obstacles"][0]["points"])
    with h5py.File(folder / FILE) as file:
        grid = file["VTKHDF"]
        last = len(grid["Steps/Values"]) - 1
        start, end = step(grid, "Points", 0), step(grid, "Points", last)
    for x, _, z in end[:plate]:
        assert z - 2.0 == pytest.approx(-x * np.tan(np.radians(30.0)), abs=1e-3)
    pole = slice(plate, plate + len(model["obstacles"][1]["points"]))
    np.testing.assert_allclose(
        end[pole] - start[pole], np.tile([-0.1, 0.0, 0.0], (pole.stop - plate, 1)), atol=1e-4
    )


def test_without_a_scene_the_grid_is_empty(tmp_path):
    write_surroundings(None, tmp_path)
    with h5py.File(tmp_path / FILE) as file:
        assert file["VTKHDF/NumberOfPoints"][0] == 0
        assert "Steps" not in file["VTKHDF"]


def test_hinges_alone(tmp_path):
    write_report(tube_result(), ReportInput(), tmp_path)
    with h5py.File(tmp_path / FILE) as file:
        assert file["VTKHDF/Types"][...].tolist() == [1]


@pytest.mark.parametrize("name", ["result.vtkhdf", FILE])
def test_pyvista_reads_every_time_as_the_documents_say(folder, name):
    """The loop of docs/output.md; only where pyvista is installed, which no extra brings."""
    pyvista = pytest.importorskip("pyvista")
    reader = pyvista.get_reader(str(folder / name)).reader
    reader.UpdateInformation()
    meshes, times = [], []
    for number in range(reader.GetNumberOfSteps()):
        reader.SetStep(number)
        reader.Update()
        meshes.append(pyvista.wrap(reader.GetOutput()).copy())
        times.append(reader.GetTimeValue())
    if name == FILE:
        (model,) = json.loads((folder / "scene.json").read_text())["models"]
        wanted = json.loads((folder / "scene.json").read_text())["times"]
        shift = sum(len(one["points"]) for one in model["obstacles"])
        for k, mesh in enumerate(meshes):
            assert mesh.points[shift:].tolist() == [hinge["place"][k] for hinge in model["hinges"]]
            states = mesh.cell_data["state"][mesh.cell_data["kind"] == HINGE]
            assert states.tolist() == [hinge["state"][k] for hinge in model["hinges"]]
    else:
        states = read(folder / name).states
        wanted = states.times.tolist()
        for k, mesh in enumerate(meshes):
            np.testing.assert_allclose(mesh.points, states.points + states.displacement[k], atol=1e-6)
    assert times == pytest.approx(wanted)
    assert len(times) > 3
