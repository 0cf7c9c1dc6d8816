"""Motion that a later stage adds acts on the bodies in their present position: a free bar in flight.

Kind: closed form.  Source: derived here.
"""

import numpy as np
import pytest
from tests.support.structures import STEEL, TUBE

from crumple.errors import InputError
from crumple.multibody import Run, solve_multibody, solve_variants
from crumple.structure import Outputs, Stage, Structure

SPIN, QUARTER = 10.0, np.pi / 20.0
THROWN = {"rotation": SPIN, "axis": (0.0, 0.0, 1.0), "about": (0.5, 0.0, 0.0), "translation": (0.0, 0.0, 3.0)}
HERE = (0.5, -0.5, 3.0 * QUARTER)
"""Where the root lies after a quarter turn: the bar points along y."""


def bar():
    return Structure(
        materials={"steel": STEEL},
        sections={"tube": TUBE},
        nodes={"root": (0, 0, 0), "tip": (1, 0, 0)},
        members={"bar": {"nodes": ("root", "tip"), "section": "tube", "material": "steel"}},
        initial_velocity=[THROWN],
    )


def run(**added):
    stages = (Stage(name="fly", duration=QUARTER), Stage(name="on", duration=0.01, **added))
    return Run(QUARTER + 0.01, 0.001, outputs=Outputs(nodes=("root", "tip")), stages=stages)


def after(**added):
    """Result, and just after the stage began: velocity of the middle, and spin about z."""
    result = solve_multibody(bar(), run(**added))
    assert result.status.ok, result.reason
    assert not any("lost" in warning for warning in result.warnings)
    root, tip = (
        np.array([result[f"node.{node}.velocity.{axis}"][-1] for axis in "xyz"]) for node in ("root", "tip")
    )
    apart = np.array([1.0, 0, 0]) + [
        result[f"node.tip.displacement.{axis}"][-1] - result[f"node.root.displacement.{axis}"][-1]
        for axis in "xyz"
    ]
    return result, (root + tip) / 2.0, float(np.cross(apart, tip - root)[2])


@pytest.mark.parametrize("members", [None, ("bar",)])
def test_a_rotation_is_about_its_axis_as_the_bar_lies_now(members):
    field = {"rotation": 4.0, "axis": (1.0, 0.0, 0.0), "about": HERE, "members": members}
    # the bar lies along y: a field about x through its root lifts its middle by 4 * 0.5
    _, middle, spin = after(initial_velocity=[field])
    np.testing.assert_allclose(middle, (0.0, 0.0, 5.0), atol=1e-6)
    field = {"rotation": 4.0, "axis": (0.0, 0.0, 1.0), "about": HERE, "members": members}
    _, middle, spin = after(initial_velocity=[field])
    np.testing.assert_allclose(middle, (-2.0, 0.0, 3.0), atol=1e-6)
    assert spin == pytest.approx(SPIN + 4.0, rel=1e-6)


def test_an_impulse_acts_at_the_node_as_it_lies_now():
    result, middle, spin = after(impulses=[{"node": "tip", "impulse": (8.0, 0.0, 0.0)}])
    structure = bar()
    mass = structure.section_of("bar").mass_per_length(structure.material_of("bar").density)
    inertia = (2.0 * result["energy.kinetic"][0] - mass * 9.0) / SPIN**2
    np.testing.assert_allclose(middle, (8.0 / mass, 0.0, 3.0), atol=1e-6)
    assert spin == pytest.approx(SPIN - 0.5 * 8.0 / inertia, rel=1e-6)


def test_variants_refuse_what_they_would_take_from_the_start():
    field = {"rotation": 4.0, "axis": (0.0, 0.0, 1.0)}
    for added in ({"initial_velocity": [field]}, {"impulses": [{"node": "tip", "impulse": (8.0, 0.0, 0.0)}]}):
        with pytest.raises(InputError, match="later stage") as error:
            solve_variants(bar(), run(**added), {"initial_velocity": [1.0]})
        assert error.value.problems[0].where == f"analysis.stages[1].{next(iter(added))}"
    whole = {"initial_velocity": [{"translation": (0.0, 5.0, 0.0)}]}
    table = solve_variants(bar(), run(**whole), {"gravity": [1.0]})
    result, *_ = after(**whole)
    assert table["node.tip.displacement.y"][0] == pytest.approx(
        result["node.tip.displacement.y"][-1], rel=1e-6
    )
