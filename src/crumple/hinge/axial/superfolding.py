"""Axial crushing of a rectangular tube by superfolding elements, after Wierzbicki and Abramowicz (1983).

Unknown: mean force P, half fold length H and rolling radius r of four right-angled corners.  One fold works
in the toroidal corners (~ r), in straight hinge lines and in inclined ones (~ 1/r):

    P/M_0 = A1 r/h + A2 c/H + A3 H/r,      M_0 = s_0 h^2/4

The straight lines turn by pi/2, pi and pi/2 in a fold 2H over the whole perimeter 4c, so A2 = 4 pi, whatever
the shape: a rectangle has c = (a + b)/2.  P is minimal if the three terms are equal:

    P = 3 (A1 A2 A3 c/h)^(1/3) M_0 = 38.27 (c/h)^(1/3) M_0
    H = 0.983 h^(1/3) c^(2/3),  r = 0.720 h^(2/3) c^(1/3)

The fold closes before 2H is used up: over the effective distance of 0.73 the mean force is P/0.73 and the
energy the same.  Limits: as the square law; c is the outer side.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from crumple.hinge.axial.axial_law import (
    CrushDistance,
    CrushRate,
    CrushValidity,
    crush_rate,
    flat_wall_moment,
    wrong_section,
)
from crumple.hinge.axial.hardened_peak import FLAT
from crumple.hinge.axial.squash import HELD, squash_force
from crumple.hinge.law import Source, Trust
from crumple.hinge.options import choice
from crumple.hinge.rate import rate_warnings
from crumple.material import Material
from crumple.section import RectangularTube, Section

SOURCE = Source(
    "after Wierzbicki & Abramowicz, J. Appl. Mech. 50 (1983) 727",
    Trust.QUOTED,
    "coefficients quoted, original not seen; that its three constants agree with one minimum, and the mean "
    "side of a rectangle, are derived here",
)
COEFFICIENT, HALF_FOLD, ROLLING_RADIUS = 38.27, 0.983, 0.720
EFFECTIVE_STROKE = 0.73
"""[-]; the value quoted for symmetric folding of square tubes."""
LONGEST_RECTANGLE = 1.5
"""Ratio of the sides above which one fold length for all four walls is doubtful."""
RATE_SHAPE = 0.33


@dataclass(frozen=True)
class SuperfoldingCrushing:
    """Axial crushing of a square or rectangular tube.

    Attributes
    ----------
    rolling_radius
        r [m].
    crush_distance
        Over which shortening the mean force is taken.

    References
    ----------
    docs/theory/axial_crushing.md.  Verified in tests/verification/hinge/test_axial_crushing.py.
    """

    name: ClassVar[str] = "superfolding"

    peak_force: float
    mean_crushing_force: float
    effective_stroke: float
    half_fold_length: float
    rolling_radius: float
    validity: CrushValidity
    rate: CrushRate | None = None
    crush_distance: CrushDistance = CrushDistance.EFFECTIVE
    peak_strain: float = 0.0
    source: Source = SOURCE

    @classmethod
    def of(
        cls,
        section: Section,
        material: Material,
        *,
        crush_distance: CrushDistance | str = CrushDistance.EFFECTIVE,
    ) -> SuperfoldingCrushing:
        """Law of a rectangular tube.

        Parameters
        ----------
        section
            Rectangular tube; its outer sides and wall are used.
        material
            Flow stress for the mean force, yield stress and hardening for the peak, flow rate for the rate
            factor.
        crush_distance
            Option, by enum or by its text.

        Raises
        ------
        InputError
            If the section is not a rectangular tube or the option is unknown.
        """
        distance = choice("crush_distance", crush_distance, CrushDistance)
        if not isinstance(section, RectangularTube):
            raise wrong_section("this law is for rectangular tubes", section, "rectangular_tube")
        wall, side = section.thickness, (section.width + section.depth) / 2.0
        stroke = 1.0 if distance is CrushDistance.FULL else EFFECTIVE_STROKE
        third = (side / wall) ** (1.0 / 3.0)
        sides = (section.width - wall, section.depth - wall)
        strain = FLAT.strain(material, wall / (side - wall))
        return cls(
            squash_force([(each, wall, HELD) for each in (*sides, *sides)], material, strain),
            COEFFICIENT * third * flat_wall_moment(material.flow_stress, wall) / stroke,
            stroke,
            HALF_FOLD * wall * third**2,
            ROLLING_RADIUS * wall * third,
            _validity(section, material),
            crush_rate(RATE_SHAPE / side, material),
            distance,
            peak_strain=strain,
        )

    @property
    def title(self) -> str:
        """One line for people."""
        return f"superfolding elements, mean over the {self.crush_distance.value} crush distance"


def _validity(section: RectangularTube, material: Material) -> CrushValidity:
    warnings = list(rate_warnings(material))
    ratio = max(section.width, section.depth) / min(section.width, section.depth)
    if ratio > LONGEST_RECTANGLE:
        warnings.append(f"sides of ratio {ratio:.2f}: one fold length for all four walls is not validated")
    if section.corner_radius > 0.0:
        warnings.append("rounded corners are treated as sharp")
    return CrushValidity(
        "agrees with the law for square tubes within 1 %; peak and first fold compared with shells, not "
        "validated by tests",
        tuple(warnings),
    )
