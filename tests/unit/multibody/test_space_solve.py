"""Structures in space: which kernel, joints, forces, obstacles, stages, the collapse log."""

import math

import numpy as np
import pytest
from tests.support.multibody.frames import CLAMP, LAW, member, structure

from crumple.errors import InputError
from crumple.multibody import Run, solve_multibody, solver_of
from crumple.multibody.answer.solved import HingeHistory
from crumple.multibody.checks.collapse import changed_capacities, collapse_log, not_unique, scaled_hinge
from crumple.multibody.spatial.solver import SpatialSolver
from crumple.structure import MultibodySettings, Outputs, Stage, placed_hinges
from crumple.structure.hinges.elastic_members import with_elastic_members

G = 9.81
BAR = {"ab": member("a", "b")}
PUSH = {"table": {"time": (0.0, 1.0), "value": (0.0, -0.05)}}


def pendulum(**joint):
    """Bar along x from a clamped node, let go under gravity."""
    given = {"j": {"node": "a", "member": "ab", **joint}}
    return structure(members=BAR, joints=given, gravity=(0.0, 0.0, -G))


def kernel(whole, **run):
    result = solve_multibody(whole, Run(1e-3, 1e-3, **run))
    assert result.status.ok
    return result.provenance.settings["kernel"]


def test_the_tree_kernel_serves_what_stays_in_a_plane():
    thrown = [{"rotation": 5.0, "axis": (0.0, 1.0, 0.0)}]
    assert kernel(structure(initial_velocity=thrown)) == "tree"
    assert (
        kernel(structure(initial_velocity=thrown), settings=MultibodySettings(kernel="spatial")) == "spatial"
    )
    # a clamp carries what leads across; nothing does where the structure floats
    across = [{"translation": (0.0, 1.0, 1.0)}]
    assert kernel(structure(initial_velocity=across)) == "tree"
    loose = {"ab": member("a", "b", ("h", 0.5))}
    assert kernel(structure(members=loose, initial_velocity=across, supports={})) == "spatial"


def test_a_support_that_leans_to_the_plane_needs_the_spatial_kernel():
    nodes = {"a": (0, 0, 0), "b": (0.6, 0.8, 0)}
    members = {"ab": member("a", "b", ("h", 0.3, {"axis": "y"}))}
    held = {"clamp": {"node": "a", "fix": "all"}, "roller": {"node": "b", "fix": ("x",)}}
    assert kernel(structure(nodes, members, supports=CLAMP)) == "tree"
    assert kernel(structure(nodes, members, supports=held)) == "spatial"
    assert (
        kernel(structure(nodes, members, supports=held | {"roller": {"node": "b", "fix": ("z",)}})) == "tree"
    )


def test_joints_and_axes_that_are_not_parallel_need_the_spatial_kernel():
    assert kernel(pendulum(type="spherical")) == "spatial"
    crossed = {"ab": member("a", "b", ("h", 0.3, {"axis": "y"}), ("i", 0.6, {"axis": "z"}))}
    assert kernel(structure(members=crossed)) == "spatial"
    with pytest.raises(InputError, match="different axes"):
        solve_multibody(structure(members=crossed), Run(1e-3, 1e-3, MultibodySettings(kernel="tree")))


@pytest.mark.parametrize(
    "joint", [{"type": "revolute", "axis": (0, 1, 0)}, {"type": "spherical"},
              {"type": "universal", "axis": (0, 1, 0), "second": (0, 0, 1)}]
)  # fmt: skip
def test_a_released_bar_hangs_on_its_joint_with_a_quarter_of_its_weight(joint):
    # thin bar of mass m let go level: force at the pin m g (1 - 3/4 / (1 + 3 r^2/L^2))
    whole = pendulum(**joint)
    result = solve_multibody(whole, Run(1e-3, 1e-3))
    section = whole.section_of("ab")
    mass = section.mass_per_length(7850.0)
    gyration = section.second_moment("y") / section.area
    expected = mass * G * (1.0 - 0.75 / (1.0 + 3.0 * gyration))
    assert result["joint.j.force.z"][-1] == pytest.approx(expected, rel=1e-4)
    assert result["support.clamp.force.z"][-1] == pytest.approx(-expected, rel=1e-4)
    assert abs(result["joint.j.moment.y"][-1]) < 1e-6 * expected


def test_moment_in_a_released_bar_follows_from_its_inertia():
    # M(x) = m g x (1 - x/L)^2 / 4 at x from the pin, stretching the lower side: about -y
    outputs = Outputs(section_forces={"third": {"member": "ab", "at": 1.0 / 3.0}})
    whole = pendulum(type="revolute", axis=(0, 1, 0))
    result = solve_multibody(whole, Run(1e-3, 1e-3, outputs=outputs))
    mass = whole.section_of("ab").mass_per_length(7850.0)
    assert abs(result["third.moment.y"][-1]) == pytest.approx(mass * G / 27.0, rel=2e-3)
    assert abs(result["third.force.x"][-1]) < 1e-3 * mass * G
    share = result["third.use"][-1]
    assert 0.0 < share < 0.01


@pytest.mark.parametrize("place", [0.2, 0.7, 0.975])
def test_the_moment_near_a_free_end_is_as_good_as_elsewhere(place):
    """Of a swinging bar of unit length: weight of the part beyond, less the change of its angular momentum.

    Forces are those of the middle of the last step, a quarter of an output interval earlier at most.
    """
    whole = pendulum(type="revolute", axis=(0, 1, 0))
    section = whole.section_of("ab")
    mass, gyration = section.mass_per_length(7850.0), section.second_moment("y") / section.area
    outputs = Outputs(nodes=["b"], section_forces={"cut": {"member": "ab", "at": place}})
    result = solve_multibody(whole, Run(0.4, 1e-3, outputs=outputs))
    across = G * (1.0 + result["node.b.displacement.x"])
    turning = across / 2.0 / (1.0 / 3.0 + gyration)
    beyond = 1.0 - place
    reach = beyond**2 / 12.0 + gyration + (place + beyond / 2.0) * beyond / 2.0
    expected = mass * beyond * (across * beyond / 2.0 - turning * reach)
    # closed: 2 rad/s at most for a quarter of a millisecond
    error = np.abs(np.abs(result["cut.moment.y"]) - np.abs(expected))
    assert error.max() < 1e-3 * np.abs(expected).max()


def test_a_section_between_rigid_nodes_is_refused():
    nodes = {"a": (0, 0, 0), "b": (1, 0, 0), "c": (2, 0, 0)}
    members = {"ab": member("a", "b", ("h", 0.5)), "bc": member("b", "c")}
    outputs = Outputs(section_forces={"f": {"member": "bc", "at": 0.5}})
    with pytest.raises(InputError, match="forces in this section are not determined"):
        solve_multibody(structure(nodes, members), Run(1e-3, 1e-3, outputs=outputs))


def test_a_mass_on_a_guide_is_stopped_by_a_hinge():
    ram = {"type": "sphere", "point": (0.9, 0.0, 0.2), "radius": 0.1, "mass": 30.0, "velocity": (0, 0, -6.0)}
    result = solve_multibody(structure(obstacles={"ram": ram}), Run(0.1, 2e-3))
    assert result.status.ok
    speed = result["obstacle.ram.velocity.z"]
    assert speed[0] == -6.0
    assert -5.0 < speed[-1] < 0.0
    # what the ram loses the hinge, the bar and the impact have
    assert np.abs(result["energy.residual"]).max() < 1e-3 * 30.0 * 36.0 / 2.0
    assert result["obstacle.ram.force.z"].max() > 0.0
    assert result["hinge.h.energy"][-1] > 100.0


def test_stages_follow_each_other_on_the_same_structure():
    driven = {"motion": {"z": {"table": {"time": (0.0, 1.0), "value": (0.0, -0.5)}}}}
    ram = {"type": "sphere", "point": (0.9, 0.0, 0.2), "radius": 0.1} | driven
    stages = (
        Stage(name="push", kind="quasi-static", duration=1.0, until=[{"displacement": 0.3, "of": "ram"}]),
        Stage(name="rest", duration=0.05, drive=()),
    )
    outputs = Outputs(distances={"sag": {"from": "a", "to": "b"}})
    result = solve_multibody(
        structure(obstacles={"ram": ram}), Run(1.05, 0.02, outputs=outputs, stages=stages)
    )
    assert result.status.ok
    push, rest = result.stages
    assert (push.name, push.ended_by) == ("push", "displacement of ram reached 300 mm")
    assert push.end == pytest.approx(0.6, rel=1e-6)
    assert (rest.start, rest.end) == (push.end, pytest.approx(0.65))
    # quasi-static: the moment is the hinge's, 500 N m, over the arm to the ram
    force = result["obstacle.ram.force.z"]
    pushing = (result.time > 0.3) & (result.time < 0.6)
    assert np.all((force[pushing] > 500.0 / 0.95) & (force[pushing] < 500.0 / 0.8))
    # once halted nothing moves any more
    end = result["hinge.h.rotation"]
    assert end[-1] == pytest.approx(end[np.searchsorted(result.time, push.end)], abs=1e-4)


def test_energies_of_members_are_those_of_their_hinges():
    result = solve_multibody(
        structure(initial_velocity=[{"rotation": 10.0, "axis": (0, 1, 0)}]), Run(0.05, 1e-3)
    )
    np.testing.assert_array_equal(result["member.bar.energy"], result["hinge.h.energy"])


def history(hinge, *plastic):
    values = np.array(plastic, float)
    return HingeHistory(hinge, {"plastic_rotation": values}, float(np.abs(values).max()), 1.0, None, 2.0)


def hinges():
    members = {"bar": member("a", "b", ("h", 0.2), ("i", 0.4), ("k", 0.6))}
    return placed_hinges(structure(members=members))


def test_collapse_log_orders_what_passed_the_threshold():
    h, i, k = hinges()
    runs = [history(h, 0.0, 0.0, -0.2), history(i, 0.0, 0.1, 0.4), history(k, 0.0, 1e-4, 1e-4)]
    log, threshold = collapse_log(runs, np.array([0.0, 1.0, 2.0]))
    assert threshold == pytest.approx(0.004)
    assert [opening.hinge for opening in log] == ["i", "h"]
    assert log[0].time == pytest.approx(0.04)
    assert log[1].time == pytest.approx(1.02)
    assert log[1].rotation == -0.2
    for still in (0.0, 1e-7, 4e-4):
        log, threshold = collapse_log([history(h, 0.0, still)], np.array([0.0, 1.0]))
        assert (log, threshold) == ((), math.radians(0.5))
    assert len(collapse_log([history(h, 0.0, 6e-4)], np.array([0.0, 1.0]))[0]) == 1


def test_a_mechanism_that_a_small_change_moves_elsewhere_is_named():
    h, i, k = hinges()
    base = [history(h, 0.4), history(i, 0.3), history(k, 0.0)]
    assert not_unique([base, [history(h, 0.41), history(i, 0.28), history(k, 0.01)]]) is None
    text = not_unique([base, [history(h, 0.4), history(i, 0.0), history(k, 0.3)]])
    assert text == "The mechanism is not unique. With capacities changed by 1 %: k opens instead of i."


def test_rotations_of_next_to_nothing_are_no_mechanism():
    """Boxes that are only crushed turn by 1e-7, and at which end is chance."""
    h, i, _ = hinges()
    for size, unique in ((1e-17, True), (1e-7, True), (1e-4, True), (2e-4, False)):
        runs = [
            [history(h, 2 * size), history(i, 0.1 * size)],
            [history(h, 0.3 * size), history(i, 4 * size)],
        ]
        assert (not_unique(runs) is None) == unique


def test_equal_hinges_at_a_corner_make_a_mechanism_that_is_not_unique():
    nodes = {"a": (0, 0, 0), "b": (0, 0, 1), "c": (1, 0, 1)}
    members = {name: member(*name) | {"up": (0.0, 1.0, 0.0)} for name in ("ab", "bc")}
    table = {"type": "table", "rotation": (0.0, 0.5), "moment": (1000.0, 300.0)}
    frame = structure(
        nodes,
        members,
        hinges={"law": table},
        masses={"m": {"node": "c", "mass": 10.0}},
        initial_velocity=[{"translation": (-3.0, 0.0, -6.0), "nodes": ("c",)}],
    )
    result = solve_multibody(frame, Run(0.05, 1e-3))
    assert any(text.startswith("The mechanism is not unique") for text in result.warnings)
    assert "bc-b" in {opening.hinge for opening in result.collapse}
    quiet = solve_multibody(frame, Run(0.05, 1e-3, MultibodySettings(mechanism_check="off")))
    assert not any("not unique" in text for text in quiet.warnings)


def test_candidates_that_stay_closed_change_nothing():
    thrown = [{"rotation": 10.0, "axis": (0, 1, 0)}]
    one = {"bar": member("a", "b", ("bar-a", "a"))}
    strong = {"law": LAW, "spacing": 0.25}
    payload = {"m": {"node": "b", "mass": 6.0}}
    rigid = Run(0.05, 1e-3, settings=MultibodySettings(members="rigid"))
    single = solve_multibody(structure(members=one, initial_velocity=thrown, masses=payload), rigid)
    many = structure(members=BAR, hinges=strong, initial_velocity=thrown, masses=payload)
    many = many.model_copy(update={"members": {"bar": many.members["ab"]}})
    result = solve_multibody(many, rigid)
    assert len(result.hinges) > 2
    # bent at the clamp alone: the others stay far below their capacity
    assert result.hinges["bar-a"].rotation_final == pytest.approx(
        single.hinges["bar-a"].rotation_final, rel=1e-4
    )


def test_a_solver_with_other_laws_at_the_same_places_is_that_of_a_structure_with_these():
    across = {"axis": None, "axes": ("y", "z")}
    members = {"ab": member("a", "b", ("h", 0.3, across), ("i", 0.6, across))}
    thrown = [{"rotation": 5.0, "axis": (0.0, 1.0, 1.0)}]
    whole = structure(members=members, initial_velocity=thrown)
    run = Run(0.02, 0.02)
    first = solver_of(whole, run)
    for hinges in changed_capacities(placed_hinges(whole)):
        shared = first.with_hinges(hinges).run(1e-3, None, ends_only=True)
        anew = SpatialSolver(whole, run, hinges).run(1e-3, None, ends_only=True)
        assert [h.rotation_max for h in shared.hinges] == [h.rotation_max for h in anew.hinges]
        assert shared.hinges[0].hinge is hinges[0]
    assert first.run(1e-3, None, ends_only=True).hinges[0].hinge is first.hinges[0]


def test_a_run_with_other_laws_takes_the_steps_of_the_first_one_and_is_as_accurate():
    across = {"axis": None, "axes": ("y", "z")}
    members = {"ab": member("a", "b", ("h", 0.2, across), ("i", 0.5, across), ("j", 0.8, across))}
    whole = structure(members=members, initial_velocity=[{"rotation": 12.0, "axis": (0.0, 1.0, 0.7)}])
    solver = solver_of(whole, Run(0.05, 0.05))
    leader = solver.run(1e-3, None, ends_only=True)
    for hinges in changed_capacities(placed_hinges(whole)):
        guided, alone = solver.with_hinges(hinges), SpatialSolver(whole, Run(0.05, 0.05), hinges)
        found, own, exact = (
            each.run(accuracy, None, ends_only=True)
            for each, accuracy in ((guided, 1e-3), (alone, 1e-3), (alone, 1e-5))
        )
        assert found.steps == leader.steps
        assert found.rejected < own.rejected
        assert found.solves < 0.7 * own.solves
        rotations = np.array([[h.rotation_max for h in run.hinges] for run in (found, exact)])
        assert np.abs(rotations[0] - rotations[1]).max() < 2e-3 * rotations[1].max()
        assert found.residual < 1e-4


@pytest.mark.parametrize("axis", [(0.0, 1.0, 0.7), (0.0, 0.2, 1.0), (0.3, 1.0, 0.0)])
def test_the_run_that_estimates_the_error_takes_pairs_of_steps_as_one(axis):
    across = {"axis": None, "axes": ("y", "z")}
    members = {"ab": member("a", "b", ("h", 0.2, across), ("i", 0.5, across), ("j", 0.8, across))}
    whole = structure(members=members, initial_velocity=[{"rotation": 12.0, "axis": axis}])
    run = Run(0.05, 0.05)
    solver = solver_of(whole, run)
    result = solver.run(2.5e-4, None)
    rough = solver.run(1e-3, None, ends_only=True)
    alone, exact = (
        SpatialSolver(whole, run, placed_hinges(whole)).run(accuracy, None, ends_only=True)
        for accuracy in (1e-3, 1e-5)
    )
    assert rough.steps < 0.8 * result.steps
    assert rough.solves < 0.6 * alone.solves
    found, coarse, true = (np.array([h.rotation_max for h in r.hinges]) for r in (result, rough, exact))
    assert np.abs(coarse - found).max() > np.abs(true - found).max()
    assert np.abs(coarse - found).max() < 1e-2 * true.max()


def test_where_members_vibrate_the_run_that_estimates_the_error_takes_single_steps():
    """Pairs depart by the phase of the vibration: each was tried, and then solved in halves."""
    nodes = {"a": (0, 0, 0), "b": (0, 0, 1), "c": (1, 0, 1), "d": (1, 0.8, 1)}
    members = {name: member(*name) for name in ("ab", "bc", "cd")}
    thrown = [{"translation": (3.0, 2.0, -4.0), "nodes": ("d",)}]
    law, masses = {"type": "constant", "moment": 1000.0}, {"m": {"node": "d", "mass": 10.0}}
    frame = structure(nodes, members, hinges={"law": law}, masses=masses, initial_velocity=thrown)
    run = Run(0.05, 0.05)
    bending = with_elastic_members(frame, run.settings, 0.05)
    solver = solver_of(bending, run)
    result, rough = solver.run(2.5e-4, None), solver.run(1e-3, None, ends_only=True)
    assert rough.solves < 1.3 * result.steps
    found, coarse = (np.array([h.rotation_max for h in r.hinges]) for r in (result, rough))
    exact = solver_of(bending, run).run(2e-5, None, ends_only=True)
    true = np.array([h.rotation_max for h in exact.hinges])
    assert np.abs(true - found).max() < np.abs(coarse - found).max() < 1e-2 * true.max()
    # those who follow take two single steps as one
    changed = next(iter(changed_capacities(placed_hinges(bending))))
    assert solver.with_hinges(changed).run(1e-3, None, ends_only=True).steps < 0.6 * result.steps


def test_a_run_that_departs_from_its_leader_goes_on_by_itself():
    members = {"ab": member("a", "b", ("h", 0.2, {"axis": "y"}), ("i", 0.5, {"axis": "z"}))}
    whole = structure(members=members, initial_velocity=[{"rotation": 8.0, "axis": (0.0, 1.0, 0.7)}])
    solver = solver_of(whole, Run(0.05, 0.05))
    solver.run(1e-3, None, ends_only=True)
    strong = tuple(scaled_hinge(hinge, 3.0) for hinge in placed_hinges(whole))
    found = solver.with_hinges(strong).run(1e-3, None, ends_only=True)
    exact = SpatialSolver(whole, Run(0.05, 0.05), strong).run(1e-5, None, ends_only=True)
    assert found.rejected > 0
    rotations = np.array([[h.rotation_max for h in run.hinges] for run in (found, exact)])
    assert np.abs(rotations[0] - rotations[1]).max() < 4e-3 * rotations[1].max()


@pytest.mark.parametrize(
    ("least", "velocity", "unique"),
    [
        (300.0, (-3.0, 0.0, -6.0), False),
        (900.0, (-3.0, 0.0, -6.0), False),
        (900.0, (-3.0, 0.3, -6.0), False),
        (900.0, (-1.0, 0.5, -8.0), False),
        (900.0, (-1.0, 2.0, -8.0), True),
        (300.0, (-3.0, 1.0, -6.0), True),
        (300.0, (-1.0, 2.0, -8.0), True),
    ],
)
def test_guided_runs_leave_the_mechanism_of_their_leader_where_runs_alone_do(least, velocity, unique):
    nodes = {"a": (0, 0, 0), "b": (0, 0, 1), "c": (1, 0, 1)}
    members = {name: member(*name) | {"up": (0.0, 1.0, 0.0)} for name in ("ab", "bc")}
    table = {"type": "table", "rotation": (0.0, 0.5), "moment": (1000.0, least)}
    thrown = [{"translation": velocity, "nodes": ("c",)}]
    masses = {"m": {"node": "c", "mass": 10.0}}
    frame = structure(nodes, members, hinges={"law": table}, masses=masses, initial_velocity=thrown)
    run = Run(0.05, 0.05)
    solver = SpatialSolver(frame, run, placed_hinges(frame))
    guided, alone = [[solver.run(1e-3, None, ends_only=True).hinges] for _ in range(2)]
    for hinges in changed_capacities(placed_hinges(frame)):
        guided.append(solver.with_hinges(hinges).run(1e-3, None, ends_only=True).hinges)
        alone.append(SpatialSolver(frame, run, hinges).run(1e-3, None, ends_only=True).hinges)
    assert (not_unique(guided) is None) == unique
    assert not_unique(guided) == not_unique(alone)
