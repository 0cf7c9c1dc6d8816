"""Numbers to explore are found by their names, and every point of the grid is a run of its own."""

import re
from pathlib import Path

import numpy as np
import pytest

from crumple.analysis import load_input, solve
from crumple.analysis.explore import explore, sliders_of
from crumple.errors import InputError
from crumple.structure import changed

EXAMPLES = Path(__file__).parents[3] / "examples"
TUBE = load_input(EXAMPLES / "01_tube_bending.yaml")
RAILS = load_input(EXAMPLES / "11_front_rails.yaml")


def named(wanted, source=TUBE):
    return sliders_of(wanted, source.analysis, source.document.data)


def test_a_number_is_named_by_its_key_and_ranges_about_its_value():
    thickness, mass = named("thickness, mass")
    assert (thickness.path, thickness.unit, len(thickness.values)) == ("sections.tube.thickness", "mm", 5)
    assert thickness.values[::2] == pytest.approx((0.7 * 2.65e-3, 2.65e-3, 1.3 * 2.65e-3))
    assert mass.path == "masses.payload.mass"
    (alone,) = named("thickness")
    assert len(alone.values) == 9


def test_a_range_has_units():
    (slider,) = named("sections.tube.thickness=0.2 cm..3 mm")
    assert (slider.values[0], slider.values[-1]) == pytest.approx((2e-3, 3e-3))
    assert slider.factor == 1e-3


@pytest.mark.parametrize(
    ("wanted", "source", "said"),
    [
        ("thickness", RAILS, "several such numbers.*sections.rail.thickness, sections.frame.thickness"),
        ("thicknes", TUBE, "no such number.*sections.tube.thickness"),
        ("duration", TUBE, "no such number"),
        ("mass,mass", TUBE, "named twice"),
        ("mass,thickness,width", TUBE, "one or two numbers"),
        ("", TUBE, "one or two numbers"),
        ("mass=1 kg", TUBE, "not a range"),
        ("mass=1 kg..1 kg", TUBE, "no width"),
        ("mass=1 kg..5 mm", TUBE, "mm"),
        ("mass=1..5", TUBE, "not a value of the number.*2 kg"),
        ("masses.car.offset.1", RAILS, "no width"),
    ],
)
def test_what_cannot_be_explored_is_refused(wanted, source, said):
    with pytest.raises(InputError) as refusal:
        named(wanted, source)
    assert re.search(said, str(refusal.value), flags=re.DOTALL)


def test_every_point_is_a_run_of_its_own():
    sliders = named("thickness,mass")
    shares = []
    points = explore(TUBE.analysis, sliders, shares.append)
    assert len(points) == 25
    assert shares[-1] == 1.0
    # the last number changes fastest
    assert points[1].values == (sliders[0].values[0], sliders[1].values[1])
    np.testing.assert_allclose(
        points[12].result["hinge.root.rotation"],
        solve(TUBE.analysis)["hinge.root.rotation"],
        rtol=1e-9,
        atol=1e-12,
    )
    structure = changed(TUBE.analysis.structure, {s.path: s.values[0] for s in sliders})
    alone = solve(TUBE.analysis.model_copy(update={"structure": structure}))
    np.testing.assert_array_equal(points[0].result["hinge.root.rotation"], alone["hinge.root.rotation"])


def test_a_refused_point_has_its_reason():
    points = explore(TUBE.analysis, named("thickness=2 mm..14 mm"))
    assert points[0].reason == ""
    assert points[-1].result is None
    assert "the wall is not thinner" in points[-1].reason


def test_a_cancelled_grid_has_reasons():
    points = explore(RAILS.analysis, named("sections.rail.thickness", RAILS), cancel=lambda: True)
    assert all(point.reason for point in points)
