"""Numbers are readable, and the verdict contains every required sentence."""

import math
from dataclasses import replace

import numpy as np
import pytest
from tests.support.result.synthetic_frame import frame_result
from tests.support.result.synthetic_tube import tube_result

from crumple.errors import Status
from crumple.hinge.law import BEYOND_RANGE
from crumple.report.drawing.scales import display_unit, output_groups, pretty_unit, spread, thinned, time_unit
from crumple.report.wording.key_figures import key_figures
from crumple.report.wording.wording import (
    BEYOND_LAWS,
    angle,
    column,
    hinge_table,
    law_table,
    number,
    output_table,
    percent,
    verdict,
)
from crumple.result import Caution, Channel, CrumpledEnd, CrushSummary, DentedWall


@pytest.mark.parametrize(
    ("share", "text"),
    [(0.001, "0.1 %"), (0.0123, "1.2 %"), (1.0, "100 %"), (12.0, "1200 %"), (-0.5, "−50 %"), (0.0, "0 %"),
     (1e-12, "< 0.0001 %"), (math.nan, "not known"), (math.inf, "not known")],
)  # fmt: skip
def test_percent(share, text):
    assert percent(share) == text


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.544867, "0.5449"),
        (31.2187, "31.22"),
        (1696.09, "1696"),
        (123456.0, "123456"),
        (0.0, "0"),
        (-2.5, "−2.500"),
        (1.5e-5, "0.00001500"),
        (math.nan, "—"),
        (-1e-14, "0.000000000"),
    ],
)
def test_number(value, text):
    assert number(value) == text


def test_angle_has_both_units():
    assert angle(math.pi / 6) == "30.00° (0.5236 rad)"


def test_column_shares_unit_and_decimals():
    assert column([1696.09, 12.0, math.nan, -0.0], "N*m") == ("kN m", ("1.696", "0.012", "—", "0.000"))
    assert column([], "J")[1] == ()


def test_verdict_good():
    message = verdict(tube_result(), 1e-3, 1e-3)
    assert (message.level, message.headline) == ("good", "Complete.")
    assert message.warnings == ()
    assert "within its bound of 0.1 %" in message.reasons[0]
    assert message.reasons[-1] == "All laws stayed inside their ranges of validity: those of 1 hinge."


CRUSH = CrushSummary(
    length=0.1,
    length_final=0.1,
    peak_force=1e5,
    mean_force=5e4,
    energy=5e3,
    stroke=0.15,
    efficiency=0.5,
    bottomed_out=False,
)


def test_verdict_speaks_of_the_laws_of_crushing_dents_and_ends():
    plain = tube_result()
    hinges = {name: replace(hinge, crush=CRUSH) for name, hinge in plain.hinges.items()}
    dents = (DentedWall("m", 0.1, "pole", 0.01, 5.0),) * 2
    ends = (CrumpledEnd("m", "n", "wall", 0.02, 7.0),)
    result = replace(plain, hinges=hinges, dents=dents, crumpled_ends=ends)
    told = "those of 1 hinge, 1 crush zone, 2 dents, 1 crumpled end."
    assert verdict(result, 1e-3, None).reasons[-1].endswith(told)


@pytest.mark.parametrize("code", sorted(BEYOND_LAWS))
def test_no_law_is_called_inside_if_one_was_passed(code):
    passed = Caution(code, 2.0, 1.0, "m", "member m", "A dent is deep.")
    reasons = verdict(replace(tube_result(), cautions=(passed,)), 1e-3, None).reasons
    assert not any("inside" in reason for reason in reasons)


def test_hinge_table_has_no_negative_zero():
    result = frame_result()
    energies = dict(zip(result.hinges, (1.0, 1.0, 1.0, -1e-9), strict=True))
    hinges = {name: replace(result.hinges[name], energy=energy) for name, energy in energies.items()}
    shares = [row[7] for row in hinge_table(replace(result, hinges=hinges)).rows]
    assert shares == ["33.3 %"] * 3 + ["0.0 %"]


def test_verdict_cautions_outside_the_range_once():
    message = verdict(frame_result(), 1e-3, None)
    assert message.level == "caution"
    assert message.warnings == (
        "Hinge h0 turned 28.65° (0.5000 rad), beyond the range of validity of its law, 11.46° (0.2000 rad). "
        f"{BEYOND_RANGE}",
        "Hinge h1 turned 24.35° (0.4250 rad), beyond the range of validity of its law, 20.05° (0.3500 rad). "
        f"{BEYOND_RANGE}",
    )
    reported = frame_result(warnings=("Hinge h0 turned by 28.6 deg; its law is valid up to 11.5 deg only.",))
    assert len(verdict(reported, 1e-3, None).warnings) == 2
    said = "turned by 28.6 deg; the law is valid up to 11.5 deg only (formula)"
    heads = {"Hinge h0": 2, "Hinges h0, h1": 1, "Hinges a, b and 2 more": 1, "Hinge h01": 3}
    for head, left in heads.items():
        reported = frame_result(warnings=(f"{head}: {said}",))
        assert len(verdict(reported, 1e-3, None).warnings) == left


def test_a_law_without_a_range_is_not_called_valid_up_to_zero():
    result = frame_result()
    hinges = {
        name: replace(hinge, validity_rotation=0.0) if name == "h0" else hinge
        for name, hinge in result.hinges.items()
    }
    first = verdict(replace(result, hinges=hinges), 1e-3, None).warnings[0]
    assert first == "Hinge h0 turned 28.65° (0.5000 rad); its law has no range of validity. " + BEYOND_RANGE
    said = "Hinges h0, h1: turned by 28.6 deg; the law has no range of validity (estimate)"
    assert len(verdict(replace(result, hinges=hinges, warnings=(said,)), 1e-3, None).warnings) == 1


def test_verdict_bad_gives_status_and_reason():
    result = tube_result(status=Status.RESIDUAL_EXCEEDED, reason="it grew from 3 ms on", energy_residual=2e-3)
    message = verdict(result, 1e-3, None)
    assert message.level == "bad"
    assert message.headline == "Ended, but the energy residual exceeds its limit: do not trust this result."
    assert message.reasons[:2] == (
        "It grew from 3 ms on.",
        "Energy balance: residual 0.2 % of the energy input, beyond its bound of 0.1 %.",
    )


def test_key_figures_name_the_hinge_where_there_are_several():
    single = {name: (value, note) for name, value, note in key_figures(tube_result())}
    assert single["At rest after"] == ("69.67 ms", "")
    several = {name: (value, note) for name, value, note in key_figures(frame_result())}
    assert several["Largest rotation"] == ("28.65°", "0.5 rad · h0")
    assert several["At rest after"] == ("—", "1 of 4 still rotating")


def test_hinge_table_shares_add_up():
    table = hinge_table(frame_result())
    assert [row[0] for row in table.rows] == ["h0", "h1", "h2", "h3"]
    assert sum(float(row[7].rstrip(" %")) for row in table.rows) == pytest.approx(100, abs=0.3)
    assert all(len(row) == len(table.heads) for row in table.rows)
    assert table.rows[0][5] == "—"
    assert "still rotating" in table.caption


def test_law_table_joins_hinges_with_one_law():
    result = frame_result()
    hinges = {name: replace(hinge, validity_rotation=0.3) for name, hinge in result.hinges.items()}
    (row,) = law_table(replace(result, hinges=hinges)).rows
    assert row[0] == "h0, h1, h2, h3"
    assert row[5:] == ("17.19°", "28.65°", "no")


def vector_result():
    time = tube_result().time
    values = {"a.displacement.x": time, "a.displacement.y": 0 * time, "a.displacement.z": 1e-15 * time,
              "a.speed.x.cfc60": time, "a.speed.z.cfc60": -time, "b": 0 * time}  # fmt: skip
    channels = {name: Channel(name, "m", value) for name, value in values.items()}
    return tube_result(channels=channels, hinges={}, output_names=tuple(channels))


def test_outputs_are_grouped_by_vector_and_zeros_only_named():
    groups, still = output_groups(vector_result())
    assert [(g.name, [label for label, _ in g.channels]) for g in groups] == [
        ("a.displacement", ["x"]),
        ("a.speed.cfc60", ["x", "z"]),
    ]
    assert still == ["a.displacement.y", "a.displacement.z", "b"]
    table = output_table(vector_result())
    assert [row[0] for row in table.rows] == ["a.displacement.x", "a.speed.x.cfc60", "a.speed.z.cfc60"]
    assert "Zero throughout: a.displacement.y, a.displacement.z, b." in table.caption


def test_thinned_keeps_ends_and_extremes():
    x = np.linspace(0.0, 1.0, 50_000)
    y = np.sin(40 * x)
    y[12_345], y[33_333] = 7.0, -9.0
    thin_x, thin_y = thinned(x, y)
    assert len(thin_x) <= 1202
    assert (thin_y.max(), thin_y.min()) == (7.0, -9.0)
    assert (thin_x[0], thin_x[-1]) == (0.0, 1.0)
    assert np.all(np.diff(thin_x) > 0)


def test_spread_is_never_empty():
    assert spread([np.array([2.0, 4.0])], margin=0.1) == pytest.approx((0.0, 4.4))
    assert spread([np.array([-2.0, np.nan])], margin=0.1) == pytest.approx((-2.2, 0.2))
    assert spread([np.zeros(3)]) == (-1.0, 1.0)
    assert spread([]) == (-1.0, 1.0)


def test_units_for_people():
    assert display_unit("N*m", 1696.0) == ("kN m", 1000.0)
    assert display_unit("m/s^2", 3.0) == ("m/s²", 1.0)
    assert display_unit("parsecs per fortnight", 3.0) == ("parsecs per fortnight", 1.0)
    assert display_unit("1", 3.0) == ("", 1.0)
    assert display_unit("rad", 1.0) == ("deg", pytest.approx(math.pi / 180))
    assert pretty_unit("kg*m^2/s^3") == "kg m²/s³"
    assert [time_unit(end)[0] for end in (1e-4, 0.1, 2.0, 10.0)] == ["µs", "ms", "ms", "s"]
