"""Spot welds between members in the multibody model: rigid joints where they lie."""

import pytest
from tests.support.multibody.frames import CLAMP, member, structure

from crumple.errors import InputError
from crumple.multibody import Run, solve_multibody

NODES = {"a": (0, 0, 0), "b": (1, 0, 0), "c": (0.8, 0, 0.025), "d": (1.8, 0, 0.025)}
LAP = {"lap": {"members": ("low", "top"), "at": (0.0, 0.0125), "from": 0.82, "to": 0.98, "pitch": 0.04}}


def lapped(*hinges, welds=LAP):
    """A bar on another's end: the first hangs on a clamp by a hinge, the second has others."""
    return structure(
        nodes=NODES,
        members={"low": member("a", "b", ("root", "a", {"offset": 0.0})), "top": member("c", "d", *hinges)},
        supports=CLAMP,
        spot_welds=welds,
        initial_velocity=[{"rotation": 5.0, "axis": (0.0, -1.0, 0.0)}],
    )


def test_welded_bars_turn_as_one():
    result = solve_multibody(lapped(), Run(5e-3, 1e-3))
    turned = result["hinge.root.rotation"]
    assert result.status.ok
    # 500 N m on the inertia of both bars about the root: the weld passes the moment on
    assert any("Spot welds lap join members low and top rigidly" in text for text in result.assumptions)
    section = lapped().section_of("low")
    per_length = section.area * 7850.0
    inertia = per_length * (1.0 / 3 + (1.8**3 - 0.8**3) / 3 + 0.025**2)
    inertia += 2 * 7850.0 * section.second_moment("y")
    assert turned[-1] == pytest.approx(-(5.0 * 5e-3 - 500.0 / inertia * 5e-3**2 / 2), rel=1e-3)


def test_bars_without_the_weld_are_two():
    free = solve_multibody(lapped(("own", "c", {"offset": 0.4}), welds={}), Run(1e-3, 1e-3))
    welded = solve_multibody(lapped(("own", "c", {"offset": 0.4})), Run(1e-3, 1e-3))
    # welded, the hinge of the second bar carries moment; alone it does not turn at all
    assert abs(free["hinge.own.rotation"][-1]) < 1e-12
    assert welded["energy.kinetic"][0] == pytest.approx(free["energy.kinetic"][0], rel=1e-4)
    assert welded["hinge.root.rotation"][-1] != pytest.approx(free["hinge.root.rotation"][-1], rel=1e-3)


def test_a_hinge_between_two_spots_cannot_turn():
    with pytest.raises(InputError, match="rigidly connected elsewhere"):
        solve_multibody(lapped(("own", "c", {"offset": 0.1})), Run(1e-3, 1e-3))


@pytest.mark.parametrize(
    ("point", "member", "away"),
    [
        ((0.9, 0.0, 0.1), "low", "87.5 mm"),
        ((0.5, 0.0, 0.0125), "top", "300 mm"),
        ((0.9, 0.2, 0.0125), "low", "175 mm"),
    ],
)
def test_a_spot_beside_its_members_is_refused(point, member, away):
    welds = {"lap": {"members": ("low", "top"), "points": [(0.85, 0.0, 0.0125), point]}}
    with pytest.raises(InputError, match=f"member '{member}' does not reach the spot") as caught:
        solve_multibody(lapped(welds=welds), Run(1e-3, 1e-3))
    assert caught.value.problems[0].came == f"{away} away"
    assert caught.value.problems[0].where == "spot_welds.lap"
