"""Outputs of moving bodies: clearances of a space that must stay free, and the work of gravity."""

import numpy as np
import pytest

from crumple.analysis import loads, solve
from crumple.errors import InputError
from crumple.report.wording.wording import fall_table

# a bar swings down from level about a pin at its end, past a square that stands still
SWINGING = """crumple: 1
materials:
  steel: {youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: 300 MPa}
sections:
  tube: {type: square_tube, side: 40 mm, thickness: 2 mm}
nodes: {pin: [0 m, 0 m, 0 m], tip: [1 m, 0 m, 0 m], post: [0 m, 0 m, -3 m], foot: [0 m, 0 m, -2 m]}
members:
  bar: {nodes: [pin, tip], section: tube, material: steel}
  post: {nodes: [post, foot], section: tube, material: steel}
supports:
  pin: {node: pin, fix: [x, y, z, rx, rz]}
  post: {node: post, fix: all}
masses: {lump: {node: tip, mass: 20 kg}}
gravity: [0 m/s^2, 0 m/s^2, -9.81 m/s^2]
analysis: {duration: 0.4 s}
outputs:
  every: 10 ms
  nodes: [tip]
  clearances:
    below:
      moves_with: post
      members: [bar]
      points: [[-1 m, 0 m, -2 m], [2 m, 0 m, -2 m], [2 m, 0 m, -1.5 m], [-1 m, 0 m, -1.5 m]]
"""


@pytest.fixture(scope="module", name="result")
def _result():
    return solve(loads(SWINGING))


def test_clearance_is_that_of_the_tip_less_half_the_section(result):
    tip = result["node.tip.displacement.z"]
    assert tip[-1] < -0.5
    np.testing.assert_allclose(result["below"], 1.5 + tip - 0.02, atol=1e-9)
    assert result.outputs["below"].unit == "m"


def test_work_of_gravity_is_the_kinetic_energy_of_what_swings_free(result):
    work = result["energy.gravity"]
    np.testing.assert_allclose(work, result["energy.kinetic"], atol=1e-3 * work[-1])
    bar, lump = 2.0 * 1.193, 20.0
    assert work[-1] == pytest.approx(
        -9.81 * result["node.tip.displacement.z"][-1] * (lump + bar / 2.0), rel=2e-2
    )


def test_the_snap_is_reported_with_both_energies(result):
    table = fall_table(result)
    fall, prescribed = (float(row[1].replace("−", "-")) for row in table.rows[:2])
    assert fall == pytest.approx(result["energy.gravity"][-1], rel=1e-3)
    assert prescribed == pytest.approx(0.75 * fall, rel=1e-3)
    # not of hinges alone: what yields between them and dents are in it
    assert table.rows[2][0] == "Absorbed by the structure"


def test_wrong_clearances_are_refused():
    for old, new, expected in (
        ("moves_with: post", "moves_with: past", "no member 'past'"),
        ("members: [bar]", "members: [bor]", "no member 'bor'"),
        (", [2 m, 0 m, -1.5 m], [-1 m, 0 m, -1.5 m]]", "]", "clearances"),
        ("[2 m, 0 m, -1.5 m], [-1 m, 0 m, -1.5 m]]", "[3 m, 0 m, -2 m]]", "no area"),
        ("[2 m, 0 m, -1.5 m], [-1 m", "[2 m, 1 m, -1.5 m], [-1 m", "in one plane"),
    ):
        with pytest.raises(InputError, match=expected):
            loads(SWINGING.replace(old, new))


def test_shells_measure_the_same_clearance():
    short = SWINGING.replace("duration: 0.4 s", "duration: 40 ms, shell: {element_size: 40 mm}")
    shells = solve(loads(short.replace("every: 10 ms", "every: 2 ms")), "shell")
    assert shells.output_names == (*shells.output_names[:-1], "below")
    tip = shells["node.tip.displacement.z"]
    assert tip[-1] < -5e-3
    np.testing.assert_allclose(shells["below"], 1.5 + tip - 0.02, atol=1e-4)
