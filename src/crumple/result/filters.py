"""Channel frequency class (CFC) filters of SAE J211-1 and ISO 6487.

A two-pole Butterworth low-pass is run forward and then backward, which gives four poles and no phase shift:

    y[t] = a0 x[t] + a1 x[t-1] + a2 x[t-2] + b1 y[t-1] + b2 y[t-2]

With the design frequency f_d and the warped frequency w = tan(pi f_d dt) the coefficients are
a0 = a2 = w^2/D, a1 = 2 a0, b1 = -2 (w^2 - 1)/D, b2 = (-1 + sqrt(2) w - w^2)/D, D = 1 + sqrt(2) w + w^2.
Both runs together pass the power 1/2 (-3 dB) where one run passes 1/sqrt(2): there (f/f_d)^4 = sqrt(2) - 1,
so f_d = 1.2465 times the cut-off.  The standards write f_d = 2.0775 CFC (SAE) and 1.25/0.6 CFC (ISO), which
puts the cut-off near 5/3 CFC.

Ends: the record is continued by its mirror image through its first and its last point, 10 ms and at least 100
samples long (or as long as the record allows), and each run starts at rest on the mean of ten samples.  The
mirror image takes a pulse at the start back; where the value before is known, it is put there instead.

Limits: see docs/theory/filters.md, also for what was read and what is quoted.
"""

from __future__ import annotations

import math
from typing import Literal, TypeAlias, get_args

import numpy as np
from numpy.typing import ArrayLike, NDArray

from crumple.errors import InputError, Problem

ChannelClass: TypeAlias = Literal[60, 180, 600, 1000]
Standard: TypeAlias = Literal["SAE J211", "ISO 6487"]

DESIGN_FACTOR: dict[Standard, float] = {"SAE J211": 2.0775, "ISO 6487": 1.25 / 0.6}
"""Design frequency of one run over the class [-]."""

CUT_OFF: dict[int, float] = {60: 100.0, 180: 300.0, 600: 1000.0, 1000: 1650.0}
"""Nominal -3 dB frequency of each class [Hz]."""

SAMPLES_PER_CUT_OFF = 6.0
"""Least sampling frequency over the cut-off [-]; below it the record itself is too coarse."""

_EXTENSION_TIME = 0.010  # [s] of mirror image at each end
_EXTENSION_SAMPLES = 100  # least number of samples of it
_START_SAMPLES = 10  # whose mean starts each run
_SPACING_TOLERANCE = (
    1e-6  # of the time step; larger than rounding of t = i dt, smaller than any real change of step
)


def cfc(
    values: ArrayLike,
    time_step: float,
    channel_class: ChannelClass,
    *,
    standard: Standard = "SAE J211",
    before: float | None = None,
) -> NDArray[np.float64]:
    """Filter a history with one of the four channel frequency classes.

    Parameters
    ----------
    values
        Samples at equal spacing, any unit, shape (n,), n >= 4.
    time_step
        Spacing [s].
    channel_class
        60, 180, 600 or 1000.
    standard
        Whose design frequency to use; the two differ by 0.3 %.
    before
        Value before the record, such as 0 of a force that nothing exerted; None: the mirror image.

    Returns
    -------
    NDArray
        Filtered samples in the unit of `values`, shape (n,), without phase shift.

    Raises
    ------
    InputError
        If the class is unknown, the record is too short or holds NaN or infinity, or it is sampled at less
        than six times the cut-off.

    References
    ----------
    Derivation and sources in docs/theory/filters.md.
    Verified in tests/verification/comparison/test_cfc_filters.py.
    """
    samples = np.asarray(values, dtype=np.float64)
    _check(samples, time_step, channel_class, standard)
    coefficients = butterworth(DESIGN_FACTOR[standard] * channel_class, time_step)
    wanted = max(round(_EXTENSION_TIME / time_step), _EXTENSION_SAMPLES)
    length = min(wanted, samples.size - 1)
    head = 2 * samples[0] - samples[length:0:-1] if before is None else np.full(wanted, before)
    extended = np.concatenate([head, samples, 2 * samples[-1] - samples[-2 : -length - 2 : -1]])
    forward = _run(extended.tolist(), coefficients)
    backward = _run(forward[::-1], coefficients)
    return np.array(backward[::-1])[head.size : head.size + samples.size]


def value_before(channel: str) -> float | None:
    """Value of a channel before a run: 0 of obstacle forces and accelerations, else not known."""
    quiet = ".acceleration." in channel or (channel.startswith("obstacle.") and ".force." in channel)
    return 0.0 if quiet else None


def butterworth(design_frequency: float, time_step: float) -> tuple[float, float, float, float, float]:
    """Coefficients a0, a1, a2, b1, b2 of one run.

    Parameters
    ----------
    design_frequency
        Frequency at which one run passes half the power [Hz].
    time_step
        [s].
    """
    w = math.tan(math.pi * design_frequency * time_step)
    D = 1 + math.sqrt(2) * w + w * w
    a0 = w * w / D
    return a0, 2 * a0, a0, -2 * (w * w - 1) / D, (-1 + math.sqrt(2) * w - w * w) / D


def uniform_step(time: NDArray[np.float64]) -> float:
    """Spacing of equally spaced times [s].

    Parameters
    ----------
    time
        [s], shape (n,), increasing.

    Raises
    ------
    InputError
        If there are fewer than two times or the spacing changes.
    """
    if time.size < 2:
        raise InputError(Problem("a filter needs at least two output times", came=f"{time.size}"))
    step = float(time[-1] - time[0]) / (time.size - 1)
    if not step > 0 or not np.allclose(np.diff(time), step, rtol=0, atol=_SPACING_TOLERANCE * step):
        steps = np.diff(time)
        raise InputError(
            Problem(
                "a CFC filter needs equally spaced times",
                came=f"steps from {steps.min():.6g} s to {steps.max():.6g} s",
                allowed="one constant step",
                todo="ask for outputs at an interval that divides the duration, or resample the history",
            )
        )
    return step


def _run(samples: list[float], coefficients: tuple[float, float, float, float, float]) -> list[float]:
    """One run of the difference equation, started at rest on the mean of the first ten samples."""
    a0, a1, a2, b1, b2 = coefficients
    start = samples[:_START_SAMPLES]
    y1 = y2 = math.fsum(start) / len(start)
    x2, x1 = samples[0], samples[1]
    filtered = [y2, y1]
    for x0 in samples[2:]:
        y0 = a0 * x0 + a1 * x1 + a2 * x2 + b1 * y1 + b2 * y2
        filtered.append(y0)
        x2, x1, y2, y1 = x1, x0, y1, y0
    return filtered


def _check(samples: NDArray[np.float64], time_step: float, channel_class: int, standard: str) -> None:
    if channel_class not in CUT_OFF:
        classes = ", ".join(map(str, CUT_OFF))
        raise InputError(
            Problem("unknown channel frequency class", came=repr(channel_class), allowed=classes)
        )
    if standard not in get_args(Standard):
        raise InputError(
            Problem("unknown filter standard", came=repr(standard), allowed=", ".join(get_args(Standard)))
        )
    if samples.ndim != 1 or samples.size < 4:
        raise InputError(
            Problem("a CFC filter needs one history of at least 4 samples", came=str(samples.shape))
        )
    if not np.isfinite(samples).all():
        raise InputError(Problem("a CFC filter needs finite samples", came="NaN or infinity in the history"))
    least = SAMPLES_PER_CUT_OFF * CUT_OFF[channel_class]
    if not (math.isfinite(time_step) and time_step > 0) or 1 / time_step < least * (1 - 1e-9):
        came = f"{1 / time_step:.6g} Hz" if time_step > 0 else f"a time step of {time_step!r} s"
        raise InputError(
            Problem(
                f"sampled too coarsely for CFC {channel_class}",
                came=came,
                allowed=f"at least {least:g} Hz, a time step of at most {1000 / least:.4g} ms",
                todo="shorten the output interval or take a lower class",
            )
        )
