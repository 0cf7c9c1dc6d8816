"""Law of a circular tube beside a clamp, from a second table of the shipped library.

    M(theta) = s_y Z m(theta; D/t, s_y/E, h)        as `crumple.hinge.tube_library.law`, other m

A clamp or a rigid joint keeps the section of the tube round, so that the fold beside it takes up to a quarter
more work than one between two pieces of the tube.  The points are cantilevers that were solved with shells;
M is the moment at the distance `fold_distance` from the clamp, and theta all plastic rotation of the
cantilever.  docs/theory/tube_library.md.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Self

from crumple.errors import InputError, Problem
from crumple.hinge.tube_library.law import TubeLibraryLaw
from crumple.hinge.tube_library.table import tube_table
from crumple.hinge.tube_library.tube import place_of_tube
from crumple.material import Material
from crumple.section import Axis, CircularTube, Section

TABLE = "clamped_circular_tube"
"""Name of the table."""


@dataclass(frozen=True)
class ClampedTubeLaw(TubeLibraryLaw):
    """Law of a circular tube beside a clamp or a rigid joint, interpolated in the library.

    References
    ----------
    docs/theory/tube_library.md.  Verified in tests/verification/hinge/test_clamped_tube.py.
    """

    name: ClassVar[str] = "clamped_tube"

    @classmethod
    def of(cls, section: Section, material: Material, axis: Axis = "y") -> Self:
        """Law of a circular tube beside a clamp.

        Parameters
        ----------
        section
            Circular tube.
        material
            Yield stress, Young's modulus, hardening curve (without one: flow stress) and flow rate.
        axis
            Any: the tube is alike about all axes.

        Raises
        ------
        InputError
            If the section is no circular tube, or outside the range of the library.
        """
        if not isinstance(section, CircularTube):
            what, todo = "this law is for circular tubes", "use auto for this section"
            raise InputError(Problem(what, section.kind, "circular_tube", todo, "section"))
        return cls.at(tube_table(TABLE), place_of_tube(section, material, axis), section, material, axis)

    @property
    def title(self) -> str:
        """One line for people."""
        return f"circular tube beside a clamp, plastic moment {self.plastic_moment / 1e3:.4g} kN m"
