"""A tube in the coordinates of the library: ratios that do not depend on its size.

A tube with sharp corners, at rest, has M/M_p(theta) of two ratios of its lengths, the yield strain s_y/E and
the shape of its hardening curve, of which one number is kept: the stress at a plastic strain of 0.1 over the
yield stress.  Poisson's ratio is that of the solved points, 0.3.  Bent about the other axis it is the tube
with width and depth exchanged.
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
        If the section is no tube, or has rounded corners.
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
    if section.corner_radius > 0.0:
        came = f"corner radius {1e3 * section.corner_radius:.4g} mm"
        what = "the library has tubes with sharp corners only"
        raise InputError(Problem(what, came, "0 mm", TODO, "section"))
    width, depth = section.flange_width(axis), section.bending_depth(axis)
    return {"slenderness": max(width, depth) / section.thickness, "ratio": width / depth, **metal}


def columns_of(table: TubeTable, place: dict[str, float]) -> tuple[float, ...]:
    """Values of the coordinates of a table at a place inside its range.

    Raises
    ------
    InputError
        With every coordinate that is out of range.
    """
    problems = [
        Problem(f"out of the library's range: {RANGES[key]}", f"{value:.4g}", f"{low:g} to {high:g}", TODO)
        for key, value in place.items()
        for low, high in [table.ranges[key]]
        if not within(value, low, high)
    ]
    if problems:
        raise InputError(problems)
    return tuple(coordinate(one, place) for one in table.coordinates)


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
