"""Bands of the curves of an answer from the bands of its hinge laws."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

from crumple.errors import CancelledError

if TYPE_CHECKING:
    from crumple.analysis import LoadedInput
    from crumple.result import Result


def bands_of(source: LoadedInput, result: Result, stopped: Callable[[], bool]) -> dict[str, Any] | None:
    """Least and greatest value of each curve of the answer at its samples, in its unit.

    The runs are those of `crumple.multibody.law_range`: all laws at the lower edges of their bands, at the
    upper ones, and alternating.

    Returns
    -------
    dict or None
        ``curves`` with ``name``, ``unit``, ``low`` and ``high``; ``laws`` with and ``without`` a known band;
        ``failed`` runs.  None if no law has a known band, or if it was stopped.
    """
    from crumple.analysis.solve import run_of  # noqa: PLC0415
    from crumple.multibody import law_factors, solve_variants  # noqa: PLC0415
    from crumple.report.drawing.scales import display_unit, largest  # noqa: PLC0415
    from crumple.report.exploration import SAMPLES, curves_of  # noqa: PLC0415

    structure = source.analysis.structure
    bands, without, factors = law_factors(structure)
    if not bands:
        return None
    times = np.linspace(0.0, float(result.time[-1]), SAMPLES)
    try:
        table = solve_variants(structure, run_of(source.analysis), factors, cancel=stopped, times=times[1:])
    except CancelledError:
        return None
    good = np.array([status.ok for status in table.status])
    if stopped() or not good.any():
        return None
    found = []
    for curve in curves_of([result]):
        name = str(curve["name"])
        if name not in table.histories:
            continue
        _, factor = display_unit(
            result.channels[name].unit, largest([np.interp(times, result.time, result[name])])
        )
        nominal = np.array(curve["values"][0])
        runs = np.vstack([table.histories[name][good] / factor, nominal[1:]])
        low, high = (np.concatenate([nominal[:1], f(runs, axis=0)]) for f in (np.nanmin, np.nanmax))
        ends = {key: [float(f"{value:.5g}") for value in row] for key, row in (("low", low), ("high", high))}
        found.append({"name": name, "unit": curve["unit"], **ends})
    return {
        "curves": found,
        "laws": len(bands),
        "without": len(without),
        "failed": int((~good).sum()),
    }
