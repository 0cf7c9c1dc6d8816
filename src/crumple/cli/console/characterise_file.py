"""`crumple characterise FILE.yaml`: laws that a structure needs, those stored, and those that are missing."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import typer

if TYPE_CHECKING:
    from collections.abc import Sequence

    from crumple.characterisation.needed import Needed

MOST_NAMES = 4
"""Members or nodes of one sub-model that are listed."""


def characterise_file(
    file: Path, store: Path, largest: float, *, workers: int, converge: bool, only_list: bool
) -> None:
    """List the laws of a structure's members and corners, and solve those that the store lacks."""
    from crumple.analysis import load
    from crumple.characterisation.needed import left_out, needed

    structure = load(file).structure
    every = needed(structure, largest)
    missing = _missing(every, store, converge)
    for one in every:
        state = f"missing, about {_time(one.seconds(converge=converge))}" if one in missing else "stored"
        typer.echo(f"{_names(one.where)}: {_title(one)}: {state}")
    for node, reason in left_out(structure).items():
        typer.echo(f"{node}: no law of this corner can be computed: {reason}")
    if not missing:
        typer.echo(f"All {len(every)} laws are in {store}. Use them with --laws {store}")
        return
    total = sum(one.seconds(converge=converge) for one in missing)
    slowest = max(one.seconds(converge=converge) for one in missing)
    count = min(workers, len(missing))
    wall = max(total / count, slowest)
    typer.echo(
        f"{len(missing)} of {len(every)} laws are missing: about {_time(total)} of processor time, "
        f"{_time(wall)} with {count} worker{'s' if count > 1 else ''}"
    )
    if not only_list and not _solve(missing, store, workers, converge):
        raise typer.Exit(1)


def _missing(every: Sequence[Needed], store: Path, converge: bool) -> list[Needed]:
    """Sub-models whose law the store lacks, the slowest first."""
    from crumple.hinge.measured.law_file import read_law
    from crumple.hinge.measured.library import by_place, read_store

    stored = {
        place: read_law(text)
        for place, text in (by_place(read_store(store)) if store.is_dir() else {}).items()
    }

    def lacks(one: Needed) -> bool:
        law = stored.get(one.place)
        return law is None or (converge and law.validity.uncertainty is None)

    return sorted((one for one in every if lacks(one)), key=lambda one: -one.seconds(converge=converge))


def _solve(missing: list[Needed], store: Path, workers: int, converge: bool) -> bool:
    """Solve what is missing; returns whether every law was found."""
    from crumple.characterisation.parallel import characterise_all
    from crumple.cli.console.progress import progress_bar
    from crumple.portable import stop_on_interrupt

    shares, weights = [0.0] * len(missing), [one.seconds() for one in missing]
    found = failed = 0
    with stop_on_interrupt() as cancel, progress_bar("characterising") as bar:

        def progress(number: int, share: float) -> None:
            shares[number] = share
            whole = sum(s * w for s, w in zip(shares, weights, strict=True)) / sum(weights)
            bar.describe(f"{found} of {len(missing)} laws, {whole:.0%}")
            bar(whole)

        models = [one.model for one in missing]
        for done in characterise_all(
            models, store, workers=workers, converge=converge, progress=progress, cancel=cancel
        ):
            one = missing[done.number]
            progress(done.number, 1.0)
            if done.path is None:
                failed += 1
                typer.echo(f"{_names(one.where)}: no law: {' '.join(done.reason.split())}", err=True)
            else:
                found += 1
                typer.echo(f"{_names(one.where)}: {done.path}")
        stopped = cancel()
    if stopped:
        typer.echo(f"Stopped with {found} of {len(missing)} laws; the same command continues.", err=True)
        raise typer.Exit(130)
    typer.echo(f"{found} laws added to {store}. Use them with --laws {store}")
    return failed == 0


def _title(one: Needed) -> str:
    """What a sub-model is, without the sense: both are solved where they differ."""
    return one.model.title.split(", closed")[0].split(", sense")[0]


def _names(names: Sequence[str]) -> str:
    more = f" and {len(names) - MOST_NAMES} more" if len(names) > MOST_NAMES else ""
    return ", ".join(names[:MOST_NAMES]) + more


def _time(seconds: float) -> str:
    return f"{seconds:.0f} s" if seconds < 100.0 else f"{seconds / 60.0:.0f} min"
