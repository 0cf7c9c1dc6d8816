"""Several jobs at a time, each in a process of its own, with their progress.

A process whose parent is gone finds its pipe closed at its next report, and can stop.  Ctrl-C reaches all
processes of a terminal; the first one ends the others.
"""

from __future__ import annotations

import multiprocessing
import signal
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from contextlib import suppress
from multiprocessing.connection import Connection, wait
from multiprocessing.process import BaseProcess
from typing import Any, TypeVar

PATIENCE = 0.2
"""Time between two looks at whether the work is to be cancelled [s]."""

Job = TypeVar("Job")
Answer = TypeVar("Answer")
Report = Callable[[float], bool]
"""Called in a process with the share done; returns whether the parent is still there."""


def in_processes(
    work: Callable[[Job, Report], Answer],
    jobs: Sequence[Job],
    workers: int,
    progress: Callable[[int, float], None] | None = None,
    cancel: Callable[[], bool] | None = None,
) -> Iterator[tuple[int, Answer | None]]:
    """Do jobs in parallel processes.

    Parameters
    ----------
    work
        Function of a module; it and the jobs must be picklable.
    jobs
        In the order in which they are begun.
    workers
        Number of processes at a time, at least 1.
    progress
        Called with the number of a job and the share of it that is done.
    cancel
        Called repeatedly; if it returns True, the processes are ended.

    Yields
    ------
    tuple
        Number of a job and its answer, None if its process ended without one; jobs that were not finished
        when cancelled are missing.
    """
    context = multiprocessing.get_context("spawn")
    waiting = list(enumerate(jobs))
    working: dict[Connection, tuple[int, BaseProcess]] = {}
    try:
        while waiting or working:
            if cancel is not None and cancel():
                return
            while waiting and len(working) < workers:
                number, job = waiting.pop(0)
                here, there = context.Pipe(duplex=False)
                process = context.Process(target=_run, args=(there, work, job), daemon=True)
                process.start()
                there.close()
                working[here] = (number, process)
            for ready in wait(list(working), PATIENCE):
                assert isinstance(ready, Connection)
                number, started = working[ready]
                kind, value = _received(ready)
                if kind == "share":
                    if progress is not None:
                        progress(number, value)
                    continue
                started.join()
                ready.close()
                del working[ready]
                yield number, value
    finally:
        for _, started in working.values():
            started.terminate()


def process_pool(workers: int) -> ProcessPoolExecutor:
    """Executor with new processes, which inherit no threads; Ctrl-C is left to the parent."""
    context = multiprocessing.get_context("spawn")
    return ProcessPoolExecutor(workers, mp_context=context, initializer=_leave_interrupts)


def _leave_interrupts() -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)


def _received(connection: Connection) -> tuple[str, Any]:
    try:
        kind, value = connection.recv()
    except (EOFError, OSError):
        return "answer", None
    return kind, value


def _run(connection: Connection, work: Callable[[Any, Report], Any], job: Any) -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)

    def report(share: float) -> bool:
        try:
            connection.send(("share", share))
        except OSError:
            return False
        return True

    answer = work(job, report)
    with suppress(OSError):
        connection.send(("answer", answer))
