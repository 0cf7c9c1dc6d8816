"""A portal that a plane presses straight down: both posts carry alike, and as stiff as E A/L.

Clamped feet, square tubes 80x80x5 mm, posts 1.5 m; the plane moves by 0.5 mm below the joints in a
quasi-static stage. Each post carries E A/L times its shortening, whichever was declared first. Nodes at
the corners are pressed on the outline of both members, so the force is that of the ends, 1 %.

Kind: closed form.  Source: derived here.
"""

import pytest

from crumple.analysis import loads, solve

PORTAL = """crumple: 1
materials:
  steel: {youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: 355 MPa}
sections: {post: {type: square_tube, side: 80 mm, thickness: 5 mm}}
nodes: {a: [0 m, 0 m, 0 m], b: [0 m, 0 m, 1.5 m], c: [1 m, 0 m, 1.5 m], e: [1 m, 0 m, 0 m]}
members: {MEMBERS}
hinges: auto
supports: {a: {node: a, fix: all}, e: {node: e, fix: all}}
obstacles:
  press: {type: plane, point: [0 m, 0 m, 1.54 m], normal: [0, 0, -1], velocity: [0 m/s, 0 m/s, -25 mm/s]}
analysis:
  multibody: {members: KIND}
  stages: [{name: press, kind: quasi-static, duration: 20 ms}]
outputs: {every: 2 ms, nodes: [b, c]}
"""
MEMBERS = [
    "p1: {nodes: [a, b], section: post, material: steel}",
    "bm: {nodes: [b, c], section: post, material: steel}",
    "p2: {nodes: [c, e], section: post, material: steel}",
]
STIFFNESS = 210e9 * 4 * 0.075 * 0.005 / 1.5
"""E A/L of a post [N/m]."""


@pytest.mark.parametrize("order", [1, -1], ids=["first post first", "second post first"])
def test_both_posts_carry_alike(order, record_figure):
    text = PORTAL.replace("{MEMBERS}", "{" + ", ".join(MEMBERS[::order]) + "}").replace("KIND", "elastic")
    result = solve(loads(text), checks=False)
    assert result.status.ok
    for foot, node in (("a", "b"), ("e", "c")):
        shortened = -float(result[f"node.{node}.displacement.z"][-1])
        force = abs(float(result[f"support.{foot}.force.z"][-1]))
        assert shortened > 1e-4
        record_figure(f"force of foot {foot}", force, STIFFNESS * shortened, 0.01, "N", relative=True)
