"""Running a structure: output times, progress and cancel, statuses, warnings."""

from dataclasses import replace

import numpy as np
import pytest
from tests.support.multibody.frames import CLAMP, LAW, THROWN, X_LINE, member, structure

from crumple.errors import InputError, Status
from crumple.multibody import Run, solve_multibody
from crumple.multibody.planar.solver import TreeSolver
from crumple.multibody.run import output_times
from crumple.structure import MultibodySettings, Outputs

PAYLOAD = {"m": {"node": "b", "mass": 6.0}}
RUN = Run(0.05, 0.005)


def thrown(**keys):
    return structure(initial_velocity=THROWN, masses=PAYLOAD, **keys)


@pytest.mark.parametrize(
    ("duration", "every", "pictures", "expected"),
    [
        (0.1, 0.025, (), (0.0, 0.025, 0.05, 0.075, 0.1)),
        (0.1, 0.04, (), (0.0, 0.04, 0.08, 0.1)),
        (0.1, 0.05, (0.0, 0.02, 0.1), (0.0, 0.02, 0.05, 0.1)),
        (0.1, 0.05, (0.05 + 1e-15, 0.2), (0.0, 0.05, 0.1)),
        (0.1, 1.0, (), (0.0, 0.1)),
    ],
)
def test_output_times(duration, every, pictures, expected):
    times = output_times(Run(duration, every, outputs=Outputs(pictures=pictures)))
    np.testing.assert_allclose(times, expected, rtol=1e-12)


def test_channels_have_the_output_times():
    result = solve_multibody(thrown(), Run(0.05, 0.005, outputs=Outputs(nodes=("b",), pictures=(0.0, 0.021))))
    assert result.status is Status.COMPLETE
    assert all(channel.values.shape == result.time.shape for channel in result.channels.values())
    np.testing.assert_allclose(result.states.times, (0.0, 0.021))
    assert result.states.displacement.shape == (2, *result.states.points.shape)
    np.testing.assert_allclose(result.states.displacement[0], 0.0, atol=1e-15)


def test_energy_channels_balance():
    result = solve_multibody(thrown(gravity=(0.0, 0.0, -9.81)), RUN)
    kinetic, elastic = result["energy.kinetic"], result["energy.elastic"]
    total = kinetic + elastic + result["energy.dissipated"] - result["energy.external_work"]
    np.testing.assert_allclose(total - total[0], result["energy.residual"], atol=1e-12)
    reference = kinetic[0] + np.abs(result["energy.external_work"]).max()
    assert np.abs(result["energy.residual"]).max() <= result.energy_residual * reference * 1.001
    assert result["energy.dissipated"][-1] == pytest.approx(result["hinge.h.energy"][-1])


def test_moment_shown_at_the_start_is_what_the_hinge_will_carry():
    result = solve_multibody(thrown(), RUN)
    assert result["hinge.h.moment"][0] == pytest.approx(500.0)
    assert result["hinge.h.capacity"][0] == pytest.approx(500.0)


@pytest.mark.parametrize(("turned_less", "runs"), [(0.1, 3), (0.001, 2)])
def test_where_a_coarse_run_takes_another_path_a_finer_one_states_the_error(monkeypatch, turned_less, runs):
    accuracies = []
    run = TreeSolver.run

    def coarse_elsewhere(solver, accuracy, *rest, **keys):
        accuracies.append(accuracy)
        found = run(solver, accuracy, *rest, **keys)
        (hinge,) = found.hinges
        if accuracy == RUN.settings.accuracy:
            hinge = replace(hinge, rotation_max=hinge.rotation_max * (1.0 - turned_less))
        return replace(found, hinges=(hinge,))

    monkeypatch.setattr(TreeSolver, "run", coarse_elsewhere)
    hinge = solve_multibody(thrown(), RUN).hinges["h"]
    assert len(accuracies) == runs
    assert accuracies[-1] == RUN.settings.accuracy * (1.0 if runs == 2 else 1.0 / 16.0)
    assert hinge.rotation_error < 0.002 * hinge.rotation_max


def test_progress_runs_from_nothing_to_the_whole():
    shares = []
    solve_multibody(thrown(), Run(0.05, 5e-5), progress=shares.append)
    assert shares == sorted(shares)
    assert shares[0] >= 0.0
    assert shares[-1] <= 1.0


def test_runs_with_changed_capacities_are_part_of_the_progress():
    shares = []
    two = {"bar": member("a", "b", ("h", 0.1), ("i", 0.4))}
    settings = MultibodySettings(mechanism_check="on")
    solve_multibody(thrown(members=two), Run(0.05, 5e-5, settings), progress=shares.append)
    assert shares == sorted(shares)
    assert {0.55, 0.7, 0.85} <= {round(share, 9) for share in shares}


def test_cancel_keeps_what_there_is():
    asked = []

    def cancel():
        asked.append(None)
        return len(asked) > 1

    result = solve_multibody(thrown(), Run(0.05, 1e-6), cancel=cancel)
    assert result.status is Status.CANCELLED
    assert 1 < result.time.size < 50001
    assert all(channel.values.size == result.time.size for channel in result.channels.values())
    assert result.hinges["h"].rotation_max > 0.0
    assert result.states.times.size >= 1


def test_residual_above_its_bound_has_a_status():
    """A coarse run of a fast chain errs by more than a bound of 1e-9."""
    members = {"bar": member("a", "b", ("h", 0.1), bars={"number": 5, "law": LAW})}
    whole = structure(members=members, masses=PAYLOAD, initial_velocity=THROWN)
    settings = MultibodySettings(accuracy=1e-2, energy_residual_bound=1e-9)
    result = solve_multibody(whole, Run(0.05, 0.05, settings))
    assert result.status is Status.RESIDUAL_EXCEEDED
    assert "1.00e-09" in result.reason
    assert result.time[-1] == 0.05


def test_nothing_moves_is_refused():
    members = {"bar": member("a", "b")}
    with pytest.raises(InputError, match="nothing can move"):
        solve_multibody(structure(members=members, supports=CLAMP), RUN)


@pytest.mark.parametrize("freedom", ["x", "y", "z", "rx", "ry", "rz"])
def test_a_rigid_arm_without_hinges_is_driven_in_every_direction(freedom):
    """It is one body: whatever its plane, a support may drive it out of that."""
    step = {"step": {"x0": 0.0, "h0": 0.0, "x1": 0.05, "h1": 0.1}}
    arm = structure(
        members={"bar": member("a", "b")},
        supports={"hub": {"node": "a", "fix": "all", "motion": {freedom: step}}},
    )
    result = solve_multibody(arm, Run(0.05, 0.005, outputs=Outputs(nodes=("b",))))
    assert result.status is Status.COMPLETE
    kind = "rotation" if freedom[0] == "r" else "displacement"
    assert result[f"node.b.{kind}.{freedom[-1]}"][-1] == pytest.approx(0.1, abs=1e-6)


def test_a_drive_out_of_the_plane_is_not_lost_where_another_part_moves_in_it():
    """The first half of a bar is held but driven along y; its hinge about y lets the other half fall."""
    step = {"step": {"x0": 0.0, "h0": 0.0, "x1": 0.05, "h1": 0.1}}
    whole = structure(
        supports={"hub": {"node": "a", "fix": "all", "motion": {"y": step}}}, gravity=(0.0, 0.0, -9.81)
    )
    result = solve_multibody(whole, Run(0.05, 0.005, outputs=Outputs(nodes=("a", "b"))))
    for node in "ab":
        assert result[f"node.{node}.displacement.y"][-1] == pytest.approx(0.1, abs=1e-4)


def test_a_drive_that_a_clamp_holds_is_named():
    step = {"step": {"x0": 0.0, "h0": 0.0, "x1": 0.05, "h1": 0.1}}
    supports = {**CLAMP, "push": {"node": "b", "motion": {"z": step}}}
    with pytest.raises(InputError, match="support push cannot move what others clamp") as refusal:
        solve_multibody(structure(members={"bar": member("a", "b")}, supports=supports), RUN)
    assert "members: elastic" in refusal.value.problems[0].todo


def test_incompatible_initial_motion_is_reported():
    """A translation of a clamped bar with one hinge loses what the hinge cannot follow."""
    velocity = [{"translation": (3.0, 0.0, 3.0)}]
    result = solve_multibody(structure(initial_velocity=velocity, masses=PAYLOAD), RUN)
    assert any("lost" in warning and "does not fit" in warning for warning in result.warnings)
    fits = solve_multibody(thrown(members={"bar": member("a", "b", ("h", "a", {"offset": 0.0}))}), RUN)
    assert not any("does not fit" in warning for warning in fits.warnings)


@pytest.mark.parametrize("nodes", [("a", "b"), ("b", "a")])
@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_rotation_is_that_of_the_second_side_against_the_first(nodes, sense):
    """Thrown about +y the outer side turns by +; with the nodes exchanged local y and the sides change."""
    members = {"bar": member(*nodes, ("h", "a", {"offset": 0.0}))}
    velocity = [{"rotation": sense * 10.0, "axis": (0.0, 1.0, 0.0)}]
    outputs = Outputs(nodes=("b",), section_rotations={"whole": {"member": "bar", "from": 0.0, "to": 1.0}})
    whole = structure(members=members, initial_velocity=velocity, masses=PAYLOAD)
    result = solve_multibody(whole, Run(0.05, 0.005, outputs=outputs))
    assert np.sign(result["hinge.h.rotation"][-1]) == sense
    np.testing.assert_allclose(result["whole"], result["hinge.h.rotation"], atol=1e-12)
    np.testing.assert_allclose(result["node.b.rotation.y"], result["hinge.h.rotation"], atol=1e-12)
    assert np.sign(result["node.b.displacement.z"][-1]) == -sense


def test_floating_part_keeps_flying():
    members = {"bar": member("a", "b", ("h", 0.6))}
    velocity = [{"translation": (2.0, 0.0, 5.0)}]
    whole = structure(X_LINE, members, supports={}, initial_velocity=velocity)
    result = solve_multibody(whole, Run(0.05, 0.005, outputs=Outputs(nodes=("a", "b"))))
    for node in "ab":
        assert result[f"node.{node}.displacement.x"][-1] == pytest.approx(0.1)
        assert result[f"node.{node}.displacement.z"][-1] == pytest.approx(0.25)
    assert result.hinges["h"].rotation_max < 1e-9


def test_rest_under_gravity_is_no_lost_energy():
    """Locked hinges creep by 1e-12 J, of which rounding is a large share: that must not fail the run."""
    members = {"bar": member("a", "b", ("h", 0.3), ("k", 0.7))}
    result = solve_multibody(structure(members=members, gravity=(0.0, 0.0, -9.81)), RUN)
    assert result.status is Status.COMPLETE
    assert result.energy_residual < 1e-6
    assert result.hinges["h"].rotation_max < 1e-9


def test_fall_from_rest_is_balanced_against_the_whole_fall():
    members = {"bar": member("a", "b", ("h", 0.5))}
    supports = {"pin": {"node": "a", "fix": "pin"}}
    whole = structure(members=members, supports=supports, gravity=(0.0, 0.0, -9.81))
    result = solve_multibody(whole, Run(0.2, 0.01, MultibodySettings(energy_residual_bound=1e-4)))
    assert result.status is Status.COMPLETE
    work = np.abs(result["energy.external_work"]).max()
    assert np.abs(result["energy.residual"]).max() <= result.energy_residual * work * 1.001


def test_outputs_closer_than_two_of_the_smallest_steps_are_refused_in_space():
    settings = MultibodySettings(kernel="spatial")
    run = Run(1e-9, 1e-11, settings)
    with pytest.raises(InputError, match="closer together than two of the smallest time steps"):
        solve_multibody(thrown(), run)
