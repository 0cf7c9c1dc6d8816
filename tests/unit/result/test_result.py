"""A result gives channels by name, summarises its outputs, filters, compares and reports missing channels."""

import json
import math
import sys
from dataclasses import replace

import numpy as np
import pytest
from tests.support.result.synthetic_tube import MOMENT, ROTATION_MAX, tube_channels, tube_result

from crumple.errors import InputError, Status
from crumple.result import Channel, cfc, summary, summary_json

ACCELERATION = "node.tip.acceleration.z"


def test_channel_by_name(tube):
    assert tube["hinge.root.rotation"][-1] == pytest.approx(-ROTATION_MAX, rel=1e-14)


def test_unknown_channel_names_the_nearest(tube):
    with pytest.raises(KeyError, match=r"hinge\.root\.rotation"):
        tube["hinge.root.rotaton"]


def test_outputs_take_the_value_of_largest_magnitude_with_its_sign(tube):
    channels = tube_channels(tube.time)
    channels["x"] = Channel("x", "m", np.array([0.0, 1.0, -3.0, math.nan] + [2.0] * (len(tube.time) - 4)))
    output = tube_result(channels=channels, output_names=("x",)).outputs["x"]
    assert (output.final, output.max, output.time_of_max, output.unit) == (2.0, -3.0, tube.time[2], "m")


def test_outputs_have_no_negative_zero(tube):
    channels = {"x": Channel("x", "m", np.full(len(tube.time), -0.0))}
    output = tube_result(channels=channels, output_names=("x",)).outputs["x"]
    assert math.copysign(1.0, output.max) == math.copysign(1.0, output.final) == 1.0


def test_outputs_skip_a_channel_without_any_number(tube):
    channels = tube_channels(tube.time)
    channels["x"] = Channel("x", "m", np.full(len(tube.time), math.nan))
    assert tube_result(channels=channels, output_names=("x",)).outputs == {}


def test_equals_sees_one_bit():
    first, second = tube_result(), tube_result()
    assert first.equals(second)
    second["energy.kinetic"][7] = np.nextafter(second["energy.kinetic"][7], np.inf)
    assert not first.equals(second)


def test_equals_takes_nan_as_equal_and_names_as_different():
    assert tube_result(energy_residual=math.nan).equals(tube_result(energy_residual=math.nan))
    assert not tube_result(energy_residual=math.nan).equals(tube_result(energy_residual=0.0))
    assert not tube_result().equals(tube_result(title="another"))


def test_a_result_holds_and_lists_the_names_of_its_channels(tube):
    assert "node.tip.velocity.z" in tube
    assert "node.tip.velocity.zz" not in tube
    assert list(tube) == list(tube.channels)


def test_filtered_is_the_filter_on_the_channel(tube):
    smooth = tube.filtered("node.tip.velocity.z", 180)
    assert smooth.name == "node.tip.velocity.z.cfc180"
    assert smooth.unit == "m/s"
    np.testing.assert_array_equal(smooth.values, cfc(tube["node.tip.velocity.z"], 0.0005, 180))
    # no acceleration before the start, while velocities are not known to vanish
    values = np.arange(40.0)
    pulse = replace(
        tube, time=0.5e-3 * values, channels={ACCELERATION: Channel(ACCELERATION, "m/s^2", values)}
    )
    smooth = pulse.filtered(ACCELERATION, 60).values
    np.testing.assert_array_equal(smooth, cfc(values, 0.0005, 60, before=0.0))


def test_filtered_refuses_what_cannot_be_filtered(tube):
    with pytest.raises(InputError, match="did you mean"):
        tube.filtered("node.tip.velocity.zz", 60)
    with pytest.raises(InputError, match="6000 Hz"):
        tube.filtered("node.tip.velocity.z", 600)
    uneven = tube_result(time=np.concatenate([tube.time[:-1], [0.09999]]))
    with pytest.raises(InputError, match="equally spaced"):
        uneven.filtered("node.tip.velocity.z", 60)


def test_to_pandas(tube):
    pytest.importorskip("pandas")
    table = tube.to_pandas()
    assert table.index.name == "time [s]"
    np.testing.assert_array_equal(table["hinge.root.moment [N*m]"], tube["hinge.root.moment"])


def test_without_pandas_a_table_says_what_to_do(tube, monkeypatch):
    monkeypatch.setitem(sys.modules, "pandas", None)
    with pytest.raises(InputError, match=r"(?s)pandas is not installed.*pip install pandas"):
        tube.to_pandas()


def test_summary_has_the_keys_of_the_contract(tube):
    content = summary(tube)
    assert {"status", "reason", "fidelity", "solve_seconds", "energy_residual", "hinges", "outputs"} <= set(
        content
    )
    assert content["status"] == "complete"
    assert content["ok"] is True
    hinge = content["hinges"]["root"]
    assert {"rotation_max", "rotation_final", "time_of_rest", "energy", "moment_max"} <= set(hinge)
    assert hinge["moment_max"] == MOMENT
    assert {"final", "max", "time_of_max"} <= set(content["outputs"]["node.tip.displacement.z"])


def test_summary_json_is_strict():
    def refuse(text):
        raise AssertionError(f"not JSON: {text}")

    result = tube_result(
        status=Status.NOT_FINITE,
        energy_residual=math.inf,
        solve_seconds=np.float64("nan"),
    )
    content = json.loads(summary_json(result), parse_constant=refuse)
    assert content["energy_residual"] is None
    assert content["solve_seconds"] is None
    assert content["ok"] is False


def test_summary_json_takes_numpy_and_foreign_settings(tube):
    settings = {"a": np.float64(1.5), "b": np.arange(3), "c": Status.COMPLETE, "d": (1, None, True)}
    changed = tube_result(provenance=type(tube.provenance)("1", "hash", settings=settings))
    content = json.loads(summary_json(changed))["provenance"]["settings"]
    assert content == {"a": 1.5, "b": [0, 1, 2], "c": "Status.COMPLETE", "d": [1, None, True]}
