"""Jobs in processes of their own: answers, progress, a process that dies, and cancelling."""

import os
import time

from crumple.processes import in_processes


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
