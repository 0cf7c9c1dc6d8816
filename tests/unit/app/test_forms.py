"""Forms show sections and laws as they are used; bands of curves hold the runs at the edges of the laws."""

import numpy as np
import pytest

pytest.importorskip("starlette")

from crumple.analysis import loads, solve
from crumple.app.answer import Answering, Job
from crumple.app.forms import forms_of
from crumple.app.start_texts import start_text
from crumple.hinge import ScaledLaw
from crumple.report.figures.law_figure import law_figure
from crumple.structure import plastic_hinges

TUBE = start_text("tube_bending")


def asked(text, *kinds):
    answering = Answering()
    (answer, *found) = (
        answering(Job(kind, (("tube.yaml", text),)), lambda share: True, lambda: False)
        for kind in ("solve", *kinds)
    )
    assert answer["problems"] == []
    return answer, *found


def test_a_section_has_its_drawing_capacities_and_the_laws_of_its_hinges():
    forms = forms_of(loads(start_text("bus_ring")).structure)
    assert [form["path"] for form in forms] == ["sections.post", "sections.roof", "sections.floor"]
    post, _, floor = forms
    assert post["drawing"].startswith("<svg")
    rows = dict(post["rows"])
    # sharp corners: 60^2 - 54^2 mm^2, times 355 MPa
    assert rows["Area"] == "684 mm²"
    assert rows["Squash force"] == "242.8 kN"
    assert post["curves"][0]["caption"].startswith("Kecman-type mechanism")
    assert floor["curves"] == []


def test_a_named_law_shows_the_curves_of_the_hinges_that_have_it():
    text = (
        TUBE.replace("law: kecman", "law: own")
        + "hinge_laws:\n  own: {type: constant}\n  idle: {type: kecman}\n"
    )
    forms = {form["path"]: form for form in forms_of(loads(text).structure)}
    assert list(forms) == ["sections.tube", "hinge_laws.own", "hinge_laws.idle"]
    assert len(forms["hinge_laws.own"]["curves"]) == len(forms["sections.tube"]["curves"]) == 1
    assert "band not known" in forms["hinge_laws.own"]["curves"][0]["caption"]
    assert forms["hinge_laws.idle"]["curves"] == []


def test_bands_of_curves_are_the_runs_with_scaled_laws():
    answer, message = asked(TUBE, "bands")
    bands = message["bands"]
    assert (bands["laws"], bands["without"], bands["failed"]) == (1, 0, 0)
    band = next(one for one in bands["curves"] if one["name"] == "hinge.root.rotation")
    curve = next(one for one in answer["curves"]["all"] if one["name"] == "hinge.root.rotation")
    assert band["unit"] == curve["unit"] == "deg"
    low, middle, high = np.array(band["low"]), np.array(curve["values"][0]), np.array(band["high"])
    assert (low <= middle).all()
    assert (middle <= high).all()
    # a table with the law at the edge of its band, scaled by hand
    (hinge,) = plastic_hinges(loads(TUBE).structure)
    turned = np.radians(np.linspace(0.0, 90.0, 400))
    width = hinge.law.validity.uncertainty
    assert 0.1 < width < 0.3
    for factor, edge in ((1.0 - width, low), (1.0 + width, high)):
        moments = ScaledLaw(hinge.law, factor).moment_capacity(turned)
        curve = f"rotation: {turned.tolist()}, moment: {moments.tolist()}"
        law = f"{{type: table, units: {{rotation: rad, moment: N*m}}, {curve}}}"
        result = solve(loads(TUBE.replace("law: kecman", f"law: {law}")))
        assert np.degrees(result["hinge.root.rotation"][-1]) == pytest.approx(edge[-1], rel=2e-3)


def test_without_known_bands_there_are_none():
    # corners that are too wide for the library
    _, message = asked(start_text("portal_frame").replace("radius: 6 mm", "radius: 10 mm"), "bands")
    assert message["bands"] is None
    assert Answering()(Job("bands"), lambda share: True, lambda: False)["bands"] is None


def test_the_figure_of_a_law_has_its_band_and_the_end_of_its_range():
    (hinge,) = plastic_hinges(loads(TUBE).structure)
    drawn = law_figure(hinge.law, "law", "tube about y")
    assert "Capacity of tube about y" in drawn
    plain = law_figure(ScaledLaw(hinge.law, 1.0), "law", "tube about y")
    # one polygon more than without the band
    assert drawn.count("FillBetween") == plain.count("FillBetween") + 1
