"""Law of a tube from the shipped library: M_p times a curve that is interpolated between solved tubes.

    M(theta) = s_y Z m(theta; a/t, b/t, s_y/E, h)        theta: plastic rotation of the fold, h: hardening

m is straight between the rotations of the table and held beyond its end.  The points were solved with shell
sub-models at rest; the strain rate acts as in the formulas.  Rectangular tubes thicker than the thickest of
the table, x_0, have its m times what the same step changes beside a clamp, m_c(x)/m_c(x_0), whose table has
thicker ones.  docs/theory/tube_library.md.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import ClassVar, Self

import numpy as np
from numpy.typing import ArrayLike

from crumple.hinge.law import SofteningVariable, Source, Trust, Validity
from crumple.hinge.rate import HingeRate, hinge_rate, rate_factor, rate_warnings
from crumple.hinge.stop import Stop
from crumple.hinge.tube_library.table import TubeTable, tube_table
from crumple.hinge.tube_library.tube import band_beyond, columns_of, place_of_tube
from crumple.material import Material
from crumple.numeric.arrays import Floats
from crumple.section import Axis, Section

SOURCE = Source(
    "library of shell sub-models, docs/theory/tube_library.md",
    Trust.COMPUTED,
    "interpolated between tubes solved with shells; the band is the largest energy error at tubes left out",
)
BESIDE = "clamped_rectangular_tube"
"""Table of folds of rectangular tubes beside a clamp, which has thicker tubes and the same rotations."""


@dataclass(frozen=True)
class TubeLibraryLaw:
    """Law of a rectangular or circular tube, interpolated in the library; the same in both senses.

    Attributes
    ----------
    plastic_moment
        s_y Z [N m].
    rotation, share
        Plastic rotations of the table [rad], and M/M_p there.
    validity, rate
        Range and band, and strain-rate law of the hinge.

    References
    ----------
    docs/theory/tube_library.md.  Verified in tests/verification/hinge/test_tube_library.py.
    """

    name: ClassVar[str] = "library"
    source: ClassVar[Source] = SOURCE
    softening_variable: ClassVar[SofteningVariable] = SofteningVariable.PEAK
    elastic_stiffness: ClassVar[float | None] = None
    jamming_angle: ClassVar[float | None] = None
    stop: ClassVar[Stop | None] = None
    symmetric: ClassVar[bool] = True

    plastic_moment: float
    rotation: tuple[float, ...]
    share: tuple[float, ...]
    validity: Validity
    rate: HingeRate | None

    @classmethod
    def of(cls, section: Section, material: Material, axis: Axis = "y") -> Self:
        """Law of a tube.

        Parameters
        ----------
        section
            Rectangular or circular tube.
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
        table = tube_table(section.kind)
        law = cls.at(table, place, section, material, axis)
        if "ratio" not in place or place["slenderness"] >= table.ranges["slenderness"][0]:
            return law
        return replace(law, share=tuple((np.array(law.share) * _thicker(table, place)).tolist()))

    @classmethod
    def at(
        cls, table: TubeTable, place: dict[str, float], section: Section, material: Material, axis: Axis
    ) -> Self:
        """Law of a tube at a place of a table; refuses like `of`."""
        share = table.moment(columns_of(table, place))
        end = float(table.rotation[-1])
        basis = f"interpolated between tubes solved with shells up to {math.degrees(end):.0f} deg"
        band = table.band + band_beyond(table, section, place)
        return cls(
            material.yield_stress * section.plastic_section_modulus(axis),
            tuple(table.rotation.tolist()),
            tuple(share.tolist()),
            Validity(end, basis, tuple(rate_warnings(material)), band),
            hinge_rate(material.flow_rate),
        )

    @property
    def title(self) -> str:
        """One line for people."""
        return f"library of tubes, plastic moment {self.plastic_moment / 1e3:.4g} kN m"

    @cached_property
    def _moment(self) -> Floats:
        return self.plastic_moment * np.array(self.share)

    def kinks(self, sense: int = 1) -> tuple[float, ...]:
        """Every rotation of the table [rad]."""
        return self.rotation[1:]

    def moment_capacity(self, rotation: ArrayLike, sense: int = 1) -> Floats:
        """Capacity [N m] at a rotation [rad]; see `HingeLaw`."""
        at = np.asarray(rotation, np.float64)
        return np.asarray(np.interp(at, self.rotation, self._moment), np.float64)

    def rate_factor(self, rotation_rate: ArrayLike) -> Floats:
        """Factor on the capacity at a rotation rate [rad/s]."""
        return rate_factor(self.rate, rotation_rate)


def _thicker(table: TubeTable, place: dict[str, float]) -> Floats:
    """M of a fold beside a clamp over that of the thickest tube of a table of free folds, (k,)."""
    beside = tube_table(BESIDE)
    thickest = {**place, "slenderness": table.ranges["slenderness"][0]}
    own, least = (beside.moment(columns_of(beside, one)) for one in (place, thickest))
    return np.asarray(own / least, np.float64)
