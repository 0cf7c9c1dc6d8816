"""Kinds of channels: each has a unit and a meaning once, and the table of the page is theirs."""

from pathlib import Path

import numpy as np
import pytest
from tests.support.structures import STEEL

import crumple
from crumple.multibody import Run, solve_multibody
from crumple.result.channels import (
    BEGIN,
    END,
    KINDS,
    channel,
    channel_table,
    channels_along,
    kind_of,
    main,
    names_of,
)
from crumple.structure import MultibodySettings, Structure

PAGE = Path("docs/conventions.md")


def test_the_page_holds_the_table_of_the_kinds(tmp_path):
    text = PAGE.read_text(encoding="utf-8")
    written = text.partition(BEGIN)[2].partition(END)[0].strip()
    assert written == channel_table(), "run: python -m crumple.result.channels docs/conventions.md"
    copy = tmp_path / "page.md"
    copy.write_text(text, encoding="utf-8")
    main(copy)
    assert copy.read_text(encoding="utf-8") == text


def test_every_kind_has_one_line():
    names = [kind.name for kind in KINDS]
    assert len(set(names)) == len(names) > 40
    assert all(kind.unit and kind.meaning for kind in KINDS)
    assert {kind.given_by for kind in KINDS} == {"", "M", "MS", "S", "MS, S"}


def test_a_channel_has_the_unit_of_its_kind():
    assert channel("energy.kinetic", np.zeros(2)).unit == "J"
    assert channel("hinge.x.slip.x.force", np.zeros(2)).unit == "N"
    assert channel("hinge.root.moment.z", np.zeros(2)).unit == "N*m"
    values = np.arange(6.0).reshape(2, 3)
    three = list(channels_along("node.tip.velocity", values))
    assert [one.name for one in three] == [f"node.tip.velocity.{axis}" for axis in "xyz"]
    assert {one.unit for one in three} == {"m/s"}
    np.testing.assert_array_equal(np.array([one.values for one in three]).T, values)


def test_a_kind_without_a_line_is_a_mistake_of_the_program():
    assert kind_of("node.x.jerk.y") == "node.NAME.jerk.xyz"
    with pytest.raises(LookupError, match="KINDS"):
        channel("node.x.jerk.y", np.zeros(2))


def test_names_of_one_hinge_leave_its_components_out():
    assert set(names_of("hinge", "root")) == {
        f"hinge.root.{quantity}"
        for quantity in ("rotation", "rotation_rate", "plastic_rotation", "moment", "capacity", "energy")
    }
    assert "node.tip.rotation_rate.z" in set(names_of("node", "tip"))
    obstacle = list(names_of("obstacle", "pole"))
    assert "obstacle.pole.dent" in obstacle
    assert len(obstacle) == 10


@pytest.mark.parametrize(
    ("example", "given_by"), [("01_tube_bending", {"", "M"}), ("11_front_rails", {"", "M", "MS", "MS, S"})]
)
def test_the_last_column_names_the_solvers_of_a_channel(example, given_by):
    analysis = crumple.load(Path(f"examples/{example}.yaml"))
    result = crumple.solve(analysis)
    asked = {*analysis.outputs.section_rotations, *analysis.outputs.distances, *analysis.outputs.filters}
    found = {kind_of(name) for name in result.channels if name not in asked}
    by_name = {kind.name: kind.given_by for kind in KINDS}
    assert {by_name[name] for name in found} <= given_by
    always = {name for name, by in by_name.items() if by == "" and not name.startswith("node.")}
    assert always <= found


def test_the_capacity_of_a_hinge_is_that_without_other_loads_and_no_limit_of_several_moments():
    """A square tube between both axes yields below either capacity, far below the length of the vector."""
    law = {"type": "constant", "moment": 5000.0, "rate": "off"}
    hinge = {"name": "foot", "at": 0.05, "law": law, "axes": ("y", "z")}
    structure = Structure(
        materials={"steel": STEEL},
        sections={"tube": {"type": "square_tube", "side": 0.05, "thickness": 0.0015}},
        nodes={"a": (0, 0, 0), "b": (0, 0, 0.4)},
        members={"ab": {"nodes": ("a", "b"), "section": "tube", "material": "steel", "hinges": (hinge,)}},
        supports={"clamp": {"node": "a", "fix": "all"}},
        masses={"m": {"node": "b", "mass": 50.0}},
        initial_velocity=[{"nodes": ("b",), "translation": (3.0, 3.0, 0.0)}],
    )
    result = solve_multibody(structure, Run(0.01, 1e-3, MultibodySettings()))
    alone = [result[f"hinge.foot.capacity.{axis}"][5] for axis in "yz"]
    assert alone == pytest.approx([5000.0, 5000.0])
    assert result["hinge.foot.capacity"][5] == pytest.approx(np.hypot(*alone))
    assert 4500.0 < result["hinge.foot.moment"][5] < 5000.0
