"""Who may speak to the app: a code that works once gives a token; Host and Origin are those of the server."""

from __future__ import annotations

import secrets
import time
from collections.abc import Callable, Iterable

from starlette.types import ASGIApp, Message, Receive, Scope, Send

MOST_CODES = 8
"""Codes that wait to be used; the oldest one is forgotten."""
CODE_SECONDS = 600.0
"""Time for which a code can be used [s]."""
HEADERS = {
    "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "DENY",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Cache-Control": "no-store",
}


class Access:
    """Codes and tokens of one server.

    Parameters
    ----------
    clock
        Time now [s]; another one in tests.
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._codes: dict[str, float] = {}
        self._tokens: list[str] = []

    def code(self) -> str:
        """A new code for the fragment of a start address."""
        while len(self._codes) >= MOST_CODES:
            del self._codes[next(iter(self._codes))]
        made = secrets.token_urlsafe(24)
        self._codes[made] = self._clock() + CODE_SECONDS
        return made

    def exchange(self, code: str) -> str | None:
        """Token for a code, which is then used up; None if it is none, or no longer."""
        known = _among(code, self._codes)
        if known is None or self._codes.pop(known) < self._clock():
            return None
        token = secrets.token_urlsafe(32)
        self._tokens.append(token)
        return token

    def knows(self, token: object) -> bool:
        """Whether a token was given by this server."""
        return isinstance(token, str) and _among(token, self._tokens) is not None


def _among(given: str, known: Iterable[str]) -> str | None:
    """The equal one, found in a time that does not tell how much of it is right."""
    found = None
    for one in known:
        if secrets.compare_digest(one.encode(), given.encode("utf-8", "replace")):
            found = one
    return found


class Guard:
    """Refuses requests for another host or from another origin, and adds headers to every answer.

    Parameters
    ----------
    app
        Behind it.
    port
        Of the server: with ``127.0.0.1`` or ``localhost`` the only host.
    """

    def __init__(self, app: ASGIApp, port: int) -> None:
        self._app = app
        self._hosts = {f"{name}:{port}" for name in ("127.0.0.1", "localhost")}

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] not in ("http", "websocket"):
            await self._app(scope, receive, send)
            return
        if not self._allowed(scope):
            await _refuse(scope, send)
            return

        async def with_headers(message: Message) -> None:
            if message["type"] == "http.response.start":
                extra = [(name.lower().encode(), value.encode()) for name, value in HEADERS.items()]
                message = {**message, "headers": [*message.get("headers", []), *extra]}
            await send(message)

        await self._app(scope, receive, with_headers)

    def _allowed(self, scope: Scope) -> bool:
        hosts = [value.decode("latin-1") for name, value in scope["headers"] if name == b"host"]
        origins = [value.decode("latin-1") for name, value in scope["headers"] if name == b"origin"]
        if len(hosts) != 1 or hosts[0] not in self._hosts:
            return False
        # a page of another origin can send a request without Origin only if it changes nothing
        reads = scope["type"] == "http" and scope["method"] in ("GET", "HEAD")
        return origins == [f"http://{hosts[0]}"] or (reads and not origins)


async def _refuse(scope: Scope, send: Send) -> None:
    if scope["type"] == "websocket":
        await send({"type": "websocket.close", "code": 1008})
        return
    await send({"type": "http.response.start", "status": 403, "headers": [(b"content-type", b"text/plain")]})
    await send({"type": "http.response.body", "body": b"refused"})
