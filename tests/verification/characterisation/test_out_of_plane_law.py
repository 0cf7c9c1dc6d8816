"""A corner out of its plane: its laws do not depend on the sub-model, and frames of it follow their shells.

Mitred corner of 90 degrees of two tubes 50x25x2.65 mm (488 MPa), coarse mesh (4 elements along half a
fold): the plastic work about its bisector and about its tangent at 5 to 30 degrees is that of pieces 1.4
times as long within 3 %. L-frames of 90, 60 and 30 degrees between their members, as in
test_l_frame_out_of_plane, whose tip is pushed by 200 mm out of the plane, with the laws of their members in
bending and torsion and of their corner in its plane and about both of its directions out of it, and
elastic members (laws of 5 elements along half a fold: with 4 the work at 90 degrees is 5.0 % above
the shells): work, and rotation of the arm, against the shell model of the same input (5 mm elements,
energy residual 2e-7 or less), solved once by this program. Tolerances: 5 % of the work, and of the rotations
3.5 degrees, since they were found to differ by up to 3.2: this is what the laws reach, not a target that was
set. About the normal of the plane the arm is compared at the end; without the shift of the set of its corner
it turned by -4 degrees at 90 and by -1 at 60 degrees.

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
COARSE, FRAMES = Resolution(4.0, 7.0), Resolution(5.0, 7.0)
TIMES = (60, 80, 100)
"""Times [ms] of the figures."""
# angle [deg]: external work [J], rotation of the tip about x and about z [deg], at TIMES
SHELLS = {
    90: ((324.4, 476.6, 534.4), (-9.8, -13.8, -15.1), (19.2, 27.7, 31.2)),
    60: ((343.9, 488.9, 540.5), (-11.7, -16.9, -18.9), (14.8, 21.1, 23.8)),
    30: ((400.3, 561.2, 617.7), (-9.1, -12.2, -13.3), (8.1, 11.0, 12.2)),
}
NORMAL = {90: 6.4, 60: 10.2, 30: 3.8}
"""Rotation of the tip about y, the normal of the plane, at the last of TIMES [deg]."""
WITHIN = 3.5
"""Tolerance of rotations [deg]."""


@pytest.mark.slow
@pytest.mark.parametrize("about", ["bisector", "tangent"])
def test_work_is_that_of_longer_pieces(about, record_figure):
    one, other = (
        characterise(OutOfPlane(TUBE, STEEL, about=about, length_factor=factor, resolution=COARSE)).curve
        for factor in (1.0, 1.4)
    )
    for degrees in (5, 10, 20, 30):
        at = math.radians(degrees)
        record_figure(
            f"work at {degrees} deg", other.energy_at(at), one.energy_at(at), 0.03, "J", relative=True
        )


@pytest.mark.slow
@pytest.mark.parametrize("degrees", SHELLS)
def test_frame_out_of_its_plane_follows_its_shells(degrees, tmp_path, record_figure):
    angle = math.radians(degrees)
    tip = f"[{0.4 * math.sin(angle):.9f} m, 0 m, {0.4 + 0.4 * math.cos(angle):.9f} m]"
    path = tmp_path / "frame.yaml"
    path.write_text(FRAME.replace("members: rigid", "members: elastic").replace("[0.4 m, 0 m, 0.4 m]", tip))
    source = load_input(path)
    structure = source.analysis.structure
    metal = structure.section_of("post"), structure.material_of("post")
    models = (
        Torsion(*metal, resolution=FRAMES),
        Bending(*metal, resolution=FRAMES),
        Bending(*metal, angle=angle, resolution=FRAMES),
        OutOfPlane(*metal, angle=angle, about="bisector", resolution=FRAMES),
        OutOfPlane(*metal, angle=angle, about="tangent", resolution=FRAMES),
    )
    store = LawStore(tmp_path / "laws")
    for model in models:
        store.keep(model, characterise(model).law)
    found = crumple.solve(source.with_laws(tmp_path / "laws").analysis)
    for i, (time, work, about_x, about_z) in enumerate(zip(TIMES, *SHELLS[degrees], strict=True), start=3):
        value = float(found["energy.external_work"][i])
        record_figure(f"work at {time} ms", value, work, 0.05, "J", relative=True)
        for axis, expected in (("x", about_x), ("z", about_z)):
            turned = math.degrees(float(found[f"node.tip.rotation.{axis}"][i]))
            record_figure(f"rotation of the arm about {axis} at {time} ms", turned, expected, WITHIN, "deg")
    turned = math.degrees(float(found["node.tip.rotation.y"][5]))
    record_figure("rotation of the arm about y at the end", turned, NORMAL[degrees], WITHIN, "deg")
