"""What a conversation with a window survives: hanging or dying processes, exceptions, texts that overtake."""

import asyncio
import json

import pytest

pytest.importorskip("starlette")
pytest.importorskip("websockets")

from crumple.app.access import Access
from crumple.app.client import Client, Limits
from crumple.app.folder import Folder
from crumple.processes import Worker


class Stubborn:
    """Hangs on one text, dies on another."""

    def __call__(self, job, report, stopped):
        import os
        import time

        text = job.texts[0][1] if job.texts else ""
        if text == "die":
            os._exit(1)
        if text == "slow":
            while not stopped():
                time.sleep(0.01)
            return {"stopped": True}
        while text == "hang":
            time.sleep(0.01)
        return {"problems": [], "text": text}


async def conversation(folder, limits, work, solver=None):
    """Run a conversation with a client whose process is stubborn; gives what it sent."""
    sent = []

    async def send(message):
        sent.append(message)

    client = Client(Folder(folder), Access(), send, limits)
    client._solver = solver or Worker(Stubborn(), limits.memory)
    solving = asyncio.create_task(client.solving())
    try:

        async def tell(number, text):
            message = {"kind": "solve", "number": number, "name": "", "text": text}
            await client.received(json.dumps(message))

        async def until(count):
            while len([one for one in sent if one["kind"] == "answer"]) < count:
                await asyncio.sleep(0.01)

        await asyncio.wait_for(work(tell, until), 60.0)
    finally:
        solving.cancel()
        client.end()
    return [one for one in sent if one["kind"] == "answer"]


def test_a_process_that_hangs_or_dies_is_replaced(tmp_path):
    async def work(tell, until):
        for number, text in enumerate(["hang", "die", "well"], 1):
            await tell(number, text)
            await until(number)

    hung, died, well = asyncio.run(conversation(tmp_path, Limits(seconds=1.0), work))
    assert "longer than 1 s" in hung["failed"]
    assert "unexpectedly" in died["failed"]
    assert well["text"] == "well"


class Surprised(Worker):
    """Its first job raises what nobody expects."""

    surprises = 1

    def ask(self, *job, **more):
        if self.surprises:
            self.surprises = 0
            raise RuntimeError("why")
        return super().ask(*job, **more)


def test_an_exception_that_nobody_expects_is_told_and_the_next_text_is_solved(tmp_path):
    async def work(tell, until):
        for number in (1, 2):
            await tell(number, "well")
            await until(number)

    solver = Surprised(Stubborn(), Limits().memory)
    surprised, well = asyncio.run(conversation(tmp_path, Limits(), work, solver))
    assert surprised["failed"] == "a defect of Crumple: RuntimeError: why"
    assert well["text"] == "well"


def test_one_runs_one_waits_and_the_newest_wins(tmp_path):
    async def work(tell, until):
        await tell(1, "slow")
        await asyncio.sleep(0.05)
        for number in (2, 3, 4):
            await tell(number, f"text {number}")
        await until(2)

    first, last = asyncio.run(conversation(tmp_path, Limits(overtaken=0.1), work))
    assert first["stopped"]
    assert (last["number"], last["text"]) == (4, "text 4")
