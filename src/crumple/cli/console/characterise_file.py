"""`crumple characterise FILE.yaml`: laws that a structure, or one of its joints, needs; those missing."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import typer

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from crumple.characterisation.needed import Needed
    from crumple.material import Material
    from crumple.section import Section
    from crumple.structure import Structure

JOINT_HELP = (
    "The corner or T-joint at a node of an input file, as 'frame.yaml:knee', or 'frame.yaml' if it has one "
    "joint: the laws of all its axes. Sections and material are those of the file."
)
_GIVEN = re.compile(r"(?P<path>.+\.ya?ml)(?::(?P<node>.+))?", re.IGNORECASE)

MOST_NAMES = 4
"""Members or nodes of one sub-model that are listed."""


class Joint(NamedTuple):
    """File with the joint, its node if one is named, and section and material that it must have, if given."""

    file: Path
    node: str | None
    section: str | None
    material: str | None


def characterise_file(
    file: Path,
    store: Path,
    largest: float,
    *,
    workers: int,
    converge: bool,
    only_list: bool,
    joint: Joint | None = None,
) -> None:
    """List the laws of a structure, or of one joint of it, and solve those that the store lacks."""
    from crumple.analysis import load
    from crumple.characterisation.needed import left_out, needed

    structure = load(file).structure
    every = needed(structure, largest)
    if joint is not None:
        every = laws_of_joint(structure, every, joint)
    missing = _missing(every, store, converge)
    for one in every:
        state = f"missing, about {_time(one.seconds(converge=converge))}" if one in missing else "stored"
        typer.echo(f"{_names(one.where)}: {_title(one)}: {state}")
    for node, reason in left_out(structure).items() if joint is None else ():
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


def joint_of(
    text: str, section: str | None, material: str | None, others: Mapping[str, object | None]
) -> Joint:
    """The joint that is asked for.

    Parameters
    ----------
    text
        As given.
    section, material
        As given beside it.
    others
        Options that the file takes the place of, None or False where they are not given.

    Raises
    ------
    InputError
        If it names no input file, or an option beside it contradicts.
    """
    from crumple.errors import InputError, Problem

    found = _GIVEN.fullmatch(text)
    if found is None:
        allowed, todo = "FILE.yaml or FILE.yaml:NODE", "give the input file that has the joint"
        raise InputError(Problem("the joint is in no input file", text, allowed, todo, "--joint"))
    if given := [name for name, value in others.items() if value]:
        what, todo = "the file gives the joint and its loads", f"leave out {' and '.join(given)}"
        raise InputError(Problem(what, ", ".join(given), "", todo, "--joint"))
    return Joint(Path(found["path"]), found["node"], section, material)


def laws_of_joint(structure: Structure, every: Sequence[Needed], joint: Joint) -> tuple[Needed, ...]:
    """Sub-models of one joint, with the places by which structures find their laws.

    Parameters
    ----------
    structure
        Of the file.
    every
        All that it needs.
    joint
        Which one.

    Raises
    ------
    InputError
        If there is no such joint, it has no sub-model, or it has another section or material.
    """
    from crumple.characterisation.needed import is_joint, left_out
    from crumple.errors import InputError, Problem

    of_joints = [one for one in every if is_joint(one.model)]
    nodes = list(dict.fromkeys(node for one in of_joints for node in one.where))
    allowed = ", ".join(nodes) or "a corner or T-joint in the file"
    node = joint.node
    if node is None and len(nodes) == 1:
        node = nodes[0]
    if node is None:
        what, todo = "the file does not have exactly one joint", f"name its node: {joint.file}:NODE"
        raise InputError(Problem(what, f"{len(nodes)} joints", allowed, todo, "--joint"))
    if node not in nodes:
        known = node in structure.nodes
        reason = left_out(structure).get(node, "no two members meet there at an angle")
        what = f"no law of this joint can be computed: {reason}" if known else "there is no such node"
        raise InputError(Problem(what, node, allowed, "choose another node", "--joint"))
    found = tuple(replace(one, where=(node,)) for one in of_joints if node in one.where)
    _check(found, joint)
    return found


def _check(found: Sequence[Needed], joint: Joint) -> None:
    """Refuse a section or material beside the file that the joint does not have."""
    from crumple.cli.console.named import material_of, section_of
    from crumple.errors import InputError, Problem

    given: dict[str, Section | Material] = {}
    if joint.section is not None:
        given["section"] = section_of(joint.section)
    if joint.material is not None:
        given["material"] = material_of(joint.material)[0]
    for name, value in given.items():
        if any(replace(one.model, **{name: value}).place != one.place for one in found):
            own = getattr(found[0].model, name)
            what, came = f"the joint has another {name}", str(getattr(joint, name))
            allowed = str(getattr(own, "title", "")) or str(own.name)
            todo = f"leave the {name} out, or change it in {joint.file}"
            raise InputError(Problem(what, came, allowed, todo, "--joint"))


def _missing(every: Sequence[Needed], store: Path, converge: bool) -> list[Needed]:
    """Sub-models whose law the store lacks, the slowest first."""
    from crumple.hinge.measured.law_file import read_law
    from crumple.hinge.measured.library import by_place, read_store

    stored = {
        place: read_law(text)
        for place, text in (by_place(read_store(store, filling=True)) if store.is_dir() else {}).items()
    }

    def lacks(one: Needed) -> bool:
        law = stored.get(one.place)
        return law is None or (converge and law.validity.uncertainty is None)

    return sorted((one for one in every if lacks(one)), key=lambda one: -one.seconds(converge=converge))


def _solve(missing: list[Needed], store: Path, workers: int, converge: bool) -> bool:
    """Solve what is missing; returns whether every law was found."""
    from crumple.characterisation import LawStore
    from crumple.characterisation.parallel import characterise_all
    from crumple.cli.console.progress import progress_bar
    from crumple.portable import exit_code_of_stop, stop_on_interrupt

    shares, weights = [0.0] * len(missing), [one.seconds() for one in missing]
    found = failed = 0
    models = [one.model for one in missing]
    LawStore(store).prepare(models)
    with stop_on_interrupt() as cancel, progress_bar("characterising") as bar:

        def progress(number: int, share: float) -> None:
            shares[number] = share
            whole = sum(s * w for s, w in zip(shares, weights, strict=True)) / sum(weights)
            bar.describe(f"{found} of {len(missing)} laws, {whole:.0%}")
            bar(whole)

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
        raise typer.Exit(exit_code_of_stop())
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
