"""Runs with the hinge laws at the edges of their bands: all low, all high, and alternating.

A law with the relative half-width u is multiplied by 1 - u or 1 + u.  The runs are variants of one structure
in one call of the batch kernel.  Together they are a range, not a bound: other combinations may lie outside.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from crumple.multibody.run import Cancel, Run
from crumple.multibody.variants.variants import solve_variants
from crumple.numeric.arrays import Floats
from crumple.result.nearby import LawRange
from crumple.result.result import Result
from crumple.structure import Structure, plastic_hinges, with_elastic_members

NOMINAL = "nominal"
"""Name of the run with the laws as they are."""
CASES: dict[str, Callable[[int], float]] = {
    NOMINAL: lambda _: 0.0,
    "all laws low": lambda _: -1.0,
    "all laws high": lambda _: 1.0,
    "alternating, the first low": lambda k: -1.0 if k % 2 == 0 else 1.0,
    "alternating, the first high": lambda k: 1.0 if k % 2 == 0 else -1.0,
}
"""Sense in which the law of the k-th hinge with a band is changed, by the name of the run."""
WIDEST = 0.95
"""Largest half-width that is used [-]: the capacity must stay positive."""


def law_range(
    structure: Structure, run: Run, nominal: Result, threads: int | None = None, cancel: Cancel | None = None
) -> LawRange | None:
    """Range of a result from the bands of its laws.

    Parameters
    ----------
    structure, run
        As they were solved.
    nominal
        Result with the nominal laws, which is one of the runs.
    threads, cancel
        As in `solve_variants`.

    Returns
    -------
    LawRange or None
        None if no law has a known band.

    Raises
    ------
    CancelledError
        If it is cancelled.

    References
    ----------
    docs/theory/measured_curves.md.  Verified in tests/unit/multibody/variants/test_law_range.py.
    """
    run = run_as_solved(run, nominal)
    bands, without, factors = law_factors(with_elastic_members(structure, run.settings, run.time_in_motion))
    if not bands:
        return None
    # the result is the run with the nominal laws, to the bit: the others take the steps of an answer, too
    changed = {name: column[1:] for name, column in factors.items()}
    names = [name for name in CASES if name != NOMINAL]
    table = solve_variants(structure, run, changed, threads, cancel=cancel, as_answer=True)
    table.need_all("the range from the laws is")
    good = dict(zip(names, (status.ok for status in table.status), strict=True))
    known = _known(run, nominal)
    values = {name: table.quantities[name] for name in known if name in table.quantities}
    cases = {NOMINAL: {name: known[name] for name in values}}
    for i, case in enumerate(names):
        if good[case]:
            cases[case] = {name: float(column[i]) for name, column in values.items()}
    ranges = {name: _range([case[name] for case in cases.values()]) for name in values}
    failed = tuple(name for name in names if not good[name])
    return LawRange(ranges, bands, without, failed, cases)


def run_as_solved(run: Run, result: Result) -> Run:
    """The run with what the solver changed of its settings: a finer accuracy, or rigid bars."""
    used = result.provenance.settings
    changed = {"accuracy": used.get("accuracy_used"), "members": used.get("members")}
    update = {name: value for name, value in changed.items() if value is not None}
    return replace(run, settings=run.settings.model_copy(update=update))


def law_factors(structure: Structure) -> tuple[dict[str, float], tuple[str, ...], dict[str, Floats]]:
    """Half-widths of the bands by hinge, hinges without a known band, and factors of all runs by parameter.

    The factors are those of `CASES`, shape (5,) each, as `solve_variants` takes them.
    """
    widths = {hinge.name: hinge.law.validity.uncertainty for hinge in plastic_hinges(structure)}
    bands = {name: min(width, WIDEST) for name, width in widths.items() if width}
    factors = {
        f"hinges.{name}.capacity": np.array([1.0 + sense(k) * band for sense in CASES.values()])
        for k, (name, band) in enumerate(bands.items())
    }
    return bands, tuple(name for name in widths if name not in bands), factors


def _known(run: Run, nominal: Result) -> dict[str, float]:
    """Quantities that have a range, with their values for the nominal laws."""
    known = {
        f"hinge.{name}.{key}": float(getattr(hinge, key))
        for name, hinge in nominal.hinges.items()
        for key in ("rotation_max", "energy")
    }
    measured = {*run.outputs.distances, *run.outputs.clearances, "energy.dissipated"}
    return known | {
        name: float(channel.values[-1])
        for name, channel in nominal.channels.items()
        if name in measured or (name.startswith("node.") and ".displacement." in name)
    }


def _range(values: list[float]) -> tuple[float, float]:
    return min(values), max(values)
