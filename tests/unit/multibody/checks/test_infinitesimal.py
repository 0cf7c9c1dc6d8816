"""Motions that begin and cannot go on: two bars in one line between two pins, struck in the middle."""

import pytest
from tests.support.structures import TUBE, constant_law
from tests.verification.spatial.test_spatial_lowering import frame
from tests.verification.stages.test_limit_loads import beam, portal

from crumple.errors import Status
from crumple.multibody import Run, infinitesimal, link, solve_multibody

ACROSS = (0, 1, 0)


def two_bars(sag=0.0, slide=False, **parts):
    """Bars of 1 m between pins, hinged in the middle, which hangs lower by a sag."""
    bars = {f"{a}{b}": {"nodes": (a, b), "section": "tube", "material": "steel"} for a, b in ("am", "mb")}
    pin = ("x", "y", "z", "rx", "rz")
    supports = {"left": {"node": "a", "fix": pin}, "right": {"node": "b", "fix": pin[slide:]}}
    joints = {"middle": {"node": "m", "member": "mb", "type": "revolute", "axis": ACROSS}}
    nodes = {"a": (0, 0, 0), "m": (1, 0, -sag), "b": (2, 0, 0)}
    return frame(nodes, bars, TUBE, supports=supports, joints=joints, **parts)


@pytest.mark.parametrize("sag", [0.0, 1e-12])
def test_bars_in_one_line_begin_to_move_and_cannot_go_on(sag):
    assert "begin to move but not go on" in infinitesimal(link(two_bars(sag)))


@pytest.mark.parametrize(
    "structure",
    [two_bars(0.05), two_bars(slide=True), portal(constant_law(1e3))[0], beam(constant_law(1e3))[0]],
    ids=["stiff triangle", "sliding", "portal", "beam that slides"],
)
def test_finite_mechanisms_and_fixed_structures_are_not_reported(structure):
    assert infinitesimal(link(structure)) == ""


def test_an_impulse_on_such_bars_is_lost_and_the_reason_reported():
    """The joints take all of the motion as it begins: nothing moves, no energy is unaccounted for."""
    struck = two_bars(impulses=[{"node": "m", "impulse": (0.0, 0.0, -30.0)}])
    result = solve_multibody(struck, Run(0.01, 0.005))
    assert result.status is Status.COMPLETE
    assert result["energy.kinetic"].max() < 1e-12
    assert any("begin to move but not go on" in warning for warning in result.warnings)
    free = solve_multibody(
        two_bars(slide=True, impulses=[{"node": "m", "impulse": (0.0, 0.0, -30.0)}]), Run(0.01, 0.005)
    )
    assert free.status.ok
    # both bars turn about their pins: inertia mu L^3/3 each, 30 N s at 1 m
    inertia = 2 * 2.8998685 / 3
    assert free["energy.kinetic"][0] == pytest.approx(30.0**2 / (2 * inertia), rel=1e-3)
    assert not any("not go on" in warning for warning in free.warnings)
