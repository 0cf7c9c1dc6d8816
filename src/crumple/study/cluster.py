"""An executor on an existing Dask cluster, which gives work to others if a worker is lost or silent."""

from __future__ import annotations

import logging
import threading
import time
from collections import deque
from collections.abc import Callable
from concurrent.futures import Executor, Future
from dataclasses import dataclass, field
from functools import partial
from types import ModuleType
from typing import Any

from crumple.errors import InputError, Problem
from crumple.version import __version__

LIMIT = 600.0
"""Time without an answer after which work is given to another worker too [s]."""
TRIES = 3
"""Workers that work is given to before the study ends."""
CONNECTING = 10.0
"""Longest wait for the scheduler [s]."""
FIRST_WORKER = 30.0
"""Longest wait for its first worker [s]."""
ANSWER = 60.0
"""Longest wait for an answer of the scheduler itself [s]."""
LOOK = 0.5
"""Time between two looks at what is late [s]."""
GO_ON = "look after it, then go on with --resume: known rows are kept"


@dataclass(eq=False)
class _Job:
    """Work, its answer, and to whom it was given when."""

    call: Callable[[], Any]
    answer: Future[Any] = field(default_factory=Future)
    tries: list[Any] = field(default_factory=list)
    given: float = 0.0


class ClusterExecutor(Executor):
    """Workers of a running Dask scheduler.

    As much work is given to them as they have threads; the rest waits here.  What a dead worker had goes to
    another one by the scheduler.  Work that has no answer within the limit is given to a worker that has not
    been silent so far, and the first answer counts.

    Parameters
    ----------
    address
        Of the scheduler, such as ``tls://host:8786``; certificates are those of Dask's configuration.
    limit
        Time without an answer after which work is given to another worker too [s].

    Raises
    ------
    InputError
        If Dask's `distributed` is not installed, or no scheduler with a worker answers.
    """

    def __init__(self, address: str, limit: float = LIMIT) -> None:
        distributed = _distributed()
        self._address, self._limit = address, limit
        try:
            self._client = distributed.Client(address, timeout=CONNECTING, set_as_default=False)
        except (OSError, ValueError, TypeError, ImportError, RuntimeError) as error:
            allowed, todo = "tls://host:port or tcp://127.0.0.1:port", "start dask scheduler, or correct it"
            what = f"no scheduler answers: {type(error).__name__}: {str(error)[:200]}"
            raise InputError(Problem(what, address[:80], allowed, todo, "--scheduler")) from None
        self._lock = threading.RLock()
        self._waiting: deque[_Job] = deque()
        self._working: set[_Job] = set()
        self._silent: set[str] = set()
        self._late: list[Any] = []
        self._end = threading.Event()
        self._broken: InputError | None = None
        try:
            self._client.wait_for_workers(1, timeout=FIRST_WORKER)
            self._threads: dict[str, int] = self._client.nthreads()
        except (OSError, TimeoutError):
            self._client.close(timeout=1)
            what, todo = "the scheduler has no worker", "start dask worker"
            raise InputError(Problem(what, address[:80], "", todo, "--scheduler")) from None
        self._watching = threading.Thread(target=self._watch, daemon=True)
        self._watching.start()

    @property
    def workers(self) -> int:
        """Number of threads that all workers have."""
        return max(sum(self._threads.values()), 1)

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        """See `concurrent.futures.Executor`."""
        job = _Job(partial(fn, *args, **kwargs))
        with self._lock:
            if self._broken is not None:
                job.answer.set_exception(self._broken)
                return job.answer
            self._waiting.append(job)
            self._fill()
        return job.answer

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """Leave the scheduler; work without an answer is cancelled there."""
        self._end.set()
        with self._lock:
            for job in self._waiting:
                job.answer.cancel()
            self._waiting.clear()
            self._working.clear()
        self._client.close(timeout=2)
        self._watching.join(CONNECTING)

    def _fill(self) -> None:
        while self._waiting and len(self._working) < self.workers:
            job = self._waiting.popleft()
            if job.answer.set_running_or_notify_cancel():
                self._working.add(job)
                self._give(job)

    def _give(self, job: _Job) -> None:
        """Give work to the scheduler, for a worker that has not been silent."""
        heard = sorted(self._threads.keys() - self._silent)
        where = {"workers": heard} if self._silent and heard else {}
        job.given = time.monotonic()
        given = self._client.submit(_called, __version__, job.call, pure=False, **where)
        job.tries.append(given)
        given.add_done_callback(partial(self._done, job))

    def _done(self, job: _Job, given: Any) -> None:
        """Take the first answer."""
        if self._end.is_set() or job.answer.done():
            return
        if given.status == "finished":
            try:
                value = given.result(timeout=self._limit)
            except TimeoutError:
                return  # its worker is silent: the work is late, and is passed on
            except Exception as error:  # the answer could not be fetched, from whatever cause
                self._answer(job, None, _refusal(error, self._address))
            else:
                self._answer(job, value, None)
        elif given.status == "error":
            failure = given.exception()
            own = isinstance(failure, InputError)
            self._answer(job, None, failure if own else _refusal(failure, self._address))
        else:
            self._break(f"the scheduler went away: {given.status}")

    def _answer(self, job: _Job, value: Any, error: Exception | None) -> None:
        with self._lock:
            if job not in self._working:
                return
            self._working.discard(job)
            if error is not None:
                job.answer.set_exception(error)
            else:
                job.answer.set_result(value)
            # attempts of others are not needed any more
            job.tries.clear()
            self._fill()

    def _break(self, why: str) -> None:
        """End all work: the scheduler has none of it any more."""
        with self._lock:
            if self._broken is None:
                self._broken = InputError(Problem(why, todo=GO_ON, where="--scheduler", file=self._address))
            for job in self._working:
                job.answer.set_exception(self._broken)
            for job in self._waiting:
                if job.answer.set_running_or_notify_cancel():
                    job.answer.set_exception(self._broken)
            self._working.clear()
            self._waiting.clear()

    def _watch(self) -> None:
        """Look for work that is late, and for workers that came or went."""
        while not self._end.wait(LOOK):
            try:
                threads = self._client.sync(self._client.scheduler.ncores, callback_timeout=ANSWER)
                with self._lock:
                    self._threads = dict(threads)
                    self._fill()
                    late = [job for job in self._working if time.monotonic() - job.given > self._limit]
                if late or self._silent:
                    self._pass_on(late)
            except Exception as error:  # whatever the connection says, it is of no use any more
                if not self._end.is_set():
                    self._break(f"the scheduler went away: {type(error).__name__}")
                return

    def _pass_on(self, late: list[_Job]) -> None:
        """Give late work to workers that are not silent; a worker that has answered all is silent no more."""
        ask, scheduler = partial(self._client.sync, callback_timeout=ANSWER), self._client.scheduler
        busy = ask(scheduler.processing, workers=None)
        holder = {key: worker for worker, keys in busy.items() for key in keys}
        # an answer that is known but cannot be fetched is with a silent worker too
        for key, workers in ask(
            scheduler.who_has, keys=[one.key for job in late for one in job.tries]
        ).items():
            holder |= dict.fromkeys([key], workers[0]) if workers else {}
        with self._lock:
            self._silent = {worker for worker in self._silent if busy.get(worker)}
            for job in late:
                if job not in self._working:
                    continue
                self._silent |= {holder[one.key] for one in job.tries if one.key in holder}
                # kept, so that the scheduler goes on to say who has it
                self._late += job.tries
                if len(job.tries) < TRIES and self._threads.keys() - self._silent:
                    self._give(job)
                    continue
                what = f"work had no answer within {self._limit:g} s from {len(job.tries)} workers"
                came = ", ".join(sorted(self._silent))[:200] if self._threads else "no worker is left"
                todo = f"raise --limit, or {GO_ON}"
                error = InputError(Problem(what, came, "", todo, "--scheduler", self._address))
                self._working.discard(job)
                job.answer.set_exception(error)


def _called(version: str, call: Callable[[], Any]) -> Any:
    """What a worker does."""
    if version != __version__:
        what, todo = "a worker has another version of Crumple", "install the same version everywhere"
        raise InputError(Problem(what, __version__, version, todo, "--scheduler"))
    return call()


def _refusal(error: BaseException, address: str) -> InputError:
    """Why work gave no row: a worker that ends or has no Crumple is the fault of no row."""
    what = f"a worker failed: {type(error).__name__}: {str(error)[:300]}"
    todo = "look for lack of memory, and for the same version of Crumple everywhere; go on with --resume"
    return InputError(Problem(what, "", "", todo, "--scheduler", address))


def _distributed() -> ModuleType:
    """Dask's `distributed`, without its messages about connections."""
    try:
        import distributed  # noqa: PLC0415  (an extra)
    except ImportError:
        what, todo = "clusters need Dask's 'distributed'", "install crumple[cluster]"
        raise InputError(Problem(what, "", "", todo, "--scheduler")) from None
    for name in ("distributed.client", "distributed.comm", "distributed.core"):
        logging.getLogger(name).setLevel(logging.CRITICAL)
    found: ModuleType = distributed
    return found
