"""Bending with axial force, and about an oblique axis, starts with the plastic interaction of the walls.

The tube 50x25x2.65 mm of 488 MPa on a coarse mesh (4 elements along half a fold), whose walls do not buckle
at first: with 0.2 of its squash force in compression and in tension, and about an axis at 45 degrees, the
largest moment is that of limit analysis within 5 %. A tube of thin walls (50x50x1.5 mm) shows what happens
later: its fold rotates about the tension flange, so that tension increases and compression reduces the work
by more than 30 % up to 30 degrees, where the walls' interaction has 5 %. Turned and shortened by b/2 a
radian, it takes the work of bending alone, as the mechanism about the tension flange does (within 10 %).

Kind: closed form; invariant.  Source: derived here; derived here.
"""

import math
from dataclasses import replace

import numpy as np
import pytest

from crumple.characterisation import LawCurve
from crumple.characterisation.combined import Combined, FixedRatio
from crumple.characterisation.resolution import Resolution
from crumple.characterisation.solving import solve
from crumple.material import Material
from crumple.section import RectangularTube, plastic_interaction

STEEL = Material("steel", 210e9, 0.3, 7850.0, 488e6)
TUBE = RectangularTube(width=0.050, depth=0.025, thickness=0.00265)
THIN = RectangularTube(width=0.050, depth=0.050, thickness=0.0015)
COARSE = Resolution(4.0, 7.0)


def solved(model: Combined) -> LawCurve:
    return model.curve(solve(model.analysis(), "shell"))


@pytest.mark.slow
@pytest.mark.parametrize(("angle", "share"), [(0.0, -0.2), (0.0, 0.2), (math.pi / 4.0, 0.0)])
def test_largest_moment_is_that_of_limit_analysis(angle, share, record_figure):
    model = Combined(TUBE, STEEL, angle, share, math.radians(8.0), COARSE)
    found = solved(model).moment.max()
    about = np.array([math.cos(angle), math.sin(angle)])
    expected = float((plastic_interaction(TUBE, STEEL).moment_curve(model.force) @ about).max())
    name = f"largest moment at {math.degrees(angle):.0f} deg, {share:+g} of squash"
    record_figure(name, float(found), expected, 0.05, "N m", relative=True)


@pytest.mark.slow
def test_axial_force_changes_the_work_of_a_thin_fold_by_more_than_its_walls_say():
    end = math.radians(30.0)
    alone = Combined(THIN, STEEL, resolution=COARSE)
    work = {share: solved(replace(alone, share=share)).energy_at(end) for share in (-0.2, 0.0, 0.2)}
    assert work[-0.2] < 0.7 * work[0.0]
    assert work[0.2] > 1.3 * work[0.0]


@pytest.mark.slow
def test_a_thin_fold_shortened_in_the_ratio_of_its_mechanism_takes_the_work_of_bending_alone(record_figure):
    """|M| + N_c b/2 = C, shortened by b/2 a radian: the work is that of C, however M and N_c share it."""
    end, arm = math.radians(30.0), (THIN.depth - THIN.thickness) / 2.0
    alone = solved(Combined(THIN, STEEL, resolution=COARSE))
    work = solved(FixedRatio(THIN, STEEL, ratio=arm, resolution=COARSE)).energy_at(end)
    name = "work to 30 deg, shortened by b/2 a radian"
    record_figure(name, work, alone.energy_at(end), 0.10, "J", relative=True)
