"""Whether a mesh can fold: elements along half a fold at the places where hinges are."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping

import numpy as np

from crumple.section import half_fold_length
from crumple.shell.mesh.mesh import Mesh
from crumple.structure import ShellSettings, Structure, hinge_places
from crumple.text.names import listed

LEAST_ELEMENTS = 4.0
"""Elements along half a fold below which there is a warning.  A cantilever of square tube 50x2 mm that is
struck at its tip stops at 210, 228, 249 and 255 mm with 2.6, 3.5, 5.3 and 7.1 of them: coarse folds take too
much energy, and where the moment falls, a tenth of the energy is a fifth of the way."""
FEW = "The mesh has as few as "
"""Start of the warning."""
LONGER = 1.05
"""Length of elements over `fine_size`, at most, in a fine zone of ten or more: their number is rounded."""


def coarse_folds(structure: Structure, mesh: Mesh) -> Iterator[str]:
    """One warning that names the members whose elements are too long for their folds."""
    found: dict[str, float] = {}
    for place in hinge_places(structure):
        tube = mesh.tubes[place.member]
        half = half_fold_length(structure.section_of(place.member), place.axis)
        inside = (tube.stations[1:] > place.station - half) & (tube.stations[:-1] < place.station + half)
        lengths = np.diff(tube.stations)[inside]
        if lengths.size:
            count = half / float(lengths.max())
            found[place.member] = min(count, found.get(place.member, count))
    yield from _too_few(structure, found)


def coarse_settings(structure: Structure, settings: ShellSettings) -> Iterator[str]:
    """The same warning by the settings alone, without a mesh, whose elements may be a little longer."""
    size, found = settings.fine_size or settings.element_size, dict[str, float]()
    for place in hinge_places(structure):
        count = half_fold_length(structure.section_of(place.member), place.axis) / size
        found[place.member] = min(count, found.get(place.member, count))
    yield from _too_few(structure, found)


def _too_few(structure: Structure, counts: Mapping[str, float]) -> Iterator[str]:
    """The warning, by the number of elements along half a fold of each member."""
    found = {member: count for member, count in counts.items() if count < LEAST_ELEMENTS}
    if found:
        size = min(
            half_fold_length(structure.section_of(place.member), place.axis)
            for place in hinge_places(structure)
            if place.member in found
        )
        yield (
            f"{FEW}{min(found.values()):.1f} elements along half a fold of "
            f"{'member' if len(found) == 1 else 'members'} {listed(found)}. With fewer than "
            f"{LEAST_ELEMENTS:.0f}, folds of thin walls take too much energy, and rotations are too small: "
            f"use fine_size {_advised(size):.2g} mm."
        )


def _advised(half: float) -> float:
    """Element size [mm] with enough elements along half a fold [m], rounded down to two digits."""
    size = 1e3 * half / LEAST_ELEMENTS / LONGER
    step = 10.0 ** (math.floor(math.log10(size)) - 1)
    return math.floor(size / step) * step
