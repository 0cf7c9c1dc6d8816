"""Driven supports that rigid parts cannot follow: found, and named where a run ends for this reason."""

import pytest
from tests.support.multibody.frames import member, structure

from crumple.errors import Status
from crumple.multibody import Run, link, notes, solve_multibody
from crumple.multibody.checks.stuck_drives import stuck_drives, with_drives_released
from crumple.structure import MultibodySettings

STUB = {"offset": 0.02}


def driven(freedom, fix, middle=0.0):
    """Beam between a clamp and a driven support, hinged at its ends and in the middle."""
    motion = {freedom: {"step": {"x0": 0.0, "h0": 0.0, "x1": 0.02, "h1": -0.02}}}
    nodes = {"a": (0.0, 0.0, 0.0), "m": (0.5, 0.0, middle), "b": (1.0, 0.0, 0.0)}
    members = {
        "am": member("a", "m", ("h1", "a", STUB), ("h2", "m", STUB)),
        "mb": member("m", "b", ("h3", "b", STUB)),
    }
    supports = {"clamp": {"node": "a", "fix": "all"}, "drive": {"node": "b", "fix": fix, "motion": motion}}
    return structure(nodes, members, supports=supports)


@pytest.mark.parametrize(
    ("freedom", "fix", "middle", "stuck"),
    [
        ("z", ("x", "y"), 0.0, True),  # a straight beam would have to lengthen
        ("z", ("y",), 0.0, False),  # its end slides
        ("x", ("y", "z"), 0.0, True),  # exactly straight it does not know where to bend
        ("x", ("y", "z"), 0.01, False),
    ],
)
def test_what_rigid_parts_cannot_follow(freedom, fix, middle, stuck):
    frame = driven(freedom, fix, middle)
    assert stuck_drives(frame, link(frame)) == ((f"drive {freedom}",) if stuck else ())
    settings = MultibodySettings(mechanism_check="off")
    result = solve_multibody(frame, Run(0.02, 0.01, settings))
    if stuck:
        assert result.status is Status.STEP_COLLAPSED
        assert f"cannot follow the driven motion of drive {freedom}" in result.reason
    else:
        assert result.status is Status.COMPLETE, result.reason
        assert result.energy_residual < 1e-3


def test_a_hinge_that_a_drive_moves_is_not_said_to_be_stuck():
    """A column that a driven end shortens: its slip moves with the drive alone."""
    motion = {"x": {"step": {"x0": 0.0, "h0": 0.0, "x1": 0.02, "h1": -0.02}}}
    drive = {"node": "b", "fix": ("y", "z", "rx", "ry", "rz"), "motion": motion}
    column = structure(
        {"a": (0.0, 0.0, 0.0), "b": (0.5, 0.0, 0.0)},
        {"ab": member("a", "b", ("h", 0.1, {"axis": None, "axes": ("y", "z"), "axial": True}))},
        supports={"clamp": {"node": "a", "fix": "all"}, "drive": drive},
    )
    linkage = link(column)
    assert any("cannot move at the start" in text for text in notes(linkage))
    released = with_drives_released(column, linkage)
    assert not any("cannot move at the start" in text for text in notes(linkage, released))
