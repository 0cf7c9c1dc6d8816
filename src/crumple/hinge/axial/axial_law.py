"""Interface of every law of axial crushing: peak force, mean force, stroke, rate, with a source and a range.

A column that crushes folds progressively: the force rises once to a peak and then swings about a mean.  The
mean times the effective stroke is the energy that the column absorbs.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum
from typing import Protocol, runtime_checkable

import numpy as np
from numpy.typing import ArrayLike

from crumple.errors import InputError, Problem
from crumple.hinge.law import Source
from crumple.material import CowperSymonds, Material
from crumple.numeric.arrays import Floats
from crumple.section import Section


@dataclass(frozen=True)
class CrushValidity:
    """Range of validity of an axial law.

    Attributes
    ----------
    basis
        Evidence for it, in one sentence.
    warnings
        One sentence for each condition that does not hold.
    uncertainty
        Relative half-width of the band of the mean force, or None if unknown.
    """

    basis: str
    warnings: tuple[str, ...] = ()
    uncertainty: float | None = None


@dataclass(frozen=True)
class CrushRate:
    """Factor 1 + (shape V/D)^(1/q) on the mean force at an impact speed V.

    Attributes
    ----------
    shape
        [1/m]: strain rate of the folds over the impact speed; includes the mean speed V/2.
    metal
        Cowper-Symonds pair of the material at large strain.
    """

    shape: float
    metal: CowperSymonds

    def factor(self, impact_speed: ArrayLike) -> Floats:
        """Dynamic over static mean force at an impact speed [m/s]."""
        return self.metal.factor(self.shape * np.asarray(impact_speed, np.float64))


@runtime_checkable
class AxialLaw(Protocol):
    """Crushing of one column; pure, frozen.

    Attributes
    ----------
    name, title
        Short key and one line for people.
    peak_force
        Squash or plate-buckling load [N], with the hardening up to the peak.
    peak_strain
        Plastic strain [-] of the whole column at the peak; 0 without hardening.
    mean_crushing_force
        Static mean force over the effective stroke [N].
    effective_stroke
        Shortening over length [-] at which the folds are closed.
    half_fold_length
        H [m], or None if the law does not give it.
    rate
        Rate law of the mean force, or None.
    """

    @property
    def name(self) -> str: ...
    @property
    def title(self) -> str: ...
    @property
    def source(self) -> Source: ...
    @property
    def validity(self) -> CrushValidity: ...
    @property
    def peak_force(self) -> float: ...
    @property
    def peak_strain(self) -> float: ...
    @property
    def mean_crushing_force(self) -> float: ...
    @property
    def effective_stroke(self) -> float: ...
    @property
    def half_fold_length(self) -> float | None: ...
    @property
    def rate(self) -> CrushRate | None: ...


def absorbed_by(law: AxialLaw, length: float) -> float:
    """Energy [J] of a column of a length [m] crushed quasi-statically to its effective stroke."""
    return law.mean_crushing_force * law.effective_stroke * length


def rate_factor_of(law: AxialLaw, impact_speed: ArrayLike) -> Floats:
    """Factor on the mean force at an impact speed [m/s]; ones without a rate law."""
    if law.rate is None:
        return np.ones_like(np.asarray(impact_speed, np.float64))
    return law.rate.factor(impact_speed)


LAWS_OF = {
    "rectangular_tube": "use the law superfolding",
    "circular_tube": "use the law circular",
    "closed_hat": "use the law top_hat",
}
"""What to do, by the kind of section, where another law does not take it."""


def wrong_section(what: str, section: Section, allowed: str) -> InputError:
    """Refusal of a section by a law, with the law that takes it if there is one."""
    none = "no law of axial crushing takes it: give peak, mean and stroke, or 'axial: true' to yield only"
    return InputError(Problem(what, section.title, allowed, LAWS_OF.get(section.kind, none), "section"))


class CrushDistance(Enum):
    """Shortening over which the mean force is averaged; the energy of a column is the same."""

    EFFECTIVE = "effective"
    """Until the folds are closed: the mean force of a test."""
    FULL = "full"
    """The whole length: the result of a folding calculation before its correction."""


def crush_rate(shape: float, material: Material) -> CrushRate | None:
    """Rate law of a mean force: strain rate over impact speed [1/m] and the flow pair of the material."""
    pair = material.flow_rate
    if pair is not None and not isinstance(pair, CowperSymonds):
        pair = pair.as_cowper_symonds()
    return None if pair is None else CrushRate(shape, pair)


def flat_wall_moment(flow_stress: float, thickness: float) -> float:
    """M_0 = s_0 h^2/4, plastic moment per width of a flat wall [N]."""
    return flow_stress * thickness**2 / 4.0


def curved_wall_moment(flow_stress: float, thickness: float) -> float:
    """M_0 = 2/sqrt(3) s_0 h^2/4, plastic moment per width of a wall in plane strain [N]."""
    return 2.0 / math.sqrt(3.0) * flow_stress * thickness**2 / 4.0
