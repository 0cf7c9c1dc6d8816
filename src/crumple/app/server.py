"""The server of the app: one page, its scripts, the exchange of the code, and one socket for each window."""

from __future__ import annotations

import asyncio
import secrets
import socket
import tempfile
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

import uvicorn
from jinja2 import Environment, FileSystemLoader, StrictUndefined
from starlette.applications import Starlette
from starlette.requests import Request
from starlette.responses import HTMLResponse, JSONResponse, Response
from starlette.routing import Route, WebSocketRoute
from starlette.types import ASGIApp
from starlette.websockets import WebSocket, WebSocketDisconnect

from crumple.app.access import Access, Guard
from crumple.app.client import Client, Limits
from crumple.app.folder import Folder
from crumple.errors import InputError, Problem
from crumple.report.scene.page import REPORT, text_of
from crumple.version import __version__

PAGE = Path(__file__).parent / "page"
LARGEST_MESSAGE = 1_000_000
"""Longest message of a window [byte]."""
MOST_CLIENTS = 4
FIRST_MESSAGE = 10.0
"""Time within which a window must show its token [s]."""
TOO_MANY, NOT_ALLOWED = 4001, 4003
"""Reasons for which a socket is closed."""
STYLES = ("page.css", "viewer.css")


def application(
    folder: Folder, access: Access, port: int, first: str = "", limits: Limits | None = None
) -> ASGIApp:
    """The app for one folder.

    Parameters
    ----------
    folder
        The only one whose files are read and written.
    access
        Its codes and tokens.
    port
        Of the server.
    first
        Name of the file that is opened first.
    limits
        Of the processes that solve.
    """
    clients: set[Client] = set()

    async def token(request: Request) -> Response:
        content = b""
        async for part in request.stream():
            content += part
            if len(content) > 1000:
                return Response("too long", 413)
        given = access.exchange(content.decode("utf-8", "replace"))
        if given is None:
            return Response("this code is not known, or was used", 403)
        return JSONResponse({"token": given})

    async def window(connection: WebSocket) -> None:
        await connection.accept()
        # what has shown no token is no window: it must not keep others out
        if not await _shows_token(connection, access):
            return
        if len(clients) >= MOST_CLIENTS:
            await connection.close(TOO_MANY, f"at most {MOST_CLIENTS} windows")
            return

        async def send(message: dict[str, Any]) -> None:
            # the window may have gone while something was solved
            with suppress(RuntimeError, WebSocketDisconnect):
                await connection.send_json(message)

        client = Client(folder, access, send, limits or Limits())
        clients.add(client)
        try:
            await _converse(connection, client, first)
        finally:
            clients.discard(client)
            client.end()

    routes = [
        Route("/", _page),
        Route("/token", token, methods=["POST"]),
        WebSocketRoute("/window", window),
        *(Route(f"/{name}", _script(text)) for name, text in _scripts().items()),
        Route("/app.css", _style),
    ]
    return Guard(Starlette(routes=routes), port)


async def _shows_token(connection: WebSocket, access: Access) -> bool:
    """Whether the first message has the token; else the socket is closed."""
    try:
        opening = await asyncio.wait_for(connection.receive_json(), FIRST_MESSAGE)
        if not isinstance(opening, dict) or not access.knows(opening.get("token")):
            raise ValueError
    except (TimeoutError, ValueError, KeyError, RecursionError):
        await connection.close(NOT_ALLOWED, "no token of this server")
        return False
    except WebSocketDisconnect:
        return False
    return True


async def _converse(connection: WebSocket, client: Client, first: str) -> None:
    """Messages of one window."""
    await client.welcome(first)
    solving = asyncio.create_task(client.solving())
    try:
        while True:
            await client.received(await connection.receive_text())
    except WebSocketDisconnect:
        pass
    except KeyError:
        await connection.close(1003, "texts only")
    finally:
        solving.cancel()


async def _page(request: Request) -> Response:
    environment = Environment(
        loader=FileSystemLoader([PAGE, REPORT / "templates"]),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
    )
    nonce = secrets.token_urlsafe(16)
    scene = {"names": [], "notes": [], "strain": 0.0}
    text = environment.get_template("app.html.jinja").render(nonce=nonce, scene=scene, version=__version__)
    # the editor makes a style sheet of its own, which carries the nonce
    policy = (
        f"default-src 'none'; script-src 'self'; style-src 'self' 'nonce-{nonce}'; "
        "img-src 'self' blob: data:; "
        f"connect-src 'self' ws://{request.headers['host']}; base-uri 'none'; form-action 'none'; "
        "frame-ancestors 'none'"
    )
    return HTMLResponse(text, headers={"Content-Security-Policy": policy})


def _scripts() -> dict[str, str]:
    """Scripts of the page by name."""
    return {
        "three.js": text_of("vendor/three.min.js"),
        "codemirror.js": _own("vendor/codemirror.min.js"),
        "viewer.js": text_of("templates/viewer.js"),
        "app.js": _own("app.js"),
    }


def _script(text: str) -> Callable[[Request], Any]:
    async def answer(request: Request) -> Response:
        return Response(text, media_type="text/javascript")

    return answer


async def _style(request: Request) -> Response:
    sheets = [text_of(f"templates/{name}") for name in STYLES]
    return Response("".join([*sheets, _own("app.css")]), media_type="text/css")


def _own(name: str) -> str:
    return (PAGE / name).read_text(encoding="utf-8")


class _Server(uvicorn.Server):
    """Removes the start page when it ends: the signal that ends it is then raised again."""

    def __init__(self, config: uvicorn.Config, private: tempfile.TemporaryDirectory[str]) -> None:
        super().__init__(config)
        self._private = private

    async def shutdown(self, sockets: list[socket.socket] | None = None) -> None:
        await super().shutdown(sockets)
        self._private.cleanup()


def serve(folder: Path, first: str, port: int, show: Callable[[str, Path], None]) -> None:
    """Serve a folder until Ctrl-C.

    Parameters
    ----------
    folder
        The only one whose files are read and written.
    first
        Name of the file that is opened first, empty for none.
    port
        To listen at; 0 for any that is free.
    show
        Called with the start address and with a page that leads there, which only this user can read, once
        the server listens.  The code of the address works once.

    Raises
    ------
    InputError
        If the port cannot be used.
    """
    access = Access()
    private = tempfile.TemporaryDirectory(prefix="crumple-")
    with socket.socket() as listening, private:
        try:
            listening.bind(("127.0.0.1", port))
        except OSError as error:
            what, todo = (
                f"this port cannot be used: {error.strerror}",
                "leave out --port, or give another one",
            )
            raise InputError(Problem(what, str(port), todo=todo)) from None
        listening.listen()
        number = listening.getsockname()[1]
        address = f"http://127.0.0.1:{number}/#{access.code()}"
        page = Path(private.name) / "open.html"
        page.touch(mode=0o600)
        page.write_text(f'<meta http-equiv="refresh" content="0; url={address}">\n', encoding="utf-8")
        config = uvicorn.Config(
            application(Folder(folder), access, number, first),
            log_level="warning",
            ws="websockets-sansio",
            ws_max_size=LARGEST_MESSAGE,
            limit_concurrency=64,
            server_header=False,
            lifespan="off",
            timeout_graceful_shutdown=1,
        )
        show(address, page)
        _Server(config, private).run(sockets=[listening])
