import re

import numpy as np
import pytest

from crumple.errors import InputError
from crumple.hinge import TabulatedLaw, build_law, plastic_part, read_table
from crumple.material import CowperSymonds, Material
from crumple.section import RectangularTube

STEEL = Material("steel", 210e9, 0.3, 7850.0, 488e6, flow_rate=CowperSymonds(6844.0, 3.91))
TUBE = RectangularTube(0.050, 0.025, 0.00265)


@pytest.mark.parametrize(
    "text",
    [
        "rotation [deg], moment [kN*m]\n0, 1\n10, 0.5\n",
        "# test 3\n\nMoment (kN*m);Angle (deg);note\n1;0;a\n0.5;10;b\n",
        "hinge_rotation [mrad]\tbending_moment [N*mm]\n0\t1e6\n174.5329251994\t5e5",
        "rotation_rate [rad/s], rotation [deg], moment [N*m]\n5,0,1000\n5,10,500\n",
    ],
)
def test_columns_are_found_by_name_and_converted(text):
    rotation, moment = read_table(text)
    np.testing.assert_allclose(rotation, [0.0, np.radians(10.0)], rtol=1e-12)
    np.testing.assert_allclose(moment, [1000.0, 500.0], rtol=1e-12)


@pytest.mark.parametrize(
    ("text", "line", "message"),
    [
        ("", 1, "empty"),
        ("# nothing\n\n", 1, "empty"),
        ("rotation [deg], moment [kN*m]\n", 1, "no points"),
        ("rotation, moment\n0,1\n", 1, "no column is named rotation"),
        ("rotation [deg], force [kN]\n0,1\n", 1, "no column is named moment"),
        ("rotation [mm], moment [kN*m]\n0,1\n", 1, "length"),
        ("rotation [deg], moment [kN*mmm]\n0,1\n", 1, "unknown unit"),
        ("rotation [deg], moment [kN*m]\n0,1\n1;2\n", 3, "not a number"),
        ("rotation [deg]; moment [kN*m]\n0;1,5\n", 2, "not a number"),
        ("rotation [deg], moment [kN*m]\n0,nan\n", 2, "not a number"),
    ],
)
def test_bad_tables_are_refused_with_their_line(text, line, message):
    with pytest.raises(InputError, match=message) as error:
        read_table(text, "bending.csv")
    assert error.value.problems[0].line == line
    assert error.value.problems[0].file == "bending.csv"


def measured(stiffness=50e3, slack=0.002):
    """A test curve: slack, elastic rise, yield at 800, peak 1000 at plastic 0.05, softening."""
    plastic = np.concatenate([np.zeros(9), np.linspace(0.0, 0.4, 41)[1:]])
    capacity = np.interp(np.linspace(0.0, 0.4, 41)[1:], [0.0, 0.05, 0.4], [800.0, 1000.0, 400.0])
    moment = np.concatenate([np.linspace(0.0, 800.0, 9), capacity])
    return slack + moment / stiffness + plastic, moment


def test_elastic_rise_and_slack_are_taken_out():
    rotation, moment, stiffness = plastic_part(*measured())
    assert stiffness == pytest.approx(50e3)
    assert rotation[0] == 0.0
    assert moment[0] == pytest.approx(800.0)
    np.testing.assert_allclose(
        moment, np.interp(rotation, [0.0, 0.05, 0.4], [800.0, 1000.0, 400.0]), rtol=1e-9
    )


def test_given_stiffness_is_used():
    rotation, moment, stiffness = plastic_part(*measured(slack=0.0), 50e3)
    assert stiffness == 50e3
    np.testing.assert_allclose(
        moment, np.interp(rotation, [0.0, 0.05, 0.4], [800.0, 1000.0, 400.0]), rtol=1e-9
    )


def test_scatter_and_unloading_are_left_out():
    rotation, moment = measured()
    # an unloading and reloading loop in the middle of the softening
    loop = np.array([rotation[30] - 300 / 50e3, rotation[30]])
    rotation = np.insert(rotation, 31, loop)
    moment = np.insert(moment, 31, [moment[30] - 300.0, moment[30]])
    plastic, capacity, _ = plastic_part(rotation, moment)
    assert np.all(np.diff(plastic) > 0.0)
    np.testing.assert_allclose(
        capacity, np.interp(plastic, [0.0, 0.05, 0.4], [800.0, 1000.0, 400.0]), rtol=1e-9
    )


def test_rise_without_points_needs_a_stiffness():
    with pytest.raises(InputError, match="elastic rise cannot be found"):
        plastic_part([0.0, 0.02, 0.3], [0.0, 1000.0, 500.0])
    with pytest.raises(InputError, match="leave it out: then"):
        plastic_part(*measured(slack=0.0), 500e3)
    for stiffness in (0.0, -1.0, np.inf, np.nan):
        with pytest.raises(InputError, match="stiffness must be positive"):
            plastic_part(*measured(slack=0.0), stiffness)


COARSE = [0.0, 0.05, 0.09, 0.35], [0.0, 1600.0, 1700.0, 800.0]
"""A test without points between 20 and 60 % of its peak."""


@pytest.mark.parametrize("given", [None, 60e3, 1e9])
def test_what_a_refused_stiffness_asks_for_is_accepted(given):
    """Leaving the stiffness out asks for one, and a steep one for the steepest that the curve has."""
    with pytest.raises(InputError) as refusal:
        plastic_part(*COARSE, given)
    (problem,) = refusal.value.problems
    written = re.search(r"elastic_stiffness: ([0-9.]+) kN\*m/rad", problem.todo)
    assert float(written[1]) == 32.0
    assert "leave it out: then" not in problem.todo
    plastic, capacity, stiffness = plastic_part(*COARSE, 1e3 * float(written[1]))
    assert (plastic[0], capacity[0], stiffness) == (0.0, 1600.0, 32e3)


def test_a_rise_that_falls_is_none():
    with pytest.raises(InputError, match="elastic rise cannot be found"):
        plastic_part([0.0, 0.01, 0.02, 0.03, 0.3], [0.0, 500.0, 400.0, 1000.0, 500.0])


def test_a_curve_that_begins_with_a_moment_takes_any_stiffness():
    begun = [0.0, 0.1, 0.3], [1600.0, 1500.0, 800.0]
    with pytest.raises(InputError, match="'type: table' without 'remove_elastic'; or give elastic_stiffness"):
        plastic_part(*begun)
    for stiffness in (5e3, 1e9):
        assert plastic_part(*begun, stiffness)[1][0] == 1600.0
    assert build_law("table", TUBE, STEEL, rotation=begun[0], moment=begun[1]).moment_capacity(0.0) == 1600.0


def test_law_of_a_measured_curve():
    rotation, moment = measured()
    law = build_law("table", TUBE, STEEL, rotation=rotation, moment=moment, remove_elastic=True)
    assert law.elastic_stiffness == pytest.approx(50e3)
    assert law.moment_capacity(0.05) == pytest.approx(1000.0)
    assert law.rate is not None
    assert build_law("table", TUBE, STEEL, rotation=[0.0], moment=[1.0], static=False).rate is None
    # as it came, the curve starts at zero moment, which is no capacity
    with pytest.raises(InputError, match="'remove_elastic: true'"):
        build_law("table", TUBE, STEEL, rotation=rotation - rotation[0], moment=moment)


def test_negative_curve_is_its_own():
    rotation, moment = measured()
    law = build_law(
        "table",
        TUBE,
        STEEL,
        rotation=rotation,
        moment=moment,
        negative_rotation=rotation,
        negative_moment=0.5 * moment,
        remove_elastic=True,
    )
    assert law.moment_capacity(0.05, -1) == pytest.approx(500.0)


def test_end_of_the_table_is_the_end_of_its_range():
    law = TabulatedLaw([0.0, 0.2], [1000.0, 500.0])
    assert law.moment_capacity(0.1) == pytest.approx(750.0)
    assert law.moment_capacity(0.5) == 500.0
    assert law.validity.rotation_max == 0.2
    assert "table ends" in law.validity.warning_at(0.5)


def test_callers_list_does_not_reach_into_the_law():
    moment = [1000.0, 500.0]
    law = TabulatedLaw([0.0, 0.2], moment)
    moment[0] = 1.0
    assert law.moment_capacity(0.0) == 1000.0


@pytest.mark.parametrize(
    ("keys", "message"),
    [
        ({"rotation": [], "moment": []}, "as many moments"),
        ({"rotation": [0.0, 1.0], "moment": [1.0]}, "as many moments"),
        ({"rotation": [0.1, 1.0], "moment": [1.0, 1.0]}, "increase strictly"),
        ({"rotation": [0.0, float("nan")], "moment": [1.0, 1.0]}, "increase strictly"),
        ({"rotation": [0.0, 1.0], "moment": [0.0, 1.0]}, "positive"),
        ({"rotation": [0.0], "moment": [1.0], "negative_moment": [1.0]}, "negative curve"),
        (
            {"rotation": [0.0], "moment": [1.0], "negative_rotation": [0.0], "negative_moment": [-1.0]},
            "positive",
        ),
    ],
)
def test_bad_points_are_refused(keys, message):
    with pytest.raises(InputError, match=message):
        TabulatedLaw(**keys)
