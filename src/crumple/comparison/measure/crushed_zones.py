"""Zones of members that fold along their axis, joined to one.

A hinge that shortens stands for folds anywhere in its member.  At which end these begin is decided by
imperfections of the walls that no input states (both ends of a tube carry the same force), and neither the
force nor the shortening depends on it.  So the zones of both nodes and the span of such a member are one zone
for both results, and members that share a node are one together.

Braced members can fold, but need not: a shallow tripod that is struck across bends.  They are joined if the
reference shortens them by half the length of a fold, below which no fold has formed.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace

from crumple.comparison.measure.measures import Measures
from crumple.section import AXES, half_fold_length
from crumple.structure import Structure, hinge_places
from crumple.structure.hinges.automatic import lengthens


def with_joined_zones(measures: Measures, structure: Structure, reference: Measures) -> Measures:
    """The same figures with the energies of zones that a crushed member joins added up.

    Parameters
    ----------
    measures, structure
        Figures of either result, and what was solved.
    reference
        Figures of the reference, which say what shortened.
    """
    names = joined_zones(structure, reference.shortened)
    zones: dict[str, float] = {}
    for zone, energy in measures.zones.items():
        name = names.get(zone, zone)
        zones[name] = zones.get(name, 0.0) + energy
    return replace(measures, zones=zones)


def joined_zones(structure: Structure, shortened: Mapping[str, float]) -> Mapping[str, str]:
    """Name of the joined zone by the names of those in it: nodes and spans of members that fold axially.

    `shortened`: by how much members shortened [m]; braced ones that are not in it count as folded.
    """
    crushed = dict.fromkeys(
        place.member
        for place in hinge_places(structure)
        if place.keys.axial is not None
        and not place.keys.axial.yields
        and _folds(structure, place.member, shortened.get(place.member, math.inf))
    )
    groups: list[tuple[list[str], set[str]]] = []
    for member in crushed:
        members, zones = [member], {*structure.members[member].nodes, f"span of {member}"}
        apart = []
        for group in groups:
            if group[1].isdisjoint(zones):
                apart.append(group)
            else:
                members, zones = [*group[0], *members], group[1] | zones
        groups = [*apart, (members, zones)]
    return {zone: f"all of {' and '.join(members)}" for members, zones in groups for zone in zones}


def _folds(structure: Structure, member: str, shortened: float) -> bool:
    """Whether a member that can shorten is one that folds: asked to, or shortened by half a fold [m]."""
    section = structure.section_of(member)
    return not lengthens(structure, member) or shortened >= max(
        half_fold_length(section, axis) for axis in AXES
    )
