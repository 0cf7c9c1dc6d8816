"""A mass on three inclined legs is thrown down: nothing can move unless the legs change their length.

Each leg at an angle a to the vertical has a hinge near its foot and one near the apex, a distance l apart,
and one between them, which stays closed: an end that turns anyway shortens for less work. They turn alike and
share its shortening evenly. With constant capacities M_p and N_p on an ellipse a descent w of the mass, small
against the legs, takes the work

    P w = 6 sqrt((M_p sin(a)/l)^2 + (N_p cos(a)/2)^2) w    (three legs, two hinges each)

and the mass m with the velocity v stops after w = m v^2/(2 P). Members are rigid. The input does not give
`axial`: the hinges have it because the legs are braced. Tolerance 1 %: the legs' own mass is 0.1 % of m,
their angle changes by 0.0002 rad, and each hinge shortens by 0.1 mm, over which folding takes 0.3 % of N_p.

Kind: closed form.  Source: derived here.
"""

import math

import numpy as np
import pytest

from crumple.analysis import loads, solve
from crumple.errors import Status
from crumple.structure import plastic_hinges

MOMENT, STRESS, MASS, VELOCITY = 2000.0, 320e6, 200.0, 1.0
HEIGHT, RADIUS = 0.6, 0.35
FEET = {
    name: (RADIUS * math.cos(at), RADIUS * math.sin(at))
    for name, at in zip("abc", (0.3, 2.3944, 4.4888), strict=True)
}
TEXT = f"""crumple: 1
materials:
  steel: {{youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 785 kg/m^3, yield_stress: {STRESS:g} Pa}}
sections:
  tube: {{type: circular_tube, diameter: 50 mm, thickness: 3 mm}}
nodes:
  apex: [0 m, 0 m, {HEIGHT} m]
  {"  ".join(f"{name}: [{x:.9g} m, {y:.9g} m, 0 m]" + chr(10) for name, (x, y) in FEET.items())}
members:
  {"  ".join(f"leg_{n}: {{nodes: [{n}, apex], section: tube, material: steel}}" + chr(10) for n in FEET)}
hinges: {{axes: [y, z], coupling: ellipsoid, law: {{type: constant, moment: {MOMENT:g} N*m}}}}
supports:
  {"  ".join(f"clamp_{name}: {{node: {name}, fix: all}}" + chr(10) for name in FEET)}
masses: {{head: {{node: apex, mass: {MASS} kg, rotary_inertia: [1 kg*m^2, 1 kg*m^2, 1 kg*m^2]}}}}
initial_velocity: [{{nodes: [apex], translation: [0 m/s, 0 m/s, -{VELOCITY} m/s]}}]
analysis:
  duration: 1 ms
  multibody: {{members: rigid}}
outputs: {{every: 0.01 ms, nodes: [apex]}}
"""


@pytest.fixture(scope="module")
def thrown():
    analysis = loads(TEXT)
    return analysis.structure, solve(analysis)


def test_descent_is_that_of_the_ellipse(thrown, record_figure):
    structure, result = thrown
    assert result.status is Status.COMPLETE, result.reason
    first, _, second = (h.station for h in plastic_hinges(structure) if h.member == "leg_a")
    squash, angle = STRESS * structure.section_of("leg_a").area, math.atan2(RADIUS, HEIGHT)
    bending, squashing = MOMENT * math.sin(angle) / (second - first), squash * math.cos(angle) / 2.0
    force = 6.0 * math.hypot(bending, squashing)
    descent = -result["node.apex.displacement.z"]
    expected = MASS * VELOCITY**2 / (2.0 * force)
    record_figure("descent", float(descent.max()), expected, 0.01, "m", relative=True)
    aside = np.hypot(result["node.apex.displacement.x"], result["node.apex.displacement.y"])
    record_figure("displacement aside", float(aside.max()), 0.0, 0.01 * expected, "m")
