"""Constant moment: a body of inertia I and rate w0 stops after I w0^2/(2 M) at the time I w0/M.

This is the closed form of a rigid-plastic hinge whose capacity does not change.  With a constant capacity
the trapezoidal motion of a wheel is exact, and a set-valued hinge that stops within a step is placed where
it stops.  The figures are therefore reproduced up to the creep of a locked hinge (at most 1e-8 rad/s), for
any step.  The bars of a structure move on arcs, and the error of their midpoint rule is below the requested
accuracy.

Kind: closed form.  Source: derived here.
"""

import numpy as np
import pytest
from tests.support.multibody.chains import ELASTIC_PLASTIC, SET_VALUED, hinge, started, wheel
from tests.support.structures import cantilever, table_law

from crumple._core.planar.simulation import TreeModel
from crumple.multibody import Run, solve_multibody
from crumple.structure import MultibodySettings

INERTIA, MOMENT, RATE = 2.0, 700.0, 15.0


@pytest.mark.parametrize("accuracy", [1e-1, 1e-3, 1e-6])
def test_stop_is_exact_at_any_accuracy(accuracy, record_figure):
    simulation = started(TreeModel((wheel(INERTIA),), (hinge(0, MOMENT),)), [RATE], accuracy)
    summary = simulation.run(np.linspace(0.0, 0.1, 7)).summary
    name = f"accuracy {accuracy:g}"
    record_figure(f"rotation, {name}", summary.rotation_max[0], INERTIA * RATE**2 / (2 * MOMENT), 1e-9, "rad")
    record_figure(f"time of rest, {name}", summary.rest_time[0], INERTIA * RATE / MOMENT, 1e-10, "s")
    record_figure(f"energy, {name}", summary.energy[0], INERTIA * RATE**2 / 2, 1e-9, "J", relative=True)


@pytest.mark.parametrize(("sign", "moment", "other"), [(1.0, 700.0, 300.0), (-1.0, 300.0, 700.0)])
def test_each_sense_has_its_own_envelope(sign, moment, other):
    """An elastic hinge swings back from the strong sense so far that it yields in the weak one."""
    energy, stiffness = INERTIA * RATE**2 / 2, 1e6
    swing = moment**2 / (2 * stiffness)
    back = max(0.0, swing - other**2 / (2 * stiffness)) / other
    for form, expected in (
        (SET_VALUED, energy / moment),
        (ELASTIC_PLASTIC, (energy - swing) / moment - back),
    ):
        one = hinge(0, 700.0, form, negative=300.0, elastic_stiffness=stiffness)
        record = started(TreeModel((wheel(INERTIA),), (one,)), [sign * RATE], 1e-4).run(np.array([0.2]))
        assert record.hinge.plastic[-1, 0] == pytest.approx(sign * expected, rel=1e-4)


@pytest.mark.parametrize("reversed_member", [False, True])
@pytest.mark.parametrize("thrown", [1.0, -1.0])
def test_sense_follows_the_member_and_not_the_joint(reversed_member, thrown, record_figure):
    """The hinge turns second side against first, wherever the ground is."""
    structure = cantilever(
        law=table_law(positive=700.0, negative=300.0),
        reversed_member=reversed_member,
        initial_velocity=[{"rotation": thrown * RATE, "axis": (0.0, 1.0, 0.0)}],
        hinge_place=0.0,
    )
    result = solve_multibody(structure, Run(0.4, 0.01, MultibodySettings(accuracy=1e-5)))
    # with the nodes exchanged the first side is the one that moves, and local y points the other way,
    # so the rotation of the second side against the first about local y keeps its sign
    moment = 700.0 if thrown > 0.0 else 300.0
    energy = result["energy.kinetic"][0]
    order = "exchanged" if reversed_member else "in order"
    name = f"rotation, thrown {'down' if thrown > 0 else 'up'}, nodes {order}"
    record_figure(
        name, result.hinges["root"].rotation_final, thrown * energy / moment, 1e-5, "rad", relative=True
    )
    assert result["hinge.root.moment"][1] == pytest.approx(thrown * moment)
    assert result["hinge.root.capacity"][1] == pytest.approx(moment)
