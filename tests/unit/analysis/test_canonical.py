"""The canonical form: one input, one hash, however it is written."""

import json
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from crumple.analysis import canonical, input_hash, load, loads

TEXT = Path("examples/01_tube_bending.yaml").read_text(encoding="utf-8")
HASH = input_hash(loads(TEXT))

SAME = {
    "units": ("2.65 mm", "0.265 cm"),
    "stress unit": ("488 MPa", "0.488 GPa"),
    "inches": ("width: 50 mm", "width: 1.968503937007874 in"),
    "degrees, rounded": ("rotation: 15 rad/s", "rotation: 859.436692696235 deg/s"),
    "minus zero": ("[0, -1, 0]", "[-0.0, -1, 0]"),
    "default spelled out": ("payload: {node: tip,", "payload: {node: tip, offset: [0, 0, 0],"),
    "default left out": (
        "    roll: 0 deg                # 90 deg turns the section upright: bending about the strong axis\n",
        "",
    ),
    "key order": ("{node: root, fix: all}", "{fix: all, node: root}"),
    "empty list": ("outputs:\n", "loads: []\noutputs:\n"),
    "comment": ("crumple: 1", "# a comment\ncrumple: 1"),
}
OTHER = {
    "thickness": ("2.65 mm", "2.651 mm"),
    "duration": ("duration: 100 ms", "duration: 101 ms"),
    "accuracy": ("1e-3", "1e-4"),
    "outputs": ("every: 0.5 ms", "every: 1 ms"),
    "hinge": ("at: root", "at: 1 mm"),
    "law": ("law: kecman", "law: {type: kecman, rolling_weight: 0.5}"),
    "axis": ("[0, -1, 0]", "[0, 1, 0]"),
}


@pytest.mark.parametrize("case", SAME)
def test_spelling_does_not_change_the_hash(case):
    old, new = SAME[case]
    assert old in TEXT
    assert input_hash(loads(TEXT.replace(old, new, 1))) == HASH


@pytest.mark.parametrize("case", OTHER)
def test_content_changes_the_hash(case):
    old, new = OTHER[case]
    assert old in TEXT
    assert input_hash(loads(TEXT.replace(old, new, 1))) != HASH


def test_the_canonical_form_is_plain_sorted_and_complete():
    form = canonical(loads(TEXT))
    assert json.loads(json.dumps(form, allow_nan=False)) == form
    assert list(form) == sorted(form)
    assert "null" not in json.dumps(form)
    assert form["structure"]["sections"]["tube"] == {
        "type": "rectangular_tube",
        "width": 0.05,
        "depth": 0.025,
        "thickness": 0.00265,
        "corner_radius": 0.0,
    }


def test_the_hash_of_curves_does_not_see_paths(tmp_path):
    text = Path("examples/03_measured_hinge.yaml").read_text(encoding="utf-8")
    curve = Path("examples/03_measured_hinge.csv").read_text(encoding="utf-8")
    (tmp_path / "other.csv").write_text(curve.replace("rotation [deg]", "angle [deg]"), encoding="utf-8")
    moved = loads(text.replace("03_measured_hinge.csv", "other.csv"), directory=tmp_path)
    assert input_hash(moved) == input_hash(load("examples/03_measured_hinge.yaml"))
    assert "other.csv" not in json.dumps(canonical(moved))


@given(st.permutations(TEXT.split("\n\n")))
def test_the_order_of_the_groups_does_not_matter(groups):
    assert input_hash(loads("\n\n".join(groups) + "\n")) == HASH
