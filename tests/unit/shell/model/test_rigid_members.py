"""Members that are rigid, or parts of them: one body in shells, no hinges in either solver."""

from dataclasses import replace

import numpy as np
import pytest
from tests.support.shell.structures import structure

from crumple._core.shell.simulation import ShellState
from crumple.errors import InputError, Status
from crumple.multibody import Run, solve_multibody
from crumple.shell import ShellRun, lower, solve_shell
from crumple.structure import Outputs, ShellSettings, Structure, hinge_places

COARSE = ShellSettings(element_size=24e-3)
DAMPED = ShellSettings(element_size=24e-3, damping=700.0)
"""Near critical for the first bending mode, so that a load put on in 8 ms comes to rest."""
LENGTH = 0.6


def bar(rigid=True, **more) -> Structure:
    """Soft tube from the root to the middle, then a rigid one of the same section to the tip."""
    given = {"supports": {"clamp": {"node": "root", "fix": "all"}}, **more}
    whole = structure(
        {"root": (0, 0, 0), "mid": (LENGTH / 2, 0, 0), "tip": (LENGTH, 0, 0)},
        {"soft": ("root", "mid"), "hard": ("mid", "tip")},
        **given,
    )
    members = {**whole.members, "hard": whole.members["hard"].model_copy(update={"rigid": rigid})}
    return whole.model_copy(update={"members": members})


def meshed_stiffness(given, member):
    """E I of the coarse mesh [N m^2]: one point in the middle of every side."""
    contour = lower(given, COARSE).mesh.tubes[member].contour
    ends = contour.points[contour.sides]
    length = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    return 210e9 * (contour.thickness * length * ends.mean(axis=1)[:, 1] ** 2).sum()


def run(duration=4e-3, every=2e-4, nodes=("mid", "tip"), **more):
    return ShellRun(duration, every, COARSE, Outputs(nodes=nodes), **more)


def test_a_rigid_member_is_one_body_with_the_joint_that_it_reaches():
    case = lower(bar(), COARSE)
    (body,) = case.bodies
    tube = case.mesh.tubes["hard"]
    assert set(tube.nodes.reshape(-1)) <= set(body.nodes)
    state = ShellState(case.model)
    elements = tube.elements_between(0, tube.last_ring)
    sheets = np.asarray(case.model.sheet)
    assert {case.model.materials[case.model.sheets[i].material].rigid for i in sheets[elements]} == {True}
    rest = np.setdiff1d(np.arange(len(sheets)), elements)
    assert {case.model.materials[case.model.sheets[i].material].rigid for i in sheets[rest]} == {False}
    assert state.rigid_sets.shape == (1, 18)


def test_a_free_rigid_bar_flies_like_one():
    """Centre of mass of both halves, spin about it kept; the soft half swings with it."""
    given = structure(
        {"a": (0, 0, 0), "b": (LENGTH, 0, 0), "c": (LENGTH, 0, 0.3)},
        {"one": ("a", "b"), "two": ("b", "c")},
        initial_velocity=[
            {"rotation": 50.0, "axis": (0, 1, 0), "about": (0.2, 0, 0), "translation": (1, 2, 3)}
        ],
    )
    stiff = {name: member.model_copy(update={"rigid": True}) for name, member in given.members.items()}
    with pytest.raises(InputError, match="every element is rigid"):
        solve_shell(given.model_copy(update={"members": stiff}), run(nodes=()))
    one = given.model_copy(update={"members": {**given.members, "one": stiff["one"]}})
    flown = solve_shell(one, run(2e-3, nodes=("a", "b")))
    assert flown.energy_residual < 1e-3
    # the distance of both ends of the rigid member stays, but for the straight lines between steps
    ends = [
        np.array([x, 0, 0]) + np.column_stack([flown[f"node.{n}.displacement.{axis}"] for axis in "xyz"])
        for n, x in (("a", 0.0), ("b", LENGTH))
    ]
    assert np.linalg.norm(ends[1] - ends[0], axis=1) == pytest.approx(LENGTH, rel=2e-6)
    assert flown["node.a.displacement.z"][-1] == pytest.approx(2e-3 * (3 + 50 * 0.2), rel=0.05)


def test_soft_half_bends_as_a_cantilever_under_the_force_at_the_rigid_tip():
    """w = F (L1^3/3 + L1^2 L2 + L1 L2^2) / EI with the moment of F at the joint: the far half is straight."""
    force = 200.0
    ramp = {"step5": {"x0": 0.0, "h0": 0.0, "x1": 8e-3, "h1": force}}
    given = bar(loads=[{"node": "tip", "force": {"z": ramp}}])
    last = solve_shell(given, replace(run(40e-3), settings=DAMPED))
    stiffness = meshed_stiffness(given, "soft")
    half = LENGTH / 2
    wanted = force * (half**3 / 3 + half**2 * half + half * half**2) / stiffness
    assert last["node.tip.displacement.z"][-1] == pytest.approx(wanted, rel=0.02)
    # were both halves soft it would be F L^3 / 3 EI
    assert wanted < 0.9 * force * LENGTH**3 / 3 / stiffness
    assert last["support.clamp.moment.y"][-1] == pytest.approx(-force * LENGTH, rel=0.03)


def test_both_solvers_swing_a_rigid_bar_on_a_pin():
    """Nothing but a rigid member turns about a pin: the angular velocity stays in both."""
    given = structure(
        {"pin": (0, 0, 0), "mid": (0.5, 0, 0), "tip": (0.7, 0, 0)},
        {"hard": ("pin", "mid"), "end": ("mid", "tip")},
        supports={"pin": {"node": "pin", "fix": ["x", "y", "z", "rx", "rz"]}},
        initial_velocity=[{"rotation": 10.0, "axis": (0, -1, 0)}],
    )
    members = {**given.members, "hard": given.members["hard"].model_copy(update={"rigid": True})}
    given = given.model_copy(update={"members": members})
    shell = solve_shell(given, run(4e-3, nodes=("pin", "mid")))
    assert shell.status is Status.COMPLETE
    assert not shell.warnings
    assert shell["node.pin.displacement.z"] == pytest.approx(0.0, abs=1e-12)
    assert shell["node.mid.rotation.y"][-1] == pytest.approx(-0.04, rel=2e-3)
    bars = solve_multibody(given, Run(4e-3, 2e-4, outputs=Outputs(nodes=("pin", "mid"))))
    assert bars["node.mid.rotation.y"][-1] == pytest.approx(-0.04, rel=2e-3)
    assert shell["node.mid.displacement.z"][-1] == pytest.approx(
        bars["node.mid.displacement.z"][-1], rel=2e-3
    )


def test_clamped_rigid_member_stays_and_its_support_takes_the_moment_about_its_node():
    """The rigid half at the clamp: force times the whole length, at the node and not in the part's middle."""
    ramp = {"step5": {"x0": 0.0, "h0": 0.0, "x1": 8e-3, "h1": 150.0}}
    whole = structure(
        {"root": (0, 0, 0), "mid": (0.3, 0, 0), "tip": (LENGTH, 0, 0)},
        {"hard": ("root", "mid"), "soft": ("mid", "tip")},
        supports={"clamp": {"node": "root", "fix": "all"}},
        loads=[{"node": "tip", "force": {"z": ramp}}],
    )
    members = {**whole.members, "hard": whole.members["hard"].model_copy(update={"rigid": True})}
    held = solve_shell(whole.model_copy(update={"members": members}), replace(run(20e-3), settings=DAMPED))
    assert held["node.mid.displacement.z"] == pytest.approx(0.0, abs=1e-15)
    deflection = 150.0 * 0.3**3 / 3 / meshed_stiffness(whole, "soft")
    assert held["node.tip.displacement.z"][-1] == pytest.approx(deflection, rel=0.03)
    # what it exerts on the support: the force up, and turning it against +y
    assert held["support.clamp.force.z"][-1] == pytest.approx(150.0, rel=0.03)
    assert held["support.clamp.moment.y"][-1] == pytest.approx(-150.0 * LENGTH, rel=0.03)


def test_part_of_a_member_is_rigid_and_has_rings_at_its_ends():
    part = [{"from": 0.1, "to": 0.21}, {"from": 0.2, "to": 0.25}]
    case = lower(bar(part), COARSE)
    tube = case.mesh.tubes["hard"]
    (body,) = case.bodies
    stations = tube.stations[np.isin(tube.nodes[:, 0], body.nodes)]
    assert stations[[0, -1]] == pytest.approx([0.1, 0.25], abs=1e-9)
    assert not body.lumps
    moved = solve_shell(bar(part, initial_velocity=[{"rotation": 8.0, "axis": (0, 1, 0)}]), run(1e-3))
    assert moved.status is Status.COMPLETE
    assert any("Member hard is rigid from 100 to 250 mm" in text for text in moved.assumptions)


def test_automatic_hinges_avoid_rigid_parts():
    hinged = bar([{"from": 0.0, "to": 0.2}]).model_copy(update={"hinges": "auto"})
    assert [place.name for place in hinge_places(hinged)] == ["soft-root", "soft-mid"]
    # without rigid parts both members are one tube
    whole = bar(False).model_copy(update={"hinges": "auto"})
    assert [place.name for place in hinge_places(whole)] == ["soft-root"]


def refused(**more):
    with pytest.raises(InputError) as error:
        lower(bar(**more), COARSE)
    return error.value.problems


def test_hinges_in_rigid_parts_and_parts_outside_are_refused():
    hinge = {"name": "fold", "at": 0.15, "law": "kecman"}
    member = bar(False).members["hard"]
    for rigid, fits in (
        (True, False),
        ([{"from": 0.1, "to": 0.2}], False),
        ([{"from": 0.15, "to": 0.2}], True),
    ):
        keys = {"hard": member.model_copy(update={"rigid": rigid, "hinges": [hinge]})}
        if fits:
            bar(False).model_copy(update={"members": {**bar(False).members, **keys}})
            continue
        with pytest.raises(InputError, match="lies in a rigid part of member 'hard'"):
            bar(False).model_copy(update={"members": {**bar(False).members, **keys}})
    (problem,) = refused(rigid=[{"from": 0.1, "to": 0.31}])
    assert problem.where == "members.hard.rigid[0].to"
    (problem,) = refused(rigid=[{"from": 0.1, "to": 0.101}])
    assert problem.what == "a rigid part is shorter than an element"
    with pytest.raises(InputError, match="true, false, or a list of parts"):
        bar("yes")
    with pytest.raises(InputError, match="ends before it begins"):
        bar([{"from": 0.2, "to": 0.1}])


@pytest.mark.parametrize(
    ("supports", "words"),
    [
        ({"one": {"node": "mid", "fix": "pin"}, "two": {"node": "tip", "fix": "pin"}}, "at several nodes"),
        ({"one": {"node": "tip", "fix": ["z"]}}, "in some directions only"),
        ({"one": {"node": "tip", "fix": ["x", "y", "z", "rx", "ry", "rz"]}}, ""),
        ({"one": {"node": "tip", "fix": ["z", "rx", "ry", "rz"]}}, ""),
        ({"one": {"node": "tip", "fix": ["rx"]}}, ""),
    ],
)
def test_supports_of_rigid_members_are_those_that_shells_can_follow(supports, words):
    if words:
        (problem,) = refused(supports=supports)
        assert words in problem.what
        assert problem.where == "supports.one"
    else:
        assert ShellState(lower(bar(supports=supports), COARSE).model).advance(1e-5) is Status.COMPLETE
