"""Law of a tube beside a clamp, from further tables of the shipped library.

    M(theta) = s_y Z m(theta; x)        as `crumple.hinge.tube_library.law`, other m

A clamp or a rigid joint keeps the section in shape, so that the fold beside it takes up to a quarter more
work than one between two pieces of the tube.  The points are cantilevers that were solved with shells; M is
the moment at the distance `fold_distance` from the clamp, and theta all plastic rotation of the two half
folds beside it.  docs/theory/tube_library.md.

The fold itself lies at x from the clamp, by a further table.  A hinge there has the moment at x, which of a
cantilever of length a is M (a - x)/(a - d), d being `fold_distance`.  The fold of a rectangular tube takes
another moment where the moment falls faster along it, to nothing at the span a:

    M(theta; x, a) = M(theta) exp(s(theta) (D/a - 1/6)) (a - x)/(a - d)

with the larger side D, M of the cantilevers of 6 D, and s of further ones of 4 and 2.5 D.  Round tubes have
no s; their moment is taken to be that of cantilevers of L = 8 D at the place e(theta) where they turn, which
moves from d to x while the plastic zone becomes a fold:

    M(theta; x, a) = M(theta) (L - e)/(L - d) (a - x)/(a - e)
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import ClassVar, Self

import numpy as np

from crumple.hinge.options import number_between
from crumple.hinge.tube_library.law import TubeLibraryLaw
from crumple.hinge.tube_library.table import tube_table
from crumple.hinge.tube_library.tube import columns_of, place_of_tube
from crumple.material import Material
from crumple.registry.quantity import PositiveLength
from crumple.section import Axis, Section, fold_distance, half_fold_length

TABLES = {"circular_tube": "clamped_circular_tube", "rectangular_tube": "clamped_rectangular_tube"}
"""Name of the table by kind of section."""
PLACES = {kind: f"place_in_{name}" for kind, name in TABLES.items()}
"""Name of the table of places of folds, over half a fold, by kind of section."""
SHORT = "short_rectangular_tube"
"""Name of the table of s."""
SPANNED = frozenset({"rectangular_tube"})
"""Kinds of sections of which short cantilevers were solved."""
LONG = {"circular_tube": 8.0, "rectangular_tube": 6.0}
"""Length of the cantilevers in diameters or larger sides."""
FURTHEST = 1.5
"""Largest distance of a hinge in larger sides or diameters."""
SPANS = (2.5, 8.0)
"""Spans in larger sides within which rectangular tubes were solved; others count as the nearer end."""
FOLDED = math.radians(8.0)
"""Rotation from which round tubes turn about their fold, roughly that of the cantilevers."""


@dataclass(frozen=True)
class ClampedTubeLaw(TubeLibraryLaw):
    """Law of a rectangular or circular tube beside a clamp or a rigid joint, interpolated in the library.

    References
    ----------
    docs/theory/tube_library.md.  Verified in tests/verification/hinge/test_tube_library.py.
    """

    name: ClassVar[str] = "clamped_tube"

    @classmethod
    def of(
        cls,
        section: Section,
        material: Material,
        axis: Axis = "y",
        *,
        span: PositiveLength | None = None,
        distance: PositiveLength | None = None,
    ) -> Self:
        """Law of a tube beside a clamp.

        Parameters
        ----------
        section
            Rectangular or circular tube.
        material
            Yield stress, Young's modulus, hardening curve (without one: flow stress) and flow rate.
        axis
            Axis of bending.
        span
            Distance from the clamp to where the member carries no moment; without it six larger sides, or
            eight diameters.
        distance
            Distance of the hinge from the clamp; without it 0.7 half fold lengths.

        Raises
        ------
        InputError
            If the section is no such tube, or outside the range of the library; a
            distance of more than 1.5 larger sides or diameters.
        """
        place = place_of_tube(section, material, axis)
        law = cls.at(tube_table(TABLES[section.kind]), place, section, material, axis)
        if span is None and distance is None:
            return law
        side, nearest = place["slenderness"] * section.thickness, fold_distance(section, axis)
        at = nearest if distance is None else number_between("distance", distance, 0.0, FURTHEST * side)
        length, shortest, longest = (sides * side for sides in (LONG[section.kind], *SPANS))
        arm = length if span is None else min(max(span, shortest), longest)
        turns = nearest + (at - nearest) * np.minimum(np.array(law.rotation) / FOLDED, 1.0)
        effect, band = (length - turns) / (length - nearest) * (arm - at) / (arm - turns), 0.0
        if span is not None and section.kind in SPANNED:
            table, shorter = tube_table(SHORT), side / arm - side / length
            effect = table.moment(columns_of(table, place)) ** shorter * (arm - at) / (arm - nearest)
            band = table.band * abs(shorter)
        validity = replace(law.validity, uncertainty=(law.validity.uncertainty or 0.0) + band)
        return replace(law, share=tuple((np.array(law.share) * effect).tolist()), validity=validity)

    @property
    def title(self) -> str:
        """One line for people."""
        return f"tube beside a clamp, plastic moment {self.plastic_moment / 1e3:.4g} kN m"


def clamped_fold_distance(section: Section, material: Material, axis: Axis) -> float:
    """Distance of the fold of a tube from the clamp or joint beside which it lies [m].

    Raises
    ------
    InputError
        If the section is no tube of the library.

    References
    ----------
    docs/theory/tube_library.md.  Verified in tests/verification/characterisation/test_short_spans.py.
    """
    place = place_of_tube(section, material, axis)
    table = tube_table(PLACES[section.kind])
    return float(table.moment(columns_of(table, place))[0]) * half_fold_length(section, axis)
