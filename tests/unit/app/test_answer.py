"""What a solver refuses has its line; a second shell check waits for the first."""

import asyncio
import json

import pytest

pytest.importorskip("starlette")
pytest.importorskip("websockets")

import crumple.analysis
import crumple.comparison
from crumple.app.access import Access
from crumple.app.answer import Answering, Job
from crumple.app.client import Client, Limits
from crumple.app.folder import Folder
from crumple.app.start_texts import start_text
from crumple.errors import InputError, Problem

TUBE = start_text("tube_bending")


@pytest.mark.parametrize(
    ("kind", "module", "name"),
    [
        ("solve", crumple.analysis, "solve_with_frames"),
        ("shell", crumple.comparison, "solve_and_compare"),
    ],
)
def test_the_refusal_of_a_solver_has_the_line_of_the_text(monkeypatch, kind, module, name):
    def refuse(*_, **__):
        raise InputError(Problem("too soft", where="members.tube.material"))

    monkeypatch.setattr(module, name, refuse)
    answer = Answering()(Job(kind, (("tube.yaml", TUBE),)), lambda share: True, lambda: False)
    (problem,) = answer["problems"]
    assert TUBE.splitlines()[problem["line"] - 1].strip() == "material: steel"
    assert (problem["what"], problem["file"]) == ("too soft", "tube.yaml")


def test_the_answer_while_a_number_is_dragged_is_the_run_without_its_checks():
    text = start_text("portal_frame").replace("  shell:", "  multibody: {mechanism_check: on}\n  shell:")
    quick, whole = (
        Answering()(Job("solve", (("x.yaml", text),), quick=quick), lambda share: True, lambda: False)
        for quick in (True, False)
    )
    assert quick["curves"] == whole["curves"]
    assert len(json.loads(quick["scene"]["header"])["times"]) < len(
        json.loads(whole["scene"]["header"])["times"]
    )
    said = [" ".join([one["headline"], *one["sentences"], *one["cautions"]]) for one in (quick, whole)]
    assert ["Estimated error" in one for one in said] == [False, True]


def test_criteria_of_the_input_are_said():
    job = Job("solve", (("x.yaml", start_text("rops")),))
    answer = Answering()(job, lambda share: True, lambda: False)
    assert answer["sentences"][-1].startswith("Criterion volume_stays_free kept: ")


class Waiting:
    """Waits until it is told to stop."""

    def ask(self, job, seconds, cancel, progress):
        while not cancel():
            pass
        return {"stopped": True}

    def end(self):
        pass


def test_one_shell_check_runs_at_a_time(tmp_path):
    sent = []

    async def send(message):
        sent.append(message)

    async def conversation():
        client = Client(Folder(tmp_path), Access(), send, Limits())
        client._checker = Waiting()
        asked = json.dumps({"kind": "shell", "name": "", "text": TUBE})
        await client.received(asked)
        await client.received(asked)
        await client.received('{"kind": "cancel"}')
        await client._check
        client.end()

    asyncio.run(conversation())
    assert [one["kind"] for one in sent] == ["refused", "shell"]
    assert "cancel it first" in sent[0]["what"]
