"""The batch solves every variant with the bits of a single run, whatever the number of threads."""

from dataclasses import replace
from operator import attrgetter

import numpy as np
import pytest
from tests.support.multibody.chains import m2
from tests.support.multibody.records import columns, same

from crumple._core.outcome import Outcome
from crumple._core.planar.batch import solve_many
from crumple._core.planar.simulation import Simulation, TreeLoad
from crumple._core.variants import Variants

COUNT, BARS, END = 40, 4, 0.05
NEVER = ("summary.opening_time", "summary.fracture")
"""Columns that the planar kernel leaves without numbers."""
LOAD = TreeLoad(3, (0.1, 0.0), (0.0, 0.0, 1.0), np.array([0.0, END]), np.array([0.0, 400.0]))


@pytest.fixture(scope="module")
def variants():
    """A loaded chain, two models of it, and everything varied."""
    model = replace(m2(BARS).model, loads=(LOAD,))
    softer = replace(model, hinges=tuple(replace(hinge, rate_reference=50.0) for hinge in model.hinges))
    rng = np.random.default_rng(3)
    rows = np.array([(*body.centre, body.mass, body.inertia) for body in model.bodies])
    return Variants(
        cases=(model, softer),
        case_of=np.arange(COUNT) % 2,
        velocity=rng.uniform(0.0, 4.0, (COUNT, BARS, 3)),
        impulse=rng.uniform(0.0, 1.0, (COUNT, BARS, 3)),
        capacity_scale=rng.uniform(0.5, 2.0, (COUNT, BARS)),
        load_scale=rng.uniform(-1.0, 1.0, (COUNT, 1)),
        bodies=rows * rng.uniform(0.8, 1.2, (COUNT, BARS, 4)),
        gravity=rng.uniform(-10.0, 10.0, (COUNT, 2)),
    )


def test_same_bits_as_single_runs(variants):
    ends = solve_many(variants, END)
    assert set(ends.outcome) == {Outcome.COMPLETE}
    for row in range(0, COUNT, 7):
        model = variants.cases[variants.case_of[row]]
        bodies = tuple(
            replace(body, centre=(float(x), float(y)), mass=float(mass), inertia=float(inertia))
            for body, (x, y, mass, inertia) in zip(model.bodies, variants.bodies[row], strict=True)
        )
        hinges = tuple(
            replace(hinge, capacity_scale=float(scale))
            for hinge, scale in zip(model.hinges, variants.capacity_scale[row], strict=True)
        )
        load = replace(LOAD, values=LOAD.values * variants.load_scale[row, 0])
        gravity = tuple(map(float, variants.gravity[row]))
        single = Simulation(replace(model, bodies=bodies, hinges=hinges, gravity=gravity, loads=(load,)))
        lost = single.set_motion(variants.velocity[row], variants.impulse[row])
        record = single.run(np.array([END]))
        assert ends.lost[row] == lost
        assert ends.steps[row] == record.steps
        for name in ("pose", "hinge.moment", "hinge.plastic", "hinge_energy.dissipated", "velocity"):
            # a scaled load rounds otherwise than scaled values of it
            np.testing.assert_allclose(
                attrgetter(name)(ends)[row], attrgetter(name)(record)[0], rtol=1e-12, atol=1e-12
            )
        unloaded = Variants(
            variants.cases, variants.case_of, variants.velocity, load_scale=np.zeros((COUNT, 1))
        )
        assert row or same_as_single(unloaded, model)


def same_as_single(unloaded, model):
    """The first row of variants without load, bit by bit."""
    single = Simulation(replace(model, loads=()))
    single.set_motion(unloaded.velocity[0], np.zeros((BARS, 3)))
    single.run(np.array([END]))
    ends = solve_many(unloaded, END)
    return np.array_equal(ends.q[0], single.q) and np.array_equal(ends.w[0], single.w)


@pytest.mark.parametrize("threads", [2, 3, 100])
def test_same_bits_from_any_number_of_threads(variants, threads):
    assert same(solve_many(variants, END), solve_many(variants, END, threads=threads))


def test_a_row_that_makes_no_sense_fails_alone(variants):
    scale, bodies = variants.capacity_scale.copy(), variants.bodies.copy()
    velocity, gravity = variants.velocity.copy(), variants.gravity.copy()
    scale[3, 1], bodies[5, 0, 2], velocity[7, 0, 0], gravity[9, 1] = -1.0, 0.0, np.nan, np.inf
    broken = replace(variants, capacity_scale=scale, bodies=bodies, velocity=velocity, gravity=gravity)
    sound, found = solve_many(variants, END), solve_many(broken, END, threads=2)
    wrong = [3, 5, 7, 9]
    assert set(found.outcome[wrong]) == {Outcome.REFUSED}
    assert not found.q[wrong].any()
    rest = np.setdiff1d(np.arange(COUNT), wrong)
    np.testing.assert_array_equal(found.q[rest], sound.q[rest])
    assert all(np.isfinite(column).all() for name, column in columns(found) if not name.startswith(NEVER))


def test_a_row_that_cannot_step_keeps_what_it_had(variants):
    ends = solve_many(replace(variants, velocity=variants.velocity * 1e150), END)
    assert Outcome.COMPLETE not in ends.outcome
    assert np.isfinite(ends.q).all()


def test_cancel_leaves_the_rest_undone(variants):
    shares = []

    def poll(share):
        shares.append(share)
        return share == 0.0

    many = Variants(variants.cases, np.zeros(20_000, np.int64), np.tile(variants.velocity, (500, 1, 1)))
    ends = solve_many(many, END, poll=poll)
    assert 0.0 < max(shares) < 1.0
    assert ends.outcome[-1] == Outcome.CANCELLED
    assert (ends.outcome == Outcome.COMPLETE).any()


def test_an_error_in_poll_comes_through(variants):
    def poll(share):
        raise RuntimeError("stop here")

    many = Variants(variants.cases, np.zeros(20_000, np.int64), np.tile(variants.velocity, (500, 1, 1)))
    with pytest.raises(RuntimeError, match="stop here"):
        solve_many(many, END, poll=poll)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"cases": ()}, "at least one model"),
        ({"case_of": np.full(COUNT, 2)}, "unknown model"),
        ({"gravity": np.zeros((COUNT, 3))}, "gravity must have shape"),
        ({"velocity": np.zeros((COUNT, BARS + 1, 3))}, "velocity must have shape"),
        ({"cases": (m2(BARS).model, m2(BARS + 1).model)}, "same bodies"),
    ],
)
def test_arrays_of_other_shapes_are_refused(variants, change, message):
    with pytest.raises(ValueError, match=message):
        solve_many(replace(variants, **change), END)
