"""Law of a tube beside a clamp, from further tables of the shipped library.

    M(theta) = s_y Z m(theta; x)        as `crumple.hinge.tube_library.law`, other m

A clamp or a rigid joint keeps the section in shape, so that the fold beside it takes up to a quarter more
work than one between two pieces of the tube.  The points are cantilevers that were solved with shells; M is
the moment at the distance `fold_distance` from the clamp, and theta all plastic rotation of the two half
folds beside it.  docs/theory/tube_library.md.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Self

from crumple.hinge.tube_library.law import TubeLibraryLaw
from crumple.hinge.tube_library.table import tube_table
from crumple.hinge.tube_library.tube import place_of_tube
from crumple.material import Material
from crumple.section import Axis, Section

TABLES = {"circular_tube": "clamped_circular_tube", "rectangular_tube": "clamped_rectangular_tube"}
"""Name of the table by kind of section."""


@dataclass(frozen=True)
class ClampedTubeLaw(TubeLibraryLaw):
    """Law of a rectangular or circular tube beside a clamp or a rigid joint, interpolated in the library.

    References
    ----------
    docs/theory/tube_library.md.  Verified in tests/verification/hinge/test_tube_library.py.
    """

    name: ClassVar[str] = "clamped_tube"

    @classmethod
    def of(cls, section: Section, material: Material, axis: Axis = "y") -> Self:
        """Law of a tube beside a clamp.

        Parameters
        ----------
        section
            Rectangular tube with sharp corners, or circular tube.
        material
            Yield stress, Young's modulus, hardening curve (without one: flow stress) and flow rate.
        axis
            Axis of bending.

        Raises
        ------
        InputError
            If the section is no such tube, or outside the range of the library.
        """
        place = place_of_tube(section, material, axis)
        return cls.at(tube_table(TABLES[section.kind]), place, section, material, axis)

    @property
    def title(self) -> str:
        """One line for people."""
        return f"tube beside a clamp, plastic moment {self.plastic_moment / 1e3:.4g} kN m"
