"""Axial slip of a hinge: force against shortening of a column that folds, and yield in tension.

Unknown: the force P(u) over the shortening u, from a peak P_0, a mean P_m over the stroke S, and the half
length H of a fold, which takes up d = 2 H S/l of a column of length l.  Walls that turn by a small angle t
shorten by u ~ H t^2 and have a lever arm H t: a mechanism of constant moments has P ~ 1/t ~ u^(-1/2), and the
walls carry no more than their yield.  A fold takes the work P_m d whatever its first force, which gives u_0:

    P = P_0 to 0.95 P_0        0 <= u < u_0 = x^2 d,     linearly
    P = 0.95 P_0 sqrt(u_0/u)   u_0 <= u < d,             x such that the mean over d is P_m
    P = P_m                    d <= u < S;  from 0.95 x P_0 linearly, over half of d - u_0 about d
    P = P_m (1 + k (u - S)/l)  S <= u < 0.9 l, stop at u = 0.9 l

Folds close one after the other from S on, until a tenth of the length is left, a solid block; k = 10 of flat
walls and 16 of round ones are those of tubes in shells.  Where the length is not known the stop is at S.
Further folds make the force swing about P_m; that is left out.  Without H the force falls linearly over 5 %
of the stroke, and d is the stroke.  In tension the walls yield.  Limits: P_0 = P_m is a constant force.
Metal that hardens yields along a length l_h before it folds, in compression, or necks, in tension: the force
rises along its hardening curve to P_0 at u_h = e l_h, with e the strain at the peak or at the neck, and the
above counts from there.
Derived here; not valid for a column shorter than its fold, or one that buckles sideways.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from crumple.errors import InputError, Problem
from crumple.hinge.axial.axial_law import AxialLaw
from crumple.hinge.axial.hardened_peak import necking_strain, uniform_yield
from crumple.hinge.law import SofteningVariable, Source, Trust, Validity
from crumple.hinge.rate import HingeRate, rate_factor
from crumple.hinge.stop import Stop
from crumple.material import Material
from crumple.material.hardening.curve import HardeningCurve
from crumple.numeric.arrays import Floats
from crumple.numeric.monotone_root import rising_root
from crumple.units import format_quantity

CHOSEN = Source("none", Trust.ASSUMED, "peak, mean and stroke are the user's choice")
FIRST_FALL = 0.05
"""Share of the stroke over which the peak falls where no fold length is known."""
CLOSING, ROUND_CLOSING = 10.0, 16.0
"""Rise of the force of closing folds over the mean force, for a shortening over the length [-]."""
SOLID = 0.9
"""Shortening over the length at which they are solid."""
PIECES = 8
"""Straight pieces of P_0 sqrt(u_0/u)."""
END = 0.95
"""Force at u_0 over P_0: a force that falls a little is found in one of several equal hinges of a member."""


_Curve = tuple[tuple[float, ...], tuple[float, ...]]
NO_RISE: _Curve = ((), ())


@dataclass(frozen=True)
class AxialCollapse:
    """Force [N] in place of a moment, shortening [m] in place of a rotation; see `HingeLaw`.

    Attributes
    ----------
    peak, mean
        P_0 and P_m [N].
    stroke
        S [m], from which on the folds close; inf: never, the mean is held.
    tension
        Force in tension [N].
    points
        Shortening beyond the rise [m] and force [N] at the corners of the curve, which is constant beyond the
        last.
    stop
        Stop of the closed folds, in shortening only; None without a stroke.
    rises
        Of tension, then of compression: slip [m] from 0 to u_h and force over that at its end [-]; empty:
        none.
    crushing
        What the force in compression is, in words.

    References
    ----------
    docs/theory/spatial_hinge.md.  Verified in tests/unit/hinge/record/test_spatial_recording.py.
    """

    name: ClassVar[str] = "axial_collapse"
    symmetric: ClassVar[bool] = False
    straight: ClassVar[bool] = True
    title: ClassVar[str] = "axial collapse"

    peak: float
    mean: float
    stroke: float
    tension: float
    points: _Curve
    stop: Stop | None = None
    rate: HingeRate | None = None
    source: Source = CHOSEN
    validity: Validity = Validity(math.inf, "axial folding is not validated by tests")  # noqa: RUF009
    softening_variable: SofteningVariable = SofteningVariable.PEAK
    elastic_stiffness: float | None = None
    jamming_angle: float | None = None
    rises: tuple[_Curve, _Curve] = (NO_RISE, NO_RISE)
    crushing: str = "yield of the walls"

    @classmethod
    def given(
        cls,
        peak: float,
        mean: float,
        stroke: float,
        *,
        tension: float | None = None,
        fold: float | None = None,
        closed_stiffness: float = 0.0,
    ) -> AxialCollapse:
        """Collapse with given forces.

        Parameters
        ----------
        peak, mean, stroke
            P_0 >= P_m [N] and S [m].
        tension
            Force in tension [N]; the peak without it.
        fold
            Shortening of the first fold [m], the stroke at most.
        closed_stiffness
            Spring of the closed folds [N/m]; 0: no stop.

        Raises
        ------
        InputError
            If a number is not positive or the mean is above the peak.
        """
        numbers = {
            "peak": peak,
            "mean": mean,
            "stroke": stroke,
            "tension": peak if tension is None else tension,
        }
        problems = [
            Problem(f"the {name} must be positive", f"{value:g}", "> 0", "", name)
            for name, value in numbers.items()
            if not value > 0.0
        ]
        if not problems and mean > peak:
            what, todo = "the mean force is above the peak", "give a higher peak or a lower mean"
            problems.append(Problem(what, f"{mean:g} N", f"at most {peak:g} N", todo, "mean"))
        if problems:
            raise InputError(problems)
        stop = Stop(stroke, closed_stiffness) if closed_stiffness > 0.0 and math.isfinite(stroke) else None
        curve = (
            _linear(peak, mean, stroke) if fold is None else _folding(peak, mean, min(fold, stroke), stroke)
        )
        return cls(peak, mean, stroke, numbers["tension"], curve, stop)

    @classmethod
    def of(
        cls, law: AxialLaw, length: float, *, tension: float, closed_stiffness: float = 0.0
    ) -> AxialCollapse:
        """Collapse of a column of a length [m] by an axial law, whose mean is over its effective stroke.

        Notes
        -----
        The rate factor of the law is defined for the impact speed; the current speed of shortening is used.
        A mean force above the peak (thick walls) is lowered to it, and a column shorter than one fold has
        none: the range then has a warning for either.
        """
        mean, half = min(law.mean_crushing_force, law.peak_force), law.half_fold_length
        made = cls.given(
            law.peak_force,
            mean,
            law.effective_stroke * length,
            tension=tension,
            fold=None if half is None else 2.0 * half * law.effective_stroke,
            closed_stiffness=closed_stiffness,
        )._closing(length, ROUND_CLOSING if law.name == "circular" else CLOSING)
        rate = None
        if law.rate is not None:
            rate = HingeRate(law.rate.metal.D / law.rate.shape, law.rate.metal.q)
        doubts = (*law.validity.warnings, *_doubts(law, length))
        basis = Validity(math.inf, law.validity.basis, doubts, law.validity.uncertainty)
        return replace(made, rate=rate, source=law.source, validity=basis, crushing=law.title)

    def _closing(self, length: float, slope: float) -> AxialCollapse:
        """The same whose folds close along what is left of a length [m] before they are solid."""
        solid = SOLID * length
        if solid <= self.stroke:
            return self
        at, force = self.points
        start = max(at[-1], self.stroke)
        flat = (start,) if start > at[-1] else ()
        closed = force[-1] + slope * self.mean * (solid - start) / length
        points = ((*at, *flat, solid), (*force, *(force[-1] for _ in flat), closed))
        return replace(self, points=points, stop=self.stop and replace(self.stop, rotation=solid))

    def hardening(
        self, material: Material, strain: float, length: float, *, neck: bool = True
    ) -> AxialCollapse:
        """The same with the rise of its metal over a length [m] before it.

        Parameters
        ----------
        material
            Its hardening curve.
        strain
            Plastic strain at the peak in compression [-]; 0: no rise there.
        neck
            Whether the force in tension, now the yield force, rises to that of the neck.
        """
        curve = material.hardening
        if curve is None:
            return self
        pulled = necking_strain(curve) if neck else 0.0
        rises = tuple(_rise(curve, end, sense, length) for end, sense in ((pulled, 1), (strain, -1)))
        first = rises[0][1][:1] or (1.0,)
        stop = self.stop and replace(self.stop, rotation=self.stop.rotation + strain * length)
        return replace(self, tension=self.tension / first[0], rises=(rises[0], rises[1]), stop=stop)

    @property
    def folding(self) -> AxialCollapse:
        """What follows the rise, as if nothing had happened before."""
        return replace(self, rises=(NO_RISE, NO_RISE))

    @property
    def origin(self) -> str:
        """Law, source and evidence in words."""
        band = self.validity.uncertainty
        known = "band not known" if band is None else f"band ±{100.0 * band:.2g} %"
        if self.source is CHOSEN:
            return self.crushing
        basis = f"{self.source.citation} ({self.source.trust.value}); {self.validity.basis}"
        return f"{self.crushing}, {known}: {basis}"

    def kinks(self, sense: int = 1) -> tuple[float, ...]:
        """Slip at which the slope of the force changes."""
        rise = self.rises[0 if sense > 0 else 1][0]
        end = rise[-1] if rise else 0.0
        later = () if sense > 0 else self.points[0]
        return tuple(at for at in (*rise, *(end + one for one in later)) if 0.0 < at < math.pi)

    def moment_capacity(self, rotation: ArrayLike, sense: int = 1) -> Floats:
        """Force [N] at a slip [m]: sense -1 is shortening."""
        u = np.asarray(rotation, np.float64)
        slip, share = self.rises[0 if sense > 0 else 1]
        beyond = np.maximum(u - slip[-1], 0.0) if slip else u
        later = np.full_like(u, self.tension) if sense > 0 else np.interp(beyond, *self.points)
        return np.asarray(later * np.interp(u, slip, share) if slip else later, np.float64)

    def rate_factor(self, rotation_rate: ArrayLike) -> Floats:
        """Factor at a speed of slip [m/s]."""
        return rate_factor(self.rate, rotation_rate)


def _doubts(law: AxialLaw, length: float) -> Iterator[str]:
    """What a law says of no column of this length [m], and of no wall this thick."""
    if law.half_fold_length is not None and length < 2.0 * law.half_fold_length:
        yield (
            f"what folds is {format_quantity(length, 'm', 3)} long, less than one fold of the law, "
            f"{format_quantity(2.0 * law.half_fold_length, 'm', 3)}: it cannot fold so"
        )
    if law.mean_crushing_force > law.peak_force:
        yield (
            f"its mean force, {format_quantity(law.mean_crushing_force, 'N', 3)}, is above its peak, "
            f"{format_quantity(law.peak_force, 'N', 3)}, which is used instead: walls this thick are crushed "
            "without folds"
        )


def _rise(curve: HardeningCurve, strain: float, sense: int, length: float) -> _Curve:
    """Slip over a length [m] and share of the last force."""
    places, share = uniform_yield(curve, strain, sense)
    return tuple((length * places).tolist()), tuple(share.tolist())


def _linear(peak: float, mean: float, stroke: float) -> _Curve:
    """A fall over `FIRST_FALL` of the stroke to the force that makes the mean over the stroke."""
    if not math.isfinite(stroke):
        return (0.0,), (mean,)
    fall = min(FIRST_FALL, mean / peak) * stroke
    return (0.0, fall), (peak, (mean * stroke - peak * fall / 2.0) / (stroke - fall / 2.0))


def _folding(peak: float, mean: float, fold: float, stroke: float) -> _Curve:
    """The curve of the module's docstring in straight pieces of the same work."""
    if mean == peak:
        return (0.0,), (peak,)
    least, end = 1.0 - math.sqrt(1.0 - mean / peak), max(END, mean / peak)

    def curve(x: float) -> _Curve:
        """With the plateau x^2 of the fold; that of a single fold does not rise at its end."""
        rise = 0.0 if fold >= stroke else (1.0 - x**2) * fold / 4.0
        at = np.geomspace(x**2 * fold, fold - rise, PIECES + 1)
        last = () if fold >= stroke else ((fold + rise, mean),)
        force = end * peak * x * np.sqrt(fold / at)
        return (0.0, *at.tolist(), *(u for u, _ in last)), (peak, *force.tolist(), *(p for _, p in last))

    def excess(x: float) -> float:
        at, force = curve(x)
        return float(np.diff(at) @ (np.add(force[1:], force[:-1]) / 2.0)) / (mean * at[-1]) - 1.0

    return curve(rising_root(excess, 0.5 * least, 0.5 * (1.0 + least), 1e-9))
