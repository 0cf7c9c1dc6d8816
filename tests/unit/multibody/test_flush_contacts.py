"""Contacts with friction that take the load in turns: points of one joint, and both sides of a fold."""

from __future__ import annotations

import pytest

from crumple._core.outcome import Outcome
from crumple.analysis import loads
from crumple.multibody import Run
from crumple.multibody.spatial import solver
from crumple.structure import placed_hinges, with_elastic_members

RAILS = """crumple: 1
materials:
  steel: {youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: 310 MPa}
sections:
  rail: {type: square_tube, side: 45 mm, thickness: 2 mm}
  cross: {type: square_tube, side: 50 mm, thickness: 3 mm}
nodes:
  rear_left: [0 m, 0.25 m, 0 m]
  rear_right: [0 m, -0.25 m, 0 m]
  front_left: [0.45 m, 0.22 m, 0.04 m]
  front_right: [0.45 m, -0.22 m, 0.04 m]
members:
  left: {nodes: [rear_left, front_left], section: rail, material: steel}
  right: {nodes: [rear_right, front_right], section: rail, material: steel}
  front: {nodes: [front_left, front_right], section: cross, material: steel}
  rear: {nodes: [rear_left, rear_right], section: cross, material: steel}
hinges: auto
masses:
  left: {node: rear_left, mass: 90 kg}
  right: {node: rear_right, mass: 90 kg}
initial_velocity: [{translation: [8 m/s, 0 m/s, 0 m/s]}]
obstacles:
  wall: {type: plane, point: [0.482 m, 0.22 m, 0 m], normal: [-0.9976, -0.0698, 0], friction: 0.3}
analysis:
  duration: 25 ms
"""
PORTAL = """crumple: 1
materials:
  steel: {youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: 300 MPa}
sections:
  post: {type: square_tube, side: 40 mm, thickness: 2 mm}
  beam: {type: rectangular_tube, width: 40 mm, depth: 60 mm, thickness: 2.5 mm}
nodes:
  left: [0 m, -0.3 m, 0 m]
  right: [0 m, 0.3 m, 0 m]
  left_top: [0 m, -0.3 m, 0.5 m]
  middle: [0 m, 0 m, 0.5 m]
  right_top: [0 m, 0.3 m, 0.5 m]
members:
  left_post: {nodes: [left, left_top], section: post, material: steel}
  right_post: {nodes: [right, right_top], section: post, material: steel}
  left_beam: {nodes: [left_top, middle], section: beam, material: steel}
  right_beam: {nodes: [middle, right_top], section: beam, material: steel}
hinges: auto
supports: {left: {node: left, fix: all}, right: {node: right, fix: all}}
obstacles:
  plate:
    type: plane
    point: [0 m, 0 m, 0.535 m]
    normal: [0, 0, -1]
    mass: 200 kg
    velocity: [0 m/s, 0 m/s, -5 m/s]
    friction: 0.2
analysis:
  duration: 3 ms
"""

FALLS = """crumple: 1
materials:
  steel: {youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: 300 MPa}
sections:
  low: {type: circular_tube, diameter: 50 mm, thickness: 2 mm}
  high: {type: square_tube, side: 50 mm, thickness: 2 mm}
nodes:
  left: [0 m, 0 m, 0 m]
  left_top: [0 m, 0 m, 0.7 m]
  right_top: [1 m, 0 m, 0.7 m]
  right: [1 m, 0 m, 0 m]
  near: [0.4 m, -0.4 m, 0.79 m]
  far: [0.43 m, 0.5 m, 0.81 m]
members:
  left: {nodes: [left, left_top], section: low, material: steel}
  roof: {nodes: [left_top, right_top], section: low, material: steel}
  right: {nodes: [right, right_top], section: low, material: steel}
  beam: {nodes: [near, far], section: high, material: steel}
hinges: auto
supports: {left: {node: left, fix: all}, right: {node: right, fix: all}}
masses: {near: {node: near, mass: 15 kg}, far: {node: far, mass: 15 kg}}
member_contact: {friction: 0.3}
initial_velocity: [{translation: [0 m/s, 0.5 m/s, -5 m/s], members: [beam]}]
analysis:
  duration: 20 ms
"""


def solved_once(text):
    analysis = loads(text)
    bends = with_elastic_members(analysis.structure, analysis.multibody, analysis.time_in_motion)
    run = Run(analysis.duration, analysis.duration)
    return solver.SpatialSolver(bends, run, placed_hinges(bends)).run(1e-3, None, ends_only=True)


def test_contacts_that_take_turns_do_not_take_all_passes_of_a_step():
    """A plate that lies flat on a beam: before, 150 linear solves a step, since friction never agreed."""
    solved = solved_once(PORTAL)
    assert solved.outcome is Outcome.COMPLETE
    assert solved.solves < 80 * solved.steps
    assert solved.residual < 1e-6


def test_corners_of_a_beam_that_lies_flat_on_a_wall_stay_rigid_contacts(monkeypatch):
    """Eight corners of the front beam and the rails' ends meet the wall, stick, slide and part.

    What a run that cannot go on is repeated with, walls that crush and no corners, is not needed.
    """

    def refuse(*_):
        pytest.fail("the run could not go on with rigid contacts")

    monkeypatch.setattr(solver, "with_crushing", refuse)
    solved = solved_once(RAILS)
    assert solved.outcome is Outcome.COMPLETE
    assert solved.residual < 1e-6


def test_both_sides_of_a_fold_press_together():
    """A beam that falls on a portal: its halves rub over the roof in opposite directions.

    Before, 181 linear solves a step in 441 steps.
    """
    solved = solved_once(FALLS)
    assert solved.outcome is Outcome.COMPLETE
    assert solved.solves < 110 * solved.steps
    assert solved.steps < 250
    assert solved.residual < 1e-6
