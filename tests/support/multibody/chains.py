"""Models M1 to M3 and their hinge law, and small trees for the kernel, shared by the verification tests.

The bar is a tube of 50x25x2.65 mm taken as slender and uniform, 2.8998685 kg/m. The law with scale s is
s * 1000 * (0.576 + 0.5/sqrt(max(|rotation|, 0.05))) N m, with a stop at 1.2 rad of 1e6 s N m/rad and 2e3
s N m s/rad; the rotation is the present one, both senses alike.
"""

from __future__ import annotations

import math

import numpy as np

from crumple._core.planar.simulation import JointKind, Simulation, TreeBody, TreeHinge, TreeModel, TreeWeld

MASS_PER_LENGTH = 2.8998685
PAYLOAD = 6.0
SET_VALUED, ELASTIC_PLASTIC, REGULARISED = 0, 1, 2
PEAK, ROTATION, ACCUMULATED = 0, 1, 2


def softening_law(scale=1.0, error=1e-8, last=1.3):
    """Places and moments of the law between which straight lines err by `error`, relatively, at most.

    Over a piece h the error is h^2/8 M''; with x = r^2 the pieces of M = 0.576 + 0.5/r grow as r^2.5.
    """
    places = [0.0, 0.05]
    while places[-1] < last:
        x = places[-1]
        moment, curvature = 0.576 + 0.5 * x**-0.5, 0.375 * x**-2.5
        places.append(x + math.sqrt(8.0 * error * moment / curvature))
    x = np.array(places)
    return x, scale * 1000.0 * (0.576 + 0.5 / np.sqrt(np.maximum(x, 0.05)))


def constant(moment):
    """Envelope of a constant moment [N m]."""
    return np.zeros(1), np.array([float(moment)])


def hinge(dof=0, moment=1000.0, form=SET_VALUED, negative=None, **options):
    """Hinge of constant moment, or of an envelope given as a pair of arrays."""
    envelope = moment if isinstance(moment, tuple) else constant(moment)
    other = envelope if negative is None else constant(negative)
    options = {"softening": PEAK} | options
    return TreeHinge(dof=dof, form=form, positive=envelope, negative=other, **options)


def softening_hinge(dof, scale, form, rate, error):
    """Hinge of the law above with its stops."""
    stop = (1.2, 1e6 * scale, 1.0, 2e3 * scale, 0.0)
    return TreeHinge(
        dof=dof,
        form=form,
        softening=ROTATION,
        positive=(envelope := softening_law(scale, error)),
        negative=envelope,
        regularisation_rate=rate,
        stop_positive=stop,
        stop_negative=stop,
    )


def bar(length, payload=0.0, anchor=(0.0, 0.0), parent=-1, joint=JointKind.REVOLUTE):
    """Slender bar along x from its inboard joint, with a point mass at its end."""
    own = MASS_PER_LENGTH * length
    mass = own + payload
    centre = (own / 2 + payload) * length / mass
    inertia = own * length**2 / 12 + own * (length / 2 - centre) ** 2 + payload * (length - centre) ** 2
    return TreeBody(parent, joint, anchor, (centre, 0.0), mass, inertia)


def wheel(inertia=2.0, mass=1.0):
    """Body pinned to the ground at its centre of mass: I dw/dt = -M and nothing else."""
    return TreeBody(-1, JointKind.REVOLUTE, (0.0, 0.0), (0.0, 0.0), mass, inertia)


def m1(accuracy=1e-3, form=SET_VALUED, rate=0.05, error=1e-8):
    """Model M1: one bar of 1 m pinned to the ground, 6 kg at its tip, 15 rad/s."""
    model = TreeModel((bar(1.0, PAYLOAD),), (softening_hinge(0, 1.0, form, rate, error),))
    return started(model, [15.0], accuracy)


def m2(number, accuracy=1e-3, form=SET_VALUED, rate=0.05, error=1e-6):
    """Model M2: chain of bars of 0.1 m, 6 kg at its tip, turning as one with 15 rad/s."""
    length = 0.1 * number
    whole = MASS_PER_LENGTH * length**3 / 3 + PAYLOAD * length**2
    root = whole / (MASS_PER_LENGTH / 3 + PAYLOAD)
    bodies, hinges = [], []
    for i in range(number):
        payload = PAYLOAD if i == number - 1 else 0.0
        bodies.append(bar(0.1, payload, (0.1 if i else 0.0, 0.0), i - 1))
        scale = root if i == 0 else 0.8 * root * (1 - 0.1 * i / length)
        hinges.append(softening_hinge(i, scale, form, rate, error))
    return started(TreeModel(tuple(bodies), tuple(hinges)), [15.0] + [0.0] * (number - 1), accuracy)


def m3(accuracy=1e-3, form=SET_VALUED, rate=0.05, error=1e-6):
    """Model M3: portal A(0,0) B(0,.5) C(1,.6) D(1,0) with 20 kg at the middle of BC.

    BC starts with 10 m/s along x.  CD is in two halves that a weld joins: one hangs on C, the other on D.
    """
    left, right = 0.5, 0.6
    top = math.hypot(1.0, right - left)
    bodies, hinges = [], []
    for parent, anchor, line, share, lump in (
        (-1, (0.0, 0.0), (0.0, left), 1.0, 0.0),
        (0, (0.0, left), (1.0, right - left), 1.0, 20.0),
        (1, (1.0, right - left), (0.0, -right), 0.5, 0.0),
        (-1, (1.0, 0.0), (0.0, right), 0.5, 0.0),
    ):
        length = math.hypot(*line)
        mass = share * MASS_PER_LENGTH * length
        inertia = mass * length**2 / 12
        centre = (line[0] / 2, line[1] / 2)
        bodies.append(TreeBody(parent, JointKind.REVOLUTE, anchor, centre, mass + lump, inertia))
        hinges.append(softening_hinge(len(hinges), 0.5, form, rate, error))
    weld = TreeWeld(2, 3, (0.0, -right), (0.0, 0.0))
    model = TreeModel(tuple(bodies), tuple(hinges), welds=(weld,), length=top)
    rates = [-10.0 / left, 10.0 / left, -10.0 / right, -10.0 / right]
    return started(model, rates, accuracy)


def started(model, rates, accuracy=1e-3, **settings):
    """Simulation of a model that starts with joint rates [rad/s]."""
    simulation = Simulation(model, accuracy, **settings)
    simulation.set_rates(np.asarray(rates, float))
    return simulation
