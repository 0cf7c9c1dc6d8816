"""Points in groups to an executor, and their rows as soon as they are known."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, Executor, Future, wait
from contextlib import contextmanager

from crumple.errors import InputError, Problem
from crumple.study.rows.model import Row
from crumple.study.space import Point

TARGET_TIME = 0.4
"""Time that a group of points takes [s]: rows are stored at the latest a second after they are known."""
WAIT = 0.5
"""Time after which waiting for rows is interrupted [s]."""
GROWTH = 8
"""Most by which a group is larger than the one that its size was measured by."""
Solve = Callable[[Sequence[Point]], tuple[list[Row], float]]
"""Picklable; points to their rows, and the time that it took [s]."""


def in_groups(
    executor: Executor,
    solve: Solve,
    points: Sequence[Point],
    ahead: int,
    *,
    first: int = 0,
    size: int = 1,
    largest: int = 1,
) -> Iterator[list[tuple[int, Row]]]:
    """Numbers of points and their rows, in the order in which they become known.

    Parameters
    ----------
    executor
        Any.
    solve
        Is given to it with each group.
    points
        All; those before `first` are left out.
    ahead
        Groups that are given to the executor at a time.
    size, largest
        Of the first group, and of any.

    Raises
    ------
    InputError
        If a process of the executor ended.
    """
    working: dict[Future[tuple[list[Row], float]], tuple[int, int]] = {}
    try:
        with _broken_refused():
            while first < len(points) or working:
                while first < len(points) and len(working) < ahead:
                    # the last groups are small, so that all processes end at about the same time
                    count = max(min(size, (len(points) - first) // ahead), 1)
                    future = executor.submit(solve, points[first : first + count])
                    working[future] = first, count
                    first += count
                # without news rows that are known are kept in the meantime
                done, _ = wait(working, WAIT, return_when=FIRST_COMPLETED)
                found: list[tuple[int, Row]] = []
                for one in done:
                    start, count = working.pop(one)
                    rows, seconds = one.result()
                    found += enumerate(rows, start)
                    wanted = int(TARGET_TIME * count / max(seconds, 1e-6))
                    size = max(min(wanted, GROWTH * count, largest), 1)
                yield found
    finally:
        for one in working:
            one.cancel()


@contextmanager
def _broken_refused() -> Iterator[None]:
    """A process that ended is a mistake of no row."""
    try:
        yield
    except BrokenExecutor:
        what, todo = "a worker process ended", "look for lack of memory; go on with --resume"
        raise InputError(Problem(what, "", "", todo)) from None
