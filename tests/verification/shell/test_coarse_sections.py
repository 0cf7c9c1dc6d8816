"""Sections with fewer elements away from the fold give the result of the same mesh without them.

Example 01 with 5 mm to 83 mm from the root, then growing by 1.2 to 25 mm.  Where the elements are longer
than 10 mm they may be 9 mm wide too, with triangles in between.  Tolerance: 3 % of rotation and plastic
energy, as for grading itself.

Kind: invariant.  Source: derived here.
"""

import numpy as np
import pytest

from crumple.analysis import load
from crumple.shell import ShellRun, solve_shell
from crumple.structure import ShellSettings

GRADED = ShellSettings(element_size=25e-3, fine_size=5e-3, fine_length=60e-3, growth=1.2)


@pytest.fixture(scope="module")
def results():
    analysis = load("examples/01_tube_bending.yaml")
    return [
        solve_shell(
            analysis.structure,
            ShellRun(
                analysis.duration, 5e-4, GRADED.model_copy(update={"coarse_sections": word}), analysis.outputs
            ),
        )
        for word in ("off", "on")
    ]


@pytest.mark.slow
def test_coarser_sections_change_little(results, record_figure):
    turned = [
        np.arctan2(result["node.tip.displacement.z"], 1.0 + result["node.tip.displacement.x"]).max()
        for result in results
    ]
    record_figure("largest tip rotation", turned[1], turned[0], 0.03, "rad", relative=True)
    plastic = [result["energy.dissipated"][-1] for result in results]
    record_figure("plastic energy", plastic[1], plastic[0], 0.03, "J", relative=True)
    peak = [np.abs(result["support.clamp.moment.y"]).max() for result in results]
    record_figure("peak root moment", peak[1], peak[0], 0.03, "N m", relative=True)


@pytest.mark.slow
def test_fewer_elements_and_a_run_to_be_believed(results, record_figure):
    numbers = [result.provenance.settings["elements"] for result in results]
    record_figure("elements over those without", numbers[1] / numbers[0], 0.70, 0.03)
    record_figure("energy residual", results[1].energy_residual, 0.0, 1e-2)
    internal = (results[1]["energy.elastic"] + results[1]["energy.dissipated"]).max()
    record_figure("hourglass share", results[1]["energy.hourglass"].max() / internal, 0.0, 0.05)
    assert not results[1].warnings
    assert results[1].provenance.settings["triangles"] == 42
