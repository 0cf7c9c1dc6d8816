"""One window of the app: its messages, and its solves, of which one runs and one waits."""

from __future__ import annotations

import asyncio
import json
import time
from collections.abc import Awaitable, Callable, Coroutine
from dataclasses import asdict, dataclass
from typing import Any

from crumple.app.access import Access
from crumple.app.answer import Answering, Job
from crumple.app.folder import Folder
from crumple.app.start_texts import start_text, start_texts
from crumple.errors import InputError
from crumple.portable import available_cores
from crumple.processes import Worker, WorkerError

Send = Callable[[dict[str, Any]], Coroutine[Any, Any, None]]
UNSAVED = "unsaved.yaml"
"""Name of a text that has none yet."""
LATER = {"figures": 0.4, "forms": 0.01, "bands": 0.01}
"""What else is sent, and the time without a change before it [s]."""
MOST_BESIDE = 3
"""Layouts that are shown beside the text."""


@dataclass(frozen=True)
class Limits:
    """Limits of the processes of one window.

    Attributes
    ----------
    seconds, shell_seconds
        Longest multibody solve, and longest shell run [s].
    overtaken
        Time after which a solve is stopped if a newer text waits [s]; shorter ones end, so that a drag shows
        something.
    memory, shell_memory
        Address space [byte].
    """

    seconds: float = 60.0
    shell_seconds: float = 3600.0
    overtaken: float = 2.0
    memory: int = 4 << 30
    shell_memory: int = 12 << 30


class Client:
    """One window.

    Parameters
    ----------
    folder, access
        Of the server.
    send
        Sends a message.
    limits
        Of its processes.
    """

    def __init__(self, folder: Folder, access: Access, send: Send, limits: Limits) -> None:
        self._folder, self._access, self._send, self._limits = folder, access, send, limits
        self._solver = Worker(Answering(), limits.memory)
        self._checker = Worker(Answering(), limits.shell_memory)
        self._pending: tuple[int, Job] | None = None
        self._changed = asyncio.Event()
        self._check: asyncio.Task[None] | None = None
        self._cancelled = False

    async def welcome(self, first: str) -> None:
        """What a new window needs."""
        from crumple.analysis import json_schema  # noqa: PLC0415

        await self._send(
            {
                "kind": "welcome",
                "folder": self._folder.path.name,
                "files": self._folder.files(),
                "starts": start_texts(),
                "first": first,
                "schema": json_schema(),
            }
        )

    async def received(self, text: str) -> None:
        """Do what a message wants; one that wants nothing that is known is refused."""
        try:
            message = json.loads(text)
            kind = message["kind"]
            handler = HANDLERS[kind]
        except (ValueError, KeyError, TypeError, RecursionError):
            await self._send({"kind": "refused", "what": "this message is not known"})
            return
        try:
            await handler(self, message)
        except InputError as error:
            problem = error.problems[0]
            parts = (problem.what, problem.allowed and f"allowed: {problem.allowed}", problem.todo)
            await self._send(
                {"kind": "refused", "of": kind, "what": "; ".join(part for part in parts if part)}
            )
        except (LookupError, TypeError, ValueError, ArithmeticError):
            await self._send({"kind": "refused", "of": kind, "what": "this message is not complete"})

    async def solving(self) -> None:
        """Solve the newest text, as long as the window is open."""
        while True:
            await self._changed.wait()
            self._changed.clear()
            if self._pending is None:
                continue
            number, job = self._pending
            self._pending = None
            answer = await self._ask(job)
            await self._send({"kind": "answer", "number": number, **answer})
            # what takes longer than a solve waits until nothing changes
            for kind, pause in LATER.items():
                if "scene" not in answer or not await self._idle(pause):
                    break
                found = await self._ask(Job(kind))
                await self._send({"kind": kind, "number": number, **found})

    async def _idle(self, pause: float) -> bool:
        """Whether nothing changes for a time [s]."""
        try:
            await asyncio.wait_for(self._changed.wait(), pause)
        except TimeoutError:
            return True
        return False

    async def _ask(self, job: Job) -> dict[str, Any]:
        begin = time.monotonic()

        def overtaken() -> bool:
            return self._pending is not None and time.monotonic() - begin > self._limits.overtaken

        try:
            return dict(await asyncio.to_thread(self._solver.ask, job, self._limits.seconds, overtaken))
        except Exception as error:
            return _failure(error)

    async def _solve(self, message: dict[str, Any]) -> None:
        number = int(message["number"])
        self._pending = (number, self._job(message))
        self._changed.set()

    def _job(self, message: dict[str, Any]) -> Job:
        numbers, quick = (bool(message.get(key)) for key in ("numbers", "quick"))
        return Job("solve", (self._text(message),), numbers=numbers, quick=quick)

    async def _beside(self, message: dict[str, Any]) -> None:
        names = list(message["names"])[:MOST_BESIDE]
        others = tuple((str(self._folder.place(name)), self._folder.open(name).text) for name in names)
        self._pending = (int(message["number"]), Job("beside", (self._text(message), *others)))
        self._changed.set()

    def _text(self, message: dict[str, Any]) -> tuple[str, str]:
        """Path and text of a message."""
        text = message["text"]
        if not isinstance(text, str):
            raise TypeError
        return str(self._folder.place(message["name"] or UNSAVED)), text

    async def _open(self, message: dict[str, Any]) -> None:
        await self._send({"kind": "opened", **asdict(self._folder.open(message["name"]))})

    async def _start(self, message: dict[str, Any]) -> None:
        text = start_text(str(message["name"]))
        await self._send({"kind": "opened", "name": "", "text": text, "seen": "", "draft": None})

    async def _save(self, message: dict[str, Any]) -> None:
        name = message["name"]
        seen = self._folder.save(name, self._text(message)[1], str(message["seen"]))
        await self._send({"kind": "saved", "name": name, "seen": seen, "files": self._folder.files()})

    async def _draft(self, message: dict[str, Any]) -> None:
        self._folder.keep_draft(message["name"] or UNSAVED, self._text(message)[1])
        await self._send({"kind": "kept"})

    async def _discard(self, message: dict[str, Any]) -> None:
        self._folder.discard(message["name"] or UNSAVED)

    async def _code(self, message: dict[str, Any]) -> None:
        await self._send({"kind": "code", "code": self._access.code()})

    async def _shell(self, message: dict[str, Any]) -> None:
        if self._check is not None and not self._check.done():
            raise InputError("a shell check is running; cancel it first")
        threads = max(available_cores() - 1, 1)
        self._cancelled = False
        self._check = asyncio.create_task(
            self._checking(Job("shell", (self._text(message),), threads=threads))
        )

    async def _cancel(self, message: dict[str, Any]) -> None:
        self._cancelled = True

    async def _checking(self, job: Job) -> None:
        loop, told = asyncio.get_running_loop(), [0.0]

        def progress(share: float) -> None:
            # some ten messages a second are enough
            if time.monotonic() - told[0] > 0.1:
                told[0] = time.monotonic()
                asyncio.run_coroutine_threadsafe(self._send({"kind": "progress", "share": share}), loop)

        def cancelled() -> bool:
            return self._cancelled

        limit = self._limits.shell_seconds
        try:
            answer = await asyncio.to_thread(self._checker.ask, job, limit, cancelled, progress)
        except Exception as error:
            answer = _failure(error)
        await self._send({"kind": "shell", **answer})

    def end(self) -> None:
        """End the processes of the window."""
        self._cancelled = True
        self._solver.end()
        self._checker.end()


def _failure(error: Exception) -> dict[str, Any]:
    """Answer of a solve that failed; what nobody expected must not end the window either."""
    if isinstance(error, WorkerError):
        return {"failed": str(error)}
    return {"failed": f"a defect of Crumple: {type(error).__name__}: {str(error)[:300]}"}


HANDLERS: dict[str, Callable[[Client, dict[str, Any]], Awaitable[None]]] = {
    "open": Client._open,
    "start": Client._start,
    "solve": Client._solve,
    "beside": Client._beside,
    "save": Client._save,
    "draft": Client._draft,
    "discard": Client._discard,
    "code": Client._code,
    "shell": Client._shell,
    "cancel": Client._cancel,
}
"""What a window can ask for."""
