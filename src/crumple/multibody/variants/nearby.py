"""Range from the hinge laws and modes of collapse in one call: their runs together fill the threads.

Where every law has a band, both ask for laws that are alternately low and high: each run is solved once.
"""

from __future__ import annotations

from crumple.multibody.run import Cancel, Progress, Run
from crumple.multibody.variants.law_range import CASES, law_factors, law_range, range_of
from crumple.multibody.variants.modes import Changes, columns_of, mode_runs, modes, modes_of
from crumple.multibody.variants.variants import solve_variants
from crumple.result.nearby import LawRange, Modes
from crumple.result.result import Result
from crumple.structure import Structure, with_elastic_members


def range_and_modes(
    structure: Structure,
    run: Run,
    result: Result,
    threads: int | None = None,
    progress: Progress | None = None,
    cancel: Cancel | None = None,
) -> tuple[LawRange | None, Modes | None]:
    """What `law_range` and `modes` return, with the same bits.

    Parameters
    ----------
    structure, run, result, threads, progress, cancel
        As in `modes`.

    References
    ----------
    Verified in tests/unit/multibody/variants/test_nearby.py.
    """
    elastic = with_elastic_members(structure, run.settings, run.duration)
    runs, factors = mode_runs(elastic, run), law_factors(elastic)
    if not runs:
        return law_range(structure, run, result, threads, cancel), None
    if not factors[0]:
        return None, modes(structure, run, result, threads, progress, cancel)
    of_laws = [{name: float(column[i]) for name, column in factors[2].items()} for i in range(len(CASES))]
    numbers: dict[tuple[tuple[str, float], ...], int] = {}
    rows = [numbers.setdefault(_key(changes), len(numbers)) for changes in (*of_laws, *runs.values())]
    distinct = [dict(key) for key in numbers]
    table = solve_variants(elastic, run, columns_of(elastic, distinct), threads, progress, cancel)
    ranged = range_of(table.rows(rows[: len(CASES)]), factors, run, result)
    others = table.rows(rows[len(CASES) :])
    return ranged, modes_of(others, runs, elastic, run, result, threads=threads, cancel=cancel)


def _key(changes: Changes) -> tuple[tuple[str, float], ...]:
    return tuple(sorted(changes.items()))
