"""Stores of hinge laws on the command line: which one is used, what it gave, and the file that freezes it."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from crumple.analysis import LoadedInput
    from crumple.result import HingeSummary, Result

MOST_RANGES = 6
"""Quantities whose range is printed; the files contain all."""
STOPPED = "runs that stopped early (unlike the run itself, they are not repeated in another way)"
"""Of runs with other laws: a single run may begin again aside of dead centres, or with walls that crush."""
MOST_NAMES = 4
"""Names of hinges with one law that are listed; the files contain all."""

Laws = Annotated[
    Path | None,
    typer.Option(
        metavar="FOLDER",
        help="Store of hinge laws from shells: a folder of `crumple characterise`, or a file of "
        "--freeze-laws. Hinges without a law of their own use it.",
        show_default=False,
    ),
]
Freeze = Annotated[
    Path | None,
    typer.Option(
        metavar="FILE",
        help="Write the stored laws that were used, with the hashes of all laws, to one file for --laws.",
        show_default=False,
    ),
]


def with_store(source: LoadedInput, laws: Path | None, freeze: Path | None = None) -> LoadedInput:
    """The input with the laws of a store; `freeze` names the file that they are written to."""
    used = source if laws is None else source.with_laws(laws)
    if freeze is not None:
        write_frozen([used], freeze)
    return used


def write_frozen(sources: list[LoadedInput], file: Path) -> None:
    """Write the stored laws that inputs use to one file; its head lists the law of every hinge."""
    from crumple.errors import InputError, Problem
    from crumple.hinge.measured.library import frozen
    from crumple.portable import refusal_of, replacing
    from crumple.structure import law_uses, used_texts, with_elastic_members
    from crumple.version import __version__

    texts: set[str] = set()
    notes = [f"Crumple {__version__}; formulas are not written, their hashes show whether they are the same."]
    for source in sources:
        analysis = source.analysis
        structure = with_elastic_members(analysis.structure, analysis.multibody, analysis.time_in_motion)
        texts |= set(used_texts(structure))
        for name, use in law_uses(structure).items():
            notes.append(f"{source.path.name}: hinge {name}: {use.origin} {use.content}")
    try:
        file.parent.mkdir(parents=True, exist_ok=True)
        with replacing(file) as part:
            part.write_text(frozen(texts, notes), encoding="utf-8")
    except OSError as error:
        what, todo = f"the laws cannot be written: {refusal_of(error)}", "choose another file"
        raise InputError(Problem(what, str(file), "", todo, "--freeze-laws")) from None


def law_lines(result: Result, source: LoadedInput) -> Iterator[str]:
    """Store that was used, and the origin of every law; hinges with one law in one line."""
    from crumple.report.wording.along import crushing_laws

    store = source.analysis.structure.laws
    if store is not None:
        yield f"Store of laws: {store.name}, {len(store.texts)} used{_of_store(store.texts, source.path)}"
    for sentence, names in grouped(result.hinges, str(source.path), _types(source)).items():
        yield f"Law of {_some(names)}: {sentence}"
    for sentence, names in crushing_laws(result):
        yield f"Crushing of {_some(names)}: {sentence}"
    if result.fidelity == "multibody":
        yield from _of_members(source)


def _some(names: Sequence[str]) -> str:
    """Number and names of some hinges, or the name of one."""
    if len(names) == 1:
        return names[0]
    more = f" and {len(names) - MOST_NAMES} more" if len(names) > MOST_NAMES else ""
    return f"{len(names)} hinges ({', '.join(names[:MOST_NAMES])}{more})"


def _types(source: LoadedInput) -> Mapping[str, str]:
    """Type of the law of every hinge, as in the input file."""
    from crumple.structure import law_types_of, with_elastic_members

    analysis = source.analysis
    return law_types_of(with_elastic_members(analysis.structure, analysis.multibody, analysis.time_in_motion))


def _of_members(source: LoadedInput) -> Iterator[str]:
    """Corners without laws of their own, and members that are rigid because the motion is long."""
    from crumple.structure import corners_without_law, rigid_for_long, with_elastic_members

    given = source.analysis
    settings = given.multibody, given.time_in_motion
    yield from corners_without_law(with_elastic_members(given.structure, *settings))
    if rigid := rigid_for_long(given.structure, *settings):
        yield rigid


def _of_store(texts: Sequence[str], file: Path) -> str:
    """What is unusual about the laws of a store that a structure uses."""
    from crumple.hinge.measured.library import without_checksum
    from crumple.portable import command_line

    if not texts:
        command = f"`crumple characterise {command_line(file)} --list`"
        return f": it has no law that a hinge of this structure could use; {command} names those that could"
    unsure = without_checksum(texts)
    return f", {unsure} without a checksum (edited, or of an earlier version)" if unsure else ""


def range_lines(result: Result) -> Iterator[str]:
    """Range of rotations, energies and displacements from the bands of the laws."""
    from crumple.report.wording.law_range import range_rows

    found = result.law_range
    if found is None:
        return
    rows = range_rows(result)
    if not found.ranges or (found.failed and not found.cases):
        yield f"No range from the laws, {STOPPED}: {'; '.join(found.failed)}"
        return
    shown = "; ".join(f"{name} {low} to {high} {unit}" for name, unit, _, low, high in rows[:MOST_RANGES])
    more = f"; and {len(rows) - MOST_RANGES} more in summary.json" if len(rows) > MOST_RANGES else ""
    if rows:
        yield f"Range from the laws (a range, not a bound): {shown}{more}"
    elif found.without:
        yield "No range from the laws: those that have a band change nothing by more than rounding"
    else:
        yield "Range from the laws: nothing changes by more than rounding"
    if found.without:
        yield f"Without a band: {', '.join(found.without[:MOST_NAMES])}" + (
            f" and {len(found.without) - MOST_NAMES} more" if len(found.without) > MOST_NAMES else ""
        )
    if found.failed:
        yield f"Not in the range, {STOPPED}: {'; '.join(found.failed)}"


def with_range(result: Result, source: LoadedInput, threads: int, cancel: Callable[[], bool]) -> Result:
    """The result with its range from the laws; what is solved is kept if the range cannot be computed."""
    from crumple.analysis import with_law_range
    from crumple.errors import CancelledError, InputError

    try:
        return with_law_range(result, source.analysis, threads, cancel)
    except CancelledError:
        typer.echo("Stopped: the range from the laws is not known", err=True)
        return result
    except InputError as error:
        typer.echo(f"The range from the laws is not known: {error.problems[0].what}", err=True)
        return result


def grouped(hinges: Mapping[str, HingeSummary], file: str, types: Mapping[str, str]) -> dict[str, list[str]]:
    """Names of hinges by the type of their law, and the sentence on its origin."""
    found: dict[str, list[str]] = {}
    for name, hinge in hinges.items():
        if hinge.law_use is not None:
            kind = f"{types[name]}: " if name in types else ""
            found.setdefault(kind + hinge.law_use.sentence(file), []).append(name)
    return found
