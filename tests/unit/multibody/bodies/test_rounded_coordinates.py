"""A node that is off its line or plane by rounded coordinates changes no answer by more than it should."""

import pytest
from tests.support.multibody.frames import STEEL

from crumple import Analysis, Status, Structure, solve

SQUARE = {"type": "square_tube", "side": 0.05, "thickness": 0.002}
PLAIN = {"section": "tube", "material": "steel"}


def solved(nodes, members, duration, roll=0.0, **parts):
    structure = Structure(
        materials={"steel": STEEL},
        sections={"tube": SQUARE},
        nodes=nodes,
        members={name: {"nodes": ends, **PLAIN, "roll": roll} for name, ends in members.items()},
        hinges="auto",
        **parts,
    )
    result = solve(
        Analysis(
            structure=structure,
            duration=duration,
            multibody={"members": "rigid", "mechanism_check": "off"},
            outputs={"nodes": list(nodes)},
        ),
        checks=False,
    )
    assert result.status is Status.COMPLETE, result.reason
    return result


def portal(across, roll=0.0):
    """Displacement of a knee of a portal that a pole strikes in its plane: a closed loop of hinges."""
    nodes = {"a": (0.0, 0.0, 0.0), "b": (0.0, 0.0, 0.8), "c": (1.0, across, 0.8), "d": (1.0, 0.0, 0.0)}
    pole = {"type": "cylinder", "point": (-0.08, 0.0, 0.75), "axis": (0.0, 1.0, 0.0), "radius": 0.05}
    result = solved(
        nodes,
        {"one": ("a", "b"), "beam": ("b", "c"), "other": ("d", "c")},
        0.03,
        roll,
        supports={"left": {"node": "a", "fix": "all"}, "right": {"node": "d", "fix": "all"}},
        obstacles={"pole": pole | {"mass": 100.0, "velocity": (4.0, 0.0, 0.0)}},
    )
    return float(result["node.c.displacement.x"][-1])


def struck(aside):
    """Way of a pole into a clamped tube of two members that it strikes at their node."""
    nodes = {"a": (0.0, 0.0, 0.0), "b": (0.55, *aside), "c": (1.1, 0.0, 0.0)}
    pole = {"type": "cylinder", "point": (0.55, 0.0, 0.1), "axis": (0.0, 1.0, 0.0), "radius": 0.05}
    result = solved(
        nodes,
        {"one": ("a", "b"), "other": ("b", "c")},
        0.02,
        supports={"left": {"node": "a", "fix": "all"}, "right": {"node": "c", "fix": "all"}},
        obstacles={"pole": pole | {"mass": 40.0, "velocity": (0.0, 0.0, -5.6)}},
    )
    return float(abs(result["obstacle.pole.displacement.z"]).max())


@pytest.mark.parametrize("across", [1e-7, 1e-6, 1e-5, 1e-4])
def test_a_frame_is_not_locked_by_a_knee_that_is_a_little_out_of_its_plane(across):
    exact = portal(0.0)
    assert exact > 0.02
    assert portal(across) == pytest.approx(exact, rel=1e-3)


@pytest.mark.parametrize(
    "aside", [(1e-6, 0.0), (1e-4, 0.0), (2e-3, 0.0), (0.0, 1e-6), (0.0, 1e-5), (0.0, 1e-4)]
)
def test_a_tube_between_clamps_stretches_although_its_middle_is_a_little_off_the_line(aside):
    assert struck(aside) == pytest.approx(struck((0.0, 0.0)), rel=0.02)


def test_sections_that_are_rolled_a_little_fold_as_square_ones():
    """Hinges about one axis of sections that differ lock the loop: such a portal folds about both."""
    straight = portal(0.0)
    assert straight > 0.02
    for roll in (5e-4, 2e-3, 5e-3):
        assert portal(0.0, roll) == pytest.approx(straight, rel=2e-3)
