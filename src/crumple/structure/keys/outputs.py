"""Outputs of a run."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from crumple.registry.quantity import NonNegativeLength, NonNegativeTime, Position, PositiveTime
from crumple.structure.schema.mapping import FrozenMapping
from crumple.structure.schema.spec import Name, Named, Spec

MOST_PICTURES = 1000
"""Stored shapes of one run."""


class SectionRotation(Spec):
    """Rotation of one section of a member relative to another."""

    member: Name
    """Member."""
    start: Annotated[NonNegativeLength, Field(alias="from")] = 0.0
    """Distance of the first section from the member's first node."""
    end: Annotated[NonNegativeLength, Field(alias="to")]
    """Distance of the second section from the member's first node."""


class SectionForce(Spec):
    """Force and moment in a section of a member, in its local axes, and their ratio to its capacity."""

    member: Name
    """Member."""
    at: NonNegativeLength
    """Distance of the section from the member's first node."""


class Distance(Spec):
    """Change of the distance between two nodes since the start, such as an intrusion."""

    start: Annotated[Name, Field(alias="from")]
    """First node."""
    end: Annotated[Name, Field(alias="to")]
    """Second node."""


class Clearance(Spec):
    """Smallest distance between a plane survival space and the members around it, negative inside.

    A member counts as a round bar as thick as its section is deep or wide, whichever is more.
    """

    points: Annotated[tuple[Position, ...], Field(min_length=3, max_length=100)]
    """Corners of the space at the start, in order, in one plane; across it the space has no end."""
    moves_with: Name
    """Member with whose middle the space moves."""
    members: tuple[Name, ...] | None = None
    """Members that must stay outside; without it all others."""


class Filter(Spec):
    """A channel passed through a channel frequency class of SAE J211 / ISO 6487."""

    channel: Annotated[str, Field(min_length=1, max_length=200)]
    """Name of the channel, for example node.tip.acceleration.z."""
    cfc: Literal[60, 180, 600, 1000]
    """Channel frequency class."""


class Outputs(Spec):
    """Outputs of a run; quantities of the hinges and energies are always included."""

    every: PositiveTime | None = None
    """Interval of the histories, at most 1 000 000 in the duration; without it a 200th of the duration."""
    nodes: tuple[Name, ...] = ()
    """Nodes whose displacement, velocity, acceleration and rotation are reported."""
    section_rotations: Named[SectionRotation] = FrozenMapping()
    """Relative rotations between two sections of a member, by channel name."""
    section_forces: Named[SectionForce] = FrozenMapping()
    """Forces and moments in sections of members, by name; multibody runs only."""
    distances: Named[Distance] = FrozenMapping()
    """Changes of distances of nodes, by channel name, negative if they come nearer."""
    clearances: Named[Clearance] = FrozenMapping()
    """Distances between spaces that must stay free and members, by channel name."""
    filters: Named[Filter] = FrozenMapping()
    """Filtered channels, by the name of the new channel."""
    pictures: Annotated[tuple[NonNegativeTime, ...], Field(max_length=MOST_PICTURES)] = ()
    """Times within the duration at which the deformed shape is stored and drawn."""
