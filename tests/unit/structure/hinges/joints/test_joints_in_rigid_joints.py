"""Elastic members do not yield inside the rigid joints at their ends, however short they are."""

import pytest
from tests.support.shell.structures import STEEL

from crumple.multibody.bodies.linkage import link
from crumple.structure import Structure
from crumple.structure.hinges.joint_reach import joint_reach


def arm_on_a_cross_tube(*lengths):
    """Arm of several members in line, from the side of a tube that is wider than a fold of the arm."""
    ends = [sum(lengths[:i]) for i in range(len(lengths) + 1)]
    nodes = {"left": (0, 0.2, 0), "right": (0, -0.2, 0)} | {f"n{i}": (x, 0, 0) for i, x in enumerate(ends)}
    arms = {f"arm{i}": ("arm", f"n{i}", f"n{i + 1}") for i in range(len(lengths))}
    members = {"one": ("cross", "left", "n0"), "two": ("cross", "n0", "right")} | arms
    return Structure(
        materials={"steel": STEEL},
        sections={
            "arm": {"type": "rectangular_tube", "width": 0.03, "depth": 0.05, "thickness": 0.002},
            "cross": {"type": "circular_tube", "diameter": 0.08, "thickness": 0.003},
        },
        nodes=nodes,
        members={
            name: {"nodes": (first, second), "section": section, "material": "steel", "elastic": 6}
            for name, (section, first, second) in members.items()
        },
        hinges="auto",
        supports={side: {"node": side, "fix": "all"} for side in ("left", "right")},
    )


@pytest.mark.parametrize("lengths", [(0.35,), (0.175, 0.175), (0.12, 0.23)])
def test_nothing_yields_between_the_node_and_the_walls_of_the_other_tubes(lengths):
    whole = arm_on_a_cross_tube(*lengths)
    reach = joint_reach(whole, "arm0", "n0")
    hinges = [
        connection.hinge
        for connection in link(whole).connections
        if connection.hinge is not None and connection.hinge.member == "arm0"
    ]
    fold = min(hinge.station for hinge in hinges if hinge.plastic)
    strongest = max(hinge.record.positive.moment.max() for hinge in hinges if hinge.plastic)
    assert reach == pytest.approx(0.04, rel=0.01)
    for hinge in hinges:
        if not hinge.plastic and hinge.station < fold:
            assert hinge.record.positive.moment.max() > 50.0 * strongest, hinge.station
