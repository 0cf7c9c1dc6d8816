"""A portal that a plane presses straight down: both posts carry alike, and as stiff as E A/L.

Clamped feet, square tubes 80x80x5 mm, posts 1.5 m; the plane moves by 0.5 mm below the joints in a
quasi-static stage. Each post carries E A/L times its shortening, whichever was declared first. A force is
the mean of its step, so it lags by half a step: 1 % at the end.

Kind: closed form.  Source: derived here.
"""

import pytest

from crumple.analysis import loads, solve
from crumple.hinge import Freedom
from crumple.section import half_fold_length
from crumple.structure import placed_hinges, with_elastic_members

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


def test_a_corner_lengthens_as_one_fold_and_the_rest_of_its_first_member_elsewhere(record_figure):
    analysis = loads(PORTAL.replace("{MEMBERS}", "{" + ", ".join(MEMBERS) + "}").replace("KIND", "elastic"))
    structure = with_elastic_members(analysis.structure, analysis.multibody, analysis.duration)
    stiffness = {}
    for hinge in placed_hinges(structure):
        parts = () if hinge.spatial is None else hinge.spatial.components
        axial = [one.record.elastic_stiffness for one in parts if one.freedom is Freedom.AXIAL]
        if hinge.plastic and axial:
            (stiffness[hinge.name],) = axial
    fold = 2.0 * half_fold_length(structure.section_of("p1"))
    assert {"p1-a", "p2-e", "corner-b"} <= set(stiffness)
    for name in ("p1-a", "p2-e"):
        record_figure(
            f"stiffness along the member of {name}", stiffness[name], STIFFNESS, 1e-9, "N/m", relative=True
        )
    expected = STIFFNESS * 1.5 / fold
    record_figure("stiffness of the corner", stiffness["corner-b"], expected, 1e-9, "N/m", relative=True)
