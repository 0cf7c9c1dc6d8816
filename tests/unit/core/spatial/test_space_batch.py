"""The spatial batch solves every variant with the bits of a single run, whatever the number of threads."""

from dataclasses import fields, replace
from operator import attrgetter

import numpy as np
import pytest
from tests.support.multibody.contact_models import ball_shape, plane, sphere
from tests.support.multibody.records import same
from tests.support.multibody.space_models import m4_parts

from crumple._core.outcome import Outcome
from crumple._core.records import EnergyRecord, HingeEnergyRecord
from crumple._core.spatial.batch import SpatialStage, StagedModel, solve_many
from crumple._core.spatial.model import SpatialLoad, SpatialModel
from crumple._core.spatial.simulation import SpatialSimulation, SpatialUntil, Until
from crumple._core.variants import Variants

COUNT, BODIES, HINGES, END = 9, 8, 12, 0.01
LOAD = SpatialLoad(
    6,
    np.array([0.25, 0.5, 0.5]),
    np.array([0.0, 0.0, -1.0]),
    np.zeros(3),
    np.array([0.0, END]),
    np.array([0.0, 4e3]),
)
ROWS = (
    "centre",
    "rotation",
    "velocity",
    *(f"hinge.{name}" for name in ("rotation", "plastic", "moment")),
    *(f"hinge_energy.{field.name}" for field in fields(HingeEnergyRecord)),
    *(f"energy.{field.name}" for field in fields(EnergyRecord)),
)


@pytest.fixture(scope="module")
def variants():
    """The loaded cube frame M4, two models of it in two stages, and everything varied."""
    model, velocity = m4_parts(error=1e-4)
    model = replace(model, loads=(LOAD,))
    softer = replace(
        model,
        hinges=tuple(
            replace(hinge, components=tuple(replace(c, rate_reference=50.0) for c in hinge.components))
            for hinge in model.hinges
        ),
    )
    stages = (SpatialStage(END), SpatialStage(END / 2))
    rng = np.random.default_rng(3)
    rows = np.array([(*b.centre, b.mass, *np.ravel(b.inertia)) for b in model.bodies])
    motion = np.zeros((COUNT, 2, BODIES, 6))
    motion[:, 0] = velocity * rng.uniform(0.5, 1.0, (COUNT, 1, 1))
    factor = np.ones((COUNT, BODIES, 13))
    factor[:, :, 3:] = rng.uniform(0.8, 1.2, (COUNT, BODIES, 1))
    bodies = rows * factor
    bodies[:, :, :3] += rng.uniform(-0.02, 0.02, (COUNT, BODIES, 3))
    return Variants(
        cases=(StagedModel(model, stages), StagedModel(softer, stages)),
        case_of=np.arange(COUNT) % 2,
        velocity=motion,
        impulse=rng.uniform(-1.0, 1.0, (COUNT, 2, BODIES, 6)) * [0.1, 0.1, 0.1, 1.0, 1.0, 1.0],
        capacity_scale=rng.uniform(0.8, 1.25, (COUNT, HINGES)),
        load_scale=rng.uniform(-1.0, 1.0, (COUNT, 1)),
        bodies=bodies,
        gravity=rng.uniform(-10.0, 10.0, (COUNT, 3)),
    )


@pytest.fixture(scope="module")
def ends(variants):
    return solve_many(variants)


def single(model, stages, motions):
    """Last records of a simulation by itself."""
    simulation = SpatialSimulation(model)
    lost = 0.0
    for stage, (velocity, impulse) in zip(stages, motions, strict=True):
        simulation.stage(quasi_static=stage.quasi_static, until=stage.until)
        lost += simulation.set_motion(velocity, impulse)
        record = simulation.run(np.array([simulation.time + stage.duration]))
    return lost, record


def test_same_bits_as_single_runs(variants):
    """Gravity, motion, stages and model varied."""
    plain = replace(variants, capacity_scale=None, load_scale=None, bodies=None)
    ends = solve_many(plain)
    assert set(ends.outcome) == {Outcome.COMPLETE}
    for row in (0, 5):
        case = variants.cases[variants.case_of[row]]
        model = replace(case.model, gravity=tuple(map(float, variants.gravity[row])))
        motions = zip(variants.velocity[row], variants.impulse[row], strict=True)
        lost, record = single(model, case.stages, motions)
        assert ends.lost[row] == lost
        assert ends.time[row] == record.time[-1]
        for name in ROWS:
            np.testing.assert_array_equal(
                attrgetter(name)(ends)[row], attrgetter(name)(record)[-1], err_msg=name
            )
        for name, column in vars(record.summary).items():
            np.testing.assert_array_equal(getattr(ends.summary, name)[row], column, err_msg=name)


def test_guided_variants_have_the_bits_of_runs_that_the_first_one_guides(variants):
    """Gravity, motion and stages varied; the first one keeps the bits of a run by itself."""
    plain = replace(variants, capacity_scale=None, load_scale=None, bodies=None)
    free, ends = solve_many(plain), solve_many(plain, guided=True, threads=2)
    assert set(ends.outcome) == {Outcome.COMPLETE}
    np.testing.assert_array_equal(ends.centre[0], free.centre[0])
    assert (ends.centre[1:] != free.centre[1:]).any()
    guide = None
    for row in (0, 5):
        case = variants.cases[variants.case_of[row]]
        simulation = SpatialSimulation(replace(case.model, gravity=tuple(map(float, variants.gravity[row]))))
        if guide is None:
            simulation.keep_guide()
            guide = simulation.guide
        else:
            simulation.be_guided_by(guide)
        for k, stage in enumerate(case.stages):
            simulation.stage(quasi_static=stage.quasi_static, until=stage.until)
            simulation.set_motion(variants.velocity[row, k], variants.impulse[row, k])
            record = simulation.run(np.array([simulation.time + stage.duration]))
        np.testing.assert_array_equal(ends.centre[row], record.centre[-1])
        np.testing.assert_array_equal(ends.velocity[row], record.velocity[-1])


def scaled(component, scale):
    """Component with both capacities multiplied."""
    curves = {name: getattr(component, name) for name in ("positive", "negative")}
    return replace(component, **{name: (x, scale * y) for name, (x, y) in curves.items()})


def test_factors_and_bodies_do_what_other_models_do(variants, ends):
    assert set(ends.outcome) == {Outcome.COMPLETE}
    for row in (1, 4):
        case = variants.cases[variants.case_of[row]]
        model = case.model
        bodies = tuple(
            replace(body, centre=given[:3], mass=float(given[3]), inertia=given[4:].reshape(3, 3))
            for body, given in zip(model.bodies, variants.bodies[row], strict=True)
        )
        hinges = tuple(
            replace(hinge, components=tuple(scaled(c, scale) for c in hinge.components))
            for hinge, scale in zip(model.hinges, variants.capacity_scale[row], strict=True)
        )
        loads = (replace(LOAD, values=LOAD.values * variants.load_scale[row, 0]),)
        gravity = tuple(map(float, variants.gravity[row]))
        other = replace(model, bodies=bodies, hinges=hinges, loads=loads, gravity=gravity)
        motions = zip(variants.velocity[row], variants.impulse[row], strict=True)
        _, record = single(other, case.stages, motions)
        for name in ("centre", "hinge.rotation", "hinge.plastic", "energy.kinetic", "energy.dissipated"):
            # products of the factors round otherwise, and Newton's method ends at 1e-9 of the moments
            expected = attrgetter(name)(record)[-1]
            apart = np.abs(attrgetter(name)(ends)[row] - expected)
            assert apart.max() < 1e-7 * np.abs(expected).max()


@pytest.mark.parametrize("threads", [2, 50])
def test_same_bits_from_any_number_of_threads(variants, ends, threads):
    assert same(ends, solve_many(variants, threads=threads))


def test_a_row_that_makes_no_sense_fails_alone(variants, ends):
    scale, bodies = variants.capacity_scale.copy(), variants.bodies.copy()
    velocity, gravity = variants.velocity.copy(), variants.gravity.copy()
    scale[1, 1], bodies[3, 0, 3], bodies[4, 1, 4] = -1.0, 0.0, -1.0
    velocity[6, 0, 0, 0], gravity[7, 1] = np.nan, np.inf
    broken = replace(variants, capacity_scale=scale, bodies=bodies, velocity=velocity, gravity=gravity)
    found = solve_many(broken, threads=2)
    wrong = [1, 3, 4, 6, 7]
    assert set(found.outcome[wrong]) == {Outcome.REFUSED}
    assert not found.centre[wrong].any()
    rest = np.setdiff1d(np.arange(COUNT), wrong)
    np.testing.assert_array_equal(found.centre[rest], ends.centre[rest])


def test_a_row_that_cannot_step_keeps_the_others(variants, ends):
    velocity = variants.velocity.copy()
    velocity[2] *= 1e150
    found = solve_many(replace(variants, velocity=velocity))
    assert found.outcome[2] in (Outcome.STEP_COLLAPSED, Outcome.NOT_FINITE)
    others = np.delete(np.arange(COUNT), 2)
    np.testing.assert_array_equal(found.energy.kinetic[others], ends.energy.kinetic[others])


def test_stages_end_on_conditions():
    """The ring is stopped by its columns' hinges when these have taken a given work."""
    model, velocity = m4_parts(error=1e-4)
    model = replace(model, loads=(LOAD,))
    until = (SpatialUntil(Until.WORK, 2.0),)
    stages = (SpatialStage(END, until=until), SpatialStage(END / 4))
    motion = np.zeros((2, 2, BODIES, 6))
    motion[0, 0] = velocity
    variants = Variants((StagedModel(model, stages),), np.zeros(2, np.int64), motion)
    found = solve_many(variants)
    motions = [(motion[0, k], np.zeros((BODIES, 6))) for k in range(2)]
    _, record = single(model, stages, motions)
    assert found.time[0] == record.time[-1] < 1.25 * END
    np.testing.assert_array_equal(found.centre[0], record.centre[-1])


def test_cancel_leaves_the_rest_undone(variants):
    shares = []

    def poll(share):
        shares.append(share)
        return share == 0.0

    many = replace(
        variants,
        case_of=np.zeros(500 * COUNT, np.int64),
        **{
            name: np.tile(getattr(variants, name), (500, *[1] * (getattr(variants, name).ndim - 1)))
            for name in ("velocity", "impulse", "capacity_scale", "load_scale", "bodies", "gravity")
        },
    )
    ends = solve_many(many, poll=poll)
    assert 0.0 < max(shares) < 1.0
    assert ends.outcome[-1] == Outcome.CANCELLED


def test_an_error_in_poll_comes_through(variants):
    def poll(share):
        raise RuntimeError("stop here")

    with pytest.raises(RuntimeError, match="stop here"):
        solve_many(replace(variants, cases=variants.cases[:1], case_of=np.zeros(COUNT, np.int64)), poll=poll)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"cases": ()}, "at least one model"),
        ({"case_of": np.full(COUNT, 2)}, "unknown model"),
        ({"gravity": np.zeros((COUNT, 2))}, "gravity must have shape"),
        ({"velocity": np.zeros((COUNT, 2, BODIES + 1, 6))}, "velocity must have shape"),
        ({"bodies": np.zeros((COUNT, BODIES, 4))}, "bodies must have shape"),
    ],
)
def test_arrays_of_other_shapes_are_refused(variants, change, message):
    with pytest.raises(ValueError, match=message):
        solve_many(replace(variants, **change))


def test_followers_of_runs_with_contact_are_refused():
    """Theirs would close at other times than the leader's, whose rates do not fit them then."""
    model = SpatialModel((sphere((0, 0, 0.3)),), capsules=(ball_shape(0, (0, 0, 0.3)),), obstacles=(plane(),))
    two = Variants((StagedModel(model, (SpatialStage(0.1),)),), np.zeros(2, np.int64))
    assert set(solve_many(two).outcome) == {Outcome.COMPLETE}
    with pytest.raises(ValueError, match="contact"):
        solve_many(two, led=True)


def test_models_that_differ_in_kind_are_refused(variants):
    case = variants.cases[0]
    fewer = replace(case, model=replace(case.model, hinges=case.model.hinges[1:]))
    with pytest.raises(ValueError, match="same bodies"):
        solve_many(replace(variants, cases=(case, fewer)))
    with pytest.raises(ValueError, match="must last"):
        solve_many(replace(variants, cases=(replace(case, stages=(SpatialStage(0.0),)),)))
