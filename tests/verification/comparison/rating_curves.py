"""Pairs of curves whose ratings by the package objective-rating-metrics are kept in rating_reference.json."""

import numpy as np


def swings(k):
    """Two decaying swings: the second larger, shifted either way, with an oscillation on it."""
    t = np.arange(401 + 120 * k) / 1e4
    a = np.sin(60 * t) * np.exp(-20 * t)
    b = (1 + 0.1 * k) * np.sin(60 * (t - 0.001 * k * (-1) ** k)) * np.exp(-20 * t) + 0.02 * k * np.sin(
        900 * t
    )
    return t, a, b


def arrested(stop, most, wobble, duration=0.1):
    """Rotation of a hinge that comes to rest at a time, with bending vibration on it while it turns."""
    t = np.arange(round(1e4 * duration) + 1) / 1e4
    share = np.minimum(t / stop, 1.0)
    return t, most * share * (2.0 - share) + wobble * (1.0 - share) * np.sin(2 * np.pi * 85.0 * t)


def rotation():
    """Rigid bars that stop early against walls that vibrate."""
    t, a = arrested(0.090, 0.57, 0.02)
    return t, a, arrested(0.080, 0.545, 0.0)[1]


def velocity():
    """The same as angular velocities."""
    t, a, b = rotation()
    return t, np.gradient(a, t), np.gradient(b, t)


def long_rotation():
    """Half a second, the standard's sampling."""
    t, a = arrested(0.35, 1.1, 0.05, 0.4999)
    return t, a, arrested(0.40, 1.2, 0.04, 0.4999)[1]


def opposite():
    """Of the wrong sign: nothing agrees."""
    t, a, _ = swings(1)
    return t, a, -a


PAIRS = {
    **{f"swings {k}": (lambda k=k: swings(k)) for k in range(6)},
    "rotation": rotation,
    "velocity": velocity,
    "long rotation": long_rotation,
    "opposite": opposite,
}
