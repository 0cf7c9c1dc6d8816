"""Several jobs at a time, each in a process of its own, with their progress.

A process whose parent is gone finds its pipe closed at its next report, and can stop.  Ctrl-C reaches all
processes of a terminal; the first one ends the others.
"""

from __future__ import annotations

import multiprocessing
import signal
import time
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from contextlib import suppress
from multiprocessing.connection import Connection, wait
from multiprocessing.process import BaseProcess
from typing import Any, Protocol, TypeVar

PATIENCE = 0.2
"""Time between two looks at whether the work is to be cancelled [s]."""
START = 60.0
"""Longest start of a process [s]; a busy machine takes seconds."""

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


class Work(Protocol):
    """What a `Worker` does: a picklable object of a module, which may remember things from job to job.

    It is called with the job, `Report`, and a function that returns whether the job is to be stopped.
    """

    def __call__(self, job: Any, report: Report, stopped: Callable[[], bool]) -> Any: ...


class WorkerError(Exception):
    """The process ended, failed or was ended at a limit, as the text says; the next job gets a new one."""


class Worker:
    """A process that does one job after the other, and whose end is only its own.

    Parameters
    ----------
    work
        Done for every job.
    memory
        Address space of the process [byte]; not limited on systems without such limits.
    """

    def __init__(self, work: Work, memory: int) -> None:
        self._work, self._memory = work, memory
        self._process: BaseProcess | None = None
        self._pipe: Connection | None = None

    @property
    def pid(self) -> int | None:
        """Number of the process, None if there is none."""
        return None if self._process is None else self._process.pid

    def ask(
        self,
        job: Any,
        seconds: float,
        cancel: Callable[[], bool] | None = None,
        progress: Callable[[float], None] | None = None,
    ) -> Any:
        """Answer to a job; blocks until there is one.

        Parameters
        ----------
        job
            Picklable.
        seconds
            Time after which the process is ended.
        cancel
            Called repeatedly; if it returns True, the job is told to stop.
        progress
            Called with the share that is done.

        Raises
        ------
        WorkerError
            If there is none.
        """
        pipe = self._started()
        try:
            pipe.send(job)
            return self._answer(pipe, seconds, cancel, progress)
        except (EOFError, OSError):
            self.end()
            raise WorkerError("the process that solves ended unexpectedly") from None

    def _answer(
        self,
        pipe: Connection,
        seconds: float,
        cancel: Callable[[], bool] | None,
        progress: Callable[[float], None] | None,
    ) -> Any:
        end, told = time.monotonic() + seconds, False
        while True:
            if pipe.poll(PATIENCE / 10):
                kind, value = pipe.recv()
                if kind == "answer":
                    return value
                if kind == "failed":
                    self.end()
                    raise WorkerError(value)
                if kind == "share" and progress is not None:
                    progress(value)
            elif time.monotonic() > end:
                self.end()
                raise WorkerError(f"stopped: it took longer than {seconds:g} s")
            if not told and cancel is not None and cancel():
                told = True
                pipe.send(None)

    def end(self) -> None:
        """End the process, whatever it does."""
        if self._process is not None:
            self._process.kill()
            self._process.join()
        if self._pipe is not None:
            self._pipe.close()
        self._process = self._pipe = None

    def _started(self) -> Connection:
        if self._pipe is not None and self._process is not None and self._process.is_alive():
            return self._pipe
        self.end()
        context = multiprocessing.get_context("spawn")
        here, there = context.Pipe()
        process = context.Process(target=_serve, args=(there, self._work, self._memory), daemon=True)
        try:
            process.start()
        except OSError as error:
            # no memory, or no more processes, for the moment
            here.close()
            raise WorkerError(f"the process that solves could not be started: {error.strerror}") from None
        finally:
            there.close()
        self._process, self._pipe = process, here
        try:
            # its start is not part of the time of a job
            ready = here.poll(START) and here.recv() == ("ready", None)
        except (EOFError, OSError):
            ready = False
        if not ready:
            self.end()
            raise WorkerError("the process that solves could not be started")
        return here


def _serve(pipe: Connection, work: Work, memory: int) -> None:
    """Do jobs until the parent is gone."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    _limit_memory(memory)

    def report(share: float) -> bool:
        try:
            pipe.send(("share", share))
        except OSError:
            return False
        return True

    pipe.send(("ready", None))
    while True:
        try:
            job = pipe.recv()
        except (EOFError, OSError):
            return
        if job is None:
            # it came after the job that it was to stop
            continue
        try:
            answer = ("answer", work(job, report, pipe.poll))
        except MemoryError:
            answer = ("failed", "stopped: it needs more memory than is allowed")
        except Exception as error:
            answer = ("failed", f"a defect of Crumple: {type(error).__name__}: {str(error)[:300]}")
        try:
            pipe.send(answer)
        except OSError:
            return


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


def _limit_memory(size: int) -> None:
    """Limit the address space of this process [byte], where the system can."""
    try:
        import resource  # noqa: PLC0415  (not on Windows)
    except ImportError:
        return
    resource.setrlimit(resource.RLIMIT_AS, (size, size))
