"""Axial crushing of a square tube, after Abramowicz and Jones (1984, 1986).

Unknown: the static mean force P of a tube of side c and wall h, over M_0 = s_0 h^2/4 and with x = c/h:

    symmetric      P/M_0 = 52.22 x^(1/3)                              = 38.12/0.73 x^(1/3)
    asymmetric_a   P/M_0 = 42.92 x^(1/3) + 3.17 x^(2/3) + 2.04
    asymmetric_b   P/M_0 = 45.90 x^(1/3) + 1.75 x^(2/3) + 1.02
    extensional    P/M_0 = 32.64 x^(1/2) + 8.16                       thick tubes, x below about 7.5
    lowest         the minimum of the four: each is an upper bound of its own mechanism

c is the outer side.  The effective crush distance is 0.73 of the length (0.77 in the extensional mode).  At
an impact speed V the factor is 1 + (0.33 V/(c D))^(1/q).  Half a fold of the inextensional modes is that of
the superfolding law, H = 0.983 h^(1/3) c^(2/3), whose mean force is the same within 1 %.  Limits: x -> large:
symmetric ~ s_0 c^(1/3) h^(5/3).
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import ClassVar

from crumple.hinge.axial.axial_law import (
    CrushRate,
    CrushValidity,
    crush_rate,
    flat_wall_moment,
    wrong_section,
)
from crumple.hinge.axial.hardened_peak import FLAT
from crumple.hinge.axial.squash import HELD, squash_force
from crumple.hinge.axial.superfolding import HALF_FOLD
from crumple.hinge.law import Source, Trust
from crumple.hinge.options import choice
from crumple.hinge.rate import rate_warnings
from crumple.material import Material
from crumple.section import RectangularTube, Section

SOURCE = Source(
    "after Abramowicz & Jones, Int. J. Impact Engng 2 (1984) 179-208 and 4 (1986) 243-270",
    Trust.QUOTED,
    "abstracts read; the coefficients are quoted, the originals were not seen",
)
SAME_SIDE = 1e-3
"""Relative difference of the sides up to which a tube counts as square."""
EXTENSIONAL_BELOW = 7.5
"""c/h below which the extensional mode governs, as quoted."""
TESTED = (30.25, 32.18)
"""c/h of the 84 dynamic tests on square steel tubes with which the authors compared the formulas."""
RATE_SHAPE = 0.33


class Mode(Enum):
    """Folding mode."""

    SYMMETRIC = "symmetric"
    ASYMMETRIC_A = "asymmetric_a"
    ASYMMETRIC_B = "asymmetric_b"
    EXTENSIONAL = "extensional"
    LOWEST = "lowest"


@dataclass(frozen=True)
class SquareCrushing:
    """Axial crushing of a square tube.

    Attributes
    ----------
    mode
        The mode of the mean force; never `Mode.LOWEST`: that is resolved.

    References
    ----------
    docs/theory/axial_crushing.md.  Verified in tests/verification/hinge/test_axial_crushing.py.
    """

    name: ClassVar[str] = "square"

    mode: Mode
    peak_force: float
    mean_crushing_force: float
    effective_stroke: float
    validity: CrushValidity
    rate: CrushRate | None = None
    half_fold_length: float | None = None
    peak_strain: float = 0.0
    source: Source = SOURCE

    @classmethod
    def of(cls, section: Section, material: Material, *, mode: Mode | str = Mode.SYMMETRIC) -> SquareCrushing:
        """Law of a square tube.

        Parameters
        ----------
        section
            Square tube; its outer side and wall are used.
        material
            Flow stress for the mean force, yield stress and hardening for the peak, flow rate for the rate
            factor.
        mode
            Folding mode, by enum or by its text.

        Raises
        ------
        InputError
            If the section is not a square tube or the mode is unknown.
        """
        wanted = choice("mode", mode, Mode)
        if (
            not isinstance(section, RectangularTube)
            or abs(section.width - section.depth) > SAME_SIDE * section.width
        ):
            raise wrong_section("this law is for square tubes", section, "rectangular_tube with equal sides")
        side, wall = section.width, section.thickness
        forces = mode_forces(side / wall)
        chosen = min(forces, key=lambda each: forces[each]) if wanted is Mode.LOWEST else wanted
        walls, strain = [(side - wall, wall, HELD)] * 4, FLAT.strain(material, wall / (side - wall))
        return cls(
            chosen,
            squash_force(walls, material, strain),
            forces[chosen] * flat_wall_moment(material.flow_stress, wall),
            0.77 if chosen is Mode.EXTENSIONAL else 0.73,
            _validity(side / wall, chosen, material),
            crush_rate(RATE_SHAPE / side, material),
            None if chosen is Mode.EXTENSIONAL else HALF_FOLD * wall * (side / wall) ** (2.0 / 3.0),
            peak_strain=strain,
        )

    @property
    def title(self) -> str:
        """One line for people."""
        return f"square tube, {self.mode.value.replace('_', ' ')} folding"


def mode_forces(slenderness: float) -> dict[Mode, float]:
    """P/M_0 [-] of each mode at c/h."""
    third = slenderness ** (1.0 / 3.0)
    return {
        Mode.SYMMETRIC: 52.22 * third,
        Mode.ASYMMETRIC_A: 42.92 * third + 3.17 * third**2 + 2.04,
        Mode.ASYMMETRIC_B: 45.90 * third + 1.75 * third**2 + 1.02,
        Mode.EXTENSIONAL: 32.64 * slenderness**0.5 + 8.16,
    }


def _validity(slenderness: float, mode: Mode, material: Material) -> CrushValidity:
    warnings = list(rate_warnings(material))
    if mode is not Mode.EXTENSIONAL and slenderness < EXTENSIONAL_BELOW:
        warnings.append(f"c/h = {slenderness:.1f}: a tube this thick folds in the extensional mode")
    if mode is Mode.EXTENSIONAL and slenderness > EXTENSIONAL_BELOW:
        warnings.append(f"c/h = {slenderness:.1f}: the extensional mode applies to tubes below c/h = 7.5")
    if mode in {Mode.ASYMMETRIC_A, Mode.ASYMMETRIC_B}:
        warnings.append("asymmetric folds tilt the column and can start overall bending")
    basis = (
        f"its authors compared it with 84 dynamic tests of steel tubes with c/h from {TESTED[0]:g} to "
        f"{TESTED[1]:g}; not validated by own tests"
    )
    return CrushValidity(basis, tuple(warnings))
