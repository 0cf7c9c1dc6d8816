"""Errors of a result from its difference to another run."""

from dataclasses import replace

import numpy as np
import pytest
from tests.support.multibody import error_cases

from crumple.multibody import solve
from crumple.multibody.answer.stated_errors import MARGIN, with_chance
from crumple.multibody.planar.solver import TreeSolver


def test_a_difference_that_vanishes_by_chance_is_no_error_of_nothing():
    rotations = np.array([0.2, 0.2, 0.1])
    errors = with_chance(np.array([3e-4, 0.0, 1e-4]), rotations)
    common = np.sqrt((0.2 * 9e-8 + 0.1 * 1e-8) / 0.5)
    assert errors == pytest.approx(MARGIN * np.array([3e-4, common, common]))


def test_hinges_at_rest_neither_err_nor_dilute_the_errors_of_others():
    few = with_chance(np.array([3e-4, 0.0]), np.array([0.2, 0.1]))
    many = with_chance(np.array([3e-4, 0.0, *[0.0] * 50]), np.array([0.2, 0.1, *[0.0] * 50]))
    assert many[:2] == pytest.approx(few)
    assert not many[2:].any()


def test_a_hinge_that_hardly_turned_has_no_common_error_above_its_rotation():
    errors = with_chance(np.array([3e-4, 0.0]), np.array([0.2, 1e-6]))
    assert errors[1] == pytest.approx(MARGIN * 1e-6)


def test_nothing_turned_and_no_hinges():
    assert not with_chance(np.zeros(3), np.zeros(3)).any()
    assert with_chance(np.array([1e-12]), np.zeros(1)) == pytest.approx(MARGIN * 1e-12)
    assert with_chance(np.zeros(0), np.zeros(0)).size == 0


def test_the_margin_covers_nine_of_ten_errors_of_chance():
    """Errors of two runs, normal, four times larger in the coarser one."""
    fine, coarse = np.random.default_rng(5).normal(size=(2, 200_000))
    kept = np.mean(np.abs(fine) <= MARGIN * np.abs(4.0 * coarse - fine))
    assert kept == pytest.approx(0.90, abs=0.005)
    angle = np.arctan((1 + 1 / MARGIN) / 4) - np.arctan((1 - 1 / MARGIN) / 4)
    assert kept == pytest.approx(1 - angle / np.pi, abs=0.005)


def test_the_finer_run_at_a_fork_is_finer_than_an_answer_that_was_repeated(monkeypatch):
    """An answer that keeps its energy balance only at a tenth of the accuracy, and a coarse run elsewhere."""
    accuracies = []
    run = TreeSolver.run

    def elsewhere(solver, accuracy, *rest, **keys):
        accuracies.append(accuracy)
        found = run(solver, accuracy, *rest, **keys)
        if keys.get("ends_only") and len(accuracies) == 3:
            turned = [replace(one, rotation_max=2.0 * one.rotation_max) for one in found.hinges]
            found = replace(found, hinges=tuple(turned))
        return replace(found, residual=1.0 if len(accuracies) == 1 else 0.0)

    monkeypatch.setattr(TreeSolver, "run", elsewhere)
    result = error_cases.solved("springy_chain", 1e-3)
    assert result.provenance.settings["accuracy_used"] == pytest.approx(1e-4)
    assert accuracies == pytest.approx([2.5e-4, 2.5e-5, 1e-4, 1e-4 / solve.CHECK_FACTOR**2])


def test_errors_are_stated_of_energies_and_displacements():
    result = error_cases.solved("chain_on_stops", 1e-3)
    for hinge in result.hinges.values():
        assert 0.0 < hinge.energy_error < 0.1 * hinge.energy
        assert hinge.energy_error >= 0.999 * hinge.energy * hinge.rotation_error / hinge.rotation_max
    assert set(result.displacement_errors) == set("oabc")
    assert result.displacement_errors["o"] == 0.0
    assert 0.0 < result.displacement_errors["c"] < 0.01
    without = error_cases.solved("chain_on_stops", 1e-3, checks=False)
    assert not without.displacement_errors
    assert all(hinge.energy_error is None for hinge in without.hinges.values())
