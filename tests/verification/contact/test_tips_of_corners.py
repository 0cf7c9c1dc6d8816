"""Planes meet corners of square tubes where the outer faces of the members meet, not where capsules end.

Members of the side a at an angle 2 h share a mitre, whose outer edge is a/(2 sin h) from the node.  Where the
members are so close that the edge would be further beyond the node than the tube's corners are from its axis
(sqrt(1/2) a), their walls end there, and the tip is at sqrt(1/2) a cos h + a/2 sin h.  Two such members fall
on the corner with their free ends up, at a constant speed: the time of the impact gives the distance.

The tip is a ball of the radius a/2000, which is less deep by (1/sin h - 1) a/2000, 0.03 mm at most here.
The tolerance adds the way in one output.

Kind: independent calculation.  Source: derived here.
"""

import math

import numpy as np
import pytest

from crumple.analysis import loads, solve
from crumple.errors import Status

SIDE, LENGTH, SPEED, EVERY, GAP = 0.05, 0.4, 5.0, 2e-5, 0.06
HEAD = """crumple: 1
materials:
  steel: {youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: 350 MPa}
sections: {tube: {type: square_tube, side: 50 mm, thickness: 2 mm}}
"""
TAIL = f"""obstacles:
  floor: {{type: plane, point: [0 m, 0 m, {-GAP} m], normal: [0, 0, 1]KEPT}}
initial_velocity: [{{translation: [0 m/s, 0 m/s, {-SPEED} m/s]}}]
analysis: {{duration: 10 ms}}
outputs: {{every: {EVERY} s, nodes: [low]}}
"""


def reach_of(ends, hinges="", kept="", gap=GAP):
    """Distance of the node `low` from the plane at the first contact of members from it to the ends [m]."""
    nodes = {"low": (0.0, 0.0, 0.0), **{f"end_{i}": tuple(end) for i, end in enumerate(ends)}}
    lines = [f"  {name}: [{', '.join(f'{x:.12g} m' for x in place)}]" for name, place in nodes.items()]
    members = [
        f"  leg_{i}: {{nodes: [low, end_{i}], section: tube, material: steel}}" for i in range(len(ends))
    ]
    text = "\n".join(
        [
            HEAD + "nodes:",
            *lines,
            "members:",
            *members,
            hinges + TAIL.replace("KEPT", kept).replace(f"{-GAP}", f"{-gap}"),
        ]
    )
    result = solve(loads(text))
    assert result.status is Status.COMPLETE, result.reason
    met = int(np.argmax(np.abs(result["obstacle.floor.force.z"]) > 0.0))
    assert met > 0
    return gap - SPEED * result.time[met]


def mitred(half):
    return [(side * LENGTH * math.sin(half), 0.0, LENGTH * math.cos(half)) for side in (-1.0, 1.0)]


@pytest.mark.parametrize("hinges", ["", "hinges: auto\n"])
@pytest.mark.parametrize("degrees", [25, 31, 40, 45, 55, 70])
def test_a_plane_meets_the_outer_edge_of_a_mitre(degrees, hinges, record_figure):
    half = math.radians(degrees)
    whole = SIDE / 2.0 / math.sin(half)
    kept = math.sqrt(0.5) * SIDE * math.cos(half) + SIDE / 2.0 * math.sin(half)
    expected = min(whole, kept)
    what = f"outer edge at half an angle of {degrees} deg, {'hinge' if hinges else 'rigid'}"
    record_figure(what, reach_of(mitred(half), hinges=hinges), expected, SPEED * EVERY + 3e-5, "m")


@pytest.mark.parametrize("member", ["leg_0", "leg_1"])
def test_a_tip_belongs_to_every_member_that_meets_there(member):
    found = reach_of(mitred(math.radians(45.0)), kept=f", members: [{member}]")
    assert found == pytest.approx(SIDE * math.sqrt(0.5), abs=SPEED * EVERY + 3e-5)


def test_members_in_line_have_no_tips():
    """A tube that falls flat is met by its faces, where it is cut in two at a node as elsewhere."""
    assert reach_of([(-LENGTH, 0.0, 0.0), (LENGTH, 0.0, 0.0)]) == pytest.approx(
        SIDE / 2.0, abs=SPEED * EVERY + 3e-5
    )


def test_a_plane_in_which_a_tip_starts_meets_the_capsules():
    found = reach_of(mitred(math.radians(45.0)), gap=0.03)
    assert found == pytest.approx(SIDE / 2.0, abs=SPEED * EVERY + 3e-5)
