"""`crumple schema`: the JSON Schema of the input file or the study file, for editors."""

from __future__ import annotations

import json
from typing import Annotated

import typer

from crumple.portable import console_takes_all


def schema(
    *,
    study: Annotated[bool, typer.Option("--study", help="Of the study file instead.")] = False,
) -> None:
    """Print the JSON Schema of the input file. Editors complete and check input with it."""
    from crumple.analysis import json_schema

    if study:
        from crumple.analysis.schema import schema_of
        from crumple.study import Study

        found = schema_of(Study, "Crumple study file, format 1")
    else:
        found = json_schema()
    typer.echo(json.dumps(found, indent=2, ensure_ascii=not console_takes_all()))
