"""Rectangular tubes that fold about an oblique axis, or about one axis after the other, against shells.

Sub-models of docs/theory/characterisation.md (two halves turned against each other, 4.5 elements along half a
fold), solved once by this program: moment [N m] about each axis alone and about an axis at 45 degrees, over
plastic rotation, and the largest moment about z after 20 degrees about y.  The hinge has the laws about both
axes alone, the interaction of the walls, the weight with which rotation about one axis softens the moment
about the other, and what the compressed edge of a fold about a diagonal does not lose.  The weight was chosen
by the moments after a first turn, mostly of the tube 50x50x1.5 mm; the edge was fitted to eleven other tubes,
none of which is here.  Square tubes of 80, 70 and 60x1.2 mm were solved when it was fixed.  Tubes between a
clamp and an end that is led across and carries 15 kg, thrown at 45 degrees to their walls (10 elements or
more across a wall): rotation of both ends; what is left of the edge beside a clamp was read off them.

Kind: independent calculation.  Source: run here.
"""

import math

import numpy as np
import pytest
from scipy.integrate import trapezoid
from tests.support.multibody.hinge_rig import ABOUT_Y, ABOUT_Z, SECTION, component, hinge, rig

from crumple.analysis import Analysis, solve
from crumple.structure import MultibodySettings, Structure, placed_hinges
from crumple.structure.hinges import spatial_hinges

PLACES = np.radians([0.2, 0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0, 12.5, 15.0, 17.5, 20.0])
S60 = [5050, 5128, 5286, 5359, 5406, 5343, 5132, 4929, 4696, 4219, 3805, 3394, 3079, 2834, 2720]
S60T = [2886, 2911, 2957, 2968, 2971, 2962, 2945, 2913, 2852, 2709, 2573, 2415, 2274, 2141, 2015]
S50 = [2444, 2406, 2284, 2107, 1932, 1694, 1522, 1393, 1289, 1135, 1020, 911, 827, 759, 704]
R84_Y = [2228, 2203, 2142, 2082, 2009, 1860, 1723, 1602, 1493, 1316, 1184, 1054, 950, 866, 798]
R84_Z = [3313, 3409, 3602, 3574, 3316, 2917, 2657, 2445, 2272, 1988, 1762, 1557, 1426, 1328, 1249]
S80 = [9692, 9631, 9322, 8720, 8065, 7072, 6347, 5799, 5369, 4719, 4244, 3792, 3442, 3163, 2935]
S70 = [3144, 3127, 3035, 2874, 2735, 2514, 2331, 2167, 2025, 1782, 1588, 1395, 1246, 1138, 1064]
S60A = [1634, 1521, 1273, 1119, 1013, 870, 771, 697, 637, 548, 485, 428, 386, 354, 329]
# width, depth, wall [m]; yield stress [MPa]; laws about y and z; work at 45 degrees up to 10 and 20 degrees
# [J]; largest moment about z after 20 degrees about y [N m], nan: not solved; what is allowed of the work
TUBES = {
    "60x60x2.5 mm": ((0.06, 0.06, 0.0025), 420, (S60, S60), (888.0, 1588.9), 3539.0, 0.10),
    "80x50x1.6 mm": ((0.08, 0.05, 0.0016), 300, (R84_Y, R84_Z), (392.3, 676.3), 1816.0, 0.10),
    "50x50x3 mm": ((0.05, 0.05, 0.003), 300, (S60T, S60T), (486.1, 918.5), math.nan, 0.05),
    "50x50x1.5 mm": ((0.05, 0.05, 0.0015), 488, (S50, S50), (312.2, 553.6), 1030.0, 0.10),
    "80x80x2.5 mm": ((0.08, 0.08, 0.0025), 450, (S80, S80), (1266.9, 2247.6), math.nan, 0.10),
    "70x70x1.6 mm": ((0.07, 0.07, 0.0016), 280, (S70, S70), (475.2, 828.6), math.nan, 0.10),
    "60x60x1.2 mm": ((0.06, 0.06, 0.0012), 300, (S60A, S60A), (186.5, 303.7), math.nan, 0.10),
}


def made(name, **changed):
    """The hinge of a tube with given laws."""
    (width, depth, wall), stress, laws, *_ = TUBES[name]
    metal = {"youngs_modulus": 210e9, "poissons_ratio": 0.3, "density": 7850.0, "yield_stress": stress * 1e6}
    structure = Structure(
        materials={"metal": metal},
        sections={"tube": {"type": "rectangular_tube", "width": width, "depth": depth, "thickness": wall}},
        nodes={"a": (0.0, 0.0, 0.0), "b": (1.0, 0.0, 0.0)},
        members={
            "bar": {
                "nodes": ("a", "b"),
                "section": "tube",
                "material": "metal",
                "hinges": [{"name": "fold", "at": 0.5, "axes": ["y", "z"]}],
            }
        },
        supports={"clamp": {"node": "a", "fix": "all"}},
    )
    record = placed_hinges(structure)[0].spatial
    parts = [
        component(axis, (PLACES - PLACES[0], law)) for axis, law in zip((ABOUT_Y, ABOUT_Z), laws, strict=True)
    ]
    surface = record.surface
    keys = {
        "rows": surface.rows.ravel().tolist(),
        "power": surface.power,
        "torque_power": surface.torque_power,
    }
    softens = {"cross_softening": record.cross_softening, "edge_relief": record.edge_relief}
    return rig(hinge(*parts, coupling=SECTION, **keys, **softens | changed))


def work(element, largest):
    """Work of a turn about the axis at 45 degrees [J]."""
    steps, cos = 200, math.sqrt(0.5)
    moments = [sum(element.led(1e-3, [cos * largest * 1e3 / steps] * 2)) * cos for _ in range(steps)]
    return float(trapezoid([moments[0], *moments], dx=largest / steps))


@pytest.mark.parametrize("name", TUBES)
def test_work_about_an_oblique_axis(name, record_figure):
    *_, shells, _, allowed = TUBES[name]
    for degrees, expected in zip((10.0, 20.0), shells, strict=True):
        found = work(made(name), math.radians(degrees))
        before = work(made(name, edge_relief=0.0), math.radians(degrees))
        most = work(made(name, cross_softening=1.0), math.radians(degrees))
        what = f"work up to {degrees:g} deg at 45 deg, {name}"
        record_figure(what, found, expected, allowed, "J", relative=True)
        assert most < before < found


@pytest.mark.parametrize("name", [name for name, tube in TUBES.items() if not math.isnan(tube[4])])
def test_moment_about_the_other_axis_after_a_fold(name, record_figure):
    element = made(name)
    for _ in range(200):
        element.led(1e-3, [math.radians(0.1) * 1e3, 0.0])
    moments = [element.led(1e-3, [0.0, math.radians(0.02) * 1e3])[1] for _ in range(100)]
    what = f"largest moment about z after 20 deg about y, {name}"
    record_figure(what, max(moments), TUBES[name][4], 0.10, "N m", relative=True)


def test_a_tube_thrown_along_a_diagonal_turns_less_than_by_the_whole_measure(monkeypatch):
    """The solver has weight and edge: a clamped tube with 20 kg at its tip, thrown along a diagonal."""

    def turned():
        metal = {"youngs_modulus": 210e9, "poissons_ratio": 0.3, "density": 7850.0, "yield_stress": 420e6}
        structure = Structure(
            materials={"metal": metal},
            sections={"tube": {"type": "square_tube", "side": 0.06, "thickness": 0.0025}},
            nodes={"a": (0.0, 0.0, 0.0), "b": (0.5, 0.0, 0.0)},
            members={"bar": {"nodes": ("a", "b"), "section": "tube", "material": "metal"}},
            hinges="auto",
            supports={"clamp": {"node": "a", "fix": "all"}},
            masses={"tip": {"node": "b", "mass": 20.0}},
            initial_velocity=[{"nodes": ("b",), "translation": (0.0, 8.0, 8.0)}],
        )
        settings = MultibodySettings(mechanism_check="off")
        result = solve(Analysis(structure=structure, duration=0.05, multibody=settings), "multibody")
        return max(one.rotation_max for one in result.hinges.values())

    relieved = turned()
    monkeypatch.setattr(spatial_hinges, "edge_relief", lambda section: 0.0)
    half = turned()
    monkeypatch.setattr(spatial_hinges, "CROSSED", 1.0)
    assert math.radians(5.0) < relieved < 0.98 * half < 0.96 * turned()


# width, depth, wall [mm]; yield stress [MPa]; whether it hardens; length [m]; speed in each direction [m/s];
# rotation [deg]
LED_ACROSS = [
    (50, 50, 1.0, 350, False, 0.65, 6.026, 24.6),
    (50, 50, 1.5, 350, False, 0.65, 7.305, 19.5),
    (60, 60, 2.5, 420, False, 0.78, 12.25, 15.5),
    (60, 40, 1.5, 350, False, 0.78, 7.288, 21.6),
    (50, 50, 2.0, 350, True, 0.65, 8.954, 12.1),
    (80, 80, 2.0, 350, False, 1.04, 13.57, 20.7),
    (45, 45, 1.2, 500, False, 0.585, 7.053, 22.0),
]


@pytest.mark.parametrize("case", LED_ACROSS)
def test_rotation_beside_a_clamp_about_a_diagonal(case, record_figure):
    width, depth, wall, stress, hardens, length, speed, shells = case
    metal = {"youngs_modulus": 210e9, "poissons_ratio": 0.3, "density": 7850.0, "yield_stress": stress * 1e6}
    if hardens:
        metal["hardening"] = {"type": "voce", "saturation": 200e6, "strain": 0.05}
    sides = {"width": width / 1e3, "depth": depth / 1e3, "thickness": wall / 1e3}
    structure = Structure(
        materials={"metal": metal},
        sections={"tube": {"type": "rectangular_tube", **sides}},
        nodes={"a": (0.0, 0.0, 0.0), "b": (0.0, 0.0, length)},
        members={"leg": {"nodes": ("a", "b"), "section": "tube", "material": "metal", "up": (1.0, 0.0, 0.0)}},
        hinges="auto",
        supports={"a": {"node": "a", "fix": "all"}, "b": {"node": "b", "fix": ("rx", "ry", "rz")}},
        masses={"b": {"node": "b", "mass": 15.0}},
        initial_velocity=[{"nodes": ("b",), "translation": (speed, speed, 0.0)}],
    )
    settings = MultibodySettings(mechanism_check="off")
    result = solve(Analysis(structure=structure, duration=0.05, multibody=settings), checks=False)
    found = math.degrees(max(one.rotation_max for one in result.hinges.values()))
    what = f"{width}x{depth}x{wall} mm, led across a clamp along a diagonal, rotation"
    record_figure(what, found, shells, 0.2 if hardens else 0.15, "deg", relative=True)
