"""Spot welds: between the walls of two members, or along the weld lines of one member's section."""

from __future__ import annotations

from typing import Annotated

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, model_validator

from crumple.registry.quantity import (
    Length,
    NonNegativeLength,
    Position,
    PositiveForce,
    PositiveLength,
)
from crumple.registry.refusal import refuse
from crumple.structure.geometry import Frame
from crumple.structure.schema.spec import Name, Spec

MOST_SPOTS = 10_000
"""Largest number of spots of one entry."""


class SpotWelds(Spec):
    """Spot welds of two members' walls that lie on each other, or along weld lines of one member's section.

    They hold until (Fn/normal_strength)^2 + (Fs/shear_strength)^2 reaches 1.
    """

    members: Annotated[tuple[Name, ...], Field(min_length=1, max_length=2)]
    """Two members; or one, whose section has lines of welds."""
    at: tuple[Length, Length] | None = None
    """Of two members: where the line of spots runs in the first one's section, y and z from its line."""
    start: Annotated[NonNegativeLength, Field(alias="from")] = 0.0
    """Where the line begins: distance from the first member's first node."""
    end: Annotated[PositiveLength | None, Field(alias="to")] = None
    """Where it ends; without it at the first member's second node."""
    pitch: PositiveLength | None = None
    """Distance of the spots; as many as fit lie evenly, half a pitch from both ends of the line."""
    points: Annotated[tuple[Position, ...], Field(max_length=MOST_SPOTS)] = ()
    """Of two members, in place of a line: the places of the spots."""
    diameter: NonNegativeLength = 0.0
    """Of a spot: all nodes of both sheets within it are tied, and always those within 1.45 element sizes."""
    normal_strength: PositiveForce | None = None
    """Tensile force across the sheets at which a spot fails; without it there is no limit."""
    shear_strength: PositiveForce | None = None
    """Force along the sheets at which a spot fails; without it there is no limit."""

    @model_validator(mode="after")
    def _one_way(self) -> SpotWelds:
        line = [key for key in ("at", "pitch", "end") if getattr(self, key) is not None]
        line += ["start"] if self.start else []
        if len(self.members) == 1:
            for key in ("at", "points"):
                if getattr(self, key):
                    what = "the spots of one member lie on the weld lines of its section"
                    refuse(what, key=key, todo="remove it")
        elif self.members[0] == self.members[1]:
            refuse(
                "both members are the same", key="members", todo="give two, or one alone for its own lines"
            )
        if self.points and line:
            key = {"start": "from", "end": "to"}.get(line[0], line[0])
            refuse("the spots are given both as points and as a line", key=key, todo="keep one of them")
        if not self.points and self.pitch is None:
            refuse("the distance of the spots is missing", key="pitch", allowed="a length, for example 40 mm")
        if not self.points and self.at is None and len(self.members) == 2:
            what = "the positions of the spots are missing"
            refuse(what, key="at", allowed="y and z in the first member's section, or 'points'")
        if self.end is not None and self.end <= self.start:
            refuse("the line ends before it begins", key="to", allowed=f"more than {1e3 * self.start:g} mm")
        return self

    @property
    def fails(self) -> bool:
        """Whether a spot can fail."""
        return self.normal_strength is not None or self.shear_strength is not None

    def stations(self, length: float) -> NDArray[np.float64]:
        """Distances of a line's spots from the first node of its member of a length [m], (k,)."""
        assert self.pitch is not None
        end = length if self.end is None else min(self.end, length)
        number = max(1, round((end - self.start) / self.pitch))
        return np.asarray(self.start + (np.arange(number) + 0.5) * (end - self.start) / number)

    def places(self, frame: Frame) -> NDArray[np.float64]:
        """Places of the spots of two members, the first one's axes given [m], (k, 3)."""
        if self.points:
            return np.array(self.points, float)
        assert self.at is not None
        beside = np.asarray(self.at) @ frame.axes[1:]
        return np.asarray(frame.origin + self.stations(frame.length)[:, None] * frame.x + beside)
