"""`crumple view DIR`: show a stored result in the viewer."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer


def view(
    folder: Annotated[Path, typer.Argument(help="Folder of results.", show_default=False)],
    *,
    page: Annotated[
        Path | None,
        typer.Option(help="Page to write; by default view.html in the folder.", show_default=False),
    ] = None,
    browser: Annotated[bool, typer.Option(help="Open the page in the browser.")] = True,
) -> None:
    """Show stored results. Writes one page that needs no server and no network, and opens it."""
    from crumple.report.scene.page import write_view

    written = write_view(folder, page)
    typer.echo(f"View: {written}")
    if browser:
        import webbrowser

        if not webbrowser.open(written.resolve().as_uri()):
            typer.echo("No browser could be started: open the page by hand.", err=True)
