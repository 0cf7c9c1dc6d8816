"""Walls that crush under a contact at a constant force, in closed form.

A mass m that strikes a wall of crush force F at the speed v stops after m v/F, having crushed it by
m v^2/(2 F); all of its energy is dissipated and nothing rebounds.

A plane that presses slowly, by d, along the whole of a bar whose one end a hinge of the moment M holds
crushes the wall there and turns the bar with its other end, at the distance L from the hinge: its depth is d,
the rotation d/L (of second order in it less), and the force F + M/L.

Kind: closed form.  Source: derived here.
"""

from dataclasses import replace

import numpy as np
import pytest
from tests.support.multibody.contact_models import ball_shape, plane, simulation, sphere

from crumple.analysis import loads, solve

MASS, SPEED, FORCE, RADIUS = 2.0, 3.0, 4000.0, 0.1
STOP, DEPTH = MASS * SPEED / FORCE, MASS * SPEED**2 / (2 * FORCE)
GAP = 0.0045


def thrown(accuracy=1e-3, restitution=0.0, friction=0.0, across=0.0, gravity=(0.0, 0.0, 0.0), speed=SPEED):
    """A ball above a plane whose own wall crushes."""
    centre = (0.0, 0.0, RADIUS + GAP)
    return simulation(
        [sphere(centre, RADIUS, MASS)],
        [replace(ball_shape(0, centre, RADIUS), crush_force=FORCE)],
        [plane(restitution=restitution, friction=friction)],
        [[0, 0, 0, across, 0, -speed]],
        gravity,
        accuracy,
    )


@pytest.mark.parametrize("restitution", [0.0, 0.7])
def test_stops_at_the_crush_force(restitution, record_figure):
    run = thrown(restitution=restitution)
    record = run.run(np.array([0.0, GAP / SPEED + STOP / 2, 0.02]))
    ((obstacle, _, capsule, depth),) = run.crushed
    assert (obstacle, capsule) == (0, 0)
    record_figure(f"depth, e = {restitution}", depth, DEPTH, 2e-3, "m")
    half = DEPTH * 0.75
    record_figure(
        f"way after half the time, e = {restitution}", RADIUS - record.centre[1, 0, 2], half, 5e-3, "m"
    )
    record_figure(f"dissipated, e = {restitution}", record.energy.contact[-1], MASS * SPEED**2 / 2, 1e-6, "J")
    assert abs(record.velocity[-1, 0, 5]) < 1e-6
    assert record.residual < 1e-9


@pytest.mark.parametrize("accuracy", [1e-2, 1e-3, 1e-4, 1e-5])
def test_the_error_is_within_the_accuracy(accuracy, record_figure):
    run = thrown(accuracy)
    run.run(np.array([0.0, 0.02]))
    record_figure(f"depth, accuracy {accuracy:g}", run.crushed[0][3], DEPTH, accuracy, "m", relative=True)


def test_a_second_blow_begins_at_the_crushed_wall(record_figure):
    """Thrown up by gravity's reversal it falls again through the gap and the depth of the first blow."""
    gravity = 9.81
    run = thrown(gravity=(0.0, 0.0, -gravity))
    run.run(np.array([0.0, 0.05]))
    first = run.crushed[0][3]
    # at rest on the crushed wall, whose force is far above the weight; then thrown up
    up = 1.0
    run.stage()
    run.set_motion(np.array([[0, 0, 0, 0, 0, up]], float), np.zeros((1, 6)))
    run.run(np.array([0.05, 0.4]))
    # returns with the same speed: work of the crush force less that of the weight
    more = MASS * up**2 / 2 / (FORCE - MASS * gravity)
    record_figure("further depth of a second blow", run.crushed[0][3] - first, more, 5e-3, "m")


def test_friction_acts_with_the_crush_force(record_figure):
    """While the wall crushes, the slip loses mu F t/m (the ball does not spin up within the short time)."""
    mu, across = 0.2, 5.0
    run = thrown(friction=mu, across=across)
    record = run.run(np.array([0.0, 0.02]))
    lost = across - record.velocity[-1, 0, 3]
    record_figure("speed lost to friction", lost, mu * FORCE * STOP / MASS, 2e-3, "m/s")


HELD = """crumple: 1
materials:
  steel: {youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: 300 MPa}
sections: {tube: {type: square_tube, side: 50 mm, thickness: 2 mm}}
nodes: {root: [0 m, 0 m, 0 m], tip: [0 m, 0 m, 1 m]}
members:
  post:
    nodes: [root, tip]
    section: tube
    material: steel
    hinges:
    - name: h
      at: root
      offset: 200 mm
      law: {type: table, rotation: [0 deg, 60 deg], moment: [2 kN m, 2 kN m]}
supports: {clamp: {node: root, fix: all}}
obstacles:
  ram: {type: plane, point: [-40 mm, 0 m, 0 m], normal: [1, 0, 0], motion: {x: {table: TABLE}}}
analysis: {stages: [{name: push, kind: quasi-static, duration: 0.5 s}]}
outputs: {every: 10 ms}
"""


def test_a_plane_crushes_the_held_end_of_a_bar_and_turns_it_with_the_other(record_figure):
    """With one depth for the whole bar the plane never reached its other end, in 109 036 steps."""
    pressed, lever = 0.1 * 0.5 - 0.015, 0.8 - 0.025
    table = "{time: [0 s, 1 s], value: [0 m, 100 mm]}"
    result = solve(loads(HELD.replace("TABLE", table)), checks=False)
    assert result.status.ok, result.reason
    assert result.provenance.settings["steps"] < 500
    (crushed,) = (caution for caution in result.cautions if caution.code == "crushed_contact")
    record_figure("depth at the held end", crushed.value, pressed, 1e-5, "m")
    record_figure(
        "rotation of the bar", -result["hinge.h.rotation"][-1], pressed / lever, 3e-3, relative=True
    )
    squash = 300e6 * 4 * 0.048 * 0.002
    force = -result["obstacle.ram.force.x"][-1]
    record_figure("force of the plane", force, squash + 2e3 / lever, 2e-3, "N", relative=True)
