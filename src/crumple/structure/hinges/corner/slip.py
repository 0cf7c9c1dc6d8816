"""Shortening of a mitred corner that folds under compression, and what that takes from its moment.

The arm of the fold about its tension flange is a part of the flange's distance d from the centroid,

    arm/d = b (1 - exp(-theta/theta_1)) + (1 - b) min(1, N/(n N_y)),    b = f - c s t/h,

with the sine s of half the angle between the members, the wall t, the depth h = 2 d of the mid-lines, the
plastic rotation theta, the compressive force N at right angles to the mitre and the yield force N_y of the
section.  The first part is the fold's, the second that of the walls that yield: compression moves the neutral
axis.  A folded corner under N = n N_y turns about its tension flange.  The moment falls by the integral of
the arm over N, and the corner shortens by the arm times its rotation.  A force without moment shortens it
too, and falls as if the corner turned (`pressed_slip`).  The second part is replaced by `SIDES`
steps, so that the set is a polygon.  Derived here; f, c, n and theta_1 are fitted to corners solved by
shells, docs/theory/mitred_corner.md.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from crumple.hinge import Coupling, Freedom, SpatialHingeRecord
from crumple.hinge.record.record import Envelope, HingeRecord
from crumple.section import Section
from crumple.structure.hinges.corners import Corner

FOLD, STEEP = 0.70, 35.0
"""f and c of the arm of a fold without compression over the distance of the tension flange [-]."""
LEAST = 0.05
"""Least b [-]: that of the steepest and thickest corner that was solved."""
FULL = 0.157
"""n, compression over the yield force at which a fold turns about its tension flange [-]."""
FOLDED = 0.023
"""theta_1, plastic rotation over which the arm of the fold grows [rad]."""
SIDES = 3
"""Steps of the arm, as many as the kernel takes: the moment differs by 0.002 d N_y at most."""
PLACES = np.linspace(0.0, 6.0 * FOLDED, 31)
"""Rotations at which the growth is given [rad]; beyond the last, 0.25 % are left."""


def with_corner_slip(
    record: SpatialHingeRecord, corner: Corner, section: Section, squash: float
) -> SpatialHingeRecord:
    """Record of a corner's hinge in a plane: the arm of a corner replaces that of a straight member.

    `squash`: force at which all walls yield [N].
    """
    surface = record.surface
    if surface.coupling is not Coupling.TENSION_FLANGE:
        return record
    fold = fold_share(corner, section)
    step = (1.0 - fold) * surface.arm / SIDES
    # a step lies in the middle of the forces that it stands for
    gains = tuple((k * step, (k - 0.5) * FULL / SIDES) for k in range(1, SIDES + 1))
    growth = (PLACES, 1.0 - np.exp(-PLACES / FOLDED))
    slip, bending = record.components
    assert slip.freedom is Freedom.AXIAL
    pressed = pressed_slip(slip.record, bending.record, surface.arm, squash, fold)
    surface = replace(
        surface, arm=fold * surface.arm, gains=gains, growth=growth, shortened_turn=pressed.turn
    )
    return replace(record, components=(replace(slip, record=pressed.record), bending), surface=surface)


@dataclass(frozen=True)
class PressedSlip:
    """Slip of a corner under compression.

    Attributes
    ----------
    record
        Of the slip, with the smaller force in compression.
    weight
        Of the slip in the measure of softening [-].
    turn
        Rotation that a shortening counts as there [rad/m].
    """

    record: HingeRecord
    weight: float
    turn: float


def fold_share(corner: Corner, section: Section) -> float:
    """b, the arm of a fold without compression over the distance of the tension flange [-]."""
    depth = section.bending_depth(corner.axis) - section.thickness
    return max(LEAST, FOLD - STEEP * math.sin(0.5 * corner.angle) * section.thickness / depth)


def pressed_slip(
    slip: HingeRecord, bending: HingeRecord, arm: float, squash: float, fold: float
) -> PressedSlip:
    """The slip under the force that a corner without moment carries; it never softens ahead of a turn."""
    laws = bending.positive, bending.negative
    at_first = sum(float(law.moment[0]) for law in laws) / 2.0
    first = (at_first / arm + (1.0 - fold) * FULL * squash / 2.0) / (1.0 - fold)
    first = min(first, float(slip.negative.moment[0]))
    turns = np.unique(np.concatenate([PLACES, *(law.rotation for law in laws)]))
    moment = sum((np.interp(turns, law.rotation, law.moment) for law in laws), np.zeros(turns.size)) / 2.0
    left = 1.0 - fold * np.exp(-turns / FOLDED)
    force = (moment / arm + (1.0 - fold) * FULL * squash / 2.0) / left
    # shortening of a corner that turns under this force
    arms = moment / np.minimum(force, first)
    way = np.concatenate([[0.0], np.cumsum(np.diff(turns) * (arms[1:] + arms[:-1]) / 2.0)])
    weight = float(np.min(at_first * turns[1:] / (first * way[1:])))
    ratio = first * weight / at_first
    places = np.unique(np.concatenate([turns / ratio, slip.negative.rotation]))
    folding = np.interp(places, slip.negative.rotation, slip.negative.moment)
    pressed = np.minimum(np.interp(places, turns / ratio, force), folding)
    return PressedSlip(replace(slip, negative=Envelope(places, pressed)), weight, ratio)
