"""Closed hat whose plate is compressed: plate and flanges fold as strips, the webs bend in their plane.

Unknown: M(theta).  In shells plate and flanges wrinkle over a short length while the webs stay nearly flat:
the flanges outside of the webs do not let the webs bulge, as the mechanism of a tube needs.  So the section
stays plane.  A compressed strip of width b and thickness t carries the share n of its yield force,

    n = sqrt(1 + k^2) - k,    k = k_0 + (theta d b/(S t^2))^p,    k_0 = (1 - n(0)^2)/(2 n(0)),

with the depth d and what buckling leaves, n(0), of a plate that is held at both edges (1 of flanges and
webs).  n is that of a strip with three hinge lines, whose k is proportional to its bow over its thickness.
In the webs, b = d, the distance below the neutral axis stands for d.  Stretched metal yields.  The height y
of the neutral axis over the flanges follows from no axial force, M is the moment of the stresses.  p, S of
the sheets and S of the webs are fitted to eight hats solved by shells; docs/theory/folded_profile.md.

Limits: theta -> 0 is the plastic moment of the section without the part of the plate that has buckled; all
sheets folded leave webs and crown.  If the sheets are stronger than all the rest, y is 0; if the crown
cannot be balanced any more, it carries what the others leave to it.  The force of the webs below y grows
with y for any n, so that y is unique and M is continuous.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from crumple.material import Material
from crumple.numeric.arrays import Floats
from crumple.numeric.sign_change import sign_change
from crumple.section.capacity.buckling import plate_stress, width_factor
from crumple.section.shapes.closed_hat import ClosedHat

POWER, SHEETS, WEBS = 8.0 / 3.0, 68.0, 920.0
"""p, S of plate and flanges, and S of the webs [-]."""
EARLY = 0.01
"""Share of the jamming angle before which no kink is looked for: thin sheets fold steeply there anyway."""
_HALVINGS = 50
_POINTS, _WEIGHTS = np.polynomial.legendre.leggauss(12)
_PLACES, _PARTS = 0.5 * (1.0 + _POINTS), 0.5 * _WEIGHTS
_ENERGY_POINTS, _ENERGY_WEIGHTS = np.polynomial.legendre.leggauss(40)


class Sheet(NamedTuple):
    """Compressed sheet: yield force [N], height over the hat's flanges [m], d b/t^2 and k_0 [-]."""

    force: float
    height: float
    slender: float
    bowed: float


@dataclass(frozen=True)
class CompressedPlate:
    """Closed hat that bends about y with its plate in compression.

    Attributes
    ----------
    sheets
        Flanges of hat and plate, and the plate between the webs.
    crown, depth
        Yield force of the crown [N], and its height over the flanges [m], between mid-lines.
    web, web_slender
        Yield force of both webs per height [N/m], and d/t^2 of a web [1/m].
    jamming_angle
        Rotation up to which it is used [rad].

    References
    ----------
    Derived here, constants fitted to shells.  docs/theory/folded_profile.md.
    Verified in tests/verification/profiles/test_folded_profiles.py.
    """

    sheets: tuple[Sheet, ...]
    crown: float
    depth: float
    web: float
    web_slender: float
    jamming_angle: float

    @classmethod
    def of(
        cls, section: ClosedHat, material: Material, jamming_angle: float, *, flows: bool
    ) -> CompressedPlate:
        """Mechanism of a hat.

        Parameters
        ----------
        section, material
            Hat, and the metal of its walls without one of their own.
        jamming_angle
            Rotation up to which it is used [rad].
        flows
            Whether the metal is at its flow stress, as in folds; otherwise at yield.
        """
        hat, plate = section.hat_material or material, section.plate_material or material
        wall, under = section.thickness, section.plate_thickness or section.thickness
        own, other = (one.flow_stress if flows else one.yield_stress for one in (hat, plate))
        below, flange, depth = -(wall + under) / 2.0, section.flange, section.depth
        buckling = plate_stress(4.0, section.width, under, plate) / plate.yield_stress
        left = width_factor(buckling)
        bowed = (1.0 - left**2) / (2.0 * left)
        sheets = (
            Sheet(2.0 * flange * wall * own, 0.0, depth * flange / wall**2, 0.0),
            Sheet(2.0 * flange * under * other, below, depth * flange / under**2, 0.0),
            Sheet(section.width * under * other, below, depth * section.width / under**2, bowed),
        )
        crown, web = section.width * wall * own, 2.0 * wall * own
        return cls(sheets, crown, depth - wall, web, depth / wall**2, jamming_angle)

    def energy(self, rotation: ArrayLike) -> NDArray[Any]:
        """Plastic work from flat walls [J]."""
        rotation = np.asarray(rotation, np.float64)
        at = rotation[..., None] * 0.5 * (1.0 + _ENERGY_POINTS)
        return np.asarray(0.5 * rotation * (self.moment(at) @ _ENERGY_WEIGHTS))

    def moment(self, rotation: ArrayLike) -> Floats:
        """Moment [N m]."""
        rotation = np.asarray(rotation, np.float64)
        sheets, lever = self._sheets(rotation)
        height = self._neutral(rotation, sheets)
        webs, webs_lever = self._webs_below(rotation, height)
        above = self.web * (self.depth - height)
        pressed, stretched = sheets + webs, above + self.crown
        # no axial force, where the neutral axis cannot give it: too strong sheets, or too weak ones
        total = np.minimum(pressed, stretched)
        upper = 0.5 * above * (self.depth + height) + self.crown * self.depth
        return np.asarray(total * (upper / stretched - (lever + webs_lever) / pressed))

    @cached_property
    def kinks(self) -> tuple[float, ...]:
        """Rotations at which the neutral axis leaves the flanges, and at which it reaches the crown [rad]."""

        def left(rotation: Floats) -> Floats:
            return self.crown + self.web * self.depth - self._sheets(rotation)[0]

        def reached(rotation: Floats) -> Floats:
            webs = self._webs_below(rotation, np.full_like(rotation, self.depth))[0]
            return self.crown - self._sheets(rotation)[0] - webs

        low = EARLY * self.jamming_angle
        found = (sign_change(each, low, self.jamming_angle) for each in (left, reached))
        # what holds there already has its place at the low end
        return tuple(at for at in found if at is not None and at > low)

    @cached_property
    def peak(self) -> float:
        """Largest moment, that of flat walls [N m]."""
        return float(self.moment(0.0))

    def _sheets(self, rotation: Floats) -> tuple[Floats, Floats]:
        """Force that the compressed sheets carry [N], and its moment about the flanges [N m]."""
        total, lever = np.zeros_like(rotation), np.zeros_like(rotation)
        for sheet in self.sheets:
            force = sheet.force * _left(sheet.bowed + (rotation * sheet.slender / SHEETS) ** POWER)
            total, lever = total + force, lever + force * sheet.height
        return total, lever

    def _neutral(self, rotation: Floats, sheets: Floats) -> Floats:
        """Height of no stress over the flanges [m], at which no axial force is left."""
        low, high = np.zeros_like(rotation), np.full_like(rotation, self.depth)
        for _ in range(_HALVINGS):
            middle = 0.5 * (low + high)
            pressed = sheets + self._webs_below(rotation, middle)[0]
            stretched = self.crown + self.web * (self.depth - middle) > pressed
            low, high = np.where(stretched, middle, low), np.where(stretched, high, middle)
        return np.asarray(0.5 * (low + high))

    def _webs_below(self, rotation: Floats, height: Floats) -> tuple[Floats, Floats]:
        """Force in the compressed part of the webs [N], and its moment about the flanges [N m]."""
        depths = height[..., None] * _PLACES
        left = _left((rotation[..., None] * depths * self.web_slender / WEBS) ** POWER) * _PARTS
        force = self.web * height * left.sum(axis=-1)
        return force, force * height - self.web * height * (left * depths).sum(axis=-1)


def _left(bow: Floats) -> Floats:
    """Share of its yield force that a strip carries whose k is given."""
    return np.asarray(1.0 / (np.sqrt(1.0 + bow**2) + bow))
