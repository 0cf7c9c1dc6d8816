"""`crumple schema`: the JSON Schema of the input file, for editors."""

from __future__ import annotations

import json

import typer

from crumple.portable import console_takes_all


def schema() -> None:
    """Print the JSON Schema of the input file. Editors complete and check input with it."""
    from crumple.analysis import json_schema

    typer.echo(json.dumps(json_schema(), indent=2, ensure_ascii=not console_takes_all()))
