"""CFC filters of SAE J211-1 and ISO 6487 have the gain and phase of their closed form.

Each run is the bilinear transform of a two-pole Butterworth filter.  Both runs together have the gain 1/(1
+ (tan(pi f dt)/tan(pi f_d dt))^4), with the design frequency f_d = 2.0775 CFC (SAE) or 1.25/0.6 CFC (ISO),
and no phase.  The tolerance of the gain is 1e-6: rounding, and the start of the runs after it has decayed.

The nominal cut-offs of 100, 300, 1000 and 1650 Hz at -3 dB, the least sampling frequency of six times the
cut-off, and the stop band of -30 dB (60, 180) and -40 dB (600, 1000) are those that Weisang documents for
the CFC filters of FlexPro, after ISO 6487:2000 and SAE J211/1 MAR95 (weisang.com, "CFC Filter Analysis
Object").  The corridor is that of the figure of the standards as it is widely quoted; the standards
themselves were not seen.

Kind: closed form; published.  Source: derived here; quoted.
"""

import math

import numpy as np
import pytest

from crumple.errors import InputError
from crumple.result import cfc
from crumple.result.filters import CUT_OFF

CLASSES = (60, 180, 600, 1000)
TIME_STEP = 1e-5


def response(channel_class, frequency, time_step=TIME_STEP, standard="SAE J211"):
    """Gain and phase [rad] of the filter on a sine, measured in the middle of a long record."""
    n = 2 * round(max(4 / frequency, 60 / channel_class) / time_step)
    t = np.arange(n) * time_step
    filtered = cfc(np.sin(2 * np.pi * frequency * t), time_step, channel_class, standard=standard)
    middle = slice(n // 4, 3 * n // 4)
    basis = np.stack([np.sin(2 * np.pi * frequency * t), np.cos(2 * np.pi * frequency * t)], axis=1)
    a, b = np.linalg.lstsq(basis[middle], filtered[middle], rcond=None)[0]
    return math.hypot(a, b), math.atan2(b, a)


def decibels(gain):
    return 20 * math.log10(gain)


@pytest.mark.parametrize("standard", ["SAE J211", "ISO 6487"])
@pytest.mark.parametrize("channel_class", CLASSES)
def test_gain_is_the_closed_form_and_the_phase_is_zero(channel_class, standard, record_figure):
    for ratio in (0.1, 0.5, 1.0, 1.667, 3.0, 5.0):
        f = ratio * channel_class
        f_d = (2.0775 if standard == "SAE J211" else 1.25 / 0.6) * channel_class
        expected = 1 / (1 + (math.tan(math.pi * f * TIME_STEP) / math.tan(math.pi * f_d * TIME_STEP)) ** 4)
        gain, phase = response(channel_class, f, standard=standard)
        assert phase == pytest.approx(0, abs=1e-4)
        if ratio == 1.667:
            record_figure(f"gain of CFC {channel_class} ({standard}) at 1.667 CFC", gain, expected, 1e-6)
        assert gain == pytest.approx(expected, abs=1e-6)


@pytest.mark.parametrize("channel_class", CLASSES)
def test_cut_off_and_stop_band(channel_class, record_figure):
    gain, _ = response(channel_class, CUT_OFF[channel_class])
    # 0.15 dB: CFC 1000 has its nominal cut-off at 1650 Hz, but 5/3 of its class is 1667 Hz
    name = f"gain of CFC {channel_class} at its cut-off of {CUT_OFF[channel_class]:g} Hz"
    record_figure(name, decibels(gain), -3.0, 0.15, "dB")
    stop = -30 if channel_class < 600 else -40
    gain, _ = response(channel_class, 4 * CUT_OFF[channel_class])
    assert decibels(gain) < stop


@pytest.mark.parametrize("channel_class", CLASSES)
def test_corridor(channel_class):
    """Flat to 0.5 dB; +0.5/-1 dB at the class; +0.5/-4 dB at the cut-off; then -9 to -24 dB/octave."""
    f_h, f_n = channel_class, CUT_OFF[channel_class]
    for f, low, high in (
        (0.1 * f_h, -0.5, 0.5),
        (f_h, -1.0, 0.5),
        (f_n, -4.0, 0.5),
        (2 * f_n, -4 - 24, 0.5 - 9),
        (3 * f_n, -4 - 24 * math.log2(3), 0.5 - 9 * math.log2(3)),
    ):
        gain, _ = response(channel_class, f)
        assert low <= decibels(gain) <= high


def test_recursion_agrees_with_scipy():
    """The coefficients are SciPy's Butterworth filter at the design frequency."""
    from scipy.signal import butter, lfilter

    from crumple.result.filters import butterworth

    a0, a1, a2, b1, b2 = butterworth(2.0775 * 180, 1e-4)
    numerator, denominator = butter(2, 2.0775 * 180, fs=1e4)
    np.testing.assert_allclose([a0, a1, a2], numerator, rtol=1e-12)
    np.testing.assert_allclose([1, -b1, -b2], denominator, rtol=1e-12)
    x = np.random.default_rng(1).standard_normal(4000)
    both = lfilter(numerator, denominator, lfilter(numerator, denominator, x)[::-1])[::-1]
    np.testing.assert_allclose(cfc(x, 1e-4, 180)[1000:3000], both[1000:3000], atol=1e-10)


def test_a_constant_stays_and_so_does_a_straight_line():
    t = np.arange(2000) * 1e-4
    np.testing.assert_allclose(cfc(np.full(2000, 3.5), 1e-4, 60), 3.5, rtol=1e-12)
    line = 5 * t - 0.3
    # the mirror image continues a line; what is left is the start of the runs, 10 ms outside the record
    np.testing.assert_allclose(cfc(line, 1e-4, 180), line, atol=1e-9)
    np.testing.assert_allclose(cfc(line, 1e-4, 60), line, atol=2e-4)


def test_time_reversal_changes_nothing_but_the_start():
    x = np.cumsum(np.random.default_rng(2).standard_normal(3000))
    there, back = cfc(x, 1e-4, 180), cfc(x[::-1], 1e-4, 180)[::-1]
    np.testing.assert_allclose(there[500:2500], back[500:2500], atol=1e-9)


@pytest.mark.parametrize("channel_class", CLASSES)
def test_a_known_past_is_as_good_as_a_longer_record(channel_class, record_figure):
    """A pulse that begins with the record: from zeros before it, as in a record that has them."""
    quiet = round(0.1 / TIME_STEP)
    pulse = np.sin(np.linspace(0.0, np.pi, round(0.1 / channel_class / TIME_STEP)))
    record = np.concatenate([pulse, np.zeros(quiet)])
    longer = cfc(np.concatenate([np.zeros(quiet), record]), TIME_STEP, channel_class)[quiet:]
    known = cfc(record, TIME_STEP, channel_class, before=0.0)
    # what is left of the run backward 10 ms before the record
    record_figure(
        f"difference over the peak, CFC {channel_class}",
        np.abs(known / longer.max() - longer / longer.max()).max(),
        0.0,
        5e-3,
    )
    assert cfc(record, TIME_STEP, channel_class).max() < 0.9 * known.max()


def test_a_step_keeps_its_place():
    x = np.where(np.arange(2001) < 1000, 0.0, 1.0)
    x[1000] = 0.5
    smooth = cfc(x, 1e-4, 60)
    assert smooth[1000] == pytest.approx(0.5, abs=1e-9)
    np.testing.assert_allclose(smooth + smooth[::-1], 1.0, atol=1e-9)


@pytest.mark.parametrize("channel_class", CLASSES)
def test_coarse_sampling_is_refused(channel_class):
    least = 6 * CUT_OFF[channel_class]
    cfc(np.zeros(50), 1 / least, channel_class)
    with pytest.raises(InputError, match=f"{least:g} Hz"):
        cfc(np.zeros(50), 1.001 / least, channel_class)


@pytest.mark.parametrize(
    ("values", "time_step", "channel_class", "words"),
    [
        (np.zeros(50), 1e-4, 100, "unknown channel frequency class"),
        (np.zeros(3), 1e-4, 60, "at least 4 samples"),
        (np.zeros((50, 2)), 1e-4, 60, "one history"),
        (np.full(50, math.nan), 1e-4, 60, "finite"),
        (np.zeros(50), 0.0, 60, "too coarsely"),
        (np.zeros(50), math.nan, 60, "too coarsely"),
        (np.zeros(50), -1e-4, 60, "too coarsely"),
    ],
)
def test_what_cannot_be_filtered_is_refused(values, time_step, channel_class, words):
    with pytest.raises(InputError, match=words):
        cfc(values, time_step, channel_class)


def test_unknown_standard_is_refused():
    with pytest.raises(InputError, match="standard"):
        cfc(np.zeros(50), 1e-4, 60, standard="DIN")


@pytest.mark.parametrize("n", [4, 5, 11, 99, 101, 102])
def test_short_records_keep_their_length(n):
    filtered = cfc(np.linspace(0, 1, n), 1e-4, 1000)
    assert filtered.shape == (n,)
    assert np.isfinite(filtered).all()
