"""`crumple check FILE`: every mistake of an input file at once, without solving it."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer


def check(file: Annotated[Path, typer.Argument(help="Input file (YAML).", show_default=False)]) -> None:
    """Report every mistake in an input file, and tell what of the structure is free or held twice."""
    from crumple.analysis import check as problems_of
    from crumple.analysis import load
    from crumple.errors import InputError
    from crumple.multibody import infinitesimal, link, notes, unheld_notes

    problems = problems_of(file)
    if problems:
        raise InputError(problems)
    typer.echo(f"{file}: no mistakes found")
    analysis = load(file)
    linkage = link(analysis.structure)
    loose = unheld_notes(analysis.structure, linkage, analysis.stages)
    for note in filter(None, (*notes(linkage), infinitesimal(linkage), *loose)):
        typer.echo(f"  {note}")
