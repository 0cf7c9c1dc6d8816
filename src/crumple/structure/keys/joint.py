"""Joints that let a member's end move against its node, in place of the rigid connection.

Without friction and play: a joint transmits loads in its fixed degrees of freedom only.
"""

from __future__ import annotations

from typing import Literal

from pydantic import model_validator

from crumple.registry.quantity import Direction
from crumple.registry.refusal import refuse
from crumple.structure.schema.spec import Name, Spec

JointType = Literal["revolute", "universal", "spherical", "prismatic", "cylindrical", "planar"]

FREE: dict[str, tuple[int, ...]] = {
    "revolute": (3,),
    "universal": (4, 5),
    "spherical": (3, 4, 5),
    "prismatic": (0,),
    "cylindrical": (0, 3),
    "planar": (1, 2, 3),
}
"""Relative freedoms that a joint leaves: 0 to 2 along, 3 to 5 about its own x, y, z; x is its axis, but y and
z are the two of a universal joint."""
SQUARE = 1e-6
"""Cosine of the angle between the two axes of a universal joint that is still rounding."""


class Joint(Spec):
    """Joint between the end of a member and its node; without one they are joined rigidly."""

    node: Name
    """Node, one of the member's two."""
    member: Name
    """Member whose end it joins to the node."""
    type: JointType
    """Which motion is free: revolute (about the axis), universal (about both axes), spherical (about all),
    prismatic (along the axis), cylindrical (along and about it), planar (in the plane across it, and about
    it)."""
    axis: Direction | None = None
    """Direction of its axis at the start, global, of any length; a spherical joint has none. That of a
    universal joint is fixed to the node."""
    second: Direction | None = None
    """Second axis of a universal joint, perpendicular to the first, fixed to the member."""

    @model_validator(mode="after")
    def _axes(self) -> Joint:
        for key, needed in (("axis", self.type != "spherical"), ("second", self.type == "universal")):
            given = getattr(self, key)
            if needed and given is None:
                refuse(f"a {self.type} joint needs '{key}'", todo=f"add '{key}', for example [0, 1, 0]")
            if not needed and given is not None:
                refuse(f"a {self.type} joint has no '{key}'", key=key, todo="remove it")
            if given is not None and not any(given):
                refuse("the axis is zero", key=key, allowed="a direction such as [0, 1, 0]")
        if self.axis is not None and self.second is not None:
            along = sum(a * b for a, b in zip(self.axis, self.second, strict=True))
            sizes = [sum(a * a for a in axis) ** 0.5 for axis in (self.axis, self.second)]
            if abs(along) > SQUARE * sizes[0] * sizes[1]:
                todo = "change one of them"
                refuse("the axes of a universal joint are not perpendicular", key="second", todo=todo)
        return self

    @property
    def free(self) -> tuple[int, ...]:
        """Relative freedoms that it leaves, as in `FREE`."""
        return FREE[self.type]
