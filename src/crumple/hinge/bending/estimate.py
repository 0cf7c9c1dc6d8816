"""Estimate for sections without a law of their own: the plastic moment with the softening of a tube.

    M(theta) = M_p m(theta),    m(theta) = M_K(theta) / M_K(0)

with M_p the plastic moment of the section, and M_K the Kecman-type law of the rectangular tube that has the
outer width, the outer depth and the thickness of the section.  The scaling is ours; no source supports it.
Walls that buckle before they yield, and folds of open profiles, may carry far less.  If no such tube exists,
the plastic moment is held.

`AutoLaw` is the law of a section: the formula of its shape, else this estimate.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from crumple.errors import InputError
from crumple.hinge.bending.kecman import KecmanLaw
from crumple.hinge.law import HingeLaw, SofteningVariable, Source, Trust, Validity
from crumple.hinge.rate import HingeRate, hinge_rate, rate_factor
from crumple.hinge.registry import (
    DEEP,
    DEFAULT_BENDING,
    FLAT_WALLS,
    FOLD_BENDING,
    HARDENING_BENDING,
    HARDENING_SECTION,
    Fold,
    build_law,
)
from crumple.hinge.stop import Stop
from crumple.hinge.tube_library.hardening import hardens
from crumple.material import Material
from crumple.numeric.arrays import Floats
from crumple.section import Axis, RectangularTube, Section

SOURCE = Source(
    "plastic moment of the section, softening of a rectangular tube of the same outer size",
    Trust.ESTIMATED,
    "not checked for this section; a law from shells (crumple characterise) replaces it",
)


@dataclass(frozen=True)
class EstimatedLaw:
    """Plastic moment of any section with the softening of the rectangular tube around it: an estimate.

    Attributes
    ----------
    plastic
        Plastic moment [N m].
    tube
        Law whose softening is used; None: the plastic moment is held.
    rate
        From the material's flow rate.
    validity
        No range: nothing supports the estimate.

    References
    ----------
    Verified in tests/unit/hinge/bending/test_estimate.py.
    """

    name: ClassVar[str] = "estimate"
    source: ClassVar[Source] = SOURCE
    softening_variable: ClassVar[SofteningVariable] = SofteningVariable.PEAK
    elastic_stiffness: ClassVar[float | None] = None
    stop: ClassVar[Stop | None] = None
    symmetric: ClassVar[bool] = True

    plastic: float
    tube: KecmanLaw | None
    rate: HingeRate | None
    validity: Validity

    @classmethod
    def of(cls, section: Section, material: Material, axis: Axis = "y") -> EstimatedLaw:
        """Estimate for a section.

        Parameters
        ----------
        section
            Any.
        material
            Yield stress and flow stress.
        axis
            Axis of bending.
        """
        plastic = material.yield_stress * section.plastic_section_modulus(axis)
        tube = _tube_around(section, material, axis)
        if tube is None:
            basis = "no rectangular tube lies around the section: no softening"
        else:
            basis = "the softening is that of the rectangular tube around the section"
        rate = hinge_rate(material.flow_rate)
        return cls(plastic, tube, rate, Validity(0.0, f"an estimate; {basis}"))

    @property
    def title(self) -> str:
        """One line for people."""
        softening = "softening of a rectangular tube" if self.tube is not None else "without softening"
        return f"estimate: plastic moment {self.plastic / 1e3:.4g} kN m, {softening}"

    @property
    def jamming_angle(self) -> float | None:
        """Jamming angle of the tube around [rad]."""
        return None if self.tube is None else self.tube.jamming_angle

    def kinks(self, sense: int = 1) -> tuple[float, ...]:
        """Rotations where the slope jumps [rad]."""
        return () if self.tube is None else self.tube.kinks(sense)

    def moment_capacity(self, rotation: ArrayLike, sense: int = 1) -> Floats:
        """Capacity [N m] at a rotation [rad]; see `HingeLaw`."""
        if self.tube is None:
            return np.full(np.shape(rotation), self.plastic)
        peak = float(self.tube.moment_capacity(0.0, sense))
        return np.asarray(self.plastic / peak * self.tube.moment_capacity(rotation, sense), np.float64)

    def rate_factor(self, rotation_rate: ArrayLike) -> Floats:
        """Factor on the capacity at a rotation rate [rad/s]."""
        return rate_factor(self.rate, rotation_rate)


class AutoLaw:
    """Law of the section's shape where there is one, else the estimate; stored laws go before both."""

    @classmethod
    def of(cls, section: Section, material: Material, axis: Axis = "y") -> HingeLaw:
        """Law of a section.

        Parameters
        ----------
        section, material, axis
            Of the hinge.
        """
        return build_law(automatic_type(section, material, axis), section, material, axis)


def automatic_type(
    section: Section,
    material: Material,
    axis: Axis,
    fold: Fold | None = None,
    *,
    build: Callable[[str, Section, Material, Axis], HingeLaw] = build_law,
) -> str:
    """Type of the law that a hinge without a law and without a stored one has.

    Parameters
    ----------
    section, material, axis
        Of the hinge.
    fold
        Whether a joint or clamp beside it keeps the section in shape; None: not known.
    build
        Builds a law by its name.
    """
    own = _laws_of_fold(section, material, axis, fold)
    # beyond the library a flow stress counts as it does within it
    harder = HARDENING_BENDING if hardens(material) or section.kind in own else {}
    if hardens(material) and section.kind not in HARDENING_BENDING:
        return HARDENING_SECTION
    names = [laws[section.kind] for laws in (own, harder, DEFAULT_BENDING) if section.kind in laws]
    if section.kind not in HARDENING_BENDING:
        names.append(FLAT_WALLS)
    for name in names:
        try:
            build(name, section, material, axis)
        except InputError:
            # the shape has this law, but not about this axis, with these proportions or this metal
            continue
        return name
    return EstimatedLaw.name


def _laws_of_fold(section: Section, material: Material, axis: Axis, fold: Fold | None) -> Mapping[str, str]:
    """Laws that go before the formula in a fold, by the kind of section."""
    if fold is None or (fold == "clamped" and not hardens(material) and _is_wide(section, axis)):
        return {}
    return FOLD_BENDING[fold]


def _is_wide(section: Section, axis: Axis) -> bool:
    flange, depth = section.flange_width(axis), section.bending_depth(axis)
    return isinstance(section, RectangularTube) and flange > DEEP * depth


def _tube_around(section: Section, material: Material, axis: Axis) -> KecmanLaw | None:
    """Law of the rectangular tube of the same outer size and thickness; None where there is no such tube."""
    width, depth = section.flange_width(axis), section.bending_depth(axis)
    try:
        return KecmanLaw.of(RectangularTube(width, depth, section.thickness), material, "y")
    except InputError:
        return None
