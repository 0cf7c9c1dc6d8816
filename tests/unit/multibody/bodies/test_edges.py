"""Obstacles meet rolled sections where the outline is deepest: max over its points p of p . t.

A clamped post along x is pressed from below at its middle.  Of a rectangle of the sides w (along y) and d
(along z) that is rolled by u the corner in front is at -z = (w sin u + d cos u)/2, y = (w cos u - d sin u)/2
to one side.  A ball of the radius R meets a corner beside its path later by R - sqrt(R^2 - y^2).

Kind: independent calculation.  Source: derived here.
"""

import math

import numpy as np
import pytest
from tests.support.multibody.frames import member, structure

from crumple.multibody import Run, solve_multibody
from crumple.multibody.bodies.edges import edges_of
from crumple.multibody.bodies.linkage import link
from crumple.structure import Outputs

GAP, SPEED, EVERY, RADIUS = 0.05, 5.0, 2e-5, 0.2
SQUARE = {"type": "square_tube", "side": 0.04, "thickness": 0.002}
FLAT = {"type": "rectangular_tube", "width": 0.05, "depth": 0.03, "thickness": 0.002}
ROUND = {"type": "circular_tube", "diameter": 0.04, "thickness": 0.002}
NODES = {"a": (0.0, 0.0, 0.0), "b": (1.0, 0.0, 0.0)}
CLAMPS = {node: {"node": node, "fix": "all"} for node in "ab"}
HINGES = [
    (name, at, {"axes": ("y", "z", "x"), "axial": True})
    for name, at in (("r", 0.05), ("s", 0.5), ("t", 0.95))
]
SHAPES = {
    "plane": {"type": "plane", "point": (0.5, 0.0, -GAP), "normal": (0.0, 0.0, 1.0)},
    "pole": {
        "type": "cylinder",
        "point": (0.5, 0.0, -GAP - RADIUS),
        "axis": (0.0, 1.0, 0.0),
        "radius": RADIUS,
    },
    "ball": {"type": "sphere", "point": (0.5, 0.0, -GAP - RADIUS), "radius": RADIUS},
}


def post(section, degrees, obstacle, hinges=None):
    """The post, with hinges at both ends and in its middle, or with automatic ones."""
    bar = member("a", "b", *(HINGES if hinges is None else ()), roll=math.radians(degrees))
    given = {} if hinges is None else {"hinges": hinges}
    if hinges is not None:
        del bar["hinges"]
    return structure(
        nodes=NODES, members={"bar": bar}, sections={"tube": section}, supports=CLAMPS,
        obstacles={"ram": obstacle}, **given,
    )  # fmt: skip


def edges(whole, held=False):
    return list(edges_of(whole, link(whole).pieces, held=held))


def depth(section, degrees, shape):
    if "diameter" in section:
        return section["diameter"] / 2.0
    width, height = (section["side"],) * 2 if "side" in section else (section["width"], section["depth"])
    sine, cosine = abs(math.sin(math.radians(degrees))), abs(math.cos(math.radians(degrees)))
    beside = (width * cosine - height * sine) / 2.0
    # a side that lies flush is met in its middle
    later = RADIUS - math.sqrt(RADIUS**2 - beside**2) if shape == "ball" and sine * cosine > 0.01 else 0.0
    return (width * sine + height * cosine) / 2.0 - later


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize(
    ("section", "degrees"),
    [(SQUARE, 0), (SQUARE, 10), (SQUARE, 45), (SQUARE, -30), (FLAT, 30), (FLAT, 60), (FLAT, 90), (ROUND, 30)],
)
def test_first_contact_is_at_the_depth_of_the_outline(shape, section, degrees):
    ram = SHAPES[shape] | {"mass": 30.0, "velocity": (0.0, 0.0, SPEED), "guide": (0.0, 0.0, 1.0)}
    result = solve_multibody(post(section, degrees, ram), Run(0.012, EVERY, outputs=Outputs()))
    assert result.status.ok, result.reason
    met = int(np.argmax(np.abs(result["obstacle.ram.force.z"]) > 0.0))
    # a corner is a segment of a radius, rounded off by a thousandth of the capsule's
    found = GAP - float(result["obstacle.ram.displacement.z"][met])
    assert found == pytest.approx(depth(section, degrees, shape), abs=SPEED * EVERY + 3e-5)
    whole = 0.5 * 30.0 * SPEED**2
    assert np.abs(result["energy.residual"]).max() < 1e-3 * whole


@pytest.mark.parametrize("shape", SHAPES)
def test_sections_that_lie_flush_or_nearly_so_have_none(shape):
    for section in (SQUARE, FLAT, ROUND):
        for degrees in (0, 2, 90, 180):
            assert edges(post(section, degrees, SHAPES[shape])) == []
    assert edges(post(ROUND, 45, SHAPES[shape])) == []


def test_an_edge_lies_along_every_piece_and_belongs_to_the_obstacle_that_it_faces():
    whole = post(SQUARE, 45, SHAPES["plane"])
    found = edges(whole)
    assert found
    assert {edge.member for edge in found} == {"bar"}
    for edge in found:
        assert edge.obstacles == {"ram"}
        assert edge.shift == pytest.approx([0.0, 0.0, -0.02 * math.sqrt(2.0)], abs=3e-5)
    # the pieces at the clamps are held, and stop nothing but a mass; capsules end a radius before a free end
    moving = sum(abs(edge.capsule.second[0] - edge.capsule.first[0]) for edge in found)
    assert moving == pytest.approx(0.9)
    assert edges(whole, held=True) == []
    stopped = edges(post(SQUARE, 45, SHAPES["plane"] | {"mass": 10.0}), held=True)
    assert sum(abs(edge.capsule.second[0] - edge.capsule.first[0]) for edge in stopped) == pytest.approx(0.06)


def test_what_starts_inside_an_obstacle_is_met_with_its_capsules():
    assert edges(post(SQUARE, 45, SHAPES["plane"] | {"point": (0.5, 0.0, -0.025)})) == []


def test_walls_that_an_obstacle_dents_have_no_edges():
    """Poles dent rectangular tubes with automatic hinges that are rolled by less than 20 degrees."""
    pole = SHAPES["pole"] | {"mass": 30.0, "velocity": (0.0, 0.0, SPEED)}
    assert not edges(post(SQUARE, 10, pole, hinges="auto"))
    assert edges(post(SQUARE, 45, pole, hinges="auto"))
    assert edges(post(SQUARE, 10, SHAPES["plane"] | {"mass": 30.0}, hinges="auto"))
