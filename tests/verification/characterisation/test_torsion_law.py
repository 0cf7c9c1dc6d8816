"""The torque of a twisted tube starts at its closed form and falls as the walls fold, whatever the length.

Tubes between rigid ends on coarse meshes (4 elements along half a bending fold). The plateau before the walls
fold is Bredt's torque with the shear yield stress, T_p = 2 A_m t s_y/sqrt(3), within 3 %. The plastic work at
5 to 30 degrees of plastic twist is that of a sub-model 1.5 times as long, and of one that is twisted twice as
slowly, within 3 %. An L-frame of these tubes that is pushed out of its plane takes less work with the law
than with constant torque, and is nearer to its shell model (534 J, see test_l_frame_out_of_plane).

Kind: closed form; invariant.  Source: textbook; derived here.
"""

import math

import numpy as np
import pytest
from tests.verification.spatial.test_l_frame_out_of_plane import FRAME

import crumple
from crumple.analysis import load_input
from crumple.characterisation import LawCurve, LawStore, Torsion, characterise
from crumple.characterisation.resolution import Resolution
from crumple.material import Material
from crumple.section import CircularTube, RectangularTube

STEEL = Material("steel", 210e9, 0.3, 7850.0, 488e6)
TUBE = RectangularTube(width=0.050, depth=0.025, thickness=0.00265)
THIN = RectangularTube(width=0.050, depth=0.050, thickness=0.0015)
ROUND = CircularTube(diameter=0.050, thickness=0.0015)
SHELL_WORK = 534.0
"""External work of the L-frame's shell model at 200 mm [J]."""


def curve_of(section, *, length_factor: float = 1.0, slowness: float = 7.0, to: float = 30.0) -> LawCurve:
    resolution = Resolution(4.0, slowness)
    model = Torsion(
        section, STEEL, largest=math.radians(to), length_factor=length_factor, resolution=resolution
    )
    return characterise(model).curve


@pytest.mark.parametrize(
    "section",
    [pytest.param(TUBE, marks=pytest.mark.slow), THIN, pytest.param(ROUND, marks=pytest.mark.slow)],
    ids=["rectangle", "square", "round"],
)
def test_plateau_is_bredts_torque(section, record_figure):
    y, z = section.outline().T
    enclosed = 0.5 * abs(float(y @ np.roll(z, -1) - z @ np.roll(y, -1)))
    bredt = 2.0 * enclosed * section.thickness * STEEL.yield_stress / math.sqrt(3.0)
    curve = curve_of(section, to=6.0)
    record_figure("largest torque", float(curve.moment.max()), bredt, 0.03, "N m", relative=True)


@pytest.mark.slow
@pytest.mark.parametrize("section", [TUBE, THIN], ids=["rectangle", "square"])
def test_work_is_that_of_another_sub_model(section, record_figure):
    usual = curve_of(section)
    others = {
        "1.5 times as long": curve_of(section, length_factor=1.5),
        "slower": curve_of(section, slowness=14.0),
    }
    for what, curve in others.items():
        for degrees in (5, 10, 20, 30):
            at = math.radians(degrees)
            name = f"work at {degrees} deg, {what}"
            record_figure(name, curve.energy_at(at), usual.energy_at(at), 0.03, "J", relative=True)
    # thin walls fold at once
    assert usual.moment[-1] < 0.65 * usual.moment.max()


@pytest.mark.slow
def test_frame_out_of_its_plane_is_nearer_to_shells_with_the_law(tmp_path, record_figure):
    path = tmp_path / "frame.yaml"
    # without a law of the corner
    path.write_text(FRAME.replace("hinges: auto", "hinges: {law: kecman}"))
    plain = load_input(path)
    structure = plain.analysis.structure
    model = Torsion(
        structure.section_of("post"), structure.material_of("post"), resolution=Resolution(4.0, 7.0)
    )
    LawStore(tmp_path / "laws").keep(model, characterise(model).law)
    works = [
        crumple.solve(source.analysis)["energy.external_work"][-1]
        for source in (plain, plain.with_laws(tmp_path / "laws"))
    ]
    # with a torque that falls as the folds bend, less what shear takes of it
    assert works[0] > 1.2 * SHELL_WORK
    record_figure("work", works[1], SHELL_WORK, 0.16, "J", relative=True)
