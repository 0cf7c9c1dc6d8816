"""A corner out of its plane: its law does not depend on the sub-model, and a frame of it follows its shells.

Mitred corner of 90 degrees of two tubes 50x25x2.65 mm (488 MPa), coarse mesh (4 elements along half a
fold): the plastic work at 5 to 30 degrees is that of pieces 1.4 times as long within 3 %. The L-frame of
test_l_frame_out_of_plane, whose tip is pushed by 200 mm out of the plane, with the laws of its members in
bending and torsion and of its corner in and out of its plane (elastic-plastic): work, and rotation of the
arm about the post, against the shell model of the same input (5 mm elements, energy residual 6e-8), solved
once by this program. Tolerances: 5 % of the work, 8 % of the rotation at the end. The shells' arm also
rolls, by 15 degrees about its own axis, since the fold's axis is oblique; the hinge's axes do not couple,
and it does not.

Kind: invariant; independent calculation.  Source: derived here; run here.
"""

import math

import pytest
from tests.verification.spatial.test_l_frame_out_of_plane import FRAME

import crumple
from crumple.analysis import load_input
from crumple.characterisation import Bending, LawStore, OutOfPlane, Torsion, characterise
from crumple.characterisation.resolution import Resolution
from crumple.material import Material
from crumple.section import RectangularTube

STEEL = Material("steel", 210e9, 0.3, 7850.0, 488e6)
TUBE = RectangularTube(width=0.050, depth=0.025, thickness=0.00265)
COARSE = Resolution(4.0, 7.0)
SHELL_WORK = {60: 324.3, 80: 476.5, 100: 534.3}
"""External work at times in ms [J]."""
SHELL_ROTATION = {60: 19.2, 80: 27.7, 100: 31.2}
"""Rotation of the tip about the post [deg]."""
ELASTIC = "hinges: {law: {type: auto, form: elastic-plastic}}"


@pytest.mark.slow
def test_work_is_that_of_longer_pieces(record_figure):
    one, other = (
        characterise(OutOfPlane(TUBE, STEEL, length_factor=factor, resolution=COARSE)).curve
        for factor in (1.0, 1.4)
    )
    for degrees in (5, 10, 20, 30):
        at = math.radians(degrees)
        record_figure(
            f"work at {degrees} deg", other.energy_at(at), one.energy_at(at), 0.03, "J", relative=True
        )


@pytest.mark.slow
def test_frame_out_of_its_plane_follows_its_shells(tmp_path, record_figure):
    path = tmp_path / "frame.yaml"
    path.write_text(FRAME.replace("hinges: auto", ELASTIC))
    source = load_input(path)
    structure = source.analysis.structure
    metal = structure.section_of("post"), structure.material_of("post")
    models = (
        Torsion(*metal, resolution=COARSE),
        Bending(*metal, resolution=COARSE),
        Bending(*metal, angle=math.pi / 2.0, resolution=COARSE),
        OutOfPlane(*metal, resolution=COARSE),
    )
    store = LawStore(tmp_path / "laws")
    for model in models:
        store.keep(model, characterise(model).law)
    found = crumple.solve(source.with_laws(tmp_path / "laws").analysis)
    for i, (time, work) in enumerate(SHELL_WORK.items(), start=3):
        value = float(found["energy.external_work"][i])
        record_figure(f"work at {time} ms", value, work, 0.05, "J", relative=True)
        turned = math.degrees(float(found["node.tip.rotation.z"][i]))
        name = f"rotation of the arm at {time} ms"
        record_figure(name, turned, SHELL_ROTATION[time], 0.08, "deg", relative=True)
