"""A tube in the coordinates of the library: ratios that do not depend on its size.

A tube at rest has M/M_p(theta) of two ratios of its lengths, the yield strain s_y/E and the shape of its
hardening curve, of which one number is kept: the stress at a plastic strain of 0.1 over the yield stress.
Poisson's ratio is that of the solved points, 0.3, and their corners are sharp.  Bent about the other axis it
is the tube with width and depth exchanged.

A yield strain below that of the solved tubes counts as theirs, down to `SOFTEST`: walls that are further from
buckling before they yield change the moments little, by `SOFTER` of them at most.  So does a larger side over
wall of rectangular tubes, down to `THICKEST`, with the same ratio of sides: `THICKER`.  Rounded corners count
in M_p; M/M_p is that of sharp ones to within `ROUNDED`.
"""

from __future__ import annotations

import math

from crumple.errors import InputError, Problem
from crumple.hinge.tube_library.table import Coordinate, TubeTable
from crumple.material import Material
from crumple.material.material import FOLD_STRAIN
from crumple.section import Axis, CircularTube, RectangularTube, Section

RANGES = {
    "slenderness": "larger side over thickness",
    "ratio": "flange width over depth",
    "yield_strain": "yield stress over Young's modulus",
    "hardening": "stress at a plastic strain of 0.1 over the yield stress",
}
SOFTEST = 0.0009
"""Least yield strain of tubes that have the laws of the lowest of a table: a steel of 189 MPa."""
SOFTER = 0.08
"""Largest change of the moment from a yield strain of 0.0012 to `SOFTEST`, of ten tubes solved at both."""
THICKEST = 10.0
"""Least larger side over wall of rectangular tubes that have the laws of the lowest of a table."""
THICKER = 0.09
"""What the band grows by down to `THICKEST`: works up to 30 degrees of 12 such tubes differ by up to 15 %."""
ROUNDEST = 3.0
"""Largest outer radius of the corners of such tubes over their wall; EN 10219-2 has 2 up to 6 mm."""
ROUNDED = 0.2
"""Largest difference of M/M_p with such corners up to 20 degrees, of tubes solved with both."""
TODO = "use a formula, or solve this tube (crumple characterise)"


def hardening_ratio(material: Material) -> float:
    """Stress at a plastic strain of 0.1 over the yield stress; the flow stress where there is no curve."""
    curve = material.hardening
    stress = material.flow_stress if curve is None else float(curve.stress(FOLD_STRAIN))
    return stress / material.yield_stress


def place_of_tube(section: Section, material: Material, axis: Axis) -> dict[str, float]:
    """Coordinates of a tube that is bent about an axis.

    Returns
    -------
    dict
        ``slenderness`` (larger side or diameter over wall), ``ratio`` (flange width over depth; of a
        rectangular tube), ``yield_strain`` and ``hardening`` [-].

    Raises
    ------
    InputError
        If the section is no tube, or has corners of more than `ROUNDEST` walls.
    """
    metal = {
        "yield_strain": material.yield_stress / material.youngs_modulus,
        "hardening": hardening_ratio(material),
    }
    if isinstance(section, CircularTube):
        return {"slenderness": section.diameter / section.thickness, **metal}
    if not isinstance(section, RectangularTube):
        what, allowed = "the library has laws of tubes only", "rectangular_tube or circular_tube"
        raise InputError(Problem(what, section.kind, allowed, "use auto for this section", "section"))
    if section.corner_radius > ROUNDEST * section.thickness * (1.0 + 1e-9):
        came = f"corner radius {1e3 * section.corner_radius:.4g} mm"
        what, allowed = (
            "the library has tubes with narrow corners only",
            f"up to {ROUNDEST:g} wall thicknesses",
        )
        raise InputError(Problem(what, came, allowed, TODO, "section"))
    width, depth = section.flange_width(axis), section.bending_depth(axis)
    return {"slenderness": max(width, depth) / section.thickness, "ratio": width / depth, **metal}


def columns_of(table: TubeTable, place: dict[str, float]) -> tuple[float, ...]:
    """Values of the coordinates of a table at a place inside its range, or below it where it is held.

    Raises
    ------
    InputError
        With every coordinate that is out of range.
    """
    ranges = {key: table.ranges[key] for key in place}
    beyond = _beyond(table)
    for key, (least, _) in beyond.items():
        ranges[key] = min(least, ranges[key][0]), ranges[key][1]
    problems = [
        Problem(
            f"out of the library's range: {RANGES[key]}", f"{place[key]:.4g}", f"{low:g} to {high:g}", TODO
        )
        for key, (low, high) in ranges.items()
        if not within(place[key], low, high)
    ]
    if problems:
        raise InputError(problems)
    held = {**place, **{key: max(place[key], table.ranges[key][0]) for key in beyond}}
    return tuple(coordinate(one, held) for one in table.coordinates)


def band_beyond(table: TubeTable, section: Section, place: dict[str, float]) -> float:
    """What a place below the solved tubes, and rounded corners, add to the band [-]."""
    added = ROUNDED if getattr(section, "corner_radius", 0.0) > 0.0 else 0.0
    for key, (least, most) in _beyond(table).items():
        low = table.ranges[key][0]
        if place[key] < low:
            added += most * math.log(low / place[key]) / math.log(low / least)
    return added


def _beyond(table: TubeTable) -> dict[str, tuple[float, float]]:
    """Least value and widest band of the coordinates that are held below the range of a table."""
    held = {"yield_strain": (SOFTEST, SOFTER)}
    # round tubes were solved down to their least
    return held | {"slenderness": (THICKEST, THICKER)} if "ratio" in table.ranges else held


def within(value: float, low: float, high: float) -> bool:
    """Whether a value lies in a range, ends included to within rounding."""
    return low * (1.0 - 1e-9) <= value <= high * (1.0 + 1e-9)


def coordinate(one: Coordinate, place: dict[str, float]) -> float:
    """Value of a coordinate; flange and web are measured over the wall."""
    return {**place, **_walls(place)}[one.key]


def _walls(place: dict[str, float]) -> dict[str, float]:
    """Flange and web over the wall, and as in plate buckling, (b/t) sqrt(s_y/E)."""
    ratio, root = place.get("ratio", 1.0), math.sqrt(place["yield_strain"])
    flange, web = place["slenderness"] * min(ratio, 1.0), place["slenderness"] / max(ratio, 1.0)
    return {"flange": flange, "web": web, "flange_buckling": flange * root, "web_buckling": web * root}
