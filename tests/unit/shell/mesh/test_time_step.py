"""Which element sets the first time step."""

import numpy as np
import pytest
from tests.support.shell.structures import cantilever, knee, tee, thrown

from crumple._core.shell.simulation import ShellState
from crumple.errors import InputError
from crumple.shell import ShellRun, lower
from crumple.shell.mesh.time_step import stable_steps
from crumple.shell.solve import start_notes
from crumple.structure import Outputs, ShellSettings, Stage

COARSE = ShellSettings(element_size=24e-3)
STAGE = Stage(name="run", duration=1e-3)


@pytest.mark.parametrize("whole", [cantilever(), knee(), tee(), thrown()])
def test_the_least_of_all_elements_is_the_step_of_the_kernel(whole):
    model = lower(whole, COARSE, Outputs(), stage=STAGE).model
    steps = stable_steps(model)
    assert steps.shape == (len(model.elements),)
    assert model.settings.safety * steps.min() == pytest.approx(ShellState(model).first_time_step, rel=1e-12)


def test_the_member_that_sets_the_step_is_named():
    whole = thrown()
    case = lower(whole, COARSE, Outputs(), stage=STAGE)
    mesh = start_notes(whole, ShellRun(1e-3, 1e-4, COARSE))[0]
    place = case.mesh.place_of(int(np.argmin(stable_steps(case.model))))
    assert f"the least that an element allows ({place}, its smallest side " in mesh
    assert place.startswith("member tube, ")
    # with mass added, no element does
    heavy = COARSE.model_copy(update={"mass_scaling": 1e-5})
    assert "the least that" not in start_notes(whole, ShellRun(1e-3, 1e-4, heavy))[0]


def test_a_least_step_that_an_element_does_not_allow_is_refused_with_its_place():
    long = COARSE.model_copy(update={"minimum_time_step": 1e-4})
    with pytest.raises(InputError, match=r"below the minimum time step \(member tube, .* smallest side"):
        start_notes(thrown(), ShellRun(1e-3, 1e-4, long))
