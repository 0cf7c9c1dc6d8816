"""Tables that `crumple run` prints: outputs that were asked for, forces, hinges, crush zones and dents."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from crumple.numeric.ranking import largest_first

if TYPE_CHECKING:
    from rich.table import Table

    from crumple.numeric.arrays import Floats
    from crumple.result import CrumpledEnd, DentedWall, HingeSummary, Result

MOST_HINGES = 20
"""Number of hinges in the table; the files contain all."""
MOST_MEMBERS = 3
"""Number of members that are named."""
MOST_OF_NAMES = 22
"""Width up to which names in tables are not broken: with the figures, 80 columns."""


def output_tables(result: Result, clearances: Collection[str]) -> Iterator[Table]:
    """Displacements, distances and clearances that were asked for, and forces of obstacles; none is empty.

    Parameters
    ----------
    result
        With at least one output time.
    clearances
        Names of outputs whose smallest value matters.
    """
    if not len(result.time):
        return
    extents = _extents(result, clearances)
    if extents:
        rows = [(values[at], result.time[at], values[-1]) for values, at in extents.values()]
        columns = (
            ("Extreme", [row[0] for row in rows], "m"),
            ("Reached at", [row[1] for row in rows], "s"),
            ("At the end", [row[2] for row in rows], "m"),
        )
        yield _table("Output", list(extents), columns)
    forces = {
        name.removeprefix("obstacle.").removesuffix(".force.x"): _magnitude(result, name.removesuffix(".x"))
        for name in result.channels
        if name.startswith("obstacle.") and name.endswith(".force.x")
    }
    if forces:
        at = [int(np.argmax(values)) for values in forces.values()]
        largest = [values[i] for values, i in zip(forces.values(), at, strict=True)]
        times = [result.time[i] for i in at]
        pushes = (("Largest force at an output", largest, "N"), ("Reached at", times, "s"))
        yield _table("Obstacle", list(forces), pushes)


def _extents(result: Result, clearances: Collection[str]) -> dict[str, tuple[Floats, int]]:
    """Histories [m] by output, displacements of nodes as magnitudes, and where each has its extreme."""
    found = {}
    for name in result.output_names:
        if name.startswith("node.") and name.endswith(".displacement.x"):
            node = name.removeprefix("node.").removesuffix(".displacement.x")
            found[f"node {node}"] = _magnitude(result, name.removesuffix(".x"))
        elif "." not in name and result.channels[name].unit == "m":
            found[f"clearance {name}" if name in clearances else f"change of {name}"] = result[name]
    return {
        name: (values, int(np.argmin(values) if name.startswith("clearance ") else np.argmax(np.abs(values))))
        for name, values in found.items()
    }


def _magnitude(result: Result, name: str) -> Floats:
    """Of a vector whose components are channels."""
    return np.asarray(np.linalg.norm([result[f"{name}.{axis}"] for axis in "xyz"], axis=0))


def most_yielding(result: Result) -> str:
    """The members that dissipated most between their hinges, in brackets; empty if they are not known."""
    from crumple.units import format_quantity

    energies = {name: sum(energy for _, energy in places) for name, places in result.yielded.items()}
    ranked = [name for name in largest_first(energies) if energies[name] > 0.0][:MOST_MEMBERS]
    if not ranked:
        return ""
    named = ", ".join(f"{name} {format_quantity(energies[name], 'J')}" for name in ranked)
    return f" (most: {named})" if len(energies) > len(ranked) else f" ({named})"


def _most_absorbing(hinges: Mapping[str, HingeSummary]) -> list[tuple[str, HingeSummary]]:
    """Hinges in their order; of many, those with the largest absorbed energy."""
    if len(hinges) <= MOST_HINGES:
        return list(hinges.items())
    ranked = largest_first({name: hinge.energy for name, hinge in hinges.items()})
    return [(name, hinges[name]) for name in ranked[:MOST_HINGES]]


def _hinge_table(summaries: Mapping[str, HingeSummary]) -> Table:
    """One row per hinge that bends or twists."""
    hinges = _most_absorbing(summaries)
    columns = (
        ("Largest rotation", [hinge.rotation_max for _, hinge in hinges], "rad"),
        ("Final rotation", [hinge.rotation_final for _, hinge in hinges], "rad"),
        ("At rest from", [hinge.time_of_rest for _, hinge in hinges], "s"),
        ("Peak moment", [hinge.moment_max for _, hinge in hinges], "N*m"),
        ("Energy absorbed", [hinge.energy for _, hinge in hinges], "J"),
    )
    return _table("Hinge", [name for name, _ in hinges], columns)


def _crush_table(summaries: Mapping[str, HingeSummary]) -> Table:
    """One row per hinge that can shorten along its member."""
    zones = [(name, hinge.crush) for name, hinge in _most_absorbing(summaries) if hinge.crush is not None]
    columns = (
        ("Crush length", [crush.length for _, crush in zones], "m"),
        ("Peak force", [crush.peak_force for _, crush in zones], "N"),
        ("Mean force", [crush.mean_force for _, crush in zones], "N"),
        ("Energy absorbed", [crush.energy for _, crush in zones], "J"),
        ("Stroke efficiency", [crush.efficiency for _, crush in zones], "1"),
    )
    names = [f"{name} (bottomed out)" if crush.bottomed_out else name for name, crush in zones]
    return _table("Crush zone", names, columns)


def _stretch_table(summaries: Mapping[str, HingeSummary]) -> Table:
    """One row per hinge that lengthened along its member."""
    hinges = [(name, h.stretch) for name, h in _most_absorbing(summaries) if h.stretch is not None]
    columns = (
        ("Lengthening", [stretch.length for _, stretch in hinges], "m"),
        ("Peak tension", [stretch.peak_force for _, stretch in hinges], "N"),
        ("Energy of tension", [stretch.energy for _, stretch in hinges], "J"),
    )
    return _table("Stretched hinge", [name for name, _ in hinges], columns)


def hinge_tables(
    result: Result, bending: dict[str, HingeSummary], crushing: dict[str, HingeSummary]
) -> Iterator[Table]:
    """Tables of hinges that bend, are crushed or stretched, of crumpled ends, and of dents; none is empty."""
    if bending:
        yield _hinge_table(bending)
    if crushing:
        yield _crush_table(crushing)
    if any(hinge.stretch is not None for hinge in result.hinges.values()):
        yield _stretch_table(result.hinges)
    if result.crumpled_ends:
        yield _crumpled_table(result.crumpled_ends)
    if result.dents:
        yield _dent_table(result.dents)


def _crumpled_table(ends: Sequence[CrumpledEnd]) -> Table:
    """One row per free end that crumpled on a plane."""
    columns = (
        ("Depth", [end.depth for end in ends], "m"),
        ("Energy absorbed", [end.energy for end in ends], "J"),
    )
    return _table("Crumpled end", [f"{end.node} on {end.obstacle}" for end in ends], columns)


def _dent_table(dents: Sequence[DentedWall]) -> Table:
    """One row per dent in the wall of a tube."""
    columns = (
        ("Depth", [dent.depth for dent in dents], "m"),
        ("Energy absorbed", [dent.energy for dent in dents], "J"),
    )
    return _table("Dent", [f"{dent.member} under {dent.obstacle}" for dent in dents], columns)


def _table(what: str, names: list[str], columns: tuple[tuple[str, list[Any], str], ...]) -> Table:
    """A table of named rows; every column in one unit."""
    from rich.markup import escape
    from rich.table import Table

    from crumple.cli.console.columns import in_one_unit

    table = Table(padding=(0, 1, 0, 0))
    # heads wrap between words; names are needed whole
    table.add_column(what, no_wrap=True)
    broken = (re.findall(f".{{1,{MOST_OF_NAMES}}}", name) for name in names)
    cells = [["\n".join(map(escape, parts)) for parts in broken]]
    for head, values, si in columns:
        unit, texts = in_one_unit(values, si, absent="turning")
        table.add_column(f"{head}, {unit}" if unit else head, justify="right")
        cells.append(texts)
    for row in zip(*cells, strict=True):
        table.add_row(*row)
    return table
