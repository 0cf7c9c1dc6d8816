"""Derivatives of final quantities equal closed forms and central differences (spatial kernel).

A wheel of inertia I that a hinge of moment M stops from the rate w0 rotates by I w0^2/(2 M) in the time I
w0/M; all derivatives follow.  The step in which it comes to rest is taken as a whole, so the relative error
of its derivatives is the share of this step in the motion, and not its square as for the values.

For the rest there is no closed form.  There the derivatives must be those of the discrete motion itself,
that is, of central differences of ordinary runs with the same steps (fixed by a loose accuracy and a
longest step), each solved by Newton's method from the beginning: the cube frame M4; an arm whose two hinges
bend about both axes and twist, in every form, softening and coupling, with stops, and until it breaks; a
four-bar linkage with three redundant constraints; loads and drives; two stages.  What comes before the
model, from section to law, is in `test_space_sensitivities_structure.py`.

Kind: closed form; independent calculation.  Source: derived here; derived here.
"""

from dataclasses import replace
from operator import attrgetter

import numpy as np
import pytest
from tests.support.multibody.chains import (
    ACCUMULATED,
    ELASTIC_PLASTIC,
    PEAK,
    REGULARISED,
    ROTATION,
    SET_VALUED,
    softening_law,
)
from tests.support.multibody.space_models import RX, RY, RZ, about, bar, component, m4_parts, with_mass

from crumple._core.outcome import Outcome
from crumple._core.spatial.batch import SpatialStage, StagedModel, solve_many
from crumple._core.spatial.model import (
    GROUND,
    Coupling,
    SpatialBody,
    SpatialDrive,
    SpatialHinge,
    SpatialJoint,
    SpatialLoad,
    SpatialModel,
    SpatialSurface,
    revolute,
    spherical,
)
from crumple._core.spatial.simulation import SpatialSimulation
from crumple._core.variants import Variants

LOOSE = 1e3
"""Accuracy that no step fails, so the longest step fixes all of them."""
LONGEST = 2e-4
FEW_DIGITS = ("velocity", "hinge.moment")
"""Moments of locked hinges that equilibrium does not determine, and rates of elastic ones."""
NEAR = 1e-5
"""By this share parameters are moved, for followers as for differences."""
FIELDS = (
    "centre",
    "rotation",
    "velocity",
    "hinge.rotation",
    "hinge.plastic",
    "hinge.moment",
    "hinge_energy.dissipated",
    "energy.kinetic",
    "energy.dissipated",
)


def runs(models, velocities, end, *, led, accuracy=LOOSE, longest=LONGEST, stages=None):
    """End values of models with velocities (bodies, 6) at the start."""
    stages = stages or (SpatialStage(end),)
    motion = np.zeros((len(models), len(stages), *np.shape(velocities[0])))
    motion[:, 0] = velocities
    variants = Variants(
        [StagedModel(model, stages) for model in models], np.arange(len(models)), velocity=motion
    )
    ends = solve_many(variants, accuracy, maximum_step=longest, led=led)
    assert set(ends.outcome) == {Outcome.COMPLETE}
    return ends


def flat(ends, row):
    return np.concatenate([np.ravel(attrgetter(name)(ends)[row]) for name in FIELDS])


def check(move, velocity, *, end=0.02, stages=None, name=None, record_figure=None):
    """The slope along `move` (a model for a small number) agrees with differences of runs by themselves."""
    models = [move(0.0), move(NEAR), move(-NEAR)]
    led = runs(models, [velocity] * 3, end, led=True, stages=stages)
    plain = runs(models, [velocity] * 3, end, led=False, stages=stages)
    np.testing.assert_array_equal(flat(led, 0), flat(plain, 0))
    assert (plain.steps == plain.steps[0]).all()
    parts = np.cumsum([np.ravel(attrgetter(field)(led)[0]).size for field in FIELDS])[:-1]
    scale = np.concatenate(
        [np.full(part.size, max(np.abs(part).max(), 1e-12)) for part in np.split(flat(led, 0), parts)]
    )
    slope, difference = (((flat(f, 1) - flat(f, 2)) / (2 * NEAR)) / scale for f in (led, plain))
    assert np.abs(slope[: parts[0]]).max() > 1e-3
    error = np.split(np.abs(slope - difference), parts)
    error = {field: float(part.max()) for field, part in zip(FIELDS, error, strict=True)}
    # the differences divide Newton's tolerance, 1e-9 of the moments, by 1e-5
    record_figure(f"{name}: slope of places against differences", error["centre"], 0.0, 1e-6)
    assert all(error[field] < 2e-5 for field in FIELDS if field not in FEW_DIGITS), error
    assert all(error[field] < 1e-3 for field in FEW_DIGITS), error


def test_wheel(record_figure):
    inertia, moment, rate = 2.0, 500.0, 10.0

    def model(m=moment, j=inertia):
        wheel = SpatialBody(1.0, np.diag([j, j, j]), np.zeros(3))
        hinge = SpatialHinge(0, (component(RX, m),))
        return SpatialModel((wheel,), (revolute(GROUND, 0, np.zeros(3), (0, 0, 1)),), (hinge,))

    def turning(w=rate):
        return np.array([[0.0, 0.0, w, 0.0, 0.0, 0.0]])

    e = NEAR
    ends = [
        (model(), turning()),
        *((model(moment * (1 + d)), turning()) for d in (e, -e)),
        *((model(j=inertia * (1 + d)), turning()) for d in (e, -e)),
        *((model(), turning(rate + d)) for d in (e, -e)),
    ]
    widths = (2 * e * moment, 2 * e * inertia, 2 * e)
    for accuracy, tolerance in ((1e-3, 1e-2), (1e-5, 2e-4)):
        led = runs(
            [m for m, _ in ends], [v for _, v in ends], 0.1, led=True, accuracy=accuracy, longest=np.inf
        )

        def slope(values, k):
            return (values[1 + 2 * k] - values[2 + 2 * k]) / widths[k]

        rotation, energy, rest = (
            led.hinge.rotation[:, 0],
            led.hinge_energy.dissipated[:, 0],
            led.summary.rest_time[:, 0],
        )
        figures = {
            "d rotation/d moment": (slope(rotation, 0), -inertia * rate**2 / (2 * moment**2), tolerance),
            "d rotation/d inertia": (slope(rotation, 1), rate**2 / (2 * moment), tolerance),
            "d rotation/d rate": (slope(rotation, 2), inertia * rate / moment, tolerance),
            "d duration/d moment": (slope(rest, 0), -inertia * rate / moment**2, 1e-4),
            "d duration/d inertia": (slope(rest, 1), rate / moment, 1e-4),
            "d duration/d rate": (slope(rest, 2), inertia / moment, 1e-4),
            "d energy/d inertia": (slope(energy, 1), rate**2 / 2, 1e-6),
        }
        for name, (value, expected, allowed) in figures.items():
            record_figure(f"{name} at accuracy {accuracy:g}", value, expected, allowed, relative=True)
        assert abs(slope(energy, 0)) < 1e-6


def scaled(hinge, factor):
    """Hinge with all its curves times a factor."""
    parts = tuple(
        replace(
            part,
            positive=(part.positive[0], factor * part.positive[1]),
            negative=(part.negative[0], factor * part.negative[1]),
        )
        for part in hinge.components
    )
    return replace(hinge, components=parts)


def moved_hinge(model, k, factor):
    hinges = list(model.hinges)
    hinges[k] = scaled(hinges[k], factor)
    return replace(model, hinges=tuple(hinges))


@pytest.mark.parametrize("what", ["capacity", "mass"])
def test_cube_frame(what, record_figure):
    """M4: twelve ball hinges and four loops."""
    model, velocity = m4_parts(error=1e-4)

    def move(e):
        if what == "capacity":
            return moved_hinge(model, 2, 1 + e)
        heavier = with_mass(model.bodies[5], (0.5, 0.5, 0.5), 5.0 * e)
        return replace(model, bodies=(*model.bodies[:5], heavier, *model.bodies[6:]))

    check(move, velocity, name=f"M4 by {what}", record_figure=record_figure)


def arm(form=SET_VALUED, softening=PEAK, coupling=Coupling.ELLIPSOID, stop=(), fracture=np.inf, **options):
    """Two bars in space with a mass; both hinges twist and bend about two axes with other capacities."""
    law = softening_law(0.3, 1e-4)
    bodies = (bar((0, 0, 0), (0.5, 0, 0)), with_mass(bar((0.5, 0, 0), (0.7, 0.4, 0.1)), (0.7, 0.4, 0.1), 3.0))
    joints = (spherical(GROUND, 0, np.zeros(3)), spherical(0, 1, np.array([0.5, 0.0, 0.0])))

    def hinge(joint):
        parts = tuple(
            component(freedom, (law[0], factor * law[1]), stop, **options)
            for freedom, factor in ((RX, 0.7), (RY, 1.0), (RZ, 1.3))
        )
        rows = (
            np.array([[0.0, 1.0, 0.3], [0.0, 0.3, 1.0], [0.0, 1.0, -0.3]])
            if coupling is Coupling.SECTION
            else np.zeros((0, 0))
        )
        if coupling is Coupling.SECTION:
            rows = rows / (np.abs(rows) ** 4).sum(axis=0).clip(1e-30) ** 0.25
        surface = SpatialSurface(coupling, rows, 4.0, 2.0, 0 if coupling is Coupling.SECTION else -1)
        return SpatialHinge(joint, parts, surface, form, softening, fracture)

    return SpatialModel(bodies, joints, (hinge(0), hinge(1)), gravity=(0.0, 0.0, -9.81), length=0.9)


THROWN = (3.0, -9.0, 6.0)


def thrown(model):
    """All turn about the root, the outer bar also about the knee."""
    turns = np.array([about((0, 0, 0), THROWN, body) for body in model.bodies])
    turns[1] += about((0.5, 0, 0), (-4.0, 8.0, 12.0), model.bodies[1])
    return turns


ARMS = {
    "peak": {},
    "rotation": {"softening": ROTATION},
    "accumulated with damper": {"softening": ACCUMULATED, "viscous_damping": 3.0},
    "rate factor": {"rate_reference": 20.0, "rate_exponent": 4.0},
    "no coupling": {"coupling": Coupling.NONE},
    "ball": {"coupling": Coupling.BALL},
    "section": {"coupling": Coupling.SECTION},
    "elastic-plastic": {"form": ELASTIC_PLASTIC, "elastic_stiffness": 2e4},
    "elastic-plastic without coupling": {
        "form": ELASTIC_PLASTIC,
        "elastic_stiffness": 2e4,
        "coupling": Coupling.NONE,
    },
    "regularised": {"form": REGULARISED, "rate": 0.5},
    "stop": {"stop": (0.02, 2e4, 1.5, 40.0, 0.01)},
    "critical stop": {"stop": (0.02, 2e4, 1.0, np.nan, 0.01)},
    "fracture": {"fracture": 0.08},
}


@pytest.mark.parametrize("kind", ARMS)
@pytest.mark.parametrize("what", ["capacity", "body", "place"])
def test_arm(kind, what, record_figure):
    model = arm(**ARMS[kind])

    def move(e):
        if what == "capacity":
            return moved_hinge(model, 0, 1 + e)
        if what == "body":
            last = model.bodies[1]
            heavier = replace(last, mass=last.mass * (1 + e), inertia=last.inertia * (1 + 2 * e))
            return replace(model, bodies=(model.bodies[0], heavier))
        joint = replace(model.joints[1], position=model.joints[1].position + np.array([0.1, 0.2, -0.1]) * e)
        return replace(model, joints=(model.joints[0], joint))

    check(move, thrown(model), name=f"arm, {kind}, by {what}", record_figure=record_figure)


def four_bar(joint=revolute):
    """Planar four-bar in space, hinges at all four corners: three constraints are held twice."""
    corners = [np.array(c, float) for c in ((0, 0, 0), (0, 0, 0.4), (0.6, 0, 0.5), (0.6, 0, 0))]
    bodies = tuple(bar(corners[i], corners[i + 1]) for i in range(3))
    joints = tuple(joint(i - 1, i if i < 3 else GROUND, corners[i], (0, 1, 0)) for i in range(4))
    law = softening_law(0.05, 1e-4)
    hinges = tuple(SpatialHinge(i, (component(RX, law),)) for i in range(4))
    return SpatialModel(bodies, joints, hinges, gravity=(0.0, 0.0, -9.81), length=0.6)


def test_loop_with_redundant_joints(record_figure):
    model = four_bar()
    assert SpatialSimulation(model).freedoms == (1, 3)

    def move(e):
        return replace(moved_hinge(model, 1, 1 + e), gravity=(0.0, 0.0, -9.81 * (1 - 3 * e)))

    velocity = np.array(
        [about((0, 0, 0), (0, 8.0, 0), model.bodies[0]), [0, 0, 0, 3.2, 0, 0], [0, 6.4, 0, 1.6, 0, 0]]
    )
    check(move, velocity, name="four-bar with three redundant constraints", record_figure=record_figure)


def test_load_and_drive(record_figure):
    """The arm pushed at its end while its root is carried along."""
    model = arm()
    held = SpatialJoint(GROUND, 0, np.zeros(3), np.eye(3), (True, True, True, False, False, False))
    times = np.array([0.0, 0.02])

    def move(e):
        values = np.array([100.0, 3000.0]) * (1 + e)
        force, moment = np.array([0.0, 1.0, 1.0]), np.array([0.0, 0.0, 10.0 * e])
        push = SpatialLoad(1, np.array([0.7, 0.4, 0.1 + e]), force, moment, times, values)
        carried = SpatialDrive(0, 1, times, np.array([0.0, 4.0 * (1 + e)]))
        return replace(model, joints=(held, model.joints[1]), loads=(push,), drives=(carried,))

    check(move, np.zeros((2, 6)), name="load and drive", record_figure=record_figure)


def test_two_stages(record_figure):
    """Thrown, then left to itself: what the first stage did counts in the second."""
    model = arm(softening=ROTATION)
    stages = (SpatialStage(0.008), SpatialStage(0.006))
    check(
        lambda e: moved_hinge(model, 1, 1 + e),
        thrown(model),
        stages=stages,
        name="two stages",
        record_figure=record_figure,
    )
