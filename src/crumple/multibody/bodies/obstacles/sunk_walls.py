"""Walls of tubes into whose folds a pole sinks: bodies that the folds move.

The walls under the pole are two light bodies, one on each piece of the tube that meets the other in the fold.
Each slides on its piece, across the tube, by the depth that belongs to the rotation of the fold
(`crumple.hinge.bending.pressed`): a cam between it and the other piece.  So what the pole does on a wall is
done on the fold, and no energy is lost.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from crumple._core.spatial.model import (
    SpatialBody,
    SpatialCam,
    SpatialCapsule,
    SpatialJoint,
    SpatialModel,
    frame_of,
)
from crumple.hinge.bending.pressed import PressedLaw
from crumple.multibody.bodies.capsules import capsule_rows, fold_at, row_shifts
from crumple.multibody.bodies.linkage import Linkage
from crumple.numeric.arrays import Floats
from crumple.structure import DentedTube, Structure, dent_at_fold
from crumple.structure.hinges.runs.straight_runs import straight_run

SLIDES = (False, True, True, True, True, True)
"""What the joint of a wall holds on its piece."""
FOLLOWS = (True, False, False, False, False, False)
"""What the cam holds between it and the other piece."""
ALONG, TURNS = 0, 5
"""Freedoms of the cam: the translation across the tube follows the rotation about its z."""
ROTATIONS = {"y": 4, "z": 5}
"""Freedoms of a hinge about the axes of the section."""
AT_REST = 1e-5
"""Rotation in the other sense from which a pole does not sink [rad]."""
LENGTH = 2.0
"""Length of a wall, over half that of the fold: a pole that meets the tube beyond presses on it there."""
SAME = 1e-7
"""Distance [m] below which places are the same."""


@dataclass(frozen=True, eq=False)
class SunkWall:
    """A wall of a fold under a pole.

    Attributes
    ----------
    tube, law
        The tube under the pole, and the law of its fold.
    hinge, component, joint
        Index of the fold's hinge in the model, that of its rotation in the plane of the pole, and that of the
        joint with the cam.
    body, own, other
        Its body, that of the piece on which it slides, and that of the piece behind the fold.
    place, outwards, along
        Of the fold [m], and unit vectors across the tube to the pole and along it to the other piece, (3,).
    length
        Of the wall [m].
    """

    tube: DentedTube
    law: PressedLaw
    hinge: int
    component: int
    joint: int
    body: int
    own: int
    other: int
    place: Floats
    outwards: Floats
    along: Floats
    length: float

    def joints(self) -> tuple[SpatialJoint, SpatialJoint]:
        """On its piece, and with the other one."""
        axes = np.array([self.outwards, -self.along, np.cross(self.along, self.outwards)])
        slide = SpatialJoint(self.own, self.body, self.place, frame_of(self.outwards), SLIDES)
        return slide, SpatialJoint(self.body, self.other, self.place, axes, FOLLOWS)

    def cam(self) -> SpatialCam:
        """Cam at the second of these joints."""
        turned = np.asarray(self.law.kinks(self.law.sense))
        angle, slope = np.append(-AT_REST, turned), np.append(0.0, self.law.slope(turned))
        return SpatialCam(self.joint, ALONG, TURNS, angle, slope)

    def capsules(self, structure: Structure) -> Iterator[SpatialCapsule]:
        """Capsules of the wall; along the tube a pole slides on both walls alike, as on any fold."""
        folds = (fold_at(structure, self.tube.member, self.place),)
        start = self.place - self.length * self.along
        radius = capsule_rows(structure.section_of(self.tube.member).outer_outline())[1]
        for shift in row_shifts(structure, self.tube.member):
            yield SpatialCapsule(self.body, start + shift, self.place + shift, radius, folds=folds)

    def rest_of(self, capsule: SpatialCapsule) -> SpatialCapsule | None:
        """What is left of a capsule of the tube before the wall: itself if it lies elsewhere, or nothing."""
        ends = [(float(self.along @ (end - self.place)), end) for end in (capsule.first, capsule.second)]
        nearest, farthest = max(at for at, _ in ends), min(at for at, _ in ends)
        if nearest > SAME or nearest <= -self.length:
            return capsule
        if farthest >= -self.length - SAME:
            return None
        first, second = (end - max(at + self.length, 0.0) * self.along for at, end in ends)
        return replace(capsule, first=first, second=second)


def sunk_walls(structure: Structure, linkage: Linkage, model: SpatialModel) -> tuple[SunkWall, ...]:
    """Walls of all folds under poles; their bodies follow those of a model without obstacles."""
    found: list[SunkWall] = []
    placed = [(c, c.hinge) for c in linkage.connections if c.hinge is not None]
    for index, (connection, hinge) in enumerate(placed):
        for axis, law in (hinge.laws or {hinge.axis: hinge.law}).items():
            if not isinstance(law, PressedLaw):
                continue
            tube = dent_at_fold(structure, hinge.member, hinge.name, axis)
            assert tube is not None
            frame, component = structure.frame_of(hinge.member), connection.free.index(ROTATIONS[axis])
            across, place = frame.axis("z" if axis == "y" else "y"), connection.position
            outwards = across * np.sign(float(across @ tube.outwards))
            run = straight_run(structure, hinge.member)
            for own, other, along in (
                (connection.first, connection.second, frame.x),
                (connection.second, connection.first, -frame.x),
            ):
                ends = (along @ (place - np.asarray(structure.nodes[node])) for node in run.nodes)
                length = min(LENGTH * law.press.half_length, max(float(end) for end in ends))
                body = len(model.bodies) + len(found)
                parts = index, component, len(model.joints) + 2 * len(found) + 1, body, own, other
                found.append(SunkWall(tube, law, *parts, place, outwards, along, length))
    return tuple(found)


def with_walls(model: SpatialModel, walls: Sequence[SunkWall], mass: float) -> SpatialModel:
    """A model with the bodies, joints and cams of walls, each of a mass [kg]."""
    inertia = mass * model.length**2 * np.eye(3)
    bodies = tuple(SpatialBody(mass, inertia, wall.place) for wall in walls)
    joints = tuple(joint for wall in walls for joint in wall.joints())
    cams = tuple(wall.cam() for wall in walls)
    return replace(
        model,
        bodies=(*model.bodies, *bodies),
        joints=(*model.joints, *joints),
        cams=(*model.cams, *cams),
    )
