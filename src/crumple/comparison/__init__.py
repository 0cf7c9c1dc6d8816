"""Two results, or a result and a measured curve: metrics, rating, verdict."""

from crumple.comparison.comparing import compare
from crumple.comparison.comparison import Comparison, Opening, Source, Timing, Trust
from crumple.comparison.measure.energy import energy_put_in
from crumple.comparison.measure.metrics import HingeComparison, HingeMetrics
from crumple.comparison.measure.motion import HingeMotion, rate_of
from crumple.comparison.rating.curve_file import CurveFile, read_curves
from crumple.comparison.rating.pairing import Pair
from crumple.comparison.rating.rating import EDITION, SAMPLING_RATE, Rating, rating
from crumple.comparison.rating.signal import Signal
from crumple.comparison.solving import (
    picture_times,
    solve_and_compare,
    with_frames,
    with_mesh,
    with_pictures,
)
from crumple.comparison.variant import MODEL_NAMES

__all__ = [
    "EDITION",
    "MODEL_NAMES",
    "SAMPLING_RATE",
    "Comparison",
    "CurveFile",
    "HingeComparison",
    "HingeMetrics",
    "HingeMotion",
    "Opening",
    "Pair",
    "Rating",
    "Signal",
    "Source",
    "Timing",
    "Trust",
    "compare",
    "energy_put_in",
    "picture_times",
    "rate_of",
    "rating",
    "read_curves",
    "solve_and_compare",
    "with_frames",
    "with_mesh",
    "with_pictures",
]
