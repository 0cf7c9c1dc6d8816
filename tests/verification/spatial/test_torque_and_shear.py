"""Torque of a hinge whose walls also carry a shear force: a closed form, and shells of tubes with an arm.

A body whose centre lies in a hinge with the torque T, pushed by a force F along y at the height a: the hinge
carries the shear force F, which leaves the share 1 - l F of the torque, so that the body turns about x with

    I w' = F a - T (1 - l F),

and with F along y and z, of a round tube, l sqrt(F_y^2 + F_z^2), else l_y F_y + l_z F_z.

Two equal tubes (320 MPa, no hardening) in line between clamps, with an arm between them that a driven
cylinder pushes across at a height: torque, shear force and bending in both.  Mean force over the third
quarter of the path in shells (elements of 6 mm) and in a model whose torque knows nothing of shear:

    square 50x2.5, 150 mm each, 120 mm high       29.2 kN    37.2 kN
    square 50x2.5, 200 mm each, 200 mm high       18.5 kN    20.3 kN
    round 60x2, 200 mm each, 200 mm high          16.7 kN    19.1 kN

Tolerance 10 %, as for displacements of the comparisons of both methods.

Kind: closed form; independent calculation.  Source: derived here; run here.
"""

import math

import numpy as np
import pytest
from tests.support.multibody.space_models import RX, RY, RZ, component, started

from crumple._core.spatial.model import (
    GROUND,
    Coupling,
    SpatialBody,
    SpatialHinge,
    SpatialLoad,
    SpatialModel,
    SpatialSurface,
    spherical,
)
from crumple.analysis import loads, solve
from crumple.section import PlasticInteraction
from crumple.structure.remembered import forget

TORQUE, FORCE, HEIGHT, INERTIA, END = 400.0, 6000.0, 0.1, 0.05, 0.003
LOSS = (2e-5, 4e-5)
ROWS = SpatialSurface(Coupling.SECTION, np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]), 6.0, 2.0, 0)


def turned(alike, angle, form, loss=LOSS):
    """Turn [rad] of a body that a force in the direction (0, cos, sin) of an angle pushes round x."""
    across = np.array([0.0, math.cos(angle), math.sin(angle)])
    body = SpatialBody(4.0, INERTIA * np.eye(3), np.zeros(3))
    parts = tuple(
        component(freedom, capacity, elastic_stiffness=1e9 if form else math.inf)
        for freedom, capacity in ((RX, TORQUE), (RY, 1e4), (RZ, 1e4))
    )
    hinge = SpatialHinge(0, parts, ROWS, form, shear_loss=loss, round_shear=alike)
    # at the height from the axis at right angles to the force
    point = HEIGHT * np.array([0.0, across[2], -across[1]])
    push = SpatialLoad(0, point, FORCE * across, np.zeros(3), np.array([0.0, END]), np.ones(2))
    model = SpatialModel((body,), (spherical(GROUND, 0, np.zeros(3)),), (hinge,), (push,))
    record = started(model, np.zeros((1, 6))).run(np.array([END]))
    return float(np.ravel(record.hinge.rotation[-1])[0])


@pytest.mark.parametrize("form", [0, 1])
@pytest.mark.parametrize("angle", [0.0, 0.5, 2.2])
def test_what_shear_leaves(angle, form, record_figure):
    parts = np.abs([LOSS[0] * math.cos(angle), LOSS[1] * math.sin(angle)]) * FORCE
    for name, alike, lost in (("walls", False, parts.sum()), ("round", True, math.hypot(*parts))):
        torque = FORCE * HEIGHT - TORQUE * (1.0 - lost)
        # an elastic hinge turns about its yield besides
        expected = torque / INERTIA * END**2 / 2.0
        where = f"{name}, force at {angle:g} rad, {'elastic' if form else 'rigid'}"
        found = turned(alike, angle, form)
        record_figure(f"turn, {where}", found, expected, 2e-2, "rad", relative=True)
    assert turned(False, angle, form, (0.0, 0.0)) < 0.9 * found


INPUT = """crumple: 1
title: Two tubes in line, pushed by an arm between them
materials:
  mild: {{youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: 320 MPa}}
  strong: {{youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: 3 GPa}}
sections:
  tube: {{{section}}}
  arm: {{type: square_tube, side: 20 mm, thickness: 4 mm}}
nodes:
  a: [0 m, 0 m, 0 m]
  b: [{length} m, 0 m, 0 m]
  c: [{double} m, 0 m, 0 m]
  top: [{length} m, 0 m, {top} m]
members:
  first: {{nodes: [a, b], section: tube, material: mild}}
  second: {{nodes: [b, c], section: tube, material: mild}}
  arm: {{nodes: [b, top], section: arm, material: strong}}
hinges: auto
supports:
  a: {{node: a, fix: all}}
  c: {{node: c, fix: all}}
obstacles:
  ram:
    type: cylinder
    point: [{length} m, -60.5 mm, {height} m]
    axis: [1, 0, 0]
    radius: 50 mm
    friction: 0
    dents: false
    motion: {{y: {{havsin: {{x0: 0 ms, h0: 0 mm, x1: 40 ms, h1: {way} m}}}}}}
analysis:
  duration: 40 ms
  multibody: {{mechanism_check: off, members: elastic}}
outputs: {{every: 0.25 ms}}
"""


def test_rigid_bars_take_as_many_steps_as_without_shear(monkeypatch):
    """With what shear leaves at the start of a step in place of its middle they take 4.7 times as many."""
    tube = "type: square_tube, side: 50 mm, thickness: 2.5 mm"
    text = INPUT.format(section=tube, length=0.2, double=0.4, height=0.12, top=0.18, way=0.03)
    steps = []
    for lost in (PlasticInteraction.torque_lost_to_shear, (0.0, 0.0)):
        forget()
        monkeypatch.setattr(PlasticInteraction, "torque_lost_to_shear", lost)
        result = solve(loads(text.replace("members: elastic", "members: rigid")))
        steps.append(result.provenance.settings["steps"])
    forget()
    assert steps[0] < 1.3 * steps[1]


def test_quasi_static_stages_do_not_depend_on_their_duration():
    """Work of the same path in 100 and in 2 ms; followed with the delay of vibration it is 12 % more."""
    tube = "type: square_tube, side: 50 mm, thickness: 2.5 mm"
    text = INPUT.format(section=tube, length=0.15, double=0.3, height=0.12, top=0.18, way=0.0285)
    text = text.replace("members: elastic", "members: rigid")
    works = []
    for duration in ("100 ms", "2 ms"):
        stage = f"stages: [{{name: push, kind: quasi-static, duration: {duration}}}]"
        run = text.replace("duration: 40 ms", stage).replace("x1: 40 ms", f"x1: {duration}")
        works.append(solve(loads(run.replace("every: 0.25 ms", "every: 0.1 ms")))["energy.dissipated"][-1])
    np.testing.assert_allclose(works[1], works[0], rtol=1e-3)


@pytest.mark.parametrize(
    ("section", "length", "height", "shells"),
    [
        ("type: square_tube, side: 50 mm, thickness: 2.5 mm", 0.15, 0.12, 29.23e3),
        ("type: square_tube, side: 50 mm, thickness: 2.5 mm", 0.2, 0.2, 18.51e3),
        ("type: circular_tube, diameter: 60 mm, thickness: 2 mm", 0.2, 0.2, 16.72e3),
    ],
)
def test_shells_of_tubes_with_an_arm(section, length, height, shells, record_figure):
    way = 0.2 * height + 0.03 * length
    text = INPUT.format(
        section=section, length=length, double=2 * length, height=height, top=height + 0.06, way=way
    )
    result = solve(loads(text))
    assert result.status.name == "COMPLETE"
    assert any(
        "Shear forces leave hinges of closed sections less torque" in text for text in result.assumptions
    )
    place = way * np.sin(math.pi / 2 * np.clip(result.time / 0.04, 0.0, 1.0)) ** 2
    force = np.abs(result["obstacle.ram.force.y"])
    work = np.append(0.0, np.cumsum((force[1:] + force[:-1]) / 2.0 * np.diff(place)))
    found = float(np.diff(np.interp([0.5 * way, 0.75 * way], place, work))[0]) / (0.25 * way)
    name = section.partition("_")[0].removeprefix("type: ")
    record_figure(f"{name}, {length:g} m, force", found, shells, 0.1, "N", relative=True)
