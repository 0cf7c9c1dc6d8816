"""A scene as part of a page: its data, the viewer's scripts and their hashes, and a page of its own."""

from __future__ import annotations

import base64
import hashlib
import json
from functools import partial
from pathlib import Path
from typing import Any

from crumple.errors import InputError, Problem
from crumple.portable import write_text
from crumple.report.scene.hinges import hinges_of_result
from crumple.report.scene.scene import FORMAT, VERSION, Scene, Shown, write_scene
from crumple.result import read
from crumple.version import __version__

REPORT = Path(__file__).parent.parent
SCENE = "scene.json"
"""File of a folder of results that holds the scene of its page."""
PAGE = "view.html"
MOST_STORED = 50_000_000
"""Largest scene file that is read [bytes]; those that are written have some 3 MB."""


def page_parts(scene: Scene | None, *styles: str, script: str = "") -> dict[str, Any]:
    """What a template needs of a scene: `scene`, `scripts`, `hashes`, `style`; for all pages alike.

    `styles` and `script`, which comes before the viewer, are further files of the templates.
    """
    from markupsafe import Markup  # noqa: PLC0415

    names = [*([script] if script and scene is None else []), "page.js"]
    if scene is not None:
        names = [*([script] if script else []), "viewer.js", *names]
    scripts = [text_of(f"templates/{name}") for name in names]
    if scene is not None:
        scripts.insert(0, text_of("vendor/three.min.js"))
    style = "".join(text_of(f"templates/{name}") for name in ("page.css", "viewer.css", *styles))
    return {
        "version": __version__,
        "scene": None if scene is None else _described(scene),
        "scripts": [Markup(script) for script in scripts],
        "hashes": " ".join(_hash(script) for script in scripts),
        "style": Markup(style),
    }


def store_scene(scene: Scene | None, folder: Path) -> None:
    """Write ``scene.json``, without a scene an empty one."""
    # an empty one replaces that of an earlier run too
    write_text(folder / SCENE, "{}" if scene is None else scene.text())


def write_view(folder: Path, page: Path | None = None) -> Path:
    """Write a page with the viewer alone for a folder of results.

    Parameters
    ----------
    folder
        With ``scene.json``, as every run and comparison leaves it, or at least ``result.vtkhdf``, whose
        walls and hinges are then shown without obstacles, masses and supports.
    page
        Where to write it; by default ``view.html`` in the folder.

    Returns
    -------
    Path
        The page.

    Raises
    ------
    InputError
        If there is no result, or it has no shapes, or a newer Crumple wrote it.
    OSError
        If the page cannot be written.
    """
    from jinja2 import Environment, FileSystemLoader, StrictUndefined  # noqa: PLC0415

    scene, title = stored_scene(folder)
    environment = Environment(
        loader=FileSystemLoader(REPORT / "templates"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
    )
    place = page or folder / PAGE
    parts = page_parts(scene)
    write_text(place, environment.get_template("view.html.jinja").render(title=title or "Result", **parts))
    return place


def stored_scene(folder: Path) -> tuple[Scene, str]:
    """The scene of a folder of results and its title; see `write_view`."""
    file = folder / SCENE
    if file.is_file() and not _empty(file):
        return _read_scene(file)
    result = read(folder)
    scene = write_scene([Shown(result.fidelity, result, partial(hinges_of_result, result))], result.title)
    if scene is None:
        raise InputError(
            Problem(
                "there are too few shapes to show",
                file=str(folder),
                todo="solve the analysis again and keep its pictures",
            )
        )
    return scene, result.title


def _empty(file: Path) -> bool:
    """Whether there was nothing to show when the file was written."""
    return file.stat().st_size == len("{}") and file.read_bytes() == b"{}"


def _read_scene(file: Path) -> tuple[Scene, str]:
    try:
        if file.stat().st_size > MOST_STORED:
            raise ValueError(f"{file.stat().st_size} bytes")
        data = json.loads(file.read_text(encoding="utf-8"))
        kind, version = data["format"], int(data["version"])
        payload = base64.b64decode(data.pop("payload"), validate=True)
        scene = Scene(
            _text(data), base64.b64encode(payload).decode(), float(data["strain"]), len(data["times"])
        )
        title = str(data["title"])
    except (ValueError, KeyError, TypeError, AttributeError, RecursionError) as error:
        came = f"{type(error).__name__}: {str(error)[:200]}"
        what, todo = "this file is not a scene, or is damaged", "solve the analysis again"
        raise InputError(Problem(what, came=came, todo=todo, file=str(file))) from error
    if kind != FORMAT or version > VERSION:
        came, allowed = f"{kind} version {version}", f"{FORMAT} up to version {VERSION}"
        raise InputError(
            Problem(
                "this scene cannot be read", came=came, allowed=allowed, todo="update Crumple", file=str(file)
            )
        )
    return scene, title


def _text(header: dict[str, Any]) -> str:
    return json.dumps(header, ensure_ascii=True, allow_nan=False).replace("<", "\\u003c")


def _described(scene: Scene) -> dict[str, Any]:
    """The scene for the template, with the notes that a reader needs."""
    from markupsafe import Markup  # noqa: PLC0415

    models = json.loads(scene.header)["models"]
    notes = [
        f"Of the {model['walls']} walls of the {model['name']} model {model['quads']} are drawn, "
        "to keep the page small."
        for model in models
        if model["quads"] < model["walls"]
    ]
    return {
        "header": Markup(scene.header),
        "payload": Markup(scene.payload),
        "strain": scene.strain,
        "names": [model["name"] for model in models],
        "notes": notes,
    }


def text_of(name: str) -> str:
    """Text of a file of this room."""
    return (REPORT / name).read_text(encoding="utf-8")


def _hash(script: str) -> str:
    """Hash by which the security policy of the page allows this script and no other."""
    # the browser hashes the text between the tags, including line breaks of the template
    digest = hashlib.sha256(f"\n{script}\n".encode()).digest()
    return f"'sha256-{base64.b64encode(digest).decode()}'"
