"""Rails with one bend that a wall strikes, in a plane and in space, and corners that are crushed straight.

Knees. A wall (friction 0.2) strikes a tube with one bend (one of them with two), behind which a mass slides.
Elastic members, hinges in the plane or about both axes, members in either order, against shells with 4
elements along half a fold, solved once by this program: path of the mass and rotation of the first bend. All
were drawn by chance; the first two were looked at while the model was changed, the others were not. Before,
the moments of the members behind the bend did not know of the axial force, corners in space had no slip where
velocities were given at some nodes only, and corners in a plane lost no moment when they shortened: in the
plane the second knee was crushed straight, its bend turned by 1 degree (found: 37.2, in shells 40.4).

Crushed corners. Two pieces of 1.3 sides between a clamp and a guide that moves one towards the other: force
over shortening, law over shells. No constant is fitted to it: the law is that of a corner that turns under
compression, at the moment zero.

Kind: independent calculation; invariant.  Source: run here; derived here.
"""

from __future__ import annotations

import math

import numpy as np
import pytest

from crumple.analysis import loads, solve
from crumple.hinge import Freedom
from crumple.structure import placed_hinges, with_elastic_members

METAL = "youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3"
HARD = ", hardening: {type: swift, prestrain: 0.005, exponent: 0.15}"
RAIL = """crumple: 1
materials: {{metal: {{{metal}, yield_stress: {stress} MPa{hard}}}}}
sections:
  rail: {{type: rectangular_tube, width: {tube[0]} mm, depth: {tube[1]} mm, thickness: {tube[2]} mm}}
nodes:
{nodes}
members:
{members}
hinges: {hinges}
supports: {{sled: {{node: n{last}, fix: [y, z, rx, ry, rz]}}}}
masses: {{sled: {{node: n{last}, mass: {mass} kg}}}}
obstacles:
  wall: {{type: plane, point: [-{tube[0]} mm, 0 m, 0 m], normal: [1, 0, 0], friction: 0.2}}
initial_velocity: [{{nodes: [{names}], translation: [-{speed} m/s, 0 m/s, 0 m/s]}}]
analysis: {{duration: 30 ms, multibody: {{members: elastic, mechanism_check: off}}}}
outputs: {{every: 0.5 ms, nodes: [n{last}]}}
"""
# tube [mm], yield stress [MPa], mass [kg] and speed [m/s], nodes behind the front [m]; path of the mass [m]
# and rotation of the first bend [rad] in shells at 30 ms
KNEES = {
    "45x45x2.5, 21 deg": (
        ((45, 45, 2.5), 500, "", 102.42, 6.023, [(0.310109, 0.0), (0.667299, 0.134545)]),
        (0.0980, 0.473),
    ),
    "60x60x1.5, 13 deg": (
        ((60, 60, 1.5), 250, "", 80.64, 5.450, [(0.234770, 0.0), (0.625212, 0.093660)]),
        (0.1337, 0.705),
    ),
    "60x60x1.5, 14 deg, not used": (
        ((60, 60, 1.5), 250, "", 169.64, 7.152, [(0.320360, 0.0), (0.568607, 0.062845)]),
        (0.1969, 1.101),
    ),
    "40x60x1.5, hardens, two of 10 deg, not used": (
        (
            (40, 60, 1.5),
            350,
            HARD,
            91.07,
            6.606,
            [(0.308514, 0.0), (0.596494, 0.048666), (0.883617, 0.048666)],
        ),
        (0.1370, 0.855),
    ),
}


def knee(case, hinges="auto", order=1):
    """Path of the mass [m] and rotation of the first bend [rad] at the end."""
    tube, stress, hard, mass, speed, behind = case
    places = [(0.0, 0.0), *behind]
    members = [
        f"  m{i}: {{nodes: [n{i}, n{i + 1}], section: rail, material: metal}}" for i in range(len(behind))
    ]
    text = RAIL.format(
        metal=METAL,
        stress=stress,
        hard=hard,
        tube=tube,
        nodes="\n".join(f"  n{i}: [{x} m, 0 m, {z} m]" for i, (x, z) in enumerate(places)),
        members="\n".join(members[::order]),
        hinges=hinges,
        last=len(behind),
        mass=mass,
        speed=speed,
        names=", ".join(f"n{i}" for i in range(len(places))),
    )
    result = solve(loads(text), "multibody", checks=False)
    assert result.status.ok
    path = abs(float(np.asarray(result[f"node.n{len(behind)}.displacement.x"])[-1]))
    return path, abs(float(np.asarray(result["hinge.corner-n1.rotation"])[-1]))


@pytest.mark.parametrize("name", KNEES)
@pytest.mark.parametrize("hinges", ["auto", "{axes: [y, z]}"], ids=["plane", "space"])
def test_a_struck_knee_turns_as_in_shells(name, hinges, record_figure):
    case, (path, turn) = KNEES[name]
    found = knee(case, hinges)
    where = f"{name}, {'plane' if hinges == 'auto' else 'space'}"
    record_figure(f"path of the mass, {where}", found[0], path, 0.10, "m", relative=True)
    record_figure(f"rotation of the first bend, {where}", found[1], turn, 0.15, "rad", relative=True)


@pytest.mark.parametrize("name", list(KNEES)[2:])
def test_the_order_of_the_members_matters_little(name):
    """The slip of a corner turns with its first member."""
    case, _ = KNEES[name]
    assert knee(case, order=-1) == pytest.approx(knee(case), rel=0.06)


CORNER = """crumple: 1
materials: {{metal: {{{metal}, yield_stress: {stress} MPa}}}}
sections: {{tube: {{type: square_tube, side: {side} mm, thickness: {wall} mm}}}}
nodes: {{a: [-{x:.6f} m, 0 m, -{z:.6f} m], b: [0 m, 0 m, 0 m], c: [{x:.6f} m, 0 m, -{z:.6f} m]}}
members:
  one: {{nodes: [a, b], section: tube, material: metal}}
  two: {{nodes: [b, c], section: tube, material: metal}}
hinges: auto
supports: {{clamp: {{node: a, fix: all}}}}
obstacles: {{wall: {{type: plane, point: [1 m, 0 m, 0 m], normal: [-1, 0, 0]}}}}
initial_velocity: [{{translation: [1 m/s, 0 m/s, 0 m/s]}}]
analysis: {{duration: 1 ms, multibody: {{members: elastic}}}}
"""
SHORTENED = [2e-3, 4e-3, 8e-3, 16e-3]
# side and wall [mm], yield stress [MPa], angle [deg]; force in shells at `SHORTENED` [N]
CRUSHED = {
    "60x60x1.5, 13 deg": ((60, 1.5, 250, 13.0), [35.4e3, 27.8e3, 20.8e3, 14.0e3]),
    "45x45x2.5, 21 deg": ((45, 2.5, 500, 21.0), [148.2e3, 118.8e3, 91.5e3, 69.4e3]),
    "50x50x2.5, 22 deg": ((50, 2.5, 250, 22.0), [81.8e3, 64.8e3, 50.8e3, 38.5e3]),
}


@pytest.mark.parametrize("name", CRUSHED)
def test_force_of_a_corner_that_is_crushed_straight(name, record_figure):
    (side, wall, stress, angle), shells = CRUSHED[name]
    half = math.radians(angle / 2.0)
    piece = 1.3e-3 * side
    sides = {"x": piece * math.cos(half), "z": piece * math.sin(half)}
    read = loads(CORNER.format(metal=METAL, stress=stress, side=side, wall=wall, **sides))
    whole = with_elastic_members(read.structure, read.multibody, read.time_in_motion)
    hinge = next(one for one in placed_hinges(whole) if one.name == "corner-b")
    slip = next(part.record for part in hinge.spatial.components if part.freedom is Freedom.AXIAL)
    law = np.interp(SHORTENED, slip.negative.rotation, slip.negative.moment)
    for shortened, found, expected in zip(SHORTENED, law, shells, strict=True):
        what = f"force, {name}, shortened by {1e3 * shortened:g} mm"
        record_figure(what, float(found), expected, 0.15, "N", relative=True)
