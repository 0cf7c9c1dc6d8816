"""Wrong input of axial slip and of walls that move: refused with line, what is allowed, what to do."""

import pytest

from crumple.analysis import loads
from crumple.errors import InputError

FILE = """crumple: 1
materials:
  steel: {youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: 300 MPa}
sections:
  tube: {type: rectangular_tube, width: 50 mm, depth: 50 mm, thickness: 1.5 mm}
  box: {type: rectangular_tube, width: 50 mm, depth: 80 mm, thickness: 1.5 mm}
  pipe: {type: circular_tube, diameter: 50 mm, thickness: 2 mm}
  channel: {type: channel, width: 40 mm, depth: 80 mm, thickness: 2 mm}
nodes: {a: [0 m, 0 m, 0 m], b: [500 mm, 0 m, 0 m]}
members:
  ab: {nodes: [a, b], section: SECTION, material: steel, hinges: [{name: h, at: 100 mm, axes: [y, z], AXIAL}]}
supports: {clamp: {node: a, fix: all}}
masses: {m: {node: b, mass: 20 kg}}
obstacles: {wall: {type: plane, point: [510 mm, 0 m, 0 m], normal: [-1, 0, 0], WALL}}
analysis: {duration: 2 ms}
"""
LINE_OF_HINGE, LINE_OF_WALL = 11, 14
NOTHING = "friction: 0"


def refused(axial="axial: true", section="tube", wall=NOTHING):
    text = FILE.replace("AXIAL", axial).replace("SECTION", section).replace("WALL", wall)
    with pytest.raises(InputError) as caught:
        loads(text).structure.hinges  # noqa: B018
    return caught.value.problems


@pytest.mark.parametrize(
    ("axial", "section", "what", "allowed", "todo"),
    [
        ("axial: {law: sqare}", "tube", "not one of the permitted", "square, superfolding", "'square'"),
        ("axial: {law: square}", "box", "for square tubes", "equal sides", "use the law superfolding"),
        ("axial: {law: square}", "pipe", "for square tubes", "equal sides", "use the law circular"),
        (
            "axial: {law: superfolding}",
            "pipe",
            "rectangular tubes",
            "rectangular_tube",
            "use the law circular",
        ),
        ("axial: {law: circular}", "tube", "circular tubes", "circular_tube", "use the law superfolding"),
        ("axial: {law: top_hat}", "tube", "closed hats", "closed_hat", "use the law superfolding"),
        ("axial: {law: square}", "channel", "square tubes", "equal sides", "give peak, mean and stroke"),
        ("axial: {law: square, peak: 10 kN}", "tube", "exclude each other", "", "remove one"),
        ("axial: {peak: 10 kN}", "tube", "needs 'mean'", "together", "add it"),
        ("axial: {peak: 10 kN, mean: 20 kN, stroke: 1 mm}", "tube", "above the peak", "10 kN", "lower mean"),
        ("axial: {peak: 10 kN, mean: 5 kN, stroke: 0 mm}", "tube", "out of range", "more than 0", "correct"),
        ("axial: {peak: 10 kN, mean: 5 kN, stroke: 1 kN}", "tube", "unit of a force", "mm", "length"),
        ("axial: {peak: .nan, mean: 5 kN, stroke: 1 mm}", "tube", "not finite", "a force", "finite number"),
        ("axial: {tension: -3 kN}", "tube", "out of range", "more than 0", "correct the number"),
        ("axial: yes please", "tube", "changes its length", "true, false, or keys", "quotation marks"),
        ("axial: {laws: square}", "tube", "unknown key 'laws'", "law, peak, mean", "'law'"),
        ("axial: true, coupling: tension-flange", "tube", "one bending axis", "axial and y", ""),
        ("axial: true, coupling: ball", "tube", "only rotations", "", "ellipsoid"),
        ("axial: true, fracture: 3 mm", "tube", "unit of a length", "deg", "an angle"),
    ],
)
def test_wrong_slip_is_refused_with_what_to_do(axial, section, what, allowed, todo):
    (problem,) = refused(axial, section)
    assert what in problem.what
    assert allowed in problem.allowed
    assert todo in problem.todo
    assert problem.line == LINE_OF_HINGE


@pytest.mark.parametrize(
    ("wall", "what"),
    [
        (
            "mass: 1 kg, motion: {x: {table: {time: [0 s, 1 s], value: [0 m, 1 m]}}}",
            "with a mass is not driven",
        ),
        ("motion: {x: {table: {time: [1 s, 0 s], value: [0 m, 1 m]}}}", "must increase"),
        ("motion: {x: {table: {time: [0 s, 1 s], value: [0 m]}}}", "two lists of one length"),
        ("motion: {x: {table: {time: [0 s, 1 s], value: [0 m, 1 kg]}}}", "unit of a mass"),
        ("motion: {w: {table: {time: [0 s, 1 s], value: [0 m, 1 m]}}}", "unknown key 'w'"),
        ("motion: 3", "a group of keys is needed"),
        ("members: [zz]", "no member 'zz'"),
    ],
)
def test_walls_that_cannot_move_so_are_refused(wall, what):
    (problem,) = refused(wall=wall)
    assert what in problem.what
    assert problem.line == LINE_OF_WALL
