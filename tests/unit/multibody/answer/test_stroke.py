"""Shortening at which the folds of a hinge close: that of its law, before its stop."""

import pytest

from crumple.hinge import Freedom
from crumple.multibody.answer.crush import _stroke
from crumple.structure import Structure, placed_hinges

LENGTH, PEAK = 0.4, 9e4
SWIFT = {"type": "swift", "prestrain": 0.008, "exponent": 0.16}


def slip(axial, hardening=None, coupling="section"):
    """The axial component of a hinge in the middle of a square tube."""
    steel = {"youngs_modulus": 210e9, "poissons_ratio": 0.3, "density": 7850.0, "yield_stress": 280e6}
    hinge = {"name": "h", "at": LENGTH / 2.0, "axes": ("y", "z"), "axial": axial, "coupling": coupling}
    structure = Structure(
        materials={"steel": steel | ({"hardening": hardening} if hardening else {})},
        sections={"tube": {"type": "square_tube", "side": 0.04, "thickness": 0.002}},
        nodes={"a": (0.0, 0.0, 0.0), "b": (LENGTH, 0.0, 0.0)},
        members={"ab": {"nodes": ("a", "b"), "section": "tube", "material": "steel", "hinges": [hinge]}},
        supports={"clamp": {"node": "a", "fix": "all"}},
    )
    spatial = placed_hinges(structure)[0].spatial
    return spatial.components[spatial.freedoms.index(Freedom.AXIAL)]


@pytest.mark.parametrize("coupling", ["section", "none"])
@pytest.mark.parametrize("hardening", [None, SWIFT])
def test_folds_of_a_law_close_before_they_are_solid(hardening, coupling):
    found = slip({"law": "square"}, hardening, coupling)
    stop = found.record.stop_negative.rotation
    # what yields along the member before it folds comes first, in both
    before = stop - 0.9 * LENGTH
    assert before == pytest.approx(0.0, abs=1e-12) if hardening is None else before > 1e-3
    assert _stroke(found) == pytest.approx(before + 0.73 * LENGTH, rel=1e-9)


def test_a_given_stroke_is_that_of_its_stop_and_what_yields_has_none():
    given = slip({"peak": PEAK, "mean": 3e4, "stroke": 0.2})
    assert _stroke(given) == pytest.approx(0.2)
    assert _stroke(slip(True)) is None
