"""Free flight of chains conserves momentum, angular momentum and energy.

Nothing acts on a floating chain, so its linear momentum, its angular momentum about a fixed point and its
energy are constant.  Their drift is of second order in the step and at most the requested accuracy; for the
energy, which depends on the square of the velocity, at most twice that.  The hinges carry 1e-12 N m.

Kind: invariant.  Source: derived here.
"""

import numpy as np
import pytest
from tests.support.multibody.chains import bar, hinge, started

from crumple._core.planar.simulation import JointKind, TreeModel

NUMBER, LENGTH = 5, 0.2
RATES = np.array([3.0, 2.0, -1.0, 8.0, -12.0, 10.0, -7.0])  # root: rotation, x, y; hinges
END = 0.2


def chain(number=NUMBER):
    """Floating bars in a row, the last with a payload."""
    root = bar(LENGTH, joint=JointKind.FREE)
    rest = tuple(bar(LENGTH, 0.5 if i == number - 1 else 0.0, (LENGTH, 0.0), i - 1) for i in range(1, number))
    return TreeModel((root, *rest), tuple(hinge(2 + i, 1e-12) for i in range(1, number)))


def momenta(model, record):
    """Linear momentum (n, 2) and angular momentum about the world's origin (n,)."""
    mass = np.array([body.mass for body in model.bodies])
    inertia = np.array([body.inertia for body in model.bodies])
    arm = np.array([body.centre for body in model.bodies])
    angle, velocity = record.pose[:, :, 0], record.velocity[:, :, 1:]
    c, s = np.cos(angle), np.sin(angle)
    x = record.pose[:, :, 1] + c * arm[:, 0] - s * arm[:, 1]
    y = record.pose[:, :, 2] + s * arm[:, 0] + c * arm[:, 1]
    spin = mass * (x * velocity[:, :, 1] - y * velocity[:, :, 0]) + inertia * record.velocity[:, :, 0]
    return (mass[:, None] * velocity).sum(axis=1), spin.sum(axis=1)


@pytest.mark.parametrize("accuracy", [1e-3, 1e-5])
def test_momentum_and_energy_are_kept(accuracy, record_figure):
    model = chain()
    record = started(model, RATES, accuracy).run(np.linspace(0.0, END, 21))
    linear, angular = momenta(model, record)
    size = np.linalg.norm(linear[0])
    name = f"accuracy {accuracy:g}"
    record_figure(f"drift of momentum, {name}", np.abs(linear - linear[0]).max() / size, 0.0, accuracy)
    record_figure(f"drift of angular momentum, {name}", np.abs(angular / angular[0] - 1).max(), 0.0, accuracy)
    energy = record.energy.kinetic
    record_figure(f"drift of energy, {name}", np.abs(energy / energy[0] - 1).max(), 0.0, 2 * accuracy)
    # it must have moved: nothing is shown by a chain that stands still
    assert np.abs(record.q[-1]).max() > 1.0


def test_second_order(record_figure):
    """Fixed steps; energy, angular momentum and the motion itself."""
    runs = {}
    for number in (100, 200, 400, 3200):
        simulation = started(chain(), RATES)
        for _ in range(number):
            assert simulation.step(END / number)
        record = simulation.run(np.array([END]))
        linear, angular = momenta(chain(), record)
        runs[number] = np.array([record.energy.kinetic[-1], angular[-1], *linear[-1], *simulation.q])
    errors = [np.abs(runs[n] - runs[3200]) for n in (100, 200, 400)]
    for i, name in enumerate(("energy", "angular momentum", "momentum along x", "momentum along y")):
        record_figure(f"order of {name}", float(np.log2(errors[1][i] / errors[2][i])), 2.0, 0.3)
    worst = [error[4:].max() for error in errors]
    record_figure("order of the motion", float(np.log2(worst[1] / worst[2])), 2.0, 0.3)
