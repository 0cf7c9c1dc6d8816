"""Yield set of a mitred corner of two tubes that folds about its bisector: its shift, and what it loses.

Shells that turn a corner about a moment between its bisector and the normal of its plane carry more if it
opens and less if it closes, and close a corner that is turned about its bisector alone. With the moments M_n
about the normal, positive if it closes, M_u along the bisector and M_t along the tangent, the set

    ((M_n + c)/A)^2 + (M_u/B)^2 + (M_t/T)^2 <= 1,    c = share A

has its centre at a share of its half axis in closing. The share grows with the rotation theta about the
bisector, and vanishes for members in line, where both senses are alike:

    share = g sin(alpha) (1 - exp(-theta/theta_1)),    theta_1 = r t/a,    a = sqrt(b h)

and for round tubes a = pi R/2, as for the distortion of their rings. A corner that has folded about its
bisector also carries less about its tangent than one that turns about that alone, T = (1 - worn) T_0 with

    worn = w (1 - exp(-theta/theta_w))
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from crumple.hinge.corner.in_plane import LARGEST
from crumple.numeric.arrays import Floats
from crumple.section import CircularTube, RectangularTube, Section

SHARE = 0.63
"""g, share of the shift of a right-angled corner that has folded far [-]."""
TURN = 3.2
"""r, rotation over which the shift grows, times the slenderness of the walls [rad]."""
WORN = 0.2
"""w, share of the moment about the tangent that a fold about the bisector takes [-]."""
WEARS = 0.03
"""theta_w, rotation about the bisector over which it takes that [rad]."""


def corner_shift(section: Section, angle: float) -> Callable[[ArrayLike], Floats] | None:
    """Share of the half axis in closing by which the centre has moved in opening [-], as a function.

    Parameters
    ----------
    section
        Of both members.
    angle
        Between their axes, 0 in line [rad].

    Returns
    -------
    callable
        Share at rotations about the bisector, >= 0 [rad], of any shape; None if it is not known: of other
        sections than rectangular and circular tubes, and of corners steeper than those of the estimates.

    References
    ----------
    docs/theory/mitred_corner.md.  Derived here; constants fitted to corners solved by shells.  Verified in
    tests/verification/characterisation/test_shifted_corners.py.
    """
    if not isinstance(section, RectangularTube | CircularTube) or angle > LARGEST:
        return None
    wall = section.thickness
    if isinstance(section, CircularTube):
        mean = math.pi * (section.diameter - wall) / 4.0
    else:
        mean = math.sqrt((section.width - wall) * (section.depth - wall))
    turn = TURN * wall / mean
    largest = SHARE * math.sin(angle)
    return lambda rotation: np.asarray(largest * (1.0 - np.exp(-np.asarray(rotation, float) / turn)))


def worn_by_bisector(rotation: ArrayLike) -> Floats:
    """Share of the moment about the tangent that is gone after rotations about the bisector [-].

    Parameters
    ----------
    rotation
        Largest one so far, >= 0 [rad], of any shape.

    References
    ----------
    docs/theory/mitred_corner.md.  Derived here; constants fitted to corners solved by shells.  Verified in
    tests/verification/characterisation/test_corners_turned_oblique.py.
    """
    return np.asarray(WORN * (1.0 - np.exp(-np.asarray(rotation, float) / WEARS)))
