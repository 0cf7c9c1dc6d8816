"""Page of a study: its rows in a table and in figures that a reader can filter, and crashes of some."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from crumple.portable import write_text

if TYPE_CHECKING:
    from crumple.report.scene.scene import Scene
    from crumple.result import Result
    from crumple.structure import Structure

PAGE = "study.html"
MOST_BYTES = 8_000_000
"""Characters of all shapes of a page together; further rows have none."""


def write_study_page(
    data: Mapping[str, Any], shapes: Iterable[tuple[int, Result, Structure]], folder: Path | str
) -> tuple[Path, list[int]]:
    """Write ``study.html``.

    Parameters
    ----------
    data
        Rows and what is drawn of them, as `crumple.study.page_data` makes it.  ``alike`` maps rows to those
        whose shapes they have.
    shapes
        Rows with their run and structure; the first is shown when the page opens.
    folder
        Made when absent.

    Returns
    -------
    tuple
        The page, and the rows whose shapes it has.

    Raises
    ------
    OSError
        If the page cannot be written.
    """
    from jinja2 import Environment, FileSystemLoader, StrictUndefined  # noqa: PLC0415
    from markupsafe import Markup  # noqa: PLC0415

    from crumple.report.scene.page import REPORT, page_parts  # noqa: PLC0415

    scenes = _scenes(shapes)
    first = next(iter(scenes.values()), None)
    environment = Environment(
        loader=FileSystemLoader(REPORT / "templates"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
    )
    parts = page_parts(first, "study.css", script="study.js")
    stored = ",".join(
        f'"{row}":{{"header":{scene.header},"payload":"{scene.payload}"}}' for row, scene in scenes.items()
    )
    alike = {str(row): solved for row, solved in data["alike"].items() if solved in scenes}
    page = Path(folder) / PAGE
    text = environment.get_template("study.html.jinja").render(
        **parts,
        title=data["title"] or "Study",
        total=data["total"],
        complete=data["complete"],
        shown=len(data["rows"]),
        remarks=data["remarks"],
        shapes=len(scenes),
        data=Markup(_json({**data, "alike": alike})),
        stored=Markup("{" + stored + "}"),
    )
    write_text(page, text)
    return page, list(scenes)


def _json(data: Mapping[str, Any]) -> str:
    # a text element of the page ends at this mark
    return json.dumps(data, ensure_ascii=True, allow_nan=False).replace("<", "\\u003c")


def _scenes(shapes: Iterable[tuple[int, Result, Structure]]) -> dict[int, Scene]:
    """Scenes by row, as many as the page holds."""
    from crumple.report.scene.hinges import hinges_of_result  # noqa: PLC0415
    from crumple.report.scene.scene import Shown, write_scene  # noqa: PLC0415

    found: dict[int, Scene] = {}
    size = 0
    for row, result, structure in shapes:
        scene = write_scene([Shown(f"row {row}", result, partial(hinges_of_result, result), structure)])
        if scene is None:
            continue
        size += len(scene.header) + len(scene.payload)
        if found and size > MOST_BYTES:
            break
        found[row] = scene
    return found
