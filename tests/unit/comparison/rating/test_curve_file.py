"""Curve files: units, separators, names, and a clear refusal of everything else."""

import numpy as np
import pytest

from crumple.comparison import read_curves
from crumple.errors import InputError


def written(tmp_path, text, name="curve.csv"):
    path = tmp_path / name
    path.write_bytes(text.encode() if isinstance(text, str) else text)
    return path


@pytest.mark.parametrize("separator", [",", ";", "\t"])
def test_units_become_si(tmp_path, separator):
    heads = ["time [ms]", "hinge.root.rotation [deg]", "root (kN*m)", "work [kJ]", "speed [mm/s]"]
    rows = [["0", "0", "0", "0", "0"], ["10", "180", "1.5", "2", "3"]]
    text = "# measured\n" + "\n".join(separator.join(row) for row in [heads, *rows])
    file = read_curves(written(tmp_path, text), "test 7")
    assert file.name == "test 7"
    signal = file.signals["hinge.root.rotation"]
    assert (signal.unit, signal.values[1]) == ("rad", pytest.approx(np.pi))
    assert signal.time == pytest.approx([0.0, 0.01])
    assert {s.unit: s.values[1] for s in file.signals.values()} == pytest.approx(
        {"rad": np.pi, "N*m": 1500.0, "J": 2000.0, "m/s": 0.003}
    )


def test_short_heads_and_columns_without_units(tmp_path):
    text = "time_s,tip_rotation_rad,tip_rate_rad_s,M2\n0,0,15,1\n0.1,1,0,2\n"
    file = read_curves(written(tmp_path, text))
    assert file.name == "curve"
    assert {name: s.unit for name, s in file.signals.items()} == {"tip_rotation": "rad", "tip_rate": "rad/s"}
    assert file.left_out == ("M2",)


def test_columns_are_renamed_and_change_sign(tmp_path):
    text = "time_s,a_rad,b_rad\n0,1,2\n0.1,3,4\n"
    file = read_curves(
        written(tmp_path, text), pairs={"a": "hinge.root.rotation", "b": "-hinge.tip.rotation"}
    )
    assert file.signals["hinge.root.rotation"].values == pytest.approx([1, 3])
    assert file.signals["hinge.tip.rotation"].values == pytest.approx([-2, -4])


def test_former_names_of_axial_channels_are_those_of_today(tmp_path):
    text = "time [s],hinge.root.slip.x.moment [N],hinge.root.moment [N*m]\n0,1,2\n0.1,3,4\n"
    file = read_curves(written(tmp_path, text))
    assert list(file.signals) == ["hinge.root.slip.x.force", "hinge.root.moment"]


@pytest.mark.parametrize(
    ("text", "expected", "line"),
    [
        ("", "the file is empty", 0),
        ("time [s],x [rad]\n", "contains a header but no numbers", 0),
        ("x [rad],y [rad]\n0,1\n", "no column of time", 1),
        ("time [s],x\n0,1\n", "no column except time has a unit", 1),
        ("time [s],x [zork]\n0,1\n", "zork", 1),
        ("time [s],x [rad]\n0,1\n0.1,oops\n", "other than finite numbers", 3),
        ("time [s],x [rad]\n0,1\n0.1,nan\n", "other than finite numbers", 3),
        ("time [s],x [rad]\n0,1\n0.1,1\n0.1,2\n", "the times do not increase", 4),
        ("time [s],x [rad]\n0,1\n0.1,1e200\n", "other than finite numbers", 3),
        ("time [s],x [rad],x [deg]\n0,1,2\n0.1,1,2\n", "two columns have the same name", 1),
        (b"time [s],x [rad]\n0,\xff\xfe\n", "not text in UTF-8", 0),
    ],
)
def test_errors_are_reported_with_their_line(tmp_path, text, expected, line):
    path = written(tmp_path, text)
    with pytest.raises(InputError) as refusal:
        read_curves(path)
    problem = refusal.value.problems[0]
    assert expected in problem.what
    assert problem.file == str(path)
    assert problem.line == line


def test_quoted_numbers_are_numbers(tmp_path):
    file = read_curves(written(tmp_path, '"time [s]","x [rad]"\n"0","1.5"\n"0.1","-2"\n'))
    assert file.signals["x"].values == pytest.approx([1.5, -2.0])


def test_two_columns_cannot_be_paired_with_one_history(tmp_path):
    path = written(tmp_path, "time_s,a_rad,b_rad\n0,1,2\n0.1,3,4\n")
    assert read_curves(path).columns == ("a", "b")
    with pytest.raises(InputError, match="two columns have the same name"):
        read_curves(path, pairs={"a": "-b"})


def test_a_missing_file_is_reported(tmp_path):
    with pytest.raises(InputError, match="there is no such file"):
        read_curves(tmp_path / "nothing.csv")


def test_only_the_first_bad_lines_are_listed(tmp_path):
    text = "time [s],x [rad]\n" + "\n".join("a,b" for _ in range(40))
    with pytest.raises(InputError) as refusal:
        read_curves(written(tmp_path, text))
    assert len(refusal.value.problems) == 11
    assert "30 more lines" in refusal.value.problems[-1].what
