"""Both engines from one analysis: what is solved beside them, and what is left out once someone cancels."""

import numpy as np
import pytest
from tests.support.result.folded_tube import EXAMPLE

from crumple.analysis import loads
from crumple.comparison import solving, with_frames
from crumple.comparison.solving import mesh_name, solve_and_compare, with_mesh
from crumple.errors import CancelledError, Status
from crumple.hinge.record import recording
from crumple.multibody.timing import REPEATS

TEXT = (
    EXAMPLE.read_text()
    .replace("duration: 100 ms", "duration: 2 ms\n  shell: {element_size: 24 mm}")
    .replace("[0 ms, 20 ms, 40 ms, 60 ms, 80 ms, 100 ms]", "[0 ms]")
)
MODELS = ["elastic hinges", "elastic members", "laws of the shells"]


@pytest.fixture(scope="module", name="case")
def _case():
    return loads(TEXT)


def test_every_multibody_model_is_timed(case):
    found = solve_and_compare(case)
    names = [source.name for source in found.variants]
    assert names
    assert set(names) <= set(MODELS)
    assert set(found.timings) == {"multibody", *names}
    assert all(timing.stepping > 0.0 and timing.again > 0.0 for timing in found.timings.values())


def test_timed_solves_sample_their_laws_anew(case, monkeypatch):
    sampled = []
    envelope = recording.sampled_envelope
    monkeypatch.setattr(
        recording, "sampled_envelope", lambda law, *rest: sampled.append(law) or envelope(law, *rest)
    )
    monkeypatch.setattr("crumple.multibody.timing.LONG", 1e9)
    solve_and_compare(case, variants=False)
    assert len(sampled) >= REPEATS


@pytest.mark.parametrize(("below", "known"), [(1e9, True), (0.0, False)])
def test_models_that_are_too_slow_to_be_timed_have_their_range(case, monkeypatch, below, known):
    monkeypatch.setattr(solving, "TIMED_BELOW", 0.0)
    monkeypatch.setattr(solving, "RANGED_BELOW", below)
    found = solve_and_compare(case)
    assert (found.candidate.result.law_range is not None) == known
    assert found.timings == {}


def test_cancelled_after_the_shell_run_nothing_more_is_solved(case):
    shares = []
    found = solve_and_compare(
        case, second_mesh=1.5, progress=shares.append, cancel=lambda: bool(shares) and shares[-1] >= 1.0
    )
    assert found.candidate.result.status is found.reference.result.status is Status.COMPLETE
    assert found.variants == ()
    assert found.timings == {}


def test_a_result_is_compared_although_the_runs_beside_it_are_stopped(case, monkeypatch):
    def stopped(*_, **__):
        raise CancelledError("cancelled while the variants were solved")

    monkeypatch.setattr("crumple.comparison.solving.with_law_range", stopped)
    monkeypatch.setattr("crumple.comparison.solving.with_modes", stopped)
    found = solve_and_compare(case)
    assert found.candidate.result.law_range is found.candidate.result.modes is None
    assert found.candidate.result.status is Status.COMPLETE


def test_without_cancelling_the_second_mesh_is_there(case):
    found = solve_and_compare(case, variants=False, second_mesh=1.5)
    assert [source.name for source in found.variants] == [mesh_name(with_mesh(case, 1.5))]


def test_pictures_a_rounding_from_even_times_are_no_second_shapes(case):
    asked = (0.1e-3 * (1 + 1e-13), 1.01e-3)
    outputs = case.outputs.model_copy(update={"pictures": asked})
    pictures = with_frames(case.model_copy(update={"outputs": outputs}), 21).outputs.pictures
    assert set(asked) <= set(pictures)
    assert len(pictures) == 22
    assert np.diff(pictures).min() > 1e-6
