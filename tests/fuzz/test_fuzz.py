"""Three hundred cases of every kind, the same in every run; `make fuzz N=...` tries any number.

Then every value of every argument and option once, the others good: the random cases draw the same values
together, but what `make test` reaches must not hang on chance.
"""

import functools

import pytest
from tests.fuzz import kernel_base
from tests.fuzz.attacks import attack_kernel
from tests.fuzz.calls import CALLS
from tests.fuzz.campaign import SHARES, campaign
from tests.fuzz.commands import OPTIONS
from tests.fuzz.input_files import bases, written
from tests.fuzz.mutation import edited, listed
from tests.fuzz.sites import reasons, sites
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
    assert len(tally.sites) > 60


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


def test_refusals_are_found_in_the_source_and_noted_exactly():
    assert len(sites()) > 500
    with Worker() as worker:
        # the message has been worded by four functions on its way here
        reached = worker.run(Case("law", "crumple_law: 1\nrotation: &a 3\n")).sites
    assert reached == {
        "hinge/measured/law_file.py read_law: InputError(told)",
        "text/plain_yaml.py _Reader._entry: anchors and aliases are refused",
        "text/plain_yaml.py _Reader._refused: _refusal(what, self._file, event.start_mark.line + 1)",
        "text/plain_yaml.py _refusal: Problem(what, '', allowed, todo, '', file, line)",
    }


def test_the_list_of_refusals_that_are_not_reached_has_a_reason_for_each():
    assert [name for name, reason in reasons().items() if not reason or name not in sites()] == []


NEEDED = {"hinge": ["--material", "S355"], "characterise": ["--list"], "run": ["--no-law-range"]}


@pytest.fixture(scope="module")
def worker():
    with Worker() as one:
        yield one


@pytest.mark.parametrize("name", sorted(CALLS))
def test_every_value_of_a_call(name, worker):
    values = list(CALLS[name][1].values())
    cases = [[0] * i + [n] for i, several in enumerate(values) for n in range(len(several))]
    outcomes = {tuple(case): worker.run(Case("call", (name, case))) for case in cases}
    assert {case: outcome.finding for case, outcome in outcomes.items() if outcome.finding} == {}


@pytest.mark.parametrize("verb", sorted(OPTIONS))
def test_every_value_of_an_option(verb, worker):
    firsts, options = OPTIONS[verb]
    words = [[verb, first, *NEEDED.get(verb, [])] for first in dict.fromkeys(firsts)]
    for name, values in options.items():
        words += [[*words[0], name, *([] if value is None else [value])] for value in values]
    outcomes = {" ".join(one): worker.run(Case("command", one)) for one in words}
    assert {case: outcome.finding for case, outcome in outcomes.items() if outcome.finding} == {}


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("compare good.yaml --curve time.csv", "is not name=file"),
        ("compare good.yaml --curve shell=time.csv", "choose another"),
        ("compare good.yaml --curve a=time.csv --pair x", "is not column=history"),
        ("compare good.yaml --curve a=time.csv --pair x=a --pair x=b", "is paired twice"),
        ("compare good.yaml --curve a=time.csv --pair no=a", "no curve file has a column"),
        ("run good.yaml --restart no.npz", "only shell runs have restart files"),
    ],
)
def test_options_that_exclude_each_other_are_refused_before_anything_is_solved(line, words, worker):
    outcome = worker.run(Case("command", line.split()))
    assert not outcome.finding
    assert words in outcome.message
