"""Hinge laws as described: each type has its keys, curves are read at once, units are checked."""

import numpy as np
import pytest

from crumple.errors import InputError
from crumple.hinge import law_options
from crumple.hinge.registry import BENDING
from crumple.structure import LawKeys


def test_every_law_can_be_described_with_every_option_it_has():
    for name in BENDING:
        own = {key.name for key in LawKeys.keys_of_type(name)}
        assert own == set(law_options(name)) - {"elastic_stiffness"}
        assert all(key.text.endswith(".") for key in LawKeys.written_keys(name))
    assert {key.name for key in LawKeys.file_keys("table")} == {"file", "negative_file", "units"}


def test_a_curve_file_is_embedded(tmp_path, monkeypatch):
    (tmp_path / "test.csv").write_text("# bending test\nangle [deg]; moment [kN*m]\n0; 1.5\n90; 0.5\n")
    monkeypatch.chdir(tmp_path)
    law = LawKeys(type="table", file="test.csv")
    np.testing.assert_allclose(law.rotation, [0, np.pi / 2])
    assert law.moment == (1500.0, 500.0)
    assert "file" not in law.own
    (tmp_path / "test.csv").unlink()
    assert law.model_copy(update={"static": False}).moment == law.moment


def test_lists_may_share_a_unit():
    law = LawKeys(
        type="table",
        rotation=[0, 90, "0.5 rev"],
        moment=[2, 1, "800 N*m"],
        units={"rotation": "deg", "moment": "kN*m"},
    )
    np.testing.assert_allclose(law.rotation, [0, np.pi / 2, np.pi])
    assert law.moment == (2000.0, 1000.0, 800.0)
    for units, key in (({"rotation": "mm"}, "unit of a length"), ({"angle": "deg"}, "unknown column")):
        with pytest.raises(InputError, match=key):
            LawKeys(type="table", rotation=[0, 1], moment=[2, 1], units=units)


BAD_FILES = {
    "missing": (None, "there is no such file"),
    "empty": ("", "the table is empty"),
    "header only": ("rotation [deg], moment [N*m]\n", "no points"),
    "no unit": ("rotation, moment\n0, 1\n", "no column is named"),
    "wrong unit": ("rotation [mm], moment [N*m]\n0, 1\n", "unit of a length"),
    "bad row": ("rotation [deg], moment [N*m]\n0, 1\n5, x\n", "not a number in every column"),
    "short row": ("rotation [deg], moment [N*m]\n0, 1\n5\n", "not a number in every column"),
    "quote left open": ('rotation [deg], moment [N*m]\n"0, 1\n5, 1\n', "not a number in every column"),
    "binary": (b"\xff\xfe\x00", "not a text in UTF-8"),
    "too large": ("0, 1\n" * 500_000, "too large"),
    "too long": (
        "rotation [deg], moment [N*m]\n" + "".join(f"{i}, 1\n" for i in range(20_001)),
        "too many points",
    ),
}


@pytest.mark.parametrize("case", BAD_FILES)
def test_a_bad_curve_file_is_refused(tmp_path, monkeypatch, case):
    content, what = BAD_FILES[case]
    monkeypatch.chdir(tmp_path)
    if content is not None:
        (tmp_path / "a.csv").write_bytes(content if isinstance(content, bytes) else content.encode())
    with pytest.raises(InputError) as refusal:
        LawKeys(type="table", file="a.csv")
    assert len(refusal.value.problems) == 1
    assert what in refusal.value.problems[0].what


def test_a_bad_row_names_file_and_line(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "a.csv").write_text("rotation [deg], moment [N*m]\n" + "x, 1\n" * 30)
    with pytest.raises(InputError) as refusal:
        LawKeys(type="table", file="a.csv")
    first, *_, last = refusal.value.problems
    assert (first.file, first.line, first.where) == ("a.csv", 2, "")
    assert last.what == "20 more lines are wrong"


@pytest.mark.parametrize("name", [3, ["a"], "a\0b", "x" * 500, "."])
def test_a_bad_file_name_is_refused(name):
    with pytest.raises(InputError):
        LawKeys(type="table", file=name)


def test_a_curve_is_given_once(tmp_path, monkeypatch):
    with pytest.raises(InputError, match="given twice"):
        LawKeys(type="table", file="a.csv", rotation=[0], moment=[1])


def test_keys_of_one_law_are_unknown_to_another():
    with pytest.raises(InputError, match="unknown key 'moment'"):
        LawKeys(type="kecman", moment=3)
    with pytest.raises(InputError, match="more than 0"):
        LawKeys(type="constant", moment="-3 N*m")


def test_a_ramp_that_no_form_uses_is_refused():
    assert LawKeys(type="kecman", form="regularised", regularisation={"rate": 0.1}).regularisation.rate == 0.1
    with pytest.raises(InputError, match="'regularisation' would have no effect") as caught:
        LawKeys(type="kecman", regularisation={"rate": 0.1})
    assert caught.value.problems[0].where == "regularisation"
