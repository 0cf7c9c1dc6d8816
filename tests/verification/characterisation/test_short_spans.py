"""Folds beside clamps: the moment in short spans, and the place of the fold, against shells.

Tubes that are clamped at one end and led across, without turning, at the other carry no moment in their
middle: their folds at both ends have a span of half their length, 3 to 4 larger sides or diameters, where the
law was solved with cantilevers of 6 and 8.  Solved once with shells by this program (slow, 5 elements along
half a fold), listed before any was solved.  Expected: work up to rotations of the chord of 4, 10 and 18
degrees.  Tolerance: 12 %, of round tubes 6 % (found: 10 and 5 % at the largest; with hinges at 0.7 of half a
fold and one law for all spans 16 and 10 %).  The last four, of soft metals, were listed and solved later:
within 5 %, and 18 % too low to 13 % too high with the formula that hardens (`hardening_tube`). Spans of 1.1
to 2 sides (4 to 5 mm elements): tolerance 20 % (found: 19 %, with the hinge where long spans have it 39 %);
the last three were solved when the form was known.

Places of folds and moments of short cantilevers: held-out tubes of the tables, solved by
`python -m tools.law_clamped solve`.

Kind: independent calculation.  Source: run here.
"""

import math

import numpy as np
import pytest

import crumple
from crumple.hinge.tube_library.clamped import LONG, SPANS
from crumple.hinge.tube_library.table import tube_table
from crumple.hinge.tube_library.tube import coordinate

LED = """crumple: 1
title: tube clamped at one end and led across at the other
materials:
  m: {{youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: {stress} MPa,
       hardening: {curve}}}
sections: {{t: {{type: {section}}}}}
nodes: {{foot: [0 m, 0 m, 0 m], tip: [{length} mm, 0 m, 0 m]}}
members: {{arm: {{nodes: [foot, tip], section: t, material: m}}}}
hinges: auto
supports:
  a: {{node: foot, fix: all}}
  b:
    node: tip
    fix: [y, rx, ry, rz]
    motion: {{z: {{havsin: {{x0: 0 s, h0: 0 m, x1: {time} ms, h1: {down} mm}}}}}}
analysis: {{duration: {stop} ms}}
outputs: {{every: 0.2 ms, nodes: [tip]}}
"""
ROUND = "circular_tube, diameter: {} mm, thickness: {} mm"
BOX = "rectangular_tube, width: {} mm, depth: {} mm, thickness: {} mm"
SWIFT = "{{type: swift, prestrain: {}, exponent: {}}}"
# section, yield [MPa], curve, length [mm]; work of shells [J]
TUBES = {
    "round 48.3x2.5": (
        (ROUND.format(48.3, 2.5), 300, SWIFT.format(0.006, 0.16), 386.4),
        (275.3, 779.1, 1442.7),
    ),
    "round 38x2": ((ROUND.format(38, 2), 260, SWIFT.format(0.006, 0.2), 266.0), (126.7, 366.3, 694.5)),
    "40x40x2.5": (
        (BOX.format(40, 40, 2.5), 300, "{type: voce, saturation: 200 MPa, strain: 0.08}", 320.0),
        (263.7, 736.2, 1340.0),
    ),
    "50x50x1.5": ((BOX.format(50, 50, 1.5), 350, SWIFT.format(0.006, 0.14), 350.0), (272.6, 588.1, 899.2)),
    "40x60x2": ((BOX.format(40, 60, 2), 320, SWIFT.format(0.01, 0.15), 360.0), (424.6, 1112.2, 1852.2)),
    "60x60x2.5": ((BOX.format(60, 60, 2.5), 355, SWIFT.format(0.01, 0.16), 360.0), (753.2, 1940.6, 3287.1)),
    # below the yield strain of the tubes of the library; S235
    "50x50x2": ((BOX.format(50, 50, 2), 235, SWIFT.format(0.01245, 0.2208), 380.0), (287.7, 715.9, 1176.5)),
    "40x60x2, soft": (
        (BOX.format(40, 60, 2), 235, SWIFT.format(0.01245, 0.2208), 360.0),
        (332.4, 871.2, 1427.0),
    ),
    "round 42.4x2.6": (
        (ROUND.format(42.4, 2.6), 235, SWIFT.format(0.01245, 0.2208), 340.0),
        (169.8, 483.8, 934.4),
    ),
    "60x40x1.5": (
        (BOX.format(60, 40, 1.5), 190, "{type: voce, saturation: 120 MPa, strain: 0.1}", 360.0),
        (119.2, 258.8, 398.0),
    ),
}
VOCE = "{type: voce, saturation: 120 MPa, strain: 0.1}"
# spans of 1.1 to 2 larger sides or diameters
SHORTEST = {
    "40x60x2.5, 130 mm": ((BOX.format(40, 60, 2.5), 280, VOCE, 130.0), (386.0, 1018.0, 1830.0)),
    "40x60x2.5, 180 mm": ((BOX.format(40, 60, 2.5), 280, VOCE, 180.0), (423.0, 1100.0, 1925.0)),
    "60x40x2.5, 130 mm": ((BOX.format(60, 40, 2.5), 280, VOCE, 130.0), (279.0, 735.0, 1330.0)),
    "60x40x2.5, 180 mm": ((BOX.format(60, 40, 2.5), 280, VOCE, 180.0), (309.0, 789.0, 1401.0)),
    "50x50x3, 130 mm": ((BOX.format(50, 50, 3), 300, VOCE, 130.0), (428.0, 1131.0, 2056.0)),
    "50x50x3, 180 mm": ((BOX.format(50, 50, 3), 300, VOCE, 180.0), (472.0, 1230.0, 2182.0)),
    "35x55x1.8, 140 mm": (
        (BOX.format(35, 55, 1.8), 320, SWIFT.format(0.01, 0.15), 140.0),
        (301.0, 798.0, 1389.0),
    ),
    "round 48.3x2.5, 130 mm": (
        (ROUND.format(48.3, 2.5), 300, SWIFT.format(0.006, 0.16), 130.0),
        (288.0, 802.0, 1477.0),
    ),
    "round 48.3x2.5, 190 mm": (
        (ROUND.format(48.3, 2.5), 300, SWIFT.format(0.006, 0.16), 190.0),
        (295.0, 821.0, 1507.0),
    ),
}
CHORDS = np.radians([4.0, 10.0, 18.0])


@pytest.mark.parametrize("name", [*TUBES, *SHORTEST])
def test_a_tube_between_a_clamp_and_a_guide_takes_the_work_of_shells(name, record_figure):
    (section, stress, curve, length), works = (TUBES | SHORTEST)[name]
    time = 40.0 * length / 300.0
    text = LED.format(
        section=section,
        stress=stress,
        curve=curve,
        length=length,
        time=time,
        down=-length / 2.0,
        stop=0.62 * time,
    )
    result = crumple.solve(crumple.loads(text), checks=False)
    down, done = np.abs(result["node.tip.displacement.z"]), result["energy.external_work"]
    found = np.interp(1e-3 * length * np.sin(CHORDS), down, done)
    for chord, own, shells in zip(CHORDS, found, works, strict=True):
        title = f"{name} mm, work to {math.degrees(chord):.0f} deg of the chord"
        tolerance = 0.2 if name in SHORTEST else 0.06 if name.startswith("round") else 0.12
        record_figure(title, float(own), shells, tolerance, "J", relative=True)


@pytest.mark.parametrize("kind", LONG)
def test_folds_of_held_out_tubes_lie_where_shells_have_them(kind):
    table = tube_table(f"place_in_clamped_{kind}")
    points = [one for one in table.facts["points"] if one["role"] in {"held-out", "check"}]
    # the energy of an entry is that of the place over half a fold, up to 5, 10, 20 and 30 degrees
    shells = np.array([one["energy"][0] / math.radians(5.0) for one in points])
    found = [table.moment(tuple(coordinate(one, point) for one in table.coordinates))[0] for point in points]
    assert len(points) == 5
    assert shells.min() < 0.7
    assert shells.max() > 1.2
    # places of strongly hardening round tubes are less certain
    assert np.median(np.abs(found / shells - 1.0)) < 0.08
    assert np.abs(found / shells - 1.0).max() < 0.3


def test_moments_of_held_out_tubes_in_the_shortest_spans():
    table = tube_table("short_rectangular_tube")
    points = [one for one in table.facts["points"] if one["role"] in {"held-out", "check"}]
    shorter, errors = 1.0 / SPANS[0] - 1.0 / LONG["rectangular_tube"], []
    for point in points:
        share = table.moment(tuple(coordinate(one, point) for one in table.coordinates))
        fine = np.radians([5.0, 10.0, 20.0, 30.0])
        own = [
            np.trapezoid(np.interp(at, table.rotation, share), at)
            for at in (np.linspace(0.0, one, 200) for one in fine)
        ]
        errors.append(shorter * (np.array(own) / np.array(point["energy"]) - 1.0))
    assert len(points) == 5
    assert np.abs(errors).max() < 0.07
