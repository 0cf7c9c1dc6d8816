"""`crumple schema`: the JSON Schema of the input file or the study file, for editors."""

from __future__ import annotations

import json
from typing import Annotated, Any

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
        from crumple.study import Study, TargetFile

        found = _either(schema_of(Study, "Study"), schema_of(TargetFile, "Inverse design"))
    else:
        found = json_schema()
    typer.echo(json.dumps(found, indent=2, ensure_ascii=not console_takes_all()))


def _either(study: dict[str, Any], target: dict[str, Any]) -> dict[str, Any]:
    """Schema of a study file: a study, or a target."""
    parts = {**study.pop("$defs"), **target.pop("$defs"), "Study": study, "TargetFile": target}
    dialect = study.pop("$schema")
    target.pop("$schema")
    choices = [{"$ref": "#/$defs/Study"}, {"$ref": "#/$defs/TargetFile"}]
    return {"$schema": dialect, "title": "Crumple study file, format 1", "$defs": parts, "anyOf": choices}
