"""Laws of axial crushing from a law file: written and read, used by hinges, refused where they do not fit."""

import pytest
from tests.support.multibody.frames import STEEL, TUBE
from tests.support.stored_laws import store_of

from crumple.errors import InputError
from crumple.hinge import AxialCollapse, build_law
from crumple.hinge.law import Source, Trust, Validity
from crumple.hinge.measured.law_file import read_law, write_law
from crumple.hinge.measured.place_hash import PLACE, place_hash
from crumple.hinge.measured.stored import StoredCurve, StoredLaw
from crumple.hinge.measured.stored_crushing import StoredCrushing
from crumple.material import Material
from crumple.section import RectangularTube
from crumple.structure import Structure, placed_hinges, used_texts

METAL = Material("any name", 210e9, 0.3, 7850.0, 488e6)
SECTION = RectangularTube(0.050, 0.025, 0.00265)
LAW = StoredLaw(
    title="made up",
    law="shell",
    origin=(
        ("method", "shell"),
        ("gauge", "200.0 mm"),
        (PLACE, place_hash(SECTION, METAL, load="crush")),
    ),
    curve=StoredCurve(((0.0,), (180e3,)), ((0.0, 0.05, 0.15), (100e3, 60e3, 60e3))),
    source=Source("a test", Trust.COMPUTED),
    validity=Validity(0.15, "a test"),
    slip=True,
)


def test_the_law_is_read_as_it_was_written_with_its_units():
    text = write_law(LAW)
    assert read_law(text) == LAW
    assert "units: {slip: m, force: N}" in text
    assert "rotation_max: 0.15 m" in text
    with pytest.raises(InputError, match="SI units"):
        read_law(text.replace("force: N}", "force: kN}"))
    with pytest.raises(InputError, match="unknown key"):
        read_law(text.replace("slip: m, force: N}", "slip: m, force: N, moment: N*m}"))


def test_peak_mean_and_stroke_are_those_of_the_curve():
    law = StoredCrushing.of(LAW)
    assert law.peak_force == 100e3
    assert law.mean_crushing_force == pytest.approx((80e3 * 0.05 + 60e3 * 0.10) / 0.15)
    assert law.effective_stroke == pytest.approx(0.75)


def test_a_law_of_crushing_is_refused_for_bending_and_one_of_bending_for_crushing():
    with pytest.raises(InputError, match="acts along the member"):
        build_law("file", SECTION, METAL, text=write_law(LAW))
    bending = StoredLaw("b", "shell", LAW.origin, LAW.curve, LAW.source, LAW.validity)
    with pytest.raises(InputError, match="no law of axial crushing"):
        StoredCrushing.of(bending)


def column(tmp_path, **axial):
    hinge = {"name": "fold", "at": 0.2, "axes": ["y", "z"], **axial}
    return Structure(
        materials={"steel": STEEL},
        sections={"tube": TUBE},
        nodes={"foot": (0.0, 0.0, 0.0), "head": (0.4, 0.0, 0.0)},
        members={
            "column": {"nodes": ("foot", "head"), "section": "tube", "material": "steel", "hinges": [hinge]}
        },
        supports={"clamp": {"node": "foot", "fix": "all"}, "stay": {"node": "head", "fix": "all"}},
        laws=str(store_of(tmp_path / "laws", write_law(LAW))),
    )


def forces(structure):
    (hinge,) = placed_hinges(structure)
    (axial,) = (c.record for c in hinge.spatial.components if c.freedom.label == "axial")
    return axial.negative


def test_an_axial_hinge_without_a_law_of_its_own_folds_by_the_stored_one(tmp_path):
    whole = column(tmp_path, axial=True)
    negative = forces(whole)
    assert negative.moment[0] == pytest.approx(100e3)
    # the mean of the second level keeps the work over the stroke of the whole member, 0.3 m
    law = AxialCollapse.of(StoredCrushing.of(LAW), 0.4, tension=1.0)
    assert negative.moment[-1] == pytest.approx(law.points[1][-1])
    assert law.stroke == pytest.approx(0.3)
    assert used_texts(whole) == (write_law(LAW),)


def test_given_forces_and_laws_are_kept(tmp_path):
    whole = column(tmp_path, axial={"peak": 90e3, "mean": 50e3, "stroke": 0.1})
    assert forces(whole).moment[0] == pytest.approx(90e3)
    assert used_texts(whole) == ()
