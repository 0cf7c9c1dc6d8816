"""Jobs in processes of their own: answers, progress, a process that dies, and cancelling."""

import os
import time
from contextlib import suppress

import pytest

from crumple.processes import Worker, WorkerError, in_processes


def squared(job, report):
    report(0.5)
    if job < 0:
        os._exit(3)
    return job * job


def slow(job, report):
    for _ in range(600):
        time.sleep(0.1)
        if not report(0.1):
            break
    return job


def test_every_job_has_its_answer_and_a_process_that_dies_has_none():
    shares = []
    found = dict(in_processes(squared, [3, -1, 5], 2, lambda number, share: shares.append((number, share))))
    assert found == {0: 9, 1: None, 2: 25}
    assert {(0, 0.5), (2, 0.5)} <= set(shares)


def test_cancelled_jobs_are_ended():
    started = time.monotonic()
    begun = []
    found = list(in_processes(slow, [1, 2], 1, lambda *one: begun.append(one), lambda: bool(begun)))
    assert found == []
    assert {number for number, _ in begun} == {0}
    assert time.monotonic() - started < 30.0


class Obedient:
    """Counts its jobs; a job says what happens."""

    def __init__(self):
        self.jobs = 0

    def __call__(self, job, report, stopped):
        self.jobs += 1
        if job == "die":
            os._exit(3)
        if job == "fail":
            raise ValueError("why")
        if job == "hang":
            while True:
                time.sleep(0.01)
        if job == "eat":
            return len(bytearray(8 << 30))
        if job == "wait":
            report(0.25)
            while not stopped():
                time.sleep(0.01)
            return "told"
        return self.jobs


@pytest.fixture(name="worker")
def _worker():
    worker = Worker(Obedient(), 2 << 30)
    yield worker
    worker.end()


def test_a_worker_keeps_what_it_knows_from_job_to_job(worker):
    assert [worker.ask("count", 60.0) for _ in range(3)] == [1, 2, 3]


@pytest.mark.parametrize(
    ("job", "seconds", "reason"),
    [("die", 60.0, "unexpectedly"), ("fail", 60.0, "ValueError: why"), ("hang", 0.5, "longer than 0.5 s")],
)
def test_the_end_of_a_worker_is_only_its_own(worker, job, seconds, reason):
    worker.ask("count", 60.0)
    with pytest.raises(WorkerError, match=reason):
        worker.ask(job, seconds)
    assert worker.ask("count", 60.0) == 1


@pytest.mark.skipif(not hasattr(os, "fork"), reason="this system has no limits of memory")
def test_memory_is_limited(worker):
    with pytest.raises(WorkerError, match="more memory than is allowed"):
        worker.ask("eat", 60.0)
    assert worker.ask("count", 60.0) == 1


def test_a_killed_worker_is_replaced(worker):
    worker.ask("count", 60.0)
    first = worker.pid
    os.kill(first, 9)
    # noticed before the job is sent, or after
    with suppress(WorkerError):
        worker.ask("count", 60.0)
    assert worker.pid != first
    assert worker.ask("count", 60.0) <= 2


def test_a_job_is_told_to_stop_and_the_next_one_is_not(worker):
    shares = []
    assert worker.ask("wait", 60.0, lambda: bool(shares), shares.append) == "told"
    assert shares == [0.25]
    assert worker.ask("count", 60.0) == 2


def test_a_process_that_cannot_be_started_is_an_error_of_the_worker(worker, monkeypatch):
    def refused(process):
        raise BlockingIOError(11, "Resource temporarily unavailable")

    with monkeypatch.context() as patch:
        patch.setattr("multiprocessing.context.SpawnProcess.start", refused)
        with pytest.raises(WorkerError, match="could not be started: Resource temporarily unavailable"):
            worker.ask("count", 60.0)
    assert worker.ask("count", 60.0) == 1
