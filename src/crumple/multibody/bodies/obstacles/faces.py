"""Faces of obstacles that dent the walls of tubes.

Such an obstacle is two bodies: its mass, and a light face that meets the tubes.  The face slides on the mass
along the force, and what resists is the force of the dents.  So the walls that give way do not move the
members, and the contact stays that of rigid bodies.  docs/theory/dents.md
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from crumple._core.spatial.model import SpatialComponent, SpatialHinge, SpatialJoint, frame_of
from crumple.numeric.arrays import Floats
from crumple.structure import DentedTube

SLIDES = (False, True, True, True, True, True)
"""What the joint of a face holds."""
APART = 10.0
"""Force that would pull a face off its obstacle, over the largest that pushes it."""


@dataclass(frozen=True, eq=False)
class Face:
    """Face of an obstacle.

    Attributes
    ----------
    obstacle
        Its name.
    tubes
        What it dents, all by the same depth.
    outwards
        Unit vector from the tubes to the obstacle, along which the face slides, (3,).
    hinge, slip
        Index of its slip in the model, and the slip, at the joint whose first body is the mass.
    """

    obstacle: str
    tubes: tuple[DentedTube, ...]
    outwards: Floats
    hinge: int
    slip: SpatialHinge

    def guide(self, mass: int, face: int, place: Floats) -> SpatialJoint:
        """Joint between the mass and the face."""
        return SpatialJoint(mass, face, place, frame_of(self.outwards), SLIDES)


def face_of(obstacle: str, tubes: tuple[DentedTube, ...], hinge: int, joint: int) -> Face:
    """Face of an obstacle.

    Parameters
    ----------
    obstacle, tubes
        Its name, and what it dents.
    hinge, joint
        Indices of its slip, and of the joint at which this is.
    """
    # the tube that is pressed flat first stops the face
    depth = min((tube.dent.depth for tube in tubes), key=lambda depths: float(depths[-1]))
    force = np.sum([tube.dent.at(depth) for tube in tubes], axis=0)
    pulled = np.zeros(1), np.array([APART * float(force.max())])
    slip = SpatialHinge(joint, (SpatialComponent(0, positive=(depth, force), negative=pulled),))
    mean = np.sum([tube.outwards for tube in tubes], axis=0)
    return Face(obstacle, tubes, mean / np.linalg.norm(mean), hinge, slip)
