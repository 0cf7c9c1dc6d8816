"""A bar with a rigid-plastic hinge under pulses of a moment, with its closed form.

While a moment F(t) acts on a bar of inertia I about its hinge of capacity M, I w' = F - M sign(w) while it
turns, and it
rests while |F| <= M.  For a piecewise linear F the rotation is a cubic in each piece between two events,
which are roots of quadratics.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from crumple.numeric.arrays import Floats
from crumple.structure import Structure

SIDE, MASS_PER_LENGTH = 1e-4, 2.0
"""Side of a section so small that the bar is a line, and mass of the line [kg/m]."""
STEEL = {"youngs_modulus": 210e9, "poissons_ratio": 0.3, "yield_stress": 488e6}


def rotations(times: Floats, moments: Floats, inertia: float, capacity: float) -> tuple[float, float]:
    """Largest and final rotation [rad] under a piecewise linear moment; closed form."""
    state = [0.0, 0.0]
    largest = 0.0
    ends = np.append(times[1:], times[-1] + 1e9)
    for begin, end, first, last in zip(
        times, ends, moments, np.append(moments[1:], moments[-1]), strict=True
    ):
        slope, left = (last - first) / (end - begin), end - begin
        while left > 1e-15 * (end - begin):
            left -= _to_next_event(state, (first, slope), end - begin - left, left, inertia, capacity)
            largest = max(largest, abs(state[0]))
    return largest, state[0]


def _to_next_event(
    state: list[float], line: tuple[float, float], since: float, left: float, inertia: float, capacity: float
) -> float:
    """Advance [rotation, rate] until it rests or begins to move, or to the end of the piece; how long."""
    rotation, rate = state
    moment, slope = line[0] + line[1] * since, line[1]
    if rate == 0.0 and abs(moment) <= capacity * (1.0 + 1e-14):
        waits = (math.copysign(capacity, slope) - moment) / slope if slope else math.inf
        if waits > 1e-14 * left:
            return min(waits, left)
        sense = math.copysign(1.0, slope)
    else:
        sense = math.copysign(1.0, rate or moment)
    a, b = (moment - sense * capacity) / inertia, slope / inertia
    stops = [t for t in _roots(b / 2.0, a, rate) if t > (1e-12 * left if rate == 0.0 else 0.0)]
    lasts = min([*stops, left])
    state[0] = rotation + lasts * (rate + lasts * (a / 2.0 + lasts * b / 6.0))
    state[1] = 0.0 if lasts < left else rate + lasts * (a + lasts * b / 2.0)
    return lasts


def _roots(a: float, b: float, c: float) -> list[float]:
    """Of a t^2 + b t + c, without cancellation."""
    if a == 0.0:
        return [-c / b] if b else []
    under = b * b - 4.0 * a * c
    if under < 0.0:
        return []
    q = -(b + math.copysign(math.sqrt(under), b)) / 2.0
    return [q / a, *([c / q] if q else [])]


@dataclass(frozen=True)
class Pulse:
    """A bar of line mass with a mass at its tip, and the moment on it."""

    length: float
    tip_mass: float
    capacity: float
    times: Floats
    moments: Floats

    @property
    def inertia(self) -> float:
        """About the hinge at the root [kg m^2]."""
        return MASS_PER_LENGTH * self.length**3 / 3.0 + self.tip_mass * self.length**2

    @property
    def expected(self) -> tuple[float, float]:
        """Largest and final rotation [rad]."""
        return rotations(self.times, self.moments, self.inertia, self.capacity)

    @property
    def structure(self) -> Structure:
        """The bar, its hinge about y and the moment about y at its tip."""
        t = SIDE / 4.0
        area = SIDE**2 - (SIDE - 2.0 * t) ** 2
        law = {
            "type": "constant",
            "moment": self.capacity,
            "rate": "off",
            "form": "set-valued",
            "stops": "none",
        }
        hinge = {"name": "h", "at": "root", "offset": 0.0, "axis": "y", "law": law}
        member = {"nodes": ("root", "tip"), "section": "line", "material": "steel", "hinges": [hinge]}
        table = {"table": {"time": self.times.tolist(), "value": self.moments.tolist()}}
        return Structure(
            materials={"steel": {**STEEL, "density": MASS_PER_LENGTH / area}},
            sections={"line": {"type": "square_tube", "side": SIDE, "thickness": t}},
            nodes={"root": (0.0, 0.0, 0.0), "tip": (self.length, 0.0, 0.0)},
            members={"bar": member},
            supports={"clamp": {"node": "root", "fix": "all"}},
            masses={"tip": {"node": "tip", "mass": self.tip_mass}},
            loads=[{"node": "tip", "moment": {"y": table}}],
        )


def shape(rng: np.random.Generator, kind: str) -> tuple[Floats, Floats]:
    """Times from 0 to 1 and values of mean about 1; rectangle, triangle, half a sine, or that with noise."""
    if kind == "rectangle":
        return np.array([0.0, 1e-6, 1.0, 1.0 + 1e-6]), np.array([0.0, 1.0, 1.0, 0.0])
    if kind == "triangle":
        return np.array([0.0, rng.uniform(0.05, 0.95), 1.0]), np.array([0.0, 2.0, 0.0])
    times = np.linspace(0.0, 1.0, 10_000 if kind == "noise" else int(rng.integers(20, 3000)))
    values = np.pi / 2.0 * np.sin(np.pi * times)
    if kind == "noise":
        values += 0.3 * rng.standard_normal(times.size)
    values[[0, -1]] = 0.0
    return times, values


def random_pulse(rng: np.random.Generator, kind: str) -> tuple[Pulse, float]:
    """A pulse of 1e-5 to 1 times the motion that it makes, at a random time, and the duration of the run
    [s]."""
    length, mass, capacity = rng.uniform(0.3, 2.0), rng.uniform(1.0, 10.0), 10.0 ** rng.uniform(2.0, 4.0)
    inertia = MASS_PER_LENGTH * length**3 / 3.0 + mass * length**2
    rate = math.sqrt(2.0 * capacity * 10.0 ** rng.uniform(-2.0, 0.3) / inertia)
    motion = rate * inertia / capacity
    lasts = motion * 10.0 ** rng.uniform(-5.0, 0.0)
    times, values = shape(rng, kind)
    begins = motion * rng.uniform(0.01, 2.0)
    duration = (begins + lasts + motion) * rng.uniform(1.2, 2.0)
    times = np.concatenate([[0.0], begins + lasts * times, [duration]])
    moments = np.concatenate([[0.0], (inertia * rate / lasts + capacity) * values, [0.0]])
    return Pulse(length, mass, capacity, times, moments), duration
