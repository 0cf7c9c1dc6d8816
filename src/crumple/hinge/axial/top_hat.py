"""Axial crushing of spot-welded hats, after White, Jones and Abramowicz (1999).

Unknown: the static mean force P of a hat closed by a plate (top hat) or of two hats on each other (double
hat), with L the length of mid-line of the whole section:

    top hat      P/M_0 = 32.89 (L/h)^(1/3)
    double hat   P/M_0 = 52.20 (L/h)^(1/3)            M_0 = s_0 h^2/4

Both follow from the square tube, 52.22 (c/h)^(1/3): a top hat has four folding corners and c = L/4:
52.22/4^(1/3) = 32.90; a double hat is two of them with L/2 each, 2 x 32.90/2^(1/3) = 52.22.  So the effective
crush distance of 0.73 is in the coefficients, and the rate factor is that of a square tube of side L/4 (L/8
for the double hat): an assumption on the same basis.  The peak is the squash load of all walls, not reduced
for buckling between the spot welds.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from crumple.hinge.axial.axial_law import (
    CrushRate,
    CrushValidity,
    crush_rate,
    flat_wall_moment,
    wrong_section,
)
from crumple.hinge.axial.hardened_peak import FLAT, rise
from crumple.hinge.law import Source, Trust
from crumple.hinge.rate import rate_warnings
from crumple.material import Material
from crumple.section import ClosedHat, Section

SOURCE = Source(
    "after White, Jones & Abramowicz, Int. J. Mech. Sci. 41 (1999) 179",
    Trust.QUOTED,
    "coefficients quoted, original not seen; that both follow from the square tube's is derived here",
)
TOP_HAT, DOUBLE_HAT = 32.89, 52.20
EFFECTIVE_STROKE = 0.73
RATE_SHAPE = 0.33


@dataclass(frozen=True)
class HatCrushing:
    """Axial crushing of a closed hat.

    Attributes
    ----------
    double
        Whether the section consists of two hats.

    References
    ----------
    docs/theory/axial_crushing.md.  Verified in tests/verification/hinge/test_axial_crushing.py.
    """

    name: ClassVar[str] = "top_hat"

    double: bool
    peak_force: float
    mean_crushing_force: float
    validity: CrushValidity
    rate: CrushRate | None = None
    effective_stroke: float = EFFECTIVE_STROKE
    half_fold_length: float | None = None
    peak_strain: float = 0.0
    source: Source = SOURCE

    @classmethod
    def of(cls, section: Section, material: Material, *, double: bool = False) -> HatCrushing:
        """Law of a closed hat.

        Parameters
        ----------
        section
            Closed hat; its area and wall are used, L = area/thickness.
        material
            Flow stress for the mean force, yield stress and hardening for the peak, flow rate for the rate
            factor.
        double
            Whether the section is two hats welded together instead of a hat on a plate.

        Raises
        ------
        InputError
            If the section is not a closed hat.
        """
        if not isinstance(section, ClosedHat):
            raise wrong_section("this law is for closed hats", section, "closed_hat")
        # the widest wall is about as wide as the whole hat
        strain = FLAT.strain(material, section.thickness / section.width)
        return cls.from_perimeter(
            section.area / section.thickness, section.thickness, material, double, strain
        )

    @classmethod
    def from_perimeter(
        cls,
        perimeter: float,
        thickness: float,
        material: Material,
        double: bool = False,
        strain: float = 0.0,
    ) -> HatCrushing:
        """Law from the length of mid-line L [m], the wall [m], and the plastic strain at the peak."""
        moment = flat_wall_moment(material.flow_stress, thickness)
        mean = (DOUBLE_HAT if double else TOP_HAT) * (perimeter / thickness) ** (1.0 / 3.0) * moment
        warnings = (
            "the spot welds do not fail in this law: if they do, the mean force is lower",
            "the peak force is the squash load, without buckling between the welds",
            *rate_warnings(material),
        )
        shape = RATE_SHAPE / (perimeter / (8.0 if double else 4.0))
        return cls(
            double,
            material.yield_stress * perimeter * thickness * rise(material, strain),
            mean,
            CrushValidity("no test was compared here", warnings),
            crush_rate(shape, material),
            peak_strain=strain,
        )

    @property
    def title(self) -> str:
        """One line for people."""
        return "double hat" if self.double else "hat closed by a plate"
