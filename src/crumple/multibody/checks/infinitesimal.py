"""Sentences about dead centres at the start, see `crumple.multibody.bodies.dead_centres`."""

from __future__ import annotations

from crumple.multibody.bodies.dead_centres import DeadCentres, dead_centres
from crumple.multibody.bodies.linkage import Linkage
from crumple.multibody.bodies.mobility import too_large
from crumple.text.names import listed


def infinitesimal(linkage: Linkage) -> str:
    """The parts of a linkage that are at a dead centre at the start; empty if there are none."""
    if too_large(linkage):
        return ""
    return " ".join(dead_centre_notes(linkage, dead_centres(linkage)))


def dead_centre_notes(linkage: Linkage, centres: DeadCentres, *, aside: bool = False) -> tuple[str, ...]:
    """Sentences about what is held at a dead centre, and what a run has moved aside."""
    found = []
    if centres.held:
        names = dict.fromkeys(linkage.connections[i].name for i, _ in sorted(centres.held))
        found.append(
            f"The structure can begin to move but not go on at {listed(names)} (bars in one line "
            "between supports, for example): these are held, and what is given to their motion is lost at "
            "once. Let a support slide, or give members hinges that lengthen ('axial')."
        )
    if aside:
        names = dict.fromkeys(linkage.connections[i].name for i in sorted(centres.aside))
        found.append(
            "The structure can move in several ways from its start position (equal members side by side, for "
            f"example), and the loads do not select one: {listed(names)} were moved aside by "
            f"{centres.offset:g} of its size, as members are never straight, and it moves in one of the ways."
        )
    return tuple(found)
