"""Hinges that break are reported: time, moment, and remaining resistance."""

import math
import re

import numpy as np
import pytest
from tests.support.structures import STEEL, TUBE, constant_law

from crumple.multibody import Run, solve_multibody
from crumple.report.wording.wording import collapse_table
from crumple.result import summary
from crumple.structure import Structure

MOMENT, ANGLE = 800.0, math.radians(10.0)


def thrown(number=1, form="set-valued", fracture="10 deg", **keys):
    """Cantilevers of one hinge each, their tips thrown down."""
    law = constant_law(MOMENT, form=form, **({"elastic_stiffness": 5e4} if form == "elastic-plastic" else {}))
    nodes, members, supports, motion = {}, {}, {}, []
    for i in range(number):
        nodes |= {f"r{i}": (0.0, float(i), 0.0), f"t{i}": (1.0, float(i), 0.0)}
        hinge = {"name": f"h{i}", "at": 0.02, "law": law, "fracture": fracture, **keys}
        members[f"m{i}"] = {
            "nodes": (f"r{i}", f"t{i}"),
            "section": "tube",
            "material": "steel",
            "hinges": [hinge],
        }
        supports[f"s{i}"] = {"node": f"r{i}", "fix": "all"}
        motion.append({"node": f"t{i}", "impulse": (0.0, 0.0, -(30.0 + i))})
    return Structure(
        materials={"steel": STEEL},
        sections={"tube": TUBE},
        nodes=nodes,
        members=members,
        supports=supports,
        impulses=motion,
    )


@pytest.mark.parametrize("form", ["set-valued", "elastic-plastic"])
def test_a_broken_hinge_is_reported_with_time_rotation_and_moment(form):
    result = solve_multibody(thrown(form=form, axes=["y"]), Run(0.03, 1e-4))
    assert result.status.ok, result.reason
    hinge = result.hinges["h0"]
    # the time is that of the history's passing the angle, the moment that of the law
    turned = np.abs(result["hinge.h0.plastic_rotation"])
    passed = np.interp(ANGLE, turned[: turned.argmax()], result.time[: turned.argmax()])
    assert 0.0 < hinge.fracture_time < 0.03
    assert hinge.fracture_time == pytest.approx(passed, abs=1e-4)
    assert hinge.fracture_moment == pytest.approx(MOMENT, rel=1e-3)
    reported = [text for text in result.warnings if "broke" in text]
    assert len(reported) == 1
    when = float(re.search(r"broke at ([\d.]+) ms", reported[0])[1])
    assert when == pytest.approx(1e3 * hinge.fracture_time, rel=1e-3)
    assert "10 deg under 800 N m. Since then it rotates freely about y, and does not separate." in reported[0]
    assert any("Results after a fracture are uncertain" in text for text in result.warnings)
    # in the collapse log, the files and the report's table too
    assert result.collapse[0].broke == hinge.fracture_time
    assert summary(result)["hinges"]["h0"]["fracture_time"] == hinge.fracture_time
    assert collapse_table(result).heads[-1].startswith("Broke at")
    # nothing is left of its moment
    assert np.abs(result["hinge.h0.moment"][result.time > hinge.fracture_time + 1e-3]).max() == 0.0


def test_intact_hinges_are_not_reported():
    result = solve_multibody(thrown(fracture="170 deg"), Run(0.03, 1e-3))
    assert result.hinges["h0"].fracture_time is None
    assert result.hinges["h0"].fracture_moment is None
    assert not any("broke" in text or "break" in text for text in result.warnings)
    assert len(collapse_table(result).heads) == 5


def test_many_are_counted_in_the_order_of_their_times():
    result = solve_multibody(thrown(8, axes=["y", "z"], coupling="ellipsoid"), Run(0.03, 1e-3))
    reported = [text for text in result.warnings if "broke" in text]
    # the one thrown hardest breaks first
    assert [text.split()[1] for text in reported[:6]] == ["h7", "h6", "h5", "h4", "h3", "h2"]
    assert "rotates freely about y and z" in reported[0]
    assert reported[6].startswith("2 further hinges broke")
