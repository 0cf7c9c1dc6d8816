"""`crumple app [FILE]`: an editor with the answer beside it, in the browser."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

NEEDED = ("starlette", "uvicorn", "websockets")
"""Packages of the extra."""


def app(
    file: Annotated[
        Path | None,
        typer.Argument(help="Input file, or a folder of them; by default this folder.", show_default=False),
    ] = None,
    *,
    port: Annotated[int, typer.Option(help="Port; 0 for any that is free.", min=0, max=65535)] = 0,
    browser: Annotated[bool, typer.Option(help="Open the browser; else print the address.")] = True,
) -> None:
    """Edit inputs in the browser and see the crash change. Serves this machine only, until Ctrl-C."""
    from importlib.util import find_spec

    from crumple.errors import InputError, Problem

    missing = [name for name in NEEDED if find_spec(name) is None]
    if missing:
        what = (
            f"the app needs {', '.join(missing)}, which {'is' if len(missing) == 1 else 'are'} not installed"
        )
        raise InputError(Problem(what, todo="install the extra: pip install 'crumple[app]'"))
    folder, first = _opened(file or Path())
    from crumple.app import serve

    def show(address: str, page: Path) -> None:
        typer.echo(f"Serving {folder} to this machine. Ctrl-C ends it.")
        if browser:
            import webbrowser

            # a file that only this user reads: the address would be seen among the running programs
            if webbrowser.open(page.as_uri()):
                return
            typer.echo("No browser could be started: open this address by hand. It works once.", err=True)
        typer.echo(address)

    serve(folder, first, port, show)


def _opened(file: Path) -> tuple[Path, str]:
    """Folder that is served, and the file in it that is opened first."""
    from crumple.errors import InputError, Problem

    if file.is_dir():
        return file, ""
    if not file.parent.is_dir():
        raise InputError(Problem("there is no such folder", file=str(file.parent), todo="check the name"))
    if not file.is_file():
        todo = "check the name, or start in a folder: crumple app"
        raise InputError(Problem("there is no such file", file=str(file), todo=todo))
    return file.parent, file.name
