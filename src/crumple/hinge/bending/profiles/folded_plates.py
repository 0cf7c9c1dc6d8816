"""Law of sections of flat plates that no other formula describes: channels about y, hats about z, cells.

    M(theta) = min(M_y(0), M_f(theta))

with M_y and M_f the moment of folding plates (`folding_plates`) at the yield stress and at the flow stress.
Each sense has its own plates in compression.  Positive rotation about y compresses the lower side (-z), about
z the right side (+y).  The curve is straight between `POINTS` rotations, whose roots are evenly spaced, since
it starts as a root of the rotation.  Limits: those of the plates.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from crumple.errors import InputError, Problem
from crumple.hinge.bending.profiles.folding_plates import Constants, FoldingPlates
from crumple.hinge.law import SofteningVariable, Source, Trust, Validity
from crumple.hinge.rate import HingeRate, hinge_rate, rate_factor, rate_warnings
from crumple.hinge.stop import Stop
from crumple.material import Material
from crumple.numeric.arrays import Floats
from crumple.section import Axis, CircularTube, RectangularTube, Section
from crumple.section.wall_section import walls_of

SOURCE = Source(
    "compressed plates that fold as strips while the section stays plane",
    Trust.FITTED,
    "derived here; constants fitted to the work of shells, and checked against others",
)
LARGEST = math.radians(30.0)
"""Rotation up to which the law was compared with shells [rad]."""
ANY = Constants(25.2, 31.3, 74.1, 0.682, 0.682, 0.472, 0.315)
"""Constants of sections without their own."""
FAMILIES = {
    "channel": Constants(30.4, 24.0, 74.1, 0.716, 0.54, 0.457, 0.27),
    "closed_hat": Constants(25.2, 33.2, 58.0, 0.723, 0.274, 3.12, 0.216),
    "multi_cell_tube": Constants(25.2, 34.1, 157.0, 0.789, 0.682, 3.08, 0.379),
}
"""Constants of kinds of section that were fitted on their own."""
BANDS = {"channel": 0.1, "closed_hat": 0.15, "multi_cell_tube": 0.15}
"""Largest difference from shells in the work up to 5, 10 and 20 degrees, fitted or not, rounded up [-]."""
ANY_BAND = 0.25
PROFILES = {("channel", "z"), ("hat", "y"), ("closed_hat", "y")}
"""Kinds and axes that have `folded_profile`."""
POINTS = 160
"""Rotations up to half a turn at which the plates are solved."""
SAME = 1e-6
"""Relative difference of the moments of both senses below which they are one curve."""


@dataclass(frozen=True)
class FoldedPlatesLaw:
    """Plates that fold, for any section of flat plates about any axis.

    Attributes
    ----------
    rotation
        Of the points of the curve [rad].
    positive, negative
        Their moments [N m] in each sense.
    rate
        From the material's flow rate.
    validity
        Up to `LARGEST`.

    References
    ----------
    docs/theory/folded_plates.md.  Verified in tests/verification/profiles/test_folded_plates.py.
    """

    name: ClassVar[str] = "folded_plates"
    source: ClassVar[Source] = SOURCE
    softening_variable: ClassVar[SofteningVariable] = SofteningVariable.PEAK
    elastic_stiffness: ClassVar[float | None] = None
    stop: ClassVar[Stop | None] = None
    jamming_angle: ClassVar[float | None] = None
    straight: ClassVar[bool] = True

    rotation: tuple[float, ...]
    positive: tuple[float, ...]
    negative: tuple[float, ...]
    rate: HingeRate | None
    validity: Validity

    @classmethod
    def of(cls, section: Section, material: Material, axis: Axis = "y") -> FoldedPlatesLaw:
        """Law of a section.

        Parameters
        ----------
        section
            Of flat walls.
        material
            Of walls without their own: yield stress, flow stress, moduli and flow rate.
        axis
            Axis of bending.

        Raises
        ------
        InputError
            If the section has a formula of its own about this axis, curved walls, or one flat along the axis.
        """
        if isinstance(section, RectangularTube | CircularTube) or (section.kind, axis) in PROFILES:
            what, todo = "this section has a formula of its own", "use the law auto"
            raise InputError(Problem(what, f"{section.title} about {axis}", "others", todo, "section"))
        walled = walls_of(section)
        constants = FAMILIES.get(section.kind, ANY)
        angle = 0.0 if axis == "y" else math.pi / 2.0
        rotation = np.linspace(0.0, math.sqrt(math.pi), POINTS) ** 2
        moments = []
        for sense in (angle, angle + math.pi):
            flat, folded = (
                FoldingPlates.of(walled, material, sense, constants, flows=flows) for flows in (False, True)
            )
            if not folded.strips:
                raise _without_plates(section)
            moments.append(np.minimum(flat.moment(rotation[:1]), folded.moment(rotation)))
        if np.allclose(moments[0], moments[1], rtol=SAME, atol=0.0):
            moments[1] = moments[0]
        band = BANDS.get(section.kind, ANY_BAND)
        basis = f"works of shells up to 20 deg differ by at most {100 * band:.0f} %"
        validity = Validity(LARGEST, basis, rate_warnings(material), band)
        points, positive, negative = (tuple(each.tolist()) for each in (rotation, *moments))
        return cls(points, positive, negative, hinge_rate(material.flow_rate), validity)

    @property
    def title(self) -> str:
        """One line for people."""
        return f"folded plates: {min(self.positive[0], self.negative[0]) / 1e3:.4g} kN m at first"

    @property
    def symmetric(self) -> bool:
        """Whether both senses have one curve."""
        return self.positive == self.negative

    def kinks(self, sense: int = 1) -> tuple[float, ...]:
        """Rotations of the points [rad]."""
        return self.rotation

    def moment_capacity(self, rotation: ArrayLike, sense: int = 1) -> Floats:
        """Capacity [N m] at a rotation [rad]; see `HingeLaw`."""
        moments = self.positive if sense > 0 else self.negative
        return np.asarray(np.interp(np.asarray(rotation, np.float64), self.rotation, moments))

    def rate_factor(self, rotation_rate: ArrayLike) -> Floats:
        """Factor on the capacity at a rotation rate [rad/s]."""
        return rate_factor(self.rate, rotation_rate)


def _without_plates(section: Section) -> InputError:
    what, allowed = (
        "this law is for flat walls at different heights",
        "channels, hats, angles, cells and walls",
    )
    return InputError(Problem(what, section.title, allowed, "use the law auto", "section"))
