"""Parameters that variants and sensitivities refuse."""

import pytest

from crumple.analysis import loads
from crumple.errors import InputError, Status
from crumple.multibody import Run, sensitivities, solve_variants

FRAME = """crumple: 1
materials: {steel: {grade: S355}}
sections: {tube: {type: square_tube, side: 40 mm, thickness: 2 mm}}
nodes: {root: [0 m, 0 m, 0 m], tip: [0.4 m, 0 m, 0 m]}
members:
  beam: {nodes: [root, tip], section: tube, material: steel, bars: {number: 3, law: constant}}
supports: {clamp: {node: root, fix: all}}
masses: {load: {node: tip, mass: 2 kg}}
initial_velocity: [{rotation: 2 rad/s, axis: [0, -1, 0]}]
analysis: {duration: 2 ms}
"""
STAGES = "stages: [{name: a, duration: 1 ms}, {name: b, duration: 1 ms, "
STAGES += "impulses: [{node: tip, impulse: [0 N*s, 0 N*s, 1 N*s]}]}]"


def run_of(text=FRAME):
    analysis = loads(text)
    return analysis.structure, Run(
        analysis.duration, analysis.output_interval, analysis.multibody, stages=analysis.stages
    )


def test_a_parameter_that_is_zero_needs_a_step():
    with pytest.raises(InputError, match="zero is not defined"):
        sensitivities(*run_of(), "gravity.2")
    assert sensitivities(*run_of(), {"gravity.2": 0.1}).status is Status.COMPLETE


@pytest.mark.parametrize("kernel", ["tree", "spatial"])
@pytest.mark.parametrize("steps", [{"gravity": 0.0}, {"gravity": 1.0}, {"gravity": float("nan")}])
def test_the_step_of_a_factor_is_a_share_of_it(steps, kernel):
    text = FRAME.replace("duration: 2 ms", f"duration: 2 ms, multibody: {{kernel: {kernel}}}")
    with pytest.raises(InputError, match="step of this parameter is out of range"):
        sensitivities(*run_of(text), steps)


def test_a_step_that_rounding_swallows_is_refused():
    # its derivative would be zero
    with pytest.raises(InputError, match="step of this parameter is out of range"):
        sensitivities(*run_of(), {"masses.load.mass": 1e-20})


def test_a_number_of_bars_is_no_parameter():
    with pytest.raises(InputError, match="a whole number is needed"):
        sensitivities(*run_of(), {"members.beam.bars.number": 1.0})
    table = solve_variants(*run_of(), {"members.beam.bars.number": [3, 2]})
    assert table.status == (Status.REFUSED, Status.REFUSED)


def test_what_a_later_stage_adds_to_moved_bodies_is_refused():
    text = FRAME.replace("duration: 2 ms", STAGES)
    with pytest.raises(InputError, match="what a later stage adds"):
        solve_variants(*run_of(text), {"masses.load.mass": [2.0]})
