"""Effect of hardening on the moment of a tube's fold, from the library of solved tubes.

    c(theta) = m(theta; x, h) / m(theta; x, 1)

with the share m of the plastic moment that the library gives to the tube x of its range that is nearest in
each coordinate, and the hardening h.  Limits: h -> 1 gives 1; theta -> 0 gives nearly 1, since walls that
have just yielded have not hardened.  docs/theory/tube_library.md.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from crumple.hinge.tube_library.table import TubeTable, tube_table
from crumple.hinge.tube_library.tube import coordinate, hardening_ratio, place_of_tube
from crumple.material import Material
from crumple.numeric.arrays import Floats
from crumple.section import Axis, CircularTube, RectangularTube, Section


@dataclass(frozen=True)
class HardeningEffect:
    """Factor on the moment of a fold whose metal would otherwise stay at its yield stress.

    Attributes
    ----------
    rotation
        Plastic rotations of the fold [rad], increasing from 0.
    factor
        Factors there [-], straight in between and held beyond the last.
    """

    rotation: tuple[float, ...] = (0.0,)
    factor: tuple[float, ...] = (1.0,)

    @classmethod
    def of(cls, section: Section, material: Material, axis: Axis = "y") -> HardeningEffect:
        """Effect in a tube bent about an axis; none without a hardening curve that rises, or without a tube.

        Rounded corners are taken to be sharp.
        """
        if not isinstance(section, RectangularTube | CircularTube) or not hardens(material):
            return cls()
        table = tube_table(section.kind)
        sharp = replace(section, corner_radius=0.0) if isinstance(section, RectangularTube) else section
        place = _within(table, place_of_tube(sharp, material, axis))
        hard, plain = (_moment(table, {**place, "hardening": h}) for h in (place["hardening"], 1.0))
        return cls(tuple(table.rotation.tolist()), tuple((hard / plain).tolist()))

    def at(self, rotation: ArrayLike) -> Floats:
        """Factor at plastic rotations [rad], same shape."""
        return np.asarray(np.interp(np.asarray(rotation, np.float64), self.rotation, self.factor), np.float64)


def hardens(material: Material) -> bool:
    """Whether a metal has a hardening curve that rises."""
    return material.hardening is not None and hardening_ratio(material) > 1.0


def at_yield(material: Material) -> Material:
    """The metal without its hardening curve, at its yield stress; one that has no curve stays as it is."""
    return (
        material if material.hardening is None else replace(material, hardening=None, given_flow_stress=None)
    )


def _within(table: TubeTable, place: dict[str, float]) -> dict[str, float]:
    return {key: min(max(value, table.ranges[key][0]), table.ranges[key][1]) for key, value in place.items()}


def _moment(table: TubeTable, place: dict[str, float]) -> Floats:
    return table.moment(tuple(coordinate(one, place) for one in table.coordinates))
