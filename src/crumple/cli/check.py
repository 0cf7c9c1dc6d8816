"""`crumple check FILE`: every mistake of an input file at once, without solving it."""

from __future__ import annotations

import gc
from collections.abc import Iterator
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from crumple.cli.console.fidelity import Fidelity

if TYPE_CHECKING:
    from crumple.analysis import Analysis

FIRST_LINES = 50
"""Lines of a file among which that of its format is looked for."""


def check(
    file: Annotated[Path, typer.Argument(help="Input file (YAML).", show_default=False)],
    *,
    fidelity: Annotated[Fidelity, typer.Option(help="Solver to check for.")] = Fidelity.MULTIBODY,
) -> None:
    """Report every mistake in an input or study file, and the notes of a solver before its first step."""
    if _is_study(file):
        from crumple.study import LoadedStudy, LoadedTarget, check_study, check_target, is_target

        if is_target(file):
            check_target(LoadedTarget(file))
        else:
            check_study(LoadedStudy(file))
        typer.echo(f"{file}: no mistakes found")
        return
    # what a check makes it keeps until its end, and an input is bounded: there is no garbage to look for
    collected = gc.isenabled()
    gc.disable()
    try:
        _check_input(file, fidelity)
    finally:
        if collected:
            gc.enable()


def _check_input(file: Path, fidelity: Fidelity) -> None:
    from crumple.analysis import load_input
    from crumple.errors import InputError
    from crumple.structure.checks.doubtful import input_doubts
    from crumple.structure.checks.never_met import never_met
    from crumple.structure.checks.section_axes import turned_posts, unnamed_axes
    from crumple.structure.checks.without_effect import unused_names

    source = load_input(file)
    # a problem that every solver reports is listed once
    found = {str(p): p for solver in fidelity.solvers for p in source.refusals(solver.value)}
    if found:
        raise InputError(list(found.values()))
    typer.echo(f"{file}: no mistakes found")
    doubts = input_doubts(source.analysis.structure, source.analysis.duration, source.analysis.stages)
    for text in dict.fromkeys(one.text for one in doubts):
        typer.echo(f"  Caution: {text}")
    if not source.analysis.stages:
        for text in never_met(source.analysis.structure, source.analysis.duration):
            typer.echo(f"  Caution: {text}")
    structure = source.analysis.structure
    for note in filter(None, (turned_posts(structure), unnamed_axes(structure), unused_names(structure))):
        typer.echo(f"  {note}")
    for solver in fidelity.solvers:
        notes = (_shell_notes if solver is Fidelity.SHELL else _multibody_notes)(source.analysis)
        for note in notes:
            typer.echo(f"  {note}")
    if fidelity is Fidelity.MULTIBODY:
        for note in _coarse_shells(source.analysis):
            typer.echo(f"  {note}")


def _is_study(file: Path) -> bool:
    """Whether a line of a file begins as that of a study's format."""
    try:
        with file.open(encoding="utf-8", errors="replace") as lines:
            return any(line.startswith("crumple_study:") for line in islice(lines, FIRST_LINES))
    except OSError:
        return False


def _multibody_notes(analysis: Analysis) -> Iterator[str]:
    """Motions that are free, constraints that are redundant, and members struck where they have no hinge."""
    from crumple.multibody import (
        infinitesimal,
        link,
        loose_drives,
        notes,
        obstacle_overlap_warnings,
        overlap_warnings,
        struck_cautions,
        struck_near_ends,
        stuck_drives,
        stuck_note,
        swept_supports,
        unheld_notes,
        with_drives_released,
    )
    from crumple.structure import corners_without_law, rigid_for_long, with_elastic_members
    from crumple.structure.checks.partly_driven import driven_assumptions
    from crumple.structure.checks.section_axes import section_doubts

    structure = with_elastic_members(analysis.structure, analysis.multibody, analysis.time_in_motion)
    linkage = link(structure)
    loose = unheld_notes(analysis.structure, linkage, analysis.stages)
    stuck = stuck_note(stuck_drives(analysis.structure, linkage))
    yield from filter(
        None,
        (*notes(linkage, with_drives_released(structure, linkage)), infinitesimal(linkage), stuck, *loose),
    )
    yield from driven_assumptions(structure)
    if rigid := rigid_for_long(analysis.structure, analysis.multibody, analysis.time_in_motion):
        yield rigid
    yield from corners_without_law(structure)
    yield from loose_drives(structure, linkage)
    yield from (f"Caution: {caution.text}" for caution in struck_cautions(structure))
    yield from (f"Caution: {text}" for text in struck_near_ends(structure))
    if not analysis.stages:
        yield from (f"Caution: {text}" for text in swept_supports(structure, analysis.duration))
    overlaps = (*overlap_warnings(structure), *obstacle_overlap_warnings(structure, analysis.stages))
    yield from (f"Caution: {text}" for text in overlaps)
    yield from (f"Caution: {text}" for text in dict.fromkeys(one.text for one in section_doubts(structure)))


def _coarse_shells(analysis: Analysis) -> Iterator[str]:
    """The warning of shells too long for folds, where the file has settings of the shell solver."""
    if analysis.shell.model_fields_set:
        from crumple.shell.checks.folds import coarse_settings

        for warning in coarse_settings(analysis.structure, analysis.shell):
            yield f"Warning for --fidelity shell: {warning}"


def _shell_notes(analysis: Analysis) -> Iterator[str]:
    """Mesh and warnings."""
    from crumple.cli.console.shell_run import shell_notes

    mesh, *warnings = shell_notes(analysis)
    yield mesh
    for warning in warnings:
        yield f"Warning: {warning}"
