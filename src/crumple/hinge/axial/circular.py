"""Axial crushing of a circular tube: concertina folds after Alexander (1960), or diamonds.

Unknown: the static mean force P of a tube of mean radius R and wall h, with y = 2R/h and plane strain in the
wall, M_0 = 2/sqrt(3) s_0 h^2/4:

    concertina   P/M_0 = 20.79 y^(1/2) + 11.90           mean over the full length; about 6 s_0 h^1.5 (2R)^0.5
                 P/(0.86 - 0.568 y^(-1/2))               mean over the effective crush distance
    diamond      P/M_0 = 86.14 y^0.33                    over the effective distance; many lobes, thin walls

Half fold length of the concertina (derived here): a fold of two walls of length H turns by pi/2 at both ends
and by pi in the middle and stretches, in the mean over the full length 2H

    P/M_0 = 2 pi^2 R/H + 2 pi + 2 sqrt(3) pi H/h

with its minimum at H^2 = pi R h/sqrt(3), H = 0.952 (2R h)^(1/2), where the term with y^(1/2) is 20.73.

At an impact speed V the factor is 1 + (0.25 V/(D R delta))^(1/q) with delta the effective distance of the
concertina, and 1 + (0.37 V/(D R))^(1/q) for diamonds.  Limits: delta -> 0.86 in thin walls; it must stay
positive, so y > 0.44, which every tube has.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum
from typing import ClassVar

from crumple.errors import InputError, Problem
from crumple.hinge.axial.axial_law import (
    CrushDistance,
    CrushRate,
    CrushValidity,
    crush_rate,
    curved_wall_moment,
    wrong_section,
)
from crumple.hinge.axial.hardened_peak import ROUND, rise
from crumple.hinge.law import Source, Trust
from crumple.hinge.options import choice
from crumple.hinge.rate import rate_warnings
from crumple.material import Material
from crumple.section import CircularTube, Section

SOURCE = Source(
    "after Alexander (1960) and Abramowicz & Jones, Int. J. Impact Engng 2 (1984) 263-281",
    Trust.QUOTED,
    "coefficients quoted; of the second paper the notation was read, the rest not seen",
)


HALF_FOLD = math.sqrt(math.pi / (2.0 * math.sqrt(3.0)))
"""H/(h y^(1/2)) of the concertina [-]."""


THINNEST = 60.0
"""Diameter over wall of the thinnest column that was compared with shells."""


class Lobes(Enum):
    """Folding mode of a circular tube."""

    CONCERTINA = "concertina"
    DIAMOND = "diamond"


@dataclass(frozen=True)
class CircularCrushing:
    """Axial crushing of a circular tube.

    Attributes
    ----------
    mode
        Concertina or diamond.

    References
    ----------
    docs/theory/axial_crushing.md.  Verified in tests/verification/hinge/test_axial_crushing.py.
    """

    name: ClassVar[str] = "circular"

    mode: Lobes
    peak_force: float
    mean_crushing_force: float
    effective_stroke: float
    validity: CrushValidity
    rate: CrushRate | None = None
    half_fold_length: float | None = None
    peak_strain: float = 0.0
    source: Source = SOURCE

    @classmethod
    def of(
        cls,
        section: Section,
        material: Material,
        *,
        mode: Lobes | str = Lobes.CONCERTINA,
        crush_distance: CrushDistance | str = CrushDistance.EFFECTIVE,
    ) -> CircularCrushing:
        """Law of a circular tube.

        Parameters
        ----------
        section
            Circular tube; its mean radius and wall are used.
        material
            Flow stress for the mean force, yield stress and hardening for the peak, flow rate for the rate
            factor.
        mode, crush_distance
            Options, by enum or by text; the diamond mode has the effective distance only.

        Raises
        ------
        InputError
            If the section is not a circular tube, or an option is unknown.
        """
        lobes = choice("mode", mode, Lobes)
        distance = choice("crush_distance", crush_distance, CrushDistance)
        if not isinstance(section, CircularTube):
            raise wrong_section("this law is for circular tubes", section, "circular_tube")
        if lobes is Lobes.DIAMOND and distance is CrushDistance.FULL:
            what, todo = "the diamond mode has no mean over the full length", "omit crush_distance"
            raise InputError(Problem(what, "full", "effective", todo, "crush_distance"))
        wall = section.thickness
        radius = (section.diameter - wall) / 2.0
        ratio = 2.0 * radius / wall
        stroke = effective_distance(ratio) if distance is CrushDistance.EFFECTIVE else 1.0
        moment = curved_wall_moment(material.flow_stress, wall)
        strain = ROUND.strain(material, 1.0 / ratio)
        if lobes is Lobes.CONCERTINA:
            mean, shape = concertina_force(ratio) / stroke, 0.25 / (radius * effective_distance(ratio))
        else:
            mean, shape = 86.14 * ratio**0.33, 0.37 / radius
        return cls(
            lobes,
            material.yield_stress * section.area * rise(material, strain),
            mean * moment,
            stroke,
            _validity(lobes, material, ratio),
            crush_rate(shape, material),
            HALF_FOLD * wall * math.sqrt(ratio) if lobes is Lobes.CONCERTINA else None,
            peak_strain=strain,
        )

    @property
    def title(self) -> str:
        """One line for people."""
        return f"circular tube, {self.mode.value} folding"


def concertina_force(ratio: float) -> float:
    """P/M_0 [-] over the full length at y = 2R/h."""
    return 20.79 * math.sqrt(ratio) + 11.90


def effective_distance(ratio: float) -> float:
    """Effective crush distance over length [-] at y = 2R/h."""
    return 0.86 - 0.568 / math.sqrt(ratio)


def _validity(mode: Lobes, material: Material, ratio: float) -> CrushValidity:
    warnings = list(rate_warnings(material))
    if mode is Lobes.DIAMOND:
        warnings.append("the stroke of the diamond mode is not known: that of the concertina mode is used")
    if ratio > THINNEST:
        warnings.append(
            f"diameter over wall of {ratio:.0f}, above {THINNEST:g}: the peak has no shell buckling and is "
            "too high"
        )
    return CrushValidity("peak and first fold compared with shells, not validated by tests", tuple(warnings))
