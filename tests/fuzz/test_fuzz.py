"""Three hundred cases of every kind, the same in every run; `make fuzz N=...` tries any number."""

import functools

import pytest
from tests.fuzz import kernel_base
from tests.fuzz.attacks import attack_kernel
from tests.fuzz.campaign import SHARES, campaign
from tests.fuzz.input_files import bases, written
from tests.fuzz.mutation import edited, listed
from tests.fuzz.sites import refusal_sites, unreached
from tests.fuzz.worker import Case, Worker

CASES = 300
WRONG = "has the wrong type or shape"


@pytest.fixture(scope="module")
def tally():
    return campaign(CASES)


def test_nothing_is_found(tally):
    assert sum(tally.tried.values()) >= CASES
    assert set(tally.tried) == set(SHARES)
    assert {finding: case.payload for finding, (case, _) in tally.findings.items()} == {}


def test_cases_are_nearly_right(tally):
    # below this share an attack only tests the first check that it meets
    assert sum(tally.accepted.values()) > 0.3 * sum(tally.tried.values())
    assert tally.accepted["input"] > 0.3 * tally.tried["input"]
    every, missed = unreached(tally.sites)
    assert len(missed) < every - 40


@pytest.mark.parametrize(
    ("room", "edit", "words"),
    [
        # mass of the model; entry of its first joint; an entry of the first hinge; a load that is a number
        ("spatial", (["model", "mass"], "x"), f"TypeError: '...' {WRONG}"),
        (
            "spatial",
            (["model", "joints", 0, 3], 7),
            "TypeError: entry # of a tuple has the wrong type or shape",
        ),
        (
            "planar",
            (["model", 4, 0, "elastic_stiffness"], []),
            "TypeError: '...' has the wrong type or shape",
        ),
        ("planar", (["model", 5, 0], 3), "ValueError: a load has body, point, direction, times, values"),
    ],
)
def test_the_kernels_name_what_they_cannot_read(room, edit, words, monkeypatch):
    given = listed({"planar": kernel_base.PLANAR, "spatial": kernel_base.SPATIAL}[room])
    (*way, last), value = edit
    functools.reduce(lambda part, key: part[key], way, given)[last] = value
    monkeypatch.setattr(kernel_base, "edited", lambda *_: edited(given, []))
    assert attack_kernel((room, [])) == words


def test_the_good_files_and_calls_are_accepted():
    with Worker() as worker:
        assert [worker.run(Case("input", written(data))).message for data in bases()] == [""] * len(bases())
    for room in ("planar", "spatial", "shell", "checkpoint"):
        assert attack_kernel((room, [])) == ""


def test_a_crash_a_hang_and_a_traceback_are_found():
    crash = "import os, signal; os.kill(os.getpid(), signal.SIGSEGV)"
    with Worker() as worker:
        assert "crash" in worker.run(Case("self-test", crash)).finding
        assert "hang" in worker.run(Case("self-test", "limit(0, 0.3); import time; time.sleep(60)")).finding
        assert "hang" in worker.run(Case("self-test", "limit(0.3, 60)\nwhile True: pass")).finding
        assert "ZeroDivisionError" in worker.run(Case("self-test", "1/0")).finding
        assert "MemoryError" in worker.run(Case("self-test", "bytearray(3 * 10**9)")).finding
        # and the next one is as sound as ever
        assert worker.run(Case("input", written(bases()[0]))).accepted


def test_every_refusal_is_listed():
    sites = refusal_sites()
    assert sum(map(len, sites.values())) > 300
    assert unreached({(name, first) for name, spans in sites.items() for first, _ in spans})[1] == []
