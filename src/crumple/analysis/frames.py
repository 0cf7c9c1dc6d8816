"""A run with enough shapes to show its motion, whose histories are those of the run without them."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from crumple.analysis.analysis import Analysis
from crumple.analysis.canonical import input_hash
from crumple.analysis.solve import solve
from crumple.numeric.arrays import Floats
from crumple.result import Result, missing_pictures

MOST_FRAMES = {"multibody": 61, "shell": 31}
"""Shapes over a run that are enough to show its motion; those of shells take memory."""
MOST_MEMBERS = 500
"""Members above which no shapes are added: their points fill the page and the memory."""


def solve_with_frames(
    analysis: Analysis, fidelity: str = "multibody", *, most: int | None = None, **options: Any
) -> tuple[Result, Result]:
    """Result of one solver as `solve` returns it, and the same with shapes at more of its output times.

    Parameters
    ----------
    analysis
        Analysis to solve; not changed.
    fidelity, options
        As for `solve`.
    most
        Most shapes besides those at the picture times; None for those of `MOST_FRAMES`.

    Raises
    ------
    InputError
        As `solve`.
    """
    if len(analysis.structure.members) > MOST_MEMBERS:
        alone = solve(analysis, fidelity, **options)
        return alone, alone
    wanted, pictures = _picture_times(analysis, fidelity, most or MOST_FRAMES[fidelity])
    outputs = analysis.outputs.model_copy(update={"pictures": pictures})
    dense = solve(analysis.model_copy(update={"outputs": outputs}), fidelity, **options)
    if not dense.time.size:
        return dense, dense
    end = float(dense.time[-1])
    added = set(missing_pictures(pictures, end))
    own = tuple(missing_pictures(analysis.outputs.pictures, end))
    at = next((i for i, warning in enumerate(dense.warnings) if warning in added), len(dense.warnings))
    kept = [warning for warning in dense.warnings if warning not in added]
    dense = replace(
        dense,
        warnings=(*kept[:at], *own, *kept[at:]),
        provenance=replace(dense.provenance, input_hash=input_hash(analysis)),
    )
    return _with_shapes(dense, wanted), dense


def _picture_times(analysis: Analysis, fidelity: str, most: int) -> tuple[Floats, tuple[float, ...]]:
    """Times of the shapes that are stored, and of all that are solved for [s]; no new times of histories."""
    interval, duration = analysis.output_interval, analysis.duration
    regular = np.minimum(interval * np.arange(int(duration / interval * (1 + 1e-12)) + 1), duration)
    rows = np.linspace(0, len(regular) - 1, min(most, len(regular)))
    even = regular[np.unique(np.round(rows).astype(int))]
    requested = np.array(analysis.outputs.pictures)
    wanted = requested if requested.size else np.linspace(0.0, duration, 6)
    if fidelity == "multibody" and not requested.size:
        # these are taken at the nearest output, and add none
        every = np.union1d(regular, [duration])
        wanted = every[np.searchsorted((every[1:] + every[:-1]) / 2.0, wanted)]
    apart = np.abs(even[:, None] - wanted).min(axis=1) > 1e-9 * duration
    return wanted, tuple(np.union1d(even[apart], wanted).tolist())


def _with_shapes(result: Result, times: Floats) -> Result:
    """The same result with the shapes nearest to some times only, those that it reached."""
    states = result.states
    if states is None or not len(states.times):
        return result
    reached = times[times <= states.times[-1] * (1 + 1e-9)]
    rows = np.array([int(np.argmin(np.abs(states.times - t))) for t in reached], dtype=np.int64)
    return replace(
        result,
        states=replace(
            states,
            times=states.times[rows],
            displacement=states.displacement[rows],
            point_data={name: values[rows] for name, values in states.point_data.items()},
            cell_data={name: values[rows] for name, values in states.cell_data.items()},
        ),
    )
