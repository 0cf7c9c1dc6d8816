"""One hinge by itself, on a small mass or led along given rates: what tests of the element share."""

from __future__ import annotations

import math

import numpy as np
from scipy.optimize import brentq

from crumple._core import _kernels

SET_VALUED, ELASTIC_PLASTIC, REGULARISED = range(3)
PEAK, ROTATION, ACCUMULATED = range(3)
NONE, ELLIPSOID, BALL, SECTION, TENSION_FLANGE = range(5)
AXIAL, TORSION, ABOUT_Y, ABOUT_Z = 0, 3, 4, 5

FORMS = (SET_VALUED, ELASTIC_PLASTIC, REGULARISED)
NO_ARM = {"arm": 0.0, "arm_gains": [], "arm_gain_shares": [], "growth_rotation": [], "growth_share": []}
NO_ARM |= {"shortened_turn": 0.0}


def component(freedom, positive, negative=None, **more):
    """A component; a plain number is a constant capacity."""

    def curve(given):
        places, values = ([0.0, 1.0], [given, given]) if np.isscalar(given) else given
        return list(map(float, places)), list(map(float, values))

    up, down = curve(positive), curve(positive if negative is None else negative)
    return {
        "freedom": freedom,
        "positive_rotation": up[0],
        "positive_moment": up[1],
        "negative_rotation": down[0],
        "negative_moment": down[1],
        "elastic_stiffness": math.inf,
        "regularisation_rate": 0.05,
        "rate_reference": math.inf,
        "rate_exponent": 1.0,
        "viscous_damping": 0.0,
        "stop_positive": [],
        "stop_negative": [],
        "shift_rotation": [],
        "shift_share": [],
        "worn_rotation": [],
        "worn_share": [],
        "driver": -1,
        "softens": 1.0,
        "flange": 0.0,
        "positive_spread": [[], []],
        "negative_spread": [[], []],
    } | more


def hinge(*components, form=SET_VALUED, softening=PEAK, coupling=NONE, **more):
    """Constants of a hinge as the kernel takes them."""
    plain = {"rows": [], "power": 2.0, "torque_power": 2.0, "torsion": -1, "fracture": math.inf, **NO_ARM}
    plain |= {
        "shear_loss": [0.0, 0.0],
        "round_shear": False,
        "axisymmetric": False,
        "cross_softening": 1.0,
        "edge_relief": 0.0,
    }
    plain |= {"form": form, "softening": softening, "coupling": coupling, "components": list(components)}
    return plain | more


class Rig:
    """A hinge between the ground and a mass that feels nothing else; `late`: weight of the ends of steps."""

    def __init__(self, constants, inertia=1.0, w=None, late=0.5):
        self.late = late
        self.element = _kernels.spatial.HingeElement(constants)
        self.n = len(constants["components"])
        self.inertia = np.diag(np.broadcast_to(np.asarray(inertia, float), self.n))
        self.w = np.zeros(self.n) if w is None else np.array(w, float)
        self.time = 0.0
        self.work = 0.0

    @property
    def q(self):
        return np.array(self.element.q)

    @property
    def state(self):
        return self.element.state

    @property
    def energy(self):
        """Kinetic, stored and dissipated energy less the work put in [J]."""
        s = self.state
        kept = ("elastic", "stop", "dissipated", "damped", "stop_dissipated")
        return self.w @ self.inertia @ self.w / 2 + sum(s[name] for name in kept) - self.work

    def step(self, h, force=0.0):
        """One step of length h under a force on the mass."""
        w0, w1 = self.w, self.w.copy()
        push = h * np.broadcast_to(np.asarray(force, float), self.n)
        for _ in range(2):
            self.element.freeze(h, w0.tolist(), w1.tolist(), self.late)
            w1 = self._balanced(w0, w1, push)
        turn = np.array(self.element.commit(w1.tolist()))
        self.work += push @ (w0 + w1) / 2
        self.w, self.time = w1, self.time + h
        return turn

    def led(self, h, rate):
        """One step at a given constant rate; returns the forces that it takes."""
        rate = np.broadcast_to(np.asarray(rate, float), self.n).tolist()
        self.element.freeze(h, rate, rate, self.late)
        impulse = np.array(self.element.respond(rate)[0])
        self.work += impulse @ np.array(rate)
        self.element.commit(rate)
        self.time += h
        return impulse / h

    def _slope(self, w, w0, push):
        """Momentum left over, and its matrix."""
        impulse, tangent, _ = self.element.respond(w.tolist())
        slope = self.inertia @ (w - w0) - push + np.array(impulse)
        return slope, self.inertia + np.reshape(tangent, (self.n, self.n))

    def _balanced(self, w0, w, push):
        if self.n == 1:
            return self._root(w0, w, push)
        # Newton's method, the ramp narrowed step by step
        for width in self.widths:
            if self.set_valued:
                self.element.widen(width)
            w = self._newton(w0, w, push)
        return w

    def _newton(self, w0, w, push):
        """Whole steps where they lead down, else to the lowest point on the way."""
        for _ in range(60):
            slope, matrix = self._slope(w, w0, push)
            # one rounding of a rate is worth tangent times rounding of impulse
            noise = 1e-15 * np.abs(matrix) @ np.abs(w) + 1e-13 * (np.abs(push) + self.inertia @ np.abs(w0))
            if np.all(np.abs(slope) <= noise):
                break
            step = -np.linalg.solve(matrix, slope)
            at_start, low, high = slope @ step, 0.0, 1.0
            share, found = 1.0, self._slope(w + step, w0, push)[0] @ step
            for _ in range(100):
                if (found <= 0.0 and share == 1.0) or abs(found) <= 1e-12 * abs(at_start):
                    break
                low, high = (low, share) if found > 0.0 else (share, high)
                share = (low + high) / 2.0
                found = self._slope(w + share * step, w0, push)[0] @ step
            w = w + share * step
        return w

    def _root(self, w0, w, push):
        """The impulse grows with the rate: a bracket and Brent's method."""

        def left(v):
            return float(self.inertia[0, 0] * (v - w0[0]) - push[0] + self.element.respond([v])[0][0])

        far = 1.0
        while left(w[0] - far) > 0.0 or left(w[0] + far) < 0.0:
            far *= 4.0
        return np.array([brentq(left, w[0] - far, w[0] + far, xtol=1e-300, rtol=8.9e-16, maxiter=500)])

    widths = (1.0, 1e-2, 1e-4, 1e-6, 1e-8)
    set_valued = True


def rig(constants, inertia=1.0, w=None, late=0.5):
    """A rig that knows its hinge's form."""
    made = Rig(constants, inertia, w, late)
    made.set_valued = constants["form"] == SET_VALUED
    if not made.set_valued:
        made.widths = (0.0,)
    return made
