"""Tables of hinges that shortened or lengthened along their members, of ends that crumpled, and of dents."""

from __future__ import annotations

import math

from crumple.report.wording.wording import Table, column, percent
from crumple.result import Result


def crush_table(result: Result) -> Table:
    """Crush length, forces, energy and stroke of every hinge that can shorten along its member."""
    zones = {name: hinge.crush for name, hinge in result.hinges.items() if hinge.crush is not None}
    length_unit, lengths = column([zone.length for zone in zones.values()], "m")
    stroke_unit, strokes = column(
        [math.nan if zone.stroke is None else zone.stroke for zone in zones.values()], "m"
    )
    peak_unit, peaks = column([zone.peak_force for zone in zones.values()], "N")
    mean_unit, means = column([zone.mean_force for zone in zones.values()], "N")
    energy_unit, energies = column([zone.energy for zone in zones.values()], "J")
    efficiencies = [percent(zone.efficiency, 3) for zone in zones.values()]
    closed = ["yes" if zone.bottomed_out else "no" for zone in zones.values()]
    heads = (
        "Crush zone", f"Crush length, {length_unit}", "Stroke efficiency", f"Folds closed at, {stroke_unit}",
        "Bottomed out", f"Peak force, {peak_unit}", f"Mean force, {mean_unit}", f"Energy, {energy_unit}",
    )  # fmt: skip
    rows = list(zip(zones, lengths, efficiencies, strokes, closed, peaks, means, energies, strict=True))
    caption = (
        "What each crush zone did. Stroke efficiency: crush length over the length of the member. Forces are "
        "unfiltered; the mean is the energy over the crush length."
    )
    return Table(caption, heads, rows)


def crushing_laws(result: Result) -> list[tuple[str, list[str]]]:
    """Laws of crushing in words, with the hinges that have each."""
    found: dict[str, list[str]] = {}
    for name, hinge in result.hinges.items():
        if hinge.crush is not None and hinge.crush.law:
            found.setdefault(hinge.crush.law, []).append(name)
    return list(found.items())


def crushing_law_table(result: Result) -> Table:
    """Force of every crush zone: its law, with source and evidence."""
    rows = [(", ".join(names), law) for law, names in crushing_laws(result)]
    caption = (
        "What the crush zones carry along their members, with source, evidence and band of the mean force."
    )
    return Table(caption, ("Crush zone", "Law"), rows, frozenset({1}))


def stretch_table(result: Result) -> Table:
    """Lengthening, tension and energy of every hinge that lengthened along its member."""
    hinges = {name: hinge.stretch for name, hinge in result.hinges.items() if hinge.stretch is not None}
    length_unit, lengths = column([hinge.length for hinge in hinges.values()], "m")
    peak_unit, peaks = column([hinge.peak_force for hinge in hinges.values()], "N")
    energy_unit, energies = column([hinge.energy for hinge in hinges.values()], "J")
    heads = ("Hinge", f"Lengthening, {length_unit}", f"Peak tension, {peak_unit}", f"Energy, {energy_unit}")
    caption = "Hinges whose members were pulled longer. The energy is the work of the tension."
    return Table(caption, heads, list(zip(hinges, lengths, peaks, energies, strict=True)))


def crumpled_table(result: Result) -> Table:
    """Free ends of members that crumpled on planes."""
    ends = result.crumpled_ends
    depth_unit, depths = column([end.depth for end in ends], "m")
    energy_unit, energies = column([end.energy for end in ends], "J")
    heads = ("End", "Member", "Obstacle", f"Depth, {depth_unit}", f"Energy, {energy_unit}")
    names = [(end.node, end.member, end.obstacle) for end in ends]
    caption = (
        "Free ends that crumpled where a plane met them obliquely. The energy is part of that of contact."
    )
    rows = [(*name, *cells) for name, *cells in zip(names, depths, energies, strict=True)]
    return Table(caption, heads, rows, frozenset({1, 2}))


def dent_table(result: Result) -> Table:
    """Dents that obstacles pressed into walls."""
    dents = result.dents
    place_unit, places = column([dent.station for dent in dents], "m")
    depth_unit, depths = column([dent.depth for dent in dents], "m")
    energy_unit, energies = column([dent.energy for dent in dents], "J")
    heads = (
        "Member",
        f"Place, {place_unit}",
        "Obstacle",
        f"Depth, {depth_unit}",
        f"Energy, {energy_unit}",
    )
    caption = "Dents under obstacles. Their energy is part of that of the member."
    names, obstacles = [dent.member for dent in dents], [dent.obstacle for dent in dents]
    rows = list(zip(names, places, obstacles, depths, energies, strict=True))
    return Table(caption, heads, rows, frozenset({2}))
