"""A run that hardly advances ends, and says what its steps went into."""

import pytest
from tests.support.structures import STEEL

from crumple.errors import Status
from crumple.multibody import Run, solve_multibody
from crumple.structure import MultibodySettings, Structure


@pytest.mark.parametrize("kernel", ["tree", "spatial"])
def test_a_run_of_a_hundred_million_steps_is_not_begun(kernel):
    """1 s in steps of 10 ns: 10 000 of them are 0.01 % of it."""
    hammer = Structure(
        materials={"steel": STEEL},
        sections={"tube": {"type": "square_tube", "side": 0.05, "thickness": 0.003}},
        nodes={"a": (0, 0, 0), "b": (1, 0, 0)},
        members={
            "bar": {
                "nodes": ("a", "b"),
                "section": "tube",
                "material": "steel",
                "hinges": [{"name": "h", "at": 0.0, "axis": "y", "law": "plastic"}],
            }
        },
        hinge_laws={"plastic": {"type": "constant", "moment": 2e3}},
        supports={"clamp": {"node": "a", "fix": "all"}},
        initial_velocity=[{"nodes": ("b",), "translation": (0, 0, 5.0)}],
    )
    settings = MultibodySettings(kernel=kernel, maximum_time_step=1e-8)
    result = solve_multibody(hammer, Run(1.0, 0.1, settings))
    assert result.status is Status.STALLED
    assert result.reason.startswith("10000 steps in a row advanced the run by less than 0.1 % of its time")
    assert "accurate, but very short" in result.reason
    assert result.provenance.settings["steps"] == 10_000
