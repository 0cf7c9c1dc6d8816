import pytest

from crumple.errors import InputError
from crumple.hinge import KecmanLaw, build_law, law_options, law_types
from crumple.material import Material
from crumple.section import CircularTube, RectangularTube

STEEL = Material("steel", 210e9, 0.3, 7850.0, 300e6)
TUBE = RectangularTube(0.05, 0.025, 0.002)


def test_laws_are_found_by_the_files_of_their_folder():
    assert list(law_types()) == [
        "auto",
        "circular",
        "clamped_tube",
        "constant",
        "estimate",
        "file",
        "folded_plates",
        "folded_profile",
        "hardening_section",
        "hardening_tube",
        "kecman",
        "library",
        "measured",
        "mitred_corner",
        "mitred_corner_across",
        "oblique",
        "table",
        "wierzbicki",
    ]
    assert law_types()["kecman"] is KecmanLaw


def test_built_law_is_that_of_the_class():
    assert build_law("kecman", TUBE, STEEL, "z", rolling_weight=0.5) == KecmanLaw.of(
        TUBE, STEEL, "z", rolling_weight=0.5
    )


def test_options_are_listed():
    assert law_options("kecman") == ("rolling_weight", "start", "after_jamming")
    assert law_options("constant") == ("moment",)


@pytest.mark.parametrize(
    ("name", "section", "options", "message"),
    [
        ("kecmann", TUBE, {}, "unknown hinge law"),
        ("kecman", TUBE, {"weight": 1.0}, "unknown option"),
        ("kecman", TUBE, {"start": "ramp"}, "unknown choice"),
        ("kecman", TUBE, {"after_jamming": "nothing"}, "second_fold, stop, hold"),
        ("kecman", TUBE, {"rolling_weight": 1.1}, "out of range"),
        ("kecman", TUBE, {"rolling_weight": float("nan")}, "out of range"),
        ("kecman", CircularTube(0.04, 0.002), {}, "rectangular"),
        ("wierzbicki", CircularTube(0.04, 0.002), {}, "square"),
        ("wierzbicki", TUBE, {}, "square"),
        ("wierzbicki", TUBE, {"equivalent_side": 0.001}, "equivalent side"),
        ("constant", TUBE, {"moment": -1.0}, "must be positive"),
        ("table", TUBE, {"rotation": [0.0, 0.0], "moment": [1.0, 1.0]}, "increase strictly"),
        ("table", TUBE, {"rotation": [0.0, 1.0]}, "moment: the law table needs more"),
        ("file", TUBE, {}, "text: the law file needs more"),
    ],
)
def test_what_cannot_be_is_refused(name, section, options, message):
    with pytest.raises(InputError, match=message):
        build_law(name, section, STEEL, **options)


def test_parabola_that_touches_nothing_is_refused():
    # walls so thick that the mechanism stays above the largest moment until they touch
    with pytest.raises(InputError, match="parabola"):
        build_law("kecman", RectangularTube(0.03, 0.09, 0.012), STEEL, start="parabola")
