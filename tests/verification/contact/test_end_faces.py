"""A free tube that stands on its end face tips about the edge of the face.

A square tube of the side a and the length L, without hinges, stands on a plane; gravity is inclined by the
angle b and friction holds it. It tips if the resultant leaves the face, tan b > a/L. Until then nothing
moves; the tolerance is 0.1 degrees, since the contact is closed within a tolerance of its own. A tipping tube
begins with the angular acceleration m g (L/2 sin b - a/2 cos b)/I about the edge, I = I_c + m (L^2 + a^2)/4,
and goes on as cosh(w t) - 1, w^2 = m g (L/2 cos b + a/2 sin b)/I; within 1 % over the first degree. Tilted by
20 degrees and dropped, it meets the plane with a corner, not with the middle of its face; within one output
of 1 ms.

Kind: closed form.  Source: textbook.
"""

import math

import numpy as np

from crumple.analysis import loads, solve
from crumple.errors import Status

SIDE, LENGTH, WALL, GRAVITY = 0.1, 0.3, 0.004, 9.81
TEXT = """crumple: 1
materials:
  steel: {youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: 350 MPa}
sections: {tube: {type: square_tube, side: 100 mm, thickness: 4 mm}}
nodes: {low: [LOW], high: [HIGH]}
members: {bar: {nodes: [low, high], section: tube, material: steel}}
obstacles:
  floor: {type: plane, point: [0 m, 0 m, 0 m], normal: [0, 0, 1], friction: 1.0}
gravity: [DOWN]
analysis: {duration: TIME}
outputs: {every: 1 ms, nodes: [low, high]}
"""


def solved(low, high, down, time):
    parts = {"LOW": (low, "m"), "HIGH": (high, "m"), "DOWN": (down, "m/s^2")}
    text = TEXT.replace("TIME", f"{1e3 * time:g} ms")
    for key, (vector, unit) in parts.items():
        text = text.replace(key, ", ".join(f"{value:.12g} {unit}" for value in vector))
    result = solve(loads(text))
    assert result.status is Status.COMPLETE, result.reason
    return result


def standing(inclination, time):
    down = (GRAVITY * math.sin(inclination), 0.0, -GRAVITY * math.cos(inclination))
    result = solved((0.0, 0.0, 0.0), (0.0, 0.0, LENGTH), down, time)
    lean = result["node.high.displacement.x"] - result["node.low.displacement.x"]
    return result.time, np.arcsin(lean / LENGTH)


def test_a_tube_stands_while_the_resultant_is_within_its_face(record_figure):
    _, turned = standing(math.atan(0.95 * SIDE / LENGTH), 0.2)
    record_figure("rotation at 95 % of the limit", math.degrees(np.abs(turned).max()), 0.0, 0.1, "deg")


def test_beyond_it_tips_about_the_edge(record_figure):
    inclination = math.atan(1.5 * SIDE / LENGTH)
    time, turned = standing(inclination, 0.1)
    end = int(np.searchsorted(turned, math.radians(1.0)))
    mass = 4.0 * (SIDE - WALL) * WALL * LENGTH * 7850.0
    middle = SIDE - WALL
    about_centre = mass * (LENGTH**2 / 12.0 + (2.0 / 3.0 * middle**2 + 0.5 * WALL**2) / 4.0)
    inertia = about_centre + mass * (LENGTH**2 + SIDE**2) / 4.0
    lever = (LENGTH * math.sin(inclination) - SIDE * math.cos(inclination)) / 2.0
    growth = mass * GRAVITY * (LENGTH * math.cos(inclination) + SIDE * math.sin(inclination)) / 2.0 / inertia
    found = turned[end] * growth / (math.cosh(math.sqrt(growth) * time[end]) - 1.0)
    record_figure(
        "angular acceleration", found, mass * GRAVITY * lever / inertia, 0.01, "rad/s^2", relative=True
    )


def test_a_tilted_tube_meets_a_floor_with_its_corner(record_figure):
    tilt, drop = math.radians(20.0), 0.05
    lowest = SIDE / 2.0 * math.sin(tilt)
    low = (0.0, 0.0, lowest + drop)
    high = (LENGTH * math.sin(tilt), 0.0, low[2] + LENGTH * math.cos(tilt))
    result = solved(low, high, (0.0, 0.0, -GRAVITY), 0.15)
    met = int(np.argmax(np.abs(result["obstacle.floor.force.z"]) > 0.0))
    fallen = GRAVITY * result.time[met] ** 2 / 2.0
    record_figure("fall up to the contact", fallen, drop, GRAVITY * result.time[met] * 1e-3, "m")
