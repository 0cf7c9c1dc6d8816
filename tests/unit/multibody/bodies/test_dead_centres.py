"""Dead centres at the start: beams over pins, clamped bars with a stem, and what only looks like them."""

import numpy as np
import pytest
from tests.support.multibody.frames import member, structure

from crumple.errors import Status
from crumple.multibody import Run, dead_centres, link, solve_multibody
from crumple.structure import MultibodySettings

SETTINGS = MultibodySettings(mechanism_check="off")


def at(parts):
    """Names and freedoms at dead centres."""
    linkage = link(parts)
    return {(linkage.connections[i].name, freedom) for i, freedom in dead_centres(linkage).held}


def overhang(fix="pin", spans=1):
    """Beam clamped at its left end, over supports, with an overhang that carries a mass."""
    nodes = {f"n{i}": (0.8 * i, 0.0, 0.0) for i in range(spans + 2)}
    pairs = [(f"n{i}", f"n{i + 1}") for i in range(spans + 1)]
    members = {
        f"b{i}": member(*pair, (f"h{i}l", pair[0], {"offset": 0.02}), (f"h{i}r", pair[1], {"offset": 0.02}))
        for i, pair in enumerate(pairs)
    }
    last = f"n{spans + 1}"
    members[f"b{spans}"]["hinges"].pop()
    supports = {"clamp": {"node": "n0", "fix": "all"}}
    supports |= {f"at{i}": {"node": f"n{i}", "fix": fix} for i in range(1, spans + 1)}
    return structure(
        nodes,
        members,
        supports=supports,
        masses={"load": {"node": last, "mass": 15.0}},
        initial_velocity=[{"translation": (0.0, 0.0, 8.0), "nodes": (last,)}],
    )


def test_only_the_overhang_moves():
    # the spans can begin to bend, but their ends cannot come nearer
    held = {f"h{i}{side}" for i in range(3) for side in "lr"}
    assert {name for name, _ in at(overhang(spans=3))} == held
    assert at(overhang(("y", "z"))) == set()


def test_an_overhang_beyond_a_pin_moves_as_beyond_a_roller():
    pinned, rolling = (
        solve_multibody(overhang(fix), Run(0.05, 0.005, SETTINGS)) for fix in ("pin", ("y", "z"))
    )
    assert pinned.status is Status.COMPLETE
    assert pinned.energy_residual < 1e-3
    # on the roller the span bends a little, too
    turned = [result.hinges["h1l"].rotation_max for result in (pinned, rolling)]
    assert turned[0] == pytest.approx(turned[1], rel=1e-2)
    # at the pin the span carries what the overhang's hinge gives
    assert np.abs(pinned["hinge.h0r.moment"]).max() == pytest.approx(500.0, rel=1e-9)


def test_a_stem_on_a_clamped_bar_turns_alone():
    nodes = {"a": (-0.4, 0.0, 0.0), "o": (0.0, 0.0, 0.0), "b": (0.4, 0.0, 0.0), "c": (0.0, 0.0, 0.6)}
    stub = {"offset": 0.02}
    members = {
        "left": member("a", "o", ("l1", "a", stub), ("l2", "o", stub)),
        "right": member("o", "b", ("r1", "o", stub), ("r2", "b", stub)),
        "stem": member("o", "c", ("s", "o", stub)),
    }
    frame = structure(
        nodes,
        members,
        supports={name: {"node": name, "fix": "all"} for name in "ab"},
        masses={"tip": {"node": "c", "mass": 15.0}},
        initial_velocity=[{"translation": (8.0, 0.0, 0.0), "nodes": ("c",)}],
    )
    assert {name for name, _ in at(frame)} == {"l1", "l2", "r1", "r2"}
    result = solve_multibody(frame, Run(0.06, 0.01, SETTINGS))
    assert result.status is Status.COMPLETE
    assert result.hinges["s"].rotation_max > 0.3
    assert result.hinges["l1"].rotation_max < 1e-12


@pytest.mark.parametrize("rise", [0.0, 0.05, 0.4])
def test_two_members_side_by_side_can_bend_together(rise):
    """Of equal length between the same nodes both fold: the forms of their loop are indefinite."""
    nodes = {"a": (0.0, 0.0, 0.0), "m": (0.5, 0.0, rise), "n": (0.5, 0.0, -rise), "b": (1.0, 0.0, 0.0)}
    pairs = {"am": ("a", "m"), "mb": ("m", "b"), "an": ("a", "n"), "nb": ("n", "b")}
    if rise == 0.0:
        nodes["n"] = (0.4, 0.0, 0.0)
    members = {
        name: member(
            *pair, (f"h-{name}", pair[0], {"offset": 0.01}), (f"g-{name}", pair[1], {"offset": 0.01})
        )
        for name, pair in pairs.items()
    }
    frame = structure(nodes, members, supports={"clamp": {"node": "a", "fix": "all"}})
    assert at(frame) == set()


def test_a_slot_across_a_straight_beam_lets_it_not_bend():
    """The slot stays with the ground while the beam's end turns in it: the beam would have to lengthen."""
    nodes = {"a": (0.0, 0.0, 0.0), "m": (0.5, 0.0, 0.0), "b": (1.0, 0.0, 0.0)}
    stub = {"offset": 0.02}
    members = {
        "am": member("a", "m", ("h1", "a", stub), ("h2", "m", stub)),
        "mb": member("m", "b", ("h3", "b", stub)),
    }
    slot = {"clamp": {"node": "a", "fix": "all"}, "slot": {"node": "b", "fix": ("x", "y", "rx", "rz")}}
    frame = structure(nodes, members, supports=slot)
    assert {name for name, _ in at(frame)} == {"h1", "h2", "h3"}
    assert not dead_centres(link(frame)).aside


def test_where_loads_select_no_way_hinges_are_moved_aside():
    """A bar that bends to both sides at once would twist at its guide, which no hinge lets it do."""
    nodes = {name: (0.4 * i, 0.0, 0.0) for i, name in enumerate("abcd")}
    own = {"offset": 0.02, "axes": ["y", "z"], "coupling": "none"}
    frame = structure(
        nodes,
        {
            "ab": member("a", "b", ("h1", "a", own), ("h2", "b", own)),
            "bc": member("b", "c", ("h3", "c", own)),
            "cd": member("c", "d", ("h4", "d", own)),
        },
        supports={
            "clamp": {"node": "a", "fix": "all"},
            "guide": {"node": "d", "fix": ("y", "z", "rx", "ry", "rz")},
        },
        masses={"p": {"node": "b", "mass": 10.0}, "q": {"node": "c", "mass": 10.0}},
        initial_velocity=[
            {"translation": (0.0, 8.0, 0.0), "nodes": ("b",)},
            {"translation": (0.0, 0.0, 8.0), "nodes": ("c",)},
        ],
    )
    assert dead_centres(link(frame)).aside
    result = solve_multibody(frame, Run(0.02, 0.002, SETTINGS))
    assert result.status is Status.COMPLETE
    assert result.energy_residual < 1e-3
    assert any("were moved aside" in warning for warning in result.warnings)
