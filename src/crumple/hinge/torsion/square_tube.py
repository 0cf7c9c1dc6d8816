"""Torsional collapse of a square tube, after Chen and Wierzbicki (2000) as quoted by others.

Unknown: the torque T of a tube of mid-line side b, wall t and twisted length L against its twist:

    T_i = min(3.72 s_y t^1.25 b^1.75, T_p)      walls begin to fold;  T_p = 2 b^2 t s_y/sqrt(3)  (Bredt)
    T_s = min(5.58 s_0 t^1.4 b^2.2 L^-0.6, T_i)  they continue to fold
    T   = T_s + (T_i - T_s) exp(-twist/decay)

3.72 s_y t^1.25 b^1.75 passes the plastic torque T_p wherever b/t < (3.72 sqrt(3)/2)^4 = 107.7, that is for
nearly every tube: the cap was added here.  The source has an exponential decay from T_i to T_s, whose
constant is not known, so ``decay`` must be given; without it the law is T_s from the start (conservative for
the load capacity of the member).  Limits: decay -> 0 is T_s, decay -> large is T_i.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from crumple.errors import InputError, Problem
from crumple.hinge.law import SofteningVariable, Source, Trust, Validity
from crumple.hinge.rate import HingeRate, rate_factor
from crumple.hinge.stop import Stop
from crumple.material import Material
from crumple.numeric.arrays import Floats
from crumple.registry.quantity import PositiveAngle
from crumple.section import RectangularTube, Section

SOURCE = Source(
    "Chen & Wierzbicki, Thin-Walled Struct. 36 (2000) 181-196, as quoted in a public paper on bus rollover",
    Trust.QUOTED,
    "both torques read in the quoting paper, the decay between them is not known; the cap is derived",
)
SAME_SIDE = 1e-3
"""Relative difference of the sides up to which a tube counts as square."""


@dataclass(frozen=True)
class SquareTubeTorsion:
    """Torsion law of a square tube; the same in both senses.

    Attributes
    ----------
    initial_torque, steady_torque
        T_i and T_s [N m].
    decay
        Twist [rad] in which the torque loses 63 % of its way to T_s; 0: T_s from the start.

    References
    ----------
    docs/theory/torsion.md.  Verified in tests/verification/hinge/test_torsion_collapse.py.
    """

    name: ClassVar[str] = "square_tube"
    symmetric: ClassVar[bool] = True

    initial_torque: float
    steady_torque: float
    decay: float
    validity: Validity
    rate: HingeRate | None = None
    softening_variable: SofteningVariable = SofteningVariable.PEAK
    source: Source = SOURCE
    elastic_stiffness: float | None = None
    jamming_angle: float | None = None
    stop: Stop | None = None

    @classmethod
    def of(
        cls, section: Section, material: Material, length: float, *, decay: PositiveAngle | None = None
    ) -> SquareTubeTorsion:
        """Law of a square tube.

        Parameters
        ----------
        section
            Square tube; its mid-line side and wall are used.
        material
            Yield stress for the initial torque, flow stress for the steady one.
        length
            Twisted length [m].
        decay
            Twist [rad] in which the torque loses 63 % of its way to the steady one, from a test or a shell
            model; without it that is held from the start.

        Raises
        ------
        InputError
            If the section is not a square tube, or a number is not positive.
        """
        if (
            not isinstance(section, RectangularTube)
            or abs(section.width - section.depth) > SAME_SIDE * section.width
        ):
            what, todo = "this law is for square tubes", "use the law plastic for other shapes"
            raise InputError(Problem(what, section.title, "equal sides", todo, "section"))
        for name, value in (("length", length), ("decay", 1.0 if decay is None else decay)):
            if not (math.isfinite(value) and value > 0.0):
                raise InputError(Problem(f"the {name} must be positive", f"{value:g}", "> 0", "", name))
        wall = section.thickness
        side = section.width - wall
        plastic = 2.0 * side**2 * wall * material.yield_stress / math.sqrt(3.0)
        initial = min(3.72 * material.yield_stress * wall**1.25 * side**1.75, plastic)
        steady = min(5.58 * material.flow_stress * wall**1.4 * side**2.2 * length**-0.6, initial)
        stiffness = material.shear_modulus * section.torsion_constant / length
        return cls(
            initial, steady, decay or 0.0, _validity(decay, initial, plastic), elastic_stiffness=stiffness
        )

    @property
    def title(self) -> str:
        """One line for people."""
        return "torsion of a square tube"

    def kinks(self, sense: int = 1) -> tuple[float, ...]:
        """No kinks."""
        return ()

    def moment_capacity(self, rotation: ArrayLike, sense: int = 1) -> Floats:
        """Torque [N m] at a twist [rad]; see `HingeLaw`."""
        twist = np.asarray(rotation, np.float64)
        if self.decay == 0.0:
            return np.full_like(twist, self.steady_torque)
        fall = (self.initial_torque - self.steady_torque) * np.exp(-twist / self.decay)
        return np.asarray(self.steady_torque + fall, np.float64)

    def rate_factor(self, rotation_rate: ArrayLike) -> Floats:
        """Ones: the strain rate of folds in torsion is not known."""
        return rate_factor(self.rate, rotation_rate)


def _validity(decay: float | None, initial: float, plastic: float) -> Validity:
    warnings = ["no strain-rate factor: the strain rate of folds in torsion is not known"]
    if initial >= plastic:
        warnings.append("the quoted initial torque exceeds the plastic torque, which is used instead")
    if decay is None:
        warnings.append("no decay given: the steady torque is used from the start, which is too low at first")
    else:
        warnings.append("the decay is given by the user")
    basis = "validated neither by tests nor by finite elements"
    return Validity(0.0, basis, tuple(warnings))
