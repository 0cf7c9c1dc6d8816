"""Figures of a hinge in one result and in two results side by side: rotation, energy, moment, opening."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from crumple.comparison.measure.motion import HingeMotion
from crumple.numeric.arrays import Floats
from crumple.numeric.crossing import first_above

OPENED_AT = math.radians(0.5)
"""Plastic rotation [rad] from which a hinge counts as open."""
NOTHING = 1e-3
"""Plastic rotation [rad] below which a hinge did not bend: no mean moment (work over rotation) then."""
STEPS = (1.0, 2.0, 5.0)
"""Round steps of the rotations [deg] at which energies are compared, to be multiplied by powers of ten."""
LEVELS = 5
"""Approximate number of these rotations."""


@dataclass(frozen=True, eq=False)
class HingeMetrics:
    """Figures of one hinge in one result; None where they are not available.

    Attributes
    ----------
    rotation_max, time_of_peak
        Largest magnitude [rad] and when [s].
    far_rotation_max
        Largest magnitude of the rotation seen from the far end [rad].
    plastic_rotation
        Largest magnitude of plastic rotation [rad].
    plastic_energy
        Dissipated at the end [J].
    energy_at
        Dissipated when each of the plastic rotations of the comparison is first reached [J].
    moment_peak, moment_mean
        Largest magnitude, and energy over plastic rotation [N m].
    opened
        When it opened [s]; None if it never did.
    """

    rotation_max: float
    time_of_peak: float
    far_rotation_max: float | None
    plastic_rotation: float
    plastic_energy: float
    energy_at: tuple[float | None, ...]
    moment_peak: float | None
    moment_mean: float | None
    opened: float | None


@dataclass(frozen=True, eq=False)
class HingeComparison:
    """One hinge in both results.

    Attributes
    ----------
    name, member, station
        Of the hinge [m].
    first, second
        In the candidate (multibody) and in the reference (shell); None if that result does not contain it.
    levels
        Plastic rotations [rad] of `HingeMetrics.energy_at`.
    fold_station, fold_extent
        Where the reference folded [m]; None without a fold there.
    how
        How the reference was measured.
    """

    name: str
    member: str
    station: float
    first: HingeMetrics | None
    second: HingeMetrics | None
    levels: tuple[float, ...]
    fold_station: float | None = None
    fold_extent: tuple[float, float] | None = None
    how: str = ""

    def error(self, quantity: str) -> float | None:
        """Relative error of a figure of the candidate; None if the reference has no fold or no figure."""
        if self.first is None or self.second is None or self.fold_station is None:
            return None
        a, b = getattr(self.first, quantity), getattr(self.second, quantity)
        if a is None or b is None or not b:
            return None
        return float(a / b - 1.0)

    def energy_errors(self) -> tuple[float | None, ...]:
        """Relative error of plastic energy at every level."""
        if self.first is None or self.second is None or self.fold_station is None:
            return tuple(None for _ in self.levels)
        pairs = zip(self.first.energy_at, self.second.energy_at, strict=True)
        return tuple(a / b - 1.0 if a is not None and b else None for a, b in pairs)


def rotation_levels(largest: float) -> tuple[float, ...]:
    """Round plastic rotations [rad] up to the largest that both reached, about five."""
    degrees = math.degrees(largest)
    if not degrees > 0.1:
        return ()
    target = degrees / LEVELS
    power = 10.0 ** math.floor(math.log10(target))
    step = min((s * power for s in (*STEPS, 10.0)), key=lambda s: abs(math.log(s / target)))
    return tuple(math.radians(step * k) for k in range(1, int(degrees / step + 1e-9) + 1))


def metrics_of(motion: HingeMotion, levels: tuple[float, ...]) -> HingeMetrics:
    """Figures of one hinge.

    Parameters
    ----------
    motion
        Its history.
    levels
        Plastic rotations [rad] at which the energy is computed.
    """
    side = motion.sense
    peak = int(np.argmax(side * motion.rotation))
    plastic = np.maximum.accumulate(np.maximum(side * motion.plastic_rotation, 0.0))
    most, work = float(plastic[-1]), float(motion.plastic_work[-1])
    moment = float(np.abs(motion.moment).max(initial=0.0))
    far = None if motion.far is None else float(np.nanmax(np.abs(motion.far)))
    return HingeMetrics(
        rotation_max=float(side * motion.rotation[peak]),
        time_of_peak=float(motion.time[peak]),
        far_rotation_max=far,
        plastic_rotation=most,
        plastic_energy=work,
        energy_at=tuple(_energy_at(plastic, motion.plastic_work, level) for level in levels),
        moment_peak=moment if moment > 0.0 and most > NOTHING else None,
        moment_mean=work / most if most > NOTHING and work > 0.0 else None,
        opened=first_above(motion.time, plastic, OPENED_AT),
    )


def _energy_at(plastic: Floats, work: Floats, level: float) -> float | None:
    """Energy when a growing plastic rotation first reaches a level; None if it never does."""
    if not plastic[-1] >= level:
        return None
    i = int(np.searchsorted(plastic, level))
    if i == 0 or plastic[i] == plastic[i - 1]:
        return float(work[i])
    share = (level - plastic[i - 1]) / (plastic[i] - plastic[i - 1])
    return float(work[i - 1] + share * (work[i] - work[i - 1]))


def compared(place: HingeMotion, first: HingeMotion | None, second: HingeMotion | None) -> HingeComparison:
    """One hinge of both results side by side.

    Parameters
    ----------
    place
        Either of them, for name and place.
    first, second
        Candidate and reference.
    """
    both = [m for m in (first, second) if m is not None and m.rotation.size]
    largest = min((float(np.max(m.sense * m.plastic_rotation)) for m in both), default=0.0)
    levels = rotation_levels(largest)
    found = second is not None and second.fold
    return HingeComparison(
        name=place.name,
        member=place.member,
        station=first.station if first is not None else place.station,
        first=metrics_of(first, levels) if first is not None and first.time.size else None,
        second=metrics_of(second, levels) if second is not None and second.time.size else None,
        levels=levels,
        fold_station=second.station if second is not None and found else None,
        fold_extent=second.extent if second is not None else None,
        how=second.how if second is not None else "",
    )


def signed(error: float) -> str:
    """A relative error in per cent with its sign; what is rounded to zero has none."""
    text = f"{100 * error:+z.1f} %"
    return "0.0 %" if text == "+0.0 %" else text.replace("-", "−")


def percent(share: float) -> str:
    """A share in per cent."""
    return f"{100 * share:z.1f} %"


def deg(angle: float) -> str:
    """An angle [rad] in degrees."""
    return f"{math.degrees(angle):.1f}°"


def mm(length: float) -> str:
    """A length [m] in millimetres."""
    return f"{length * 1e3:.0f} mm"
