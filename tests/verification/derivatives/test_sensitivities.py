"""Derivatives of final quantities equal closed forms and central differences (planar kernel).

A wheel of inertia I that a hinge of moment M stops from the rate w0 rotates by I w0^2/(2 M) in the time I
w0/M; all its derivatives follow, and the step is exact for it.  Trees, loops, drives, stops, dampers, rate
factors and the three forms have no closed form.  There the derivatives must be those of the discrete motion
itself, that is, of central differences of runs with the same steps (fixed by a loose accuracy and a longest
step), up to the error of the differences.  Through the structure, laws and geometry depend on the
parameters: there a table of variants with parameters changed by 0.1 % gives the differences.

Kind: closed form; independent calculation.  Source: derived here; derived here.
"""

from dataclasses import replace

import numpy as np
import pytest
from tests.support.multibody.chains import (
    ACCUMULATED,
    ELASTIC_PLASTIC,
    PEAK,
    REGULARISED,
    ROTATION,
    SET_VALUED,
    bar,
    hinge,
    m2,
    softening_law,
    wheel,
)
from tests.support.structures import STEEL, cantilever, constant_law

from crumple._core.planar.simulation import (
    JointKind,
    Outcome,
    Simulation,
    TreeBody,
    TreeDrive,
    TreeHold,
    TreeLoad,
    TreeModel,
    TreeWeld,
)
from crumple._core.planar.tangent import TreeDirection, solve_tangent
from crumple.errors import InputError, Status
from crumple.multibody import Run, sensitivities, solve_variants
from crumple.structure import MultibodySettings, Outputs, Structure, changed, placed_hinges, value_at

INERTIA, MOMENT, RATE = 2.0, 500.0, 10.0
LOOSE = 1e3
"""Accuracy that no step fails, so the longest step fixes all of them."""


def direction(up, down, width, velocities=None, bodies=1):
    """A direction along which the model changes, and perhaps the velocity."""
    still = np.zeros((bodies, 3))
    first, second = velocities or (still, still)
    return TreeDirection(up, down, first, second, still, still, width)


def test_wheel(record_figure):
    def model(moment=MOMENT, inertia=INERTIA):
        return TreeModel((wheel(inertia),), (hinge(moment=moment),))

    def turning(rate):
        return np.array([[rate, 0.0, 0.0]])

    e = 1e-4
    same = (turning(RATE), turning(RATE))
    tangent = solve_tangent(
        model(),
        turning(RATE),
        np.zeros((1, 3)),
        [
            direction(model(MOMENT * (1 + e)), model(MOMENT * (1 - e)), 2 * e * MOMENT, same),
            direction(
                model(inertia=INERTIA * (1 + e)), model(inertia=INERTIA * (1 - e)), 2 * e * INERTIA, same
            ),
            direction(model(), model(), 2 * e, (turning(RATE + e), turning(RATE - e))),
        ],
        0.1,
    )
    figures = {
        "d rotation/d moment": (tangent.ends.q[1, 0], -INERTIA * RATE**2 / (2 * MOMENT**2)),
        "d rotation/d inertia": (tangent.ends.q[2, 0], RATE**2 / (2 * MOMENT)),
        "d rotation/d rate": (tangent.ends.q[3, 0], INERTIA * RATE / MOMENT),
        "d duration/d moment": (tangent.ends.summary.rest_time[1, 0], -INERTIA * RATE / MOMENT**2),
        "d duration/d inertia": (tangent.ends.summary.rest_time[2, 0], RATE / MOMENT),
        "d duration/d rate": (tangent.ends.summary.rest_time[3, 0], INERTIA / MOMENT),
        "d energy/d inertia": (tangent.ends.hinge_energy.dissipated[2, 0], RATE**2 / 2),
        "d energy/d moment": (tangent.ends.hinge_energy.dissipated[1, 0], 0.0),
    }
    for name, (value, expected) in figures.items():
        # the locked hinge's creep of 1e-8 rad/s is what is left
        record_figure(name, value, expected, 1e-7 * max(abs(expected), 1.0))


def recorded(rows):
    """Columns of hinges and energies."""
    return [column for of in (rows.hinge, rows.hinge_energy, rows.energy) for column in vars(of).values()]


def final(model, velocity, end, longest):
    """Coordinates, rates, hinges and energies at the end of a run of equal steps."""
    simulation = Simulation(model, LOOSE, maximum_step=longest)
    simulation.set_motion(velocity, np.zeros_like(velocity))
    record = simulation.run(np.array([end]))
    assert record.outcome is Outcome.COMPLETE
    return np.concatenate([simulation.q, simulation.w, *(column.ravel() for column in recorded(record))])


def check(model, move, velocity, *, end=0.04, e=1e-5, tolerance=2e-6):
    """The tangent along `move` (a model for a small number) agrees with central differences."""
    longest = 2e-4
    tangent = solve_tangent(
        model,
        velocity,
        np.zeros_like(velocity),
        [direction(move(1e-4), move(-1e-4), 2e-4, (velocity, velocity), len(model.bodies))],
        end,
        LOOSE,
        maximum_step=longest,
    )
    found = (tangent.ends.q, tangent.ends.w, *recorded(tangent.ends))
    values = np.concatenate([column[0].ravel() for column in found])
    slopes = np.concatenate([column[1].ravel() for column in found])
    np.testing.assert_array_equal(values, final(model, velocity, end, longest))
    differences = (final(move(e), velocity, end, longest) - final(move(-e), velocity, end, longest)) / (2 * e)
    scale = np.maximum(np.abs(values), 1e-3 * np.abs(values).max())
    assert np.abs(slopes).max() > 0.0
    error = np.abs(slopes - differences) / scale
    assert error.max() < tolerance, (slopes, differences)


def chain(form, softening, **options):
    """Three bars with a mass at the end; the hinges soften, and have what `options` give them."""
    law = softening_law(0.3, 1e-4)
    bodies = (bar(0.4), bar(0.3, 0.0, (0.4, 0.0), 0), bar(0.3, 2.0, (0.3, 0.0), 1))
    hinges = tuple(hinge(k, law, form, softening=softening, **options) for k in range(3))
    return TreeModel(bodies, hinges, gravity=(0.0, -9.81))


FORMS = [
    (SET_VALUED, PEAK, {}),
    (SET_VALUED, ROTATION, {"rate_reference": 20.0, "rate_exponent": 4.0}),
    (SET_VALUED, ACCUMULATED, {"viscous_damping": 3.0}),
    (ELASTIC_PLASTIC, PEAK, {"elastic_stiffness": 2e4}),
    (REGULARISED, ROTATION, {"regularisation_rate": 0.5}),
    (SET_VALUED, ROTATION, {"stop_positive": (0.05, 2e4, 1.5, 40.0, 0.01)}),
]


@pytest.mark.parametrize(("form", "softening", "options"), FORMS)
@pytest.mark.parametrize("what", ["capacity", "body", "option"])
def test_chain(form, softening, options, what):
    model = chain(form, softening, **options)
    velocity = np.array([[9.0, 0.0, 1.0], [9.0, 0.0, 4.0], [6.0, 0.0, 7.0]])
    first, *others = model.hinges

    def move(e):
        if what == "capacity":
            return replace(model, hinges=(replace(first, capacity_scale=1 + e), *others))
        if what == "body":
            last = model.bodies[2]
            moved = replace(last, mass=last.mass * (1 + e), anchor=(0.3 * (1 + e), 0.02 * e))
            return replace(model, bodies=(*model.bodies[:2], moved))
        changes = {}
        for name, value in options.items():
            changes[name] = tuple(v * (1 + e) for v in value) if isinstance(value, tuple) else value * (1 + e)
        return replace(model, hinges=(replace(first, **changes), *others))

    if what == "option" and not options:
        pytest.skip("nothing but the capacity")
    # Newton's method solves the curved ramps' moments to 1e-9, which the differences divide by 1e-5
    check(model, move, velocity, tolerance=2e-4 if form == REGULARISED else 2e-6)


def test_loop_with_load_drive_and_hold():
    """A parallelogram closed by a weld and pushed by a load; beside it a driven trolley."""
    law = softening_law(0.05, 1e-4)
    half = TreeBody(1, JointKind.REVOLUTE, (0.5, 0.0), (0.0, 0.05), 0.4, 0.01)
    bodies = (
        TreeBody(-1, JointKind.REVOLUTE, (0.0, 0.0), (0.0, 0.2), 1.0, 0.02),
        TreeBody(0, JointKind.REVOLUTE, (0.0, 0.4), (0.25, 0.0), 2.0, 0.05),
        half,
        TreeBody(-1, JointKind.REVOLUTE, (0.5, 0.0), (0.0, 0.2), 0.6, 0.01),
        TreeBody(-1, JointKind.FREE, (2.0, 0.0), (0.0, 0.0), 3.0, 0.1),
    )
    hinges = tuple(hinge(k, law) for k in range(4))
    push = TreeLoad(1, (0.2, 0.0), (0.0, 1.0, 0.0), np.array([0.0, 0.04]), np.array([200.0, 600.0]))
    times = np.array([0.0, 0.04])
    ram = TreeDrive(4, (0.1, 0.0), (0.0, 1.0, 0.0), times, 0.5 * times, rates=np.array([0.5, 0.5]))
    model = TreeModel(
        bodies,
        hinges,
        loads=(push,),
        drives=(ram,),
        holds=(TreeHold(4, (0.0, 0.0), (0.0, 0.0, 1.0)),),
        welds=(TreeWeld(2, 3, (0.0, 0.0), (0.0, 0.4)),),
    )

    def move(e):
        load = replace(push, values=push.values * (1 + e), point=(0.2 + 0.1 * e, 0.0))
        first = replace(hinges[0], capacity_scale=1 - e)
        heavier = replace(bodies[1], mass=2.0 * (1 + 2 * e))
        return replace(
            model, loads=(load,), hinges=(first, *hinges[1:]), bodies=(bodies[0], heavier, *bodies[2:])
        )

    velocity = np.array(
        [[-3.0, 0.6, 0.0], [0.0, 1.2, 0.0], [-3.0, 1.2, 0.0], [-3.0, 0.6, 0.0], [0.0, 0.5, 0.0]]
    )
    # moments of locked hinges are solved to 1e-9 of both capacities, which the differences divide by 1e-3
    check(model, move, velocity, end=0.03, e=1e-3, tolerance=2e-5)


def test_many_directions_go_in_shares():
    """More directions than the kernel carries at a time give what each gives alone."""
    model = m2(10).model
    velocity = np.zeros((10, 3))
    velocity[:, 0] = 15.0
    velocity[:, 2] = [15.0 * (0.1 * i + body.centre[0]) for i, body in enumerate(model.bodies)]

    def scaled(k, e):
        hinges = tuple(
            replace(hinge, capacity_scale=1 + e * (j == k)) for j, hinge in enumerate(model.hinges)
        )
        return replace(model, hinges=hinges)

    still = np.zeros_like(velocity)
    moves = [direction(scaled(k, 1e-4), scaled(k, -1e-4), 2e-4, (velocity, velocity), 10) for k in range(10)]
    whole = solve_tangent(model, velocity, still, moves, 0.1)
    for k in (0, 9):
        one = solve_tangent(model, velocity, still, [moves[k]], 0.1)
        np.testing.assert_array_equal(whole.ends.q[[0, 1 + k]], one.ends.q)


TURN = {"rotation": 15.0, "about": (0.0, 0.0, 0.0), "axis": (0.0, -1.0, 0.0)}
FINE = Run(0.1, 0.1, MultibodySettings(accuracy=1e-6), Outputs(nodes=("tip",)))
QUANTITIES = ("hinge.root.rotation", "hinge.root.energy", "node.tip.displacement.z", "energy.dissipated")


def test_constant_moment_through_the_structure(record_figure):
    """theta = I w^2/(2 M) with I of the tube about its root and the lump's m L^2."""
    tube = cantilever(constant_law(2000.0), initial_velocity=[TURN], hinge_place=0.0)
    names = ["hinges.root.capacity", "masses.payload.mass", "initial_velocity"]
    found = sensitivities(tube, FINE, names)
    assert found.status is Status.COMPLETE
    theta = found.quantities["hinge.root.rotation_max"]
    slopes = found["hinge.root.rotation_max"]
    record_figure("d rotation/d capacity factor", slopes[names[0]], -theta, 1e-5, "rad", relative=True)
    by_mass = 15.0**2 / (2 * 2000.0)
    record_figure("d rotation/d mass", slopes[names[1]], by_mass, 1e-5, "rad/kg", relative=True)
    record_figure("d rotation/d speed factor", slopes[names[2]], 2 * theta, 1e-5, "rad", relative=True)


@pytest.mark.parametrize(
    "name",
    [
        "materials.steel.yield_stress",
        "materials.steel.density",
        "sections.tube.thickness",
        "sections.tube.depth",
        "masses.payload.mass",
        "nodes.tip.0",
        "gravity",
        "loads",
    ],
)
def test_structure_against_variants(name, record_figure):
    tube = cantilever(
        {"type": "kecman"},
        bars=2,
        initial_velocity=[TURN],
        gravity=(0.0, 0.0, -9.81),
        loads=[{"node": "tip", "force": {"z": {"step": {"x0": 0.0, "h0": 0.0, "x1": 0.01, "h1": 300.0}}}}],
    )
    value = 1.0 if name in ("gravity", "loads") else value_at(tube, name)
    e = 1e-3
    table = solve_variants(tube, FINE, {name: [value * (1 + e), value * (1 - e)]})
    found = sensitivities(tube, FINE, [name])
    for quantity in QUANTITIES:
        difference = (table[quantity][0] - table[quantity][1]) / (2 * e)
        # both sides' laws are sampled to 1e-4 by themselves, nearly alike: an error of some 1e-4 of the slope
        slope = found[quantity][name] * value
        scale = max(abs(found.quantities[quantity]), abs(difference))
        record_figure(f"{quantity} by {name}", slope, difference, 2e-3 * scale)


def elastic_portal():
    """Portal that stays elastic; the hinges of each member share its flexibility with an elastic joint."""
    law = {"type": "constant", "form": "elastic-plastic"}

    def member(first, second, **keys):
        ends = [
            {"name": f"{first}{second}-{node}", "at": node, "offset": 0.05, "law": law}
            for node in (first, second)
        ]
        return {"nodes": (first, second), "section": "tube", "material": "steel", "hinges": ends, **keys}

    return Structure(
        materials={"steel": STEEL},
        sections={"tube": {"type": "square_tube", "side": 0.05, "thickness": 0.003}},
        nodes={"a": (0.0, 0.0, 0.0), "b": (0.0, 0.0, 1.0), "c": (1.2, 0.0, 1.0), "d": (1.2, 0.0, 0.0)},
        members={
            "ab": member("a", "b", up=(1, 0, 0)),
            "bc": member("b", "c"),
            "cd": member("c", "d", up=(1, 0, 0)),
        },
        supports={node: {"node": node, "fix": "all"} for node in "ad"},
        masses={"payload": {"node": "b", "mass": 40.0}},
        initial_velocity=[{"nodes": ["b"], "translation": (0.3, 0.0, 0.0)}],
    )


@pytest.mark.parametrize(
    "name",
    [
        "sections.tube.thickness",
        "materials.steel.youngs_modulus",
        "masses.payload.mass",
        "nodes.c.0",
        "members.ab.hinges.0.offset",
    ],
)
def test_elastic_portal_against_variants(name, record_figure):
    portal = elastic_portal()
    assert [h.name for h in placed_hinges(portal) if not h.plastic] == [
        "ab elastic",
        "bc elastic",
        "cd elastic",
    ]
    # a vibration: at the usual accuracy the number of steps, and with it the phase, changes between variants
    run = Run(5e-3, 5e-3, MultibodySettings(accuracy=1e-6), Outputs(nodes=("b",)))
    value = value_at(portal, name)
    e = 1e-4
    table = solve_variants(portal, run, {name: [value * (1 + e), value * (1 - e)]})
    found = sensitivities(portal, run, [name])
    for quantity in ("energy.elastic", "energy.kinetic", "node.b.displacement.x", "hinge.ab-a.moment"):
        difference = (table[quantity][0] - table[quantity][1]) / (2 * e)
        slope = found[quantity][name] * value
        scale = max(abs(found.quantities[quantity]), abs(difference))
        record_figure(f"{quantity} by {name}", slope, difference, 1e-4 * scale)


def test_a_parameter_of_value_zero_needs_a_step():
    tube = cantilever(constant_law(2000.0), initial_velocity=[TURN])
    off = changed(tube, {"masses.payload.offset.2": 0.0})
    with pytest.raises(InputError, match="step of a parameter that is zero"):
        sensitivities(off, FINE, ["masses.payload.offset.2"])
    found = sensitivities(off, FINE, {"masses.payload.offset.2": 1e-4})
    # the lump's inertia has its minimum there, and the velocity field moves with it
    assert abs(found["hinge.root.rotation"]["masses.payload.offset.2"]) < 1e-4


def test_what_cannot_be_moved_is_refused():
    tube = cantilever(constant_law(2000.0), initial_velocity=[TURN])
    with pytest.raises(InputError, match="does not exist"):
        sensitivities(tube, FINE, ["masses.payload.weight"])
