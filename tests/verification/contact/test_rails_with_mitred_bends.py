"""S-rails that a wall strikes: bends with the estimate of a mitred corner under axial force, against shells.

Tubes with two bends against a wall (friction 0.1), a mass behind them, elastic members. Shells with 3.4 to
4.5 elements along half a fold: shortening [m], peak and mean force at the wall [N], filtered alike in both.
The constants of the corner were fitted to sub-models of six others; the first three rails were used for an
earlier choice. The first four were solved again when peak forces got zeros before the start of a record in
place of its mirror image, with 4 elements; until then their peaks were 10 to 29 % lower. The last three have
a flight of 10 ms before the wall; two of them were described and solved after all choices. Tolerances:
the targets of docs/theory/comparison.md, 10 % of the shortening and 15 % of both forces. With the law of
before the peak forces of these three were 19, 17 and 0 % off.

Kind: independent calculation.  Source: derived here.
"""

from __future__ import annotations

import math

import numpy as np
import pytest

from crumple.analysis import loads, solve
from crumple.comparison import with_frames
from crumple.comparison.measure.measures import measure

RAIL = """crumple: 1
materials:
  steel: {{youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: {strength} MPa}}
sections:
  rail: {{type: rectangular_tube, width: {width} mm, depth: {depth} mm, thickness: {wall} mm}}
nodes:
  front: [0 m, 0 m, 0 m]
  lower_bend: [{bend} m, 0 m, 0 m]
  upper_bend: [{top} m, 0 m, {rise} m]
  rear: [{end} m, 0 m, {rise} m]
members:
  front: {{nodes: [front, lower_bend], section: rail, material: steel}}
  middle: {{nodes: [lower_bend, upper_bend], section: rail, material: steel}}
  rear: {{nodes: [upper_bend, rear], section: rail, material: steel}}
hinges: auto
supports: {{sled: {{node: rear, fix: [y, z, rx, ry, rz]}}}}
masses: {{sled: {{node: rear, mass: {mass} kg}}}}
obstacles: {{wall: {{type: plane, point: [-{gap} mm, 0 m, 0 m], normal: [1, 0, 0], friction: 0.1}}}}
initial_velocity: [{{translation: [-{speed} m/s, 0 m/s, 0 m/s]}}]
analysis: {{duration: {duration} ms, multibody: {{members: elastic, mechanism_check: off}}}}
outputs: {{every: 0.1 ms, distances: {{crush: {{from: front, to: rear}}}}}}
"""
PLACES = {"bend": 0.2, "end": 0.75, "mass": 90, "speed": 6, "gap": 1, "duration": 25}
# strength, section and shape; what shells say
RAILS = {
    "50x50x2, 33 deg": (
        PLACES | {"strength": 280, "width": 50, "depth": 50, "wall": 2, "top": 0.45, "rise": 0.16},
        (0.0618, 13.8e3, 4.61e3),
    ),
    "60x60x2.5, 45 deg": (
        PLACES
        | {"strength": 350, "width": 60, "depth": 60, "wall": 2.5, "top": 0.4, "rise": 0.2}
        | {"end": 0.7, "mass": 150},
        (0.0630, 17.8e3, 8.49e3),
    ),
    "60x40x1.8, 18 deg": (
        PLACES
        | {"strength": 320, "width": 60, "depth": 40, "wall": 1.8, "top": 0.5, "rise": 0.1}
        | {"end": 0.8},
        (0.0627, 18.6e3, 5.89e3),
    ),
    "50x70x2.2, 25 deg, not used": (
        PLACES
        | {"strength": 400, "width": 50, "depth": 70, "wall": 2.2, "bend": 0.25, "top": 0.55}
        | {"rise": 0.14, "end": 0.85, "mass": 200, "speed": 7},
        (0.0728, 35.8e3, 12.09e3),
    ),
    "50x50x1.8, 18 deg, after a flight, not used": (
        {"strength": 280, "width": 50, "depth": 50, "wall": 1.8, "bend": 0.22, "top": 0.5053}
        | {"rise": 0.0927, "end": 0.8053, "mass": 100, "speed": 6, "gap": 60, "duration": 35},
        (0.0654, 20.3e3, 4.38e3),
    ),
    "45x60x1.7, 23 deg, after a flight, not used": (
        {"strength": 250, "width": 45, "depth": 60, "wall": 1.7, "bend": 0.25, "top": 0.4801}
        | {"rise": 0.0977, "end": 0.7801, "mass": 90, "speed": 6, "gap": 60, "duration": 35},
        (0.0686, 16.8e3, 4.06e3),
    ),
    "65x55x2.3, 33 deg, after a flight, not used": (
        {"strength": 380, "width": 65, "depth": 55, "wall": 2.3, "bend": 0.22, "top": 0.4716}
        | {"rise": 0.1634, "end": 0.7716, "mass": 180, "speed": 6.5, "gap": 65, "duration": 35},
        (0.0678, 24.6e3, 6.07e3),
    ),
}
ALLOWED = {"shortening": 0.10, "peak force": 0.15, "mean force": 0.15}


@pytest.mark.parametrize("rail", RAILS)
def test_rail_shortens_and_pushes_as_in_shells(rail, record_figure):
    shape, shells = RAILS[rail]
    analysis = with_frames(loads(RAIL.format(**shape)))
    found = measure(solve(analysis, "multibody", checks=False), analysis.structure)
    values = (found.extents["crush"], found.peak_force["wall"], found.mean_force["wall"])
    for (name, allowed), value, expected in zip(ALLOWED.items(), values, shells, strict=True):
        unit = "m" if name == "shortening" else "N"
        record_figure(f"{name}, {rail}", value, expected, allowed, unit, relative=True)


KINK = """crumple: 1
materials:
  metal: {{youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: {0} MPa}}
sections: {{rail: {{type: square_tube, side: 60 mm, thickness: 2 mm}}}}
nodes: {{front: [0.2 m, 0 m, 0 m], kink: [0.4 m, 0 m, 0 m], rear: [0.82 m, 0 m, {1} m]}}
members: {{{2}}}
hinges: auto
supports: {{sled: {{node: rear, fix: [y, z, rx, ry, rz]}}}}
masses: {{sled: {{node: rear, mass: {3} kg}}}}
obstacles: {{wall: {{type: plane, point: [199 mm, 0 m, 0 m], normal: [1, 0, 0], friction: 0.25}}}}
initial_velocity: [{{translation: [-6 m/s, 0 m/s, 0 m/s]}}]
analysis: {{duration: 30 ms, multibody: {{members: elastic, mechanism_check: off}}}}
outputs: {{every: 0.1 ms, distances: {{crush: {{from: front, to: rear}}}}}}
"""
KINKED = {
    "600 MPa, 12 deg": ((600, 0.089273, 200), (0.1119, 32.2e3)),
    "300 MPa, 15 deg": ((300, 0.112539, 100), (0.1039, 17.2e3)),
}
"""Yield stress, rise and mass; shortening and mean force of shells (4 elements along half a fold)."""
HORN = "horn: {nodes: [front, kink], section: rail, material: metal}"
REAR = "rear: {nodes: [kink, rear], section: rail, material: metal}"


@pytest.mark.parametrize("rail", KINKED)
@pytest.mark.parametrize("order", [(HORN, REAR), (REAR, HORN)], ids=["horn first", "rear first"])
def test_a_corner_with_a_small_kink_shortens_and_then_turns(rail, order, record_figure):
    """Its moment fell with its rotation alone: it shortened straight on, by 52 mm in both.

    Both rails were solved by shells before the change; with it nothing was fitted to them.
    """
    (strength, rise, mass), shells = KINKED[rail]
    analysis = with_frames(loads(KINK.format(strength, rise, ", ".join(order), mass)))
    found = measure(solve(analysis, "multibody", checks=False), analysis.structure)
    where = f"{rail}, {order[0].split(':')[0]} first"
    for name, value, expected, unit, allowed in (
        ("shortening", found.extents["crush"], shells[0], "m", 0.10),
        ("mean force", found.mean_force["wall"], shells[1], "N", 0.15),
    ):
        record_figure(f"{name}, {where}", value, expected, allowed, unit, relative=True)
    assert 45.0 < max(math.degrees(float(np.linalg.norm(one))) for one in found.rotations.values()) < 60.0
