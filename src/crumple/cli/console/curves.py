"""Curve files of `crumple compare`, from the options that name them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import typer

if TYPE_CHECKING:
    from crumple.comparison import CurveFile


def curves_of(given: Sequence[str], pairs: Sequence[str]) -> list[CurveFile]:
    """Curve files from ``name=file.csv`` and ``column=history``.

    Raises
    ------
    InputError
        If a file cannot be taken.
    typer.BadParameter
        If an option is not of its form, a name is taken already, or no file has a column to be paired.
    """
    from crumple.comparison import MODEL_NAMES, read_curves

    renamed = {}
    for entry in pairs:
        column, equals, history = (part.strip() for part in entry.partition("="))
        if not equals or not column or not history:
            raise typer.BadParameter(f"'{entry}' is not column=history", param_hint="--pair")
        if column in renamed:
            raise typer.BadParameter(f"column '{column}' is paired twice", param_hint="--pair")
        renamed[column] = history
    found: dict[str, CurveFile] = {}
    for text in given:
        name, equals, path = (part.strip() for part in text.partition("="))
        if not equals or not name or not path:
            raise typer.BadParameter(f"'{text}' is not name=file.csv", param_hint="--curve")
        if name in found or name in MODEL_NAMES:
            whose = "another curve's" if name in found else "that of a result"
            raise typer.BadParameter(f"the name '{name}' is {whose}; choose another", param_hint="--curve")
        found[name] = read_curves(path, name, renamed)
    columns = [column for curve in found.values() for column in curve.columns]
    for column in renamed:
        if column not in columns:
            there = ", ".join(f"'{one}'" for one in columns) or "none, as there is no --curve"
            message = f"no curve file has a column '{column}' with a unit; the columns are: {there}"
            raise typer.BadParameter(message, param_hint="--pair")
    return list(found.values())
