"""What is written reads back equal, appears whole or not at all, and a damaged or foreign file is refused."""

import json
import math
import random

import h5py
import numpy as np
import pytest
from tests.support.result.synthetic_tube import tube_channels, tube_result, tube_states

from crumple.errors import InputError, Status
from crumple.portable import replacing
from crumple.result import Channel, read, write
from crumple.result.histories import histories_csv

FILES = {"summary.json", "histories.csv", "result.vtkhdf"}


def test_round_trip(tube, tmp_path):
    write(tube, tmp_path / "new" / "folder")
    assert {path.name for path in (tmp_path / "new" / "folder").iterdir()} == FILES
    assert read(tmp_path / "new" / "folder").equals(tube)
    assert read(tmp_path / "new" / "folder" / "result.vtkhdf").equals(tube)


def written_in_format_1(result, path):
    """A result file as the first format had it."""
    write(result, path)
    with h5py.File(path / "result.vtkhdf", "r+") as file:
        file["crumple"].attrs["format"] = 1


def test_former_names_of_axial_channels_are_read_with_a_note(tube, tmp_path):
    former = {
        "rotation": "m",
        "rotation_rate": "m/s",
        "plastic_rotation": "m",
        "moment": "N",
        "capacity": "N",
    }
    old = {f"hinge.root.slip.x.{name}": unit for name, unit in former.items()}
    channels = {name: Channel(name, unit, np.sin(tube.time)) for name, unit in old.items()}
    first = "hinge.root.slip.x.moment"
    written_in_format_1(tube_result(channels=channels, output_names=(first,)), tmp_path)
    again = read(tmp_path)
    present = ("travel", "rate", "plastic_travel", "force", "capacity")
    assert list(again.channels) == [f"hinge.root.slip.x.{name}" for name in present]
    assert [channel.name for channel in again.channels.values()] == list(again.channels)
    assert again.output_names == ("hinge.root.slip.x.force",)
    assert "hinge.root.slip.x.rotation and 3 more as hinge.root.slip.x.travel" in again.warnings[-1]
    assert "next release" in again.warnings[-1]


def test_a_result_of_format_1_without_axial_channels_has_no_note(tube, tmp_path):
    written_in_format_1(tube, tmp_path)
    assert read(tmp_path).equals(tube)


def test_the_summary_contains_its_format(tube, tmp_path):
    write(tube, tmp_path)
    summary = json.loads((tmp_path / "summary.json").read_text())
    with h5py.File(tmp_path / "result.vtkhdf") as file:
        assert summary["format"] == file["crumple"].attrs["format"] == 2


@pytest.mark.parametrize(
    "changes",
    [
        {"states": None},
        {"states": tube_states([0.03])},
        {"channels": {}, "hinges": {}, "output_names": ()},
        {"time": np.zeros(0), "channels": {}, "output_names": (), "states": None},
        {
            "status": Status.NOT_CONVERGED,
            "reason": "the step at 3 ms, “θ” ≈ ½",
            "energy_residual": math.inf,
            "warnings": ("first", "second"),
            "title": "",
        },
    ],
    ids=["no states", "one state", "no channels", "nothing", "failed run"],
)
def test_round_trip_of_odd_results(tmp_path, changes):
    result = tube_result(**changes)
    write(result, tmp_path)
    assert read(tmp_path).equals(result)


def test_round_trip_keeps_nan_and_the_order_of_channels(tube, tmp_path):
    channels = dict(reversed(tube_channels(tube.time).items()))
    channels["broken"] = Channel("broken", "m", np.where(tube.time > 0.05, math.nan, -0.0))
    result = tube_result(channels=channels)
    write(result, tmp_path)
    again = read(tmp_path)
    assert again.equals(result)
    assert list(again.channels) == list(channels)
    assert np.signbit(again["broken"][0])


def test_round_trip_of_fields_whose_names_collide_in_the_grid(tmp_path):
    states = tube_states([0.0, 0.05])
    n = len(states.points)
    fields = {
        name: np.random.default_rng(i).random((2, n)) for i, name in enumerate(["a.b", "a_b", "member"])
    }
    result = tube_result(states=type(states)(**{**vars(states), "point_data": fields}))
    write(result, tmp_path)
    assert read(tmp_path).equals(result)


def test_histories_open_in_pandas(tube, tmp_path):
    pandas = pytest.importorskip("pandas")
    write(tube, tmp_path)
    table = pandas.read_csv(tmp_path / "histories.csv", index_col=0)
    assert table.index.name == "time [s]"
    # 1e-14: some versions of pandas read numbers to the last digit but one
    np.testing.assert_allclose(table["hinge.root.rotation [rad]"], tube["hinge.root.rotation"], rtol=1e-14)


def test_histories_leave_nan_empty_and_quote_names():
    channels = {"x": Channel('odd, "name"', "m", np.array([1.0, math.nan, math.inf]))}
    text = histories_csv(tube_result(time=np.array([0.0, 0.5, 1.0]), channels=channels))
    assert text == 'time [s],"odd, ""name"" [m]"\n0.0,1.0\n0.5,\n1.0,inf\n'


def test_numbers_of_histories_read_back_to_the_same_bits():
    values = np.array([-0.0, 1e-9, 5e-324, 1.7976931348623157e308, 0.1 + 0.2, 1e16, 123456789.125, -np.inf])
    channels = {"x": Channel("x", "m", values)}
    rows = histories_csv(tube_result(time=np.arange(8.0), channels=channels)).splitlines()[1:]
    read = np.array([float(row.split(",")[1]) for row in rows])
    np.testing.assert_array_equal(read.view(np.uint64), values.view(np.uint64))


def test_the_grid_follows_the_specification(tube, tmp_path):
    """Read every step by the rules of the VTKHDF specification alone."""
    write(tube, tmp_path)
    states = tube.states
    with h5py.File(tmp_path / "result.vtkhdf") as file:
        grid, steps = file["VTKHDF"], file["VTKHDF/Steps"]
        assert list(grid.attrs["Version"]) == [2, 0]
        assert grid.attrs.get_id("Type").get_type().is_variable_str() is False
        assert grid.attrs["Type"] == b"UnstructuredGrid"
        assert steps.attrs["NSteps"] == len(states.times)
        np.testing.assert_array_equal(steps["Values"], states.times)
        for i in range(len(states.times)):
            part = steps["PartOffsets"][i]
            assert steps["NumberOfParts"][i] == 1
            n_points, n_cells = grid["NumberOfPoints"][part], grid["NumberOfCells"][part]
            first = steps["PointOffsets"][i]
            points = grid["Points"][first : first + n_points]
            np.testing.assert_array_equal(points, states.points + states.displacement[i])
            start = steps["CellOffsets"][i, 0]
            offsets = grid["Offsets"][start : start + n_cells + 1]
            ids = steps["ConnectivityIdOffsets"][i, 0]
            connectivity = grid["Connectivity"][ids : ids + grid["NumberOfConnectivityIds"][part]]
            cells = [connectivity[offsets[k] : offsets[k + 1]] for k in range(n_cells)]
            np.testing.assert_array_equal(cells, states.quads)
            assert set(grid["Types"][start : start + n_cells]) == {9}
            at = steps["PointDataOffsets/displacement"][i]
            np.testing.assert_array_equal(
                grid["PointData/displacement"][at : at + n_points], states.displacement[i]
            )
            at = steps["CellDataOffsets/plastic_strain_mean"][i]
            np.testing.assert_array_equal(
                grid["CellData/plastic_strain_mean"][at : at + n_cells],
                states.cell_data["plastic.strain/mean"][i],
            )


@pytest.mark.parametrize("content", [b"", b"PK\x03\x04 not HDF5", b"\x89HDF\r\n\x1a\n" + bytes(100)])
def test_a_file_that_is_not_hdf5_is_refused(tmp_path, content):
    (tmp_path / "result.vtkhdf").write_bytes(content)
    with pytest.raises(InputError, match="damaged or not a result"):
        read(tmp_path)


def test_no_file_is_refused(tmp_path):
    with pytest.raises(InputError, match="no result here"):
        read(tmp_path)
    with pytest.raises(InputError, match="no result here"):
        read(tmp_path / "nowhere.vtkhdf")


def test_another_programs_file_is_refused(tmp_path):
    with h5py.File(tmp_path / "result.vtkhdf", "w") as file:
        file.create_group("VTKHDF").attrs["Version"] = [2, 0]
    with pytest.raises(InputError, match="not written by Crumple"):
        read(tmp_path)


def test_a_newer_format_is_refused(tube, tmp_path):
    write(tube, tmp_path)
    with h5py.File(tmp_path / "result.vtkhdf", "r+") as file:
        file["crumple"].attrs["format"] = 99
    with pytest.raises(InputError, match="newer Crumple"):
        read(tmp_path)


@pytest.mark.parametrize(
    "gone", ["crumple/text", "crumple/channels", "crumple/points", "VTKHDF/PointData/station"]
)
def test_a_missing_piece_is_refused(tube, tmp_path, gone):
    write(tube, tmp_path)
    with h5py.File(tmp_path / "result.vtkhdf", "r+") as file:
        del file[gone]
    with pytest.raises(InputError, match="damaged"):
        read(tmp_path)


def test_a_damaged_file_is_refused_or_unharmed(tube, tmp_path):
    """Bytes changed or cut off anywhere: never another answer, never another exception."""
    write(tube, tmp_path)
    path = tmp_path / "result.vtkhdf"
    whole = path.read_bytes()
    dice = random.Random(6)
    refused = 0
    for i in range(120):
        broken = bytearray(whole)
        if i % 4 == 0:
            del broken[dice.randrange(len(whole)) :]
        else:
            broken[dice.randrange(len(whole))] ^= 1 << dice.randrange(8)
        path.write_bytes(bytes(broken))
        try:
            assert read(tmp_path).equals(tube)
        except InputError:
            refused += 1
    assert refused > 60


def test_a_broken_write_leaves_the_old_file_and_no_other(tmp_path):
    path = tmp_path / "file.txt"
    path.write_text("old")

    def fail():
        with replacing(path) as temporary:
            temporary.write_text("half")
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        fail()
    assert path.read_text() == "old"
    assert list(tmp_path.iterdir()) == [path]


def test_an_earlier_run_is_replaced(tube, tmp_path):
    write(tube, tmp_path)
    write(tube_result(title="second"), tmp_path)
    assert json.loads((tmp_path / "summary.json").read_text())["title"] == "second"
    assert read(tmp_path).title == "second"
    assert {path.name for path in tmp_path.iterdir()} == FILES
