"""Content hash of the place that a law was characterised for: section, material, axis and corner angle.

Two descriptions have one hash if they describe the same metal and geometry: names, units and the order of
keys do not matter.  A law file contains it in its origin, so that a structure finds the laws of its members
and corners without solving anything.
"""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from typing import Any, Literal

import numpy as np

from crumple.material import Material
from crumple.section import Axis, RectangularTube, Section

Load = Literal["bending", "torsion", "crush", "out-of-plane"]
"""What a place is loaded by."""
Direction = Literal["bisector", "tangent"]
"""Direction in a corner's plane of a moment that acts out of this plane: the line that halves the corner, or
the one across it, in which the corner runs on the whole."""
DIRECTIONS: tuple[Direction, ...] = ("bisector", "tangent")
DIGITS = 10
"""Significant digits by which places differ: a length given in inches and the same in mm are one place."""
LENGTH = 16
"""Hexadecimal digits of the hash."""
PLACE = "place"
"""Key of the hash in the origin of a law file."""
ABOUT = "about"
"""Key of the direction of the moment out of a corner's plane; laws from before there were two have none."""
CORNER = "corner"
"""Key of the corner's angle in the origin of a law file."""
JOINT = "joint"
"""Key of the kind of joint; a law without it and without a corner is that of a straight member."""
REVISION = "revision"
"""Key of the number of the method that made a law of a corner; laws from before it was written have none."""


def place_hash(
    section: Section,
    material: Material,
    axis: Axis = "y",
    angle: float | None = None,
    *,
    load: Load = "bending",
    about: Direction | None = None,
) -> str:
    """Hash of a straight member's fold, or of a mitred corner, 16 hexadecimal digits.

    Parameters
    ----------
    section, material
        Of the member, or of both members of the corner.
    axis
        Axis of the section about which it bends.
    angle
        Angle between the members' axes [rad]; None: a straight member.
    load
        Load that folds it; without an axis for torsion and crushing.
    about
        Direction of the moment out of a corner's plane. Without it the place is that of laws of former
        versions, whose moment was perpendicular to the second piece; structures do not use them.

    Notes
    -----
    Circular and square tubes are the same about both axes, so the axis is left out for these.
    """
    content: dict[str, Any] = {
        "section": _plain(section),
        "material": _plain(material),
        "axis": "any" if load in ("torsion", "crush") or _same_about_both(section) else axis,
        "angle": None if angle is None else round(math.degrees(angle), 3),
    }
    # the hash of bending was defined before there were other loads
    content |= {} if load == "bending" else {"load": load}
    content |= {} if about is None else {"about": about}
    text = json.dumps(content, sort_keys=True, separators=(",", ":"), allow_nan=False)
    return hashlib.sha256(text.encode()).hexdigest()[:LENGTH]


def t_joint_hash(branch: RectangularTube, chord: RectangularTube, material: Material, *, across: bool) -> str:
    """Hash of a welded T-joint at a right angle, 16 hexadecimal digits.

    Parameters
    ----------
    branch, chord, material
        The branch's width lies along the chord; it stands on a face across the chord's z axis.
    across
        Whether the branch is turned about the chord's axis, in place of the normal of the joint's plane.
    """
    both = (place_hash(section, material) for section in (branch, chord))
    return content_hash("|".join(("welded T-joint", "across" if across else "in", *both)))


def content_hash(text: str) -> str:
    """Hash of the content of a law, 16 hexadecimal digits."""
    return hashlib.sha256(text.encode()).hexdigest()[:LENGTH]


def _same_about_both(section: Section) -> bool:
    if section.kind == "circular_tube":
        return True
    return isinstance(section, RectangularTube) and math.isclose(section.width, section.depth, rel_tol=1e-9)


def _plain(value: Any) -> Any:
    """Plain data of frozen objects: fields that differ from their defaults, without names of materials."""
    if is_dataclass(value) and not isinstance(value, type):
        return {"type": type(value).__name__, **_fields(value)}
    if isinstance(value, Mapping):
        return {str(key): _plain(one) for key, one in value.items()}
    if isinstance(value, np.ndarray | np.generic):
        value = value.tolist()
    if isinstance(value, list | tuple):
        return [_plain(one) for one in value]
    if isinstance(value, float | int) and not isinstance(value, bool):
        return f"{float(value):.{DIGITS}g}"
    return value if value is None or isinstance(value, bool) else str(value)


def _fields(value: Any) -> dict[str, Any]:
    found = {}
    for field in fields(value):
        one = getattr(value, field.name)
        unnamed = isinstance(value, Material) and field.name == "name"
        if field.init and not unnamed and one is not None and not _is_default(one, field.default):
            found[field.name] = _plain(one)
    return found


def _is_default(value: Any, default: object) -> bool:
    return bool(type(value) is type(default) and value == default)
