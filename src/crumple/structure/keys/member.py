"""Members: straight thin-walled bars between two nodes, and the hinges in them."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from numbers import Integral
from typing import Annotated, Any, Literal

from pydantic import (
    BeforeValidator,
    Discriminator,
    Field,
    Tag,
    ValidationInfo,
    WithJsonSchema,
    field_validator,
    model_validator,
)

from crumple.registry.quantity import (
    LENGTH,
    Angle,
    Direction,
    Length,
    NonNegativeLength,
    PositiveLength,
)
from crumple.registry.refusal import refuse
from crumple.structure.keys.hinge_axes import HingeAxes
from crumple.structure.schema.problems import suggestion
from crumple.structure.schema.spec import Name, Spec

MOST_BARS = 10_000
"""Largest number of bars in one member."""

_DISTANCE = re.compile(r"\s*[+-]?(\d+\.?\d*|\.\d+)\s*([eE][+-]?\d+)?\s*\D")


def _place(given: Any, info: ValidationInfo) -> str | float:
    """A name stays a name; a number, or a text that starts like one with a unit, is a distance."""
    in_file = bool(info.context and info.context.get("file"))
    if isinstance(given, int) and not isinstance(given, bool) and in_file and given != 0:
        return str(given)
    if isinstance(given, str) and not _DISTANCE.match(given):
        if not given or len(given) > 64:
            refuse(
                "this is neither a node nor a distance",
                allowed="a node of the member, or a distance: '300 mm'",
            )
        return given
    return LENGTH.value_of(given, info)


Place = Annotated[
    str | float,
    BeforeValidator(_place),
    WithJsonSchema(
        {"type": ["string", "number"], "description": "a node of the member, or a distance: '300 mm'"}
    ),
]
"""A node of the member (text), or a distance from its first node [m]."""


class Placed(Spec):
    """Name and place of a hinge."""

    name: Name
    """Name, unique in the structure; its channels are `hinge.NAME.rotation` and so on."""
    at: Place
    """A node of the member, or the distance from its first node."""
    offset: Length | None = None
    """Shift from that place into the member (from a distance: towards the second node);
    without it the distance of a fold from a clamp, 0.7 of half a fold length, at one, else 0."""


class Hinge(HingeAxes, Placed):
    """Plastic hinge at a place of a member."""


class AutomaticHinges(HingeAxes):
    """Candidate hinges wherever a fold can form; those not loaded to their capacity stay rigid.

    Without `axis` and `axes` they bend across the plane of bending, or about y and z where there is none.
    """

    spacing: PositiveLength | None = None
    """Largest distance between candidates along a member; without it they lie at its ends, at the
    distance of a fold from a rigid face, and where an obstacle strikes it in between. Members in line that
    are one tube count as one, with a candidate at a node between them only if it is a kink or is struck."""


def _is_group(given: Any) -> bool:
    return isinstance(given, Mapping | Spec)


def _automatic(given: Any) -> Any:
    allowed = "auto, or keys such as axes: [y, z]"
    if isinstance(given, list | tuple):
        refuse(
            "a list of hinges belongs to a member",
            allowed=allowed,
            todo="write it as members.NAME.hinges, or 'auto' here for all members",
        )
    return _keys_of_auto(given, allowed, "write auto")


def _automatic_here(given: Any) -> Any:
    allowed = "auto, a list of hinges, or keys such as axes: [y, z]"
    return _keys_of_auto(given, allowed, "write auto, or a list such as [{name: root, at: NODE}]")


def _keys_of_auto(given: Any, allowed: str, todo: str) -> Any:
    """No keys for `auto`; a group of keys as it is."""
    if isinstance(given, str) and given == "auto":
        return {}
    if not _is_group(given):
        meant = suggestion(given, ["auto"]) if isinstance(given, str) else ""
        refuse("this does not say where hinges are", allowed=allowed, todo=meant or todo)
    return given


def _hinges_tag(given: Any) -> str:
    return "(list)" if isinstance(given, list | tuple) else "(automatic)"


OnlyAutomatic = Annotated[
    AutomaticHinges, BeforeValidator(_automatic, json_schema_input_type=Literal["auto"] | AutomaticHinges)
]
"""`auto`, or how."""
AutomaticHere = Annotated[
    AutomaticHinges,
    BeforeValidator(_automatic_here, json_schema_input_type=Literal["auto"] | AutomaticHinges),
]
"""The same beside a list of hinges."""
GivenOrAutomatic = Annotated[
    Annotated[tuple[Hinge, ...], Tag("(list)")] | Annotated[AutomaticHere, Tag("(automatic)")],
    Discriminator(_hinges_tag),
]
"""List of hinges, or `auto`."""


def _plain(given: Any) -> Any:
    """An integer of NumPy as a plain one."""
    return int(given) if isinstance(given, Integral) and not isinstance(given, bool) else given


class Division(Spec):
    """Into how many bars."""

    number: Annotated[int, Field(ge=1, le=MOST_BARS, strict=True), BeforeValidator(_plain)] = 1
    """How many bars; the hinge after bar i is named MEMBER-i."""


SEGMENTS, MOST_SEGMENTS = 6, 32
"""Usual and largest number of segments of an elastic member."""


class Bars(HingeAxes, Division):
    """Division of a member into equal rigid bars, with a hinge between neighbours."""


def _number_of_bars(given: Any) -> Any:
    if isinstance(given, Integral) and not isinstance(given, bool):
        return {"number": given}
    if not _is_group(given):
        refuse(
            "this is not a number of bars",
            allowed="a whole number, or keys such as {number: 4, axis: y}",
            todo="write the number without quotation marks, for example 4",
        )
    return given


class Stretch(Spec):
    """Part of a member between two distances from its first node."""

    start: Annotated[NonNegativeLength, Field(alias="from")] = 0.0
    """Where it begins."""
    end: Annotated[PositiveLength, Field(alias="to")]
    """Where it ends."""

    @model_validator(mode="after")
    def _has_length(self) -> Stretch:
        if self.end <= self.start:
            refuse("the part ends before it begins", key="to", allowed=f"more than {1e3 * self.start:g} mm")
        return self


def _rigid_tag(given: Any) -> str:
    return "(list)" if isinstance(given, list | tuple) else "(whole)"


def _true_or_false(given: Any) -> Any:
    if not isinstance(given, bool):
        refuse(
            "this does not say what is rigid",
            allowed="true, false, or a list of parts such as [{from: 0 mm, to: 100 mm}]",
            todo="write true or false without quotation marks, or a list",
        )
    return given


Rigid = Annotated[
    Annotated[tuple[Stretch, ...], Tag("(list)")]
    | Annotated[bool, BeforeValidator(_true_or_false), Tag("(whole)")],
    Discriminator(_rigid_tag),
]
"""Whether a member is rigid, or which parts of it are."""


def _segments(given: Any) -> Any:
    if isinstance(given, bool):
        return SEGMENTS * given
    if not _is_whole(given):
        refuse(
            "this does not say whether it is elastic",
            allowed=f"true, false, or a whole number of segments, 0 to {MOST_SEGMENTS}",
            todo="write true or false without quotation marks, or a whole number",
        )
    return given


def _is_whole(given: Any) -> bool:
    """Whether it is a whole number or spelt as one."""
    try:
        return float(given).is_integer()
    except (TypeError, ValueError, OverflowError):
        return False


Elastic = Annotated[
    int,
    Field(ge=0, le=MOST_SEGMENTS),
    BeforeValidator(_segments, json_schema_input_type=bool | Annotated[int, Field(ge=0, le=MOST_SEGMENTS)]),
]
"""Number of segments of an elastic member; 0: rigid bars."""


def united(stretches: Iterable[tuple[float, float]]) -> tuple[tuple[float, float], ...]:
    """Stretches of a line by increasing start, those that overlap as one."""
    merged: list[tuple[float, float]] = []
    for a, b in sorted(stretches):
        if merged and a <= merged[-1][1]:
            merged[-1] = (merged[-1][0], max(b, merged[-1][1]))
        else:
            merged.append((a, b))
    return tuple(merged)


class Member(Spec):
    """Straight bar of one section and one material between two nodes.

    Local x runs from the first node to the second.  Local z is the part of `up` across x, local y is
    z cross x; then both are turned by `roll` about x.  Section coordinates are local (y, z).
    """

    nodes: tuple[Name, Name]
    """First and second node."""
    section: Name
    """Name of its section."""
    material: Name
    """Name of its material."""
    roll: Angle = 0.0
    """Rotation of the section about local x; 90 deg puts it on edge."""
    up: Direction | None = None
    """Direction whose part across the member is local z; without it global z, or x for a member along z."""
    bars: Annotated[Bars, BeforeValidator(_number_of_bars, json_schema_input_type=int | Bars)] = Bars()
    """Equal rigid bars with hinges between them; a plain number stands for `{number: ...}`."""
    hinges: GivenOrAutomatic | None = None
    """Further hinges, one by one; or `auto`: candidates wherever a fold can form. Without it an elastic
    member has candidates too, also besides a list where this has none near; `[]`: none of its own."""
    elastic: Elastic | None = None
    """Whether it bends and yields along its length in the multibody model: `true` (6 segments), `false`, or a
    number of segments; without it as `analysis.multibody.members`."""
    rigid: Rigid = False
    """`true`: it does not deform, in either solver, and has no hinges; or the parts of it that do not."""

    def rigid_parts(self, length: float) -> tuple[tuple[float, float], ...]:
        """Stretches that do not deform [m], of a member of a length [m]; those that overlap as one."""
        if isinstance(self.rigid, bool):
            return ((0.0, length),) if self.rigid else ()
        return united((part.start, part.end) for part in self.rigid)

    @property
    def given_hinges(self) -> tuple[Hinge, ...]:
        """Hinges that are given one by one."""
        return () if self.hinges is None or isinstance(self.hinges, AutomaticHinges) else self.hinges

    @field_validator("up", mode="after")
    @classmethod
    def _not_zero(cls, up: Direction | None) -> Direction | None:
        if up is not None and not any(up):
            refuse("the direction is zero", allowed="a direction such as [0, 0, 1]")
        return up

    @model_validator(mode="after")
    def _not_rigid_and_elastic(self) -> Member:
        if self.rigid is True and self.elastic:
            refuse("the member is rigid and elastic", key="elastic", todo="remove 'rigid' or 'elastic'")
        return self
