"""Calls of public functions with values of which some are out of range, as a table of them.

A case is the name of a function and the number of the value of each argument, the first of which is good.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from functools import cache
from typing import Any

import numpy as np

from crumple.analysis import solve
from crumple.comparison.rating.rating import rating
from crumple.function.parse import parse_time_function
from crumple.function.time_function import Stop, Sum, Table, Transition
from crumple.hinge import build_axial_law, build_law, build_torsion_law
from crumple.hinge.band import band_of
from crumple.hinge.measured.measured import (
    bending_band,
    crushing_of,
    measured_band,
    read_specimens,
    smoothed,
)
from crumple.hinge.registry import AXIAL, BENDING, TORSION
from crumple.material import Material, grade_material
from crumple.material.flow_stress import bending_flow_stress
from crumple.material.hardening.swift import Swift, swift_from_tensile_test
from crumple.material.hardening.table import HardeningTable
from crumple.material.hardening.voce import Voce
from crumple.material.rate import CowperSymonds, JohnsonCook
from crumple.result.filters import cfc, uniform_step
from crumple.section import (
    Angle,
    Channel,
    CircularTube,
    ClosedHat,
    Hat,
    MultiCellTube,
    RectangularTube,
    Wall,
    WallSection,
    Weld,
    moment_capacity,
    square_tube,
)
from crumple.units import parse_quantity

Values = Sequence[Any]
Call = tuple[Callable[..., Any], Mapping[str, Values]]

NUMBERS: Values = [1.0, 0.5, 2.0, 0.0, -1.0, 1e-12, 1e12, math.nan, math.inf]
LENGTHS: Values = [0.05, 0.06, 0.04, 0.002, 0.0, -0.01, 4.0, 1e-9, math.nan, math.inf]
THIN: Values = [0.002, 0.001, 0.003, 0.03, 0.0, -1.0, 1e-9, math.nan]
RADII: Values = [0.0, 0.004, 0.001, 0.04, -1.0, math.nan]
STRESSES: Values = [300e6, 400e6, 500e6, 0.0, -1.0, 1e12, math.nan]
TIMES: Values = [np.linspace(0.0, 0.1, n) for n in (500, 30, 2, 1)] + [np.zeros(500), np.empty(0)]
HISTORIES: Values = [
    np.sin(np.linspace(0.0, 9.0, 500)),
    np.cos(np.linspace(0.0, 9.0, 500)),
    np.zeros(500),
    np.full(500, math.nan),
    np.linspace(0.0, 1.0, 30),
    np.ones(2),
    np.empty(0),
    np.r_[np.ones(250), math.inf, np.ones(249)],
]
POINTS: Values = [
    ((0.0, 0.0), (0.06, 0.0), (0.06, 0.04), (0.0, 0.04)),
    ((0.0, 0.0), (0.06, 0.0), (0.06, 0.04)),
    ((0.0, 0.0), (0.06, 0.04), (0.06, 0.0), (0.0, 0.04)),
    ((0.0, 0.0), (0.06, 0.0), (0.0, 0.0005)),
    ((0.0, 0.0), (0.06, 0.0), (0.059, 0.0)),
    ((0.0, 0.0), (0.03, 0.0), (0.0605, 0.03), (0.061, 0.03), (0.061, 0.0)),
    ((0.0, 0.0),),
    ((0.0, 0.0), (0.0, 0.0)),
    ((0.0, math.nan), (1.0, 0.0)),
    (),
]
MORE: Values = [
    (),
    (Wall(((0.03, 0.0), (0.03, 0.04)), 0.002),),
    (Wall(((0.03, 0.001), (0.03, 0.04)), 0.002),),
    (Wall(((0.03, -0.01), (0.03, 0.05)), 0.002),),
    (Wall(((0.0, -0.002), (0.06, -0.002)), 0.002),),
    (Wall(((0.5, 0.0), (0.6, 0.0)), 0.002),),
    (Wall(((0.06, 0.0), (0.0, 0.001)), 0.002),),
]
WELDS: Values = [(), (Weld((0.03, 0.0), (0.03, -0.002)),), (Weld((0.03, 0.02), (0.03, 9.0)),)]


@cache
def steel() -> Material:
    """A metal."""
    return Material("steel", 210e9, 0.3, 7850.0, 355e6, 510e6)


@cache
def sections() -> list[Any]:
    """Some sections."""
    return [
        square_tube(0.04, 0.002),
        RectangularTube(0.06, 0.04, 0.002, 0.004),
        CircularTube(0.05, 0.002),
        ClosedHat(0.06, 0.05, 0.0015, 0.02),
        Hat(0.06, 0.05, 0.0015, 0.02),
        Channel(0.04, 0.06, 0.002),
        Angle(0.04, 0.05, 0.003),
        MultiCellTube(0.09, 0.06, 0.003),
        square_tube(0.04, 0.012),
        WallSection((Wall(POINTS[0], 0.002, 0.0, closed=True),)),
    ]


def _law(name: str, section: Any, axis: Any, **options: Any) -> None:
    law = build_law(name, section, steel(), axis, **{k: v for k, v in options.items() if v is not None})
    rotation = np.linspace(0.0, 0.5, 9)
    assert np.isfinite(np.asarray(law.moment_capacity(rotation))).all(), "a moment that is not finite"
    band_of(law)


def _walls(
    points: Any, thickness: float, radius: float, *, closed: bool, more: Any, welds: Any, angle: float
) -> None:
    section = WallSection((Wall(points, thickness, radius, closed), *more), welds)
    moment_capacity(section, steel(), angle)


def _specimens(text: str, more: str, window: Any, stiffness: Any, coverage: float, factor: float) -> None:
    texts = {"a.csv": text, "b.csv": more}
    curves = read_specimens({name: one for name, one in texts.items() if one})
    band = measured_band(
        curves, window=window, elastic_stiffness=stiffness, coverage=coverage, dynamic_factor=factor
    )
    bending_band(band)
    crushing_of(band, 0.3)


def _sampled(function: Any, end: float, tolerance: float) -> None:
    function.sampled(0.0, end, tolerance)


def _made(kind: str, x1: float, h1: float) -> Transition:
    return Transition(kind, 0.0, 0.0, x1, h1)


def _stop(k: float, e: float, cmax: float, d: float, end: float) -> None:
    Stop(_made("step", 0.02, -0.01), 0.0, None, k, e, cmax, d).sampled(0.0, end, 1e-3)


SPECIMEN = "rotation [deg], moment [N*m]\n" + "".join(
    f"{x}, {y}\n" for x, y in [(0, 0), (1, 500), (2, 900), (10, 700), (30, 500)]
)
TEXTS: Values = [SPECIMEN, SPECIMEN.replace("900", "950"), SPECIMEN.replace("500", "-500"), "x\n1", ""]
TEXTS = [*TEXTS, "rotation [deg], moment [N*m]\n0, 0\n1, 9\n", SPECIMEN.replace("deg", "m")]
SHAPE = {"width": LENGTHS, "depth": LENGTHS, "thickness": THIN}
FUNCTIONS: Values = [
    {"step": {"x0": 0, "h0": 0, "x1": 1, "h1": 1}},
    {"step": {"x0": 1, "h0": 0, "x1": 1, "h1": 1}},
    {"table": {"time": [0, 1], "value": [0, 1]}},
    {"table": {"time": [0, 0], "value": [0, 1]}},
    {"table": {"time": [0], "value": [0, math.nan]}},
    {"sum": []},
    {"sum": 3},
    {"sum": [{"constant": 1}] * 3},
    {"step": []},
    {"no": 1},
    [],
    {"impact": {"x": {"constant": 1}, "x1": 0, "k": 1, "e": 0.5, "cmax": 1, "d": 1}},
    {"impact": {"x": {"constant": 1}, "x1": 0, "k": 1, "e": 1.5, "cmax": 1, "d": 1}},
    {"bistop": {"x": {"constant": 1}, "x1": 1, "x2": 0, "k": 1, "e": 1.5, "cmax": 1, "d": 1}},
    {"bistop": {"x": {"constant": 1}, "x1": 0, "x2": 1, "k": 1, "e": 1.5, "cmax": 1, "d": 1}},
]

CALLS: dict[str, Call] = {
    "solve": (solve, {"analysis": [None, 3, "x"], "fidelity": ["multibody", "no"], "threads": [1, 0]}),
    "rating": (
        rating,
        {
            "reference_time": TIMES,
            "reference": HISTORIES,
            "time": TIMES,
            "values": HISTORIES,
            "start": [None, 0.01, 9.0],
            "end": [None, 0.09, 0.0101, -1.0],
        },
    ),
    "cfc": (
        cfc,
        {
            "values": HISTORIES,
            "time_step": [1e-4, 1e-2, 0.0, -1.0, math.nan, math.inf],
            "channel_class": [600, 60, 7],
            "standard": ["SAE J211", "no"],
        },
    ),
    "uniform_step": (uniform_step, {"time": [*TIMES, np.array([0.0, 1.0, 3.0]), np.array([0.0, math.nan])]}),
    "Material": (
        Material,
        {
            "name": ["steel", ""],
            "youngs_modulus": [210e9, *NUMBERS],
            "poissons_ratio": [0.3, 0.5, *NUMBERS],
            "density": [7850.0, *NUMBERS],
            "yield_stress": STRESSES,
            "ultimate_stress": [None, *STRESSES],
            "given_flow_stress": [None, *STRESSES],
            "hardening": [None, Voce(300e6, 100e6, 0.2), Voce(310e6, 100e6, 0.2)],
            "failure_strain": [None, *NUMBERS],
        },
    ),
    "CowperSymonds": (CowperSymonds, {"D": [40.0, *NUMBERS], "q": [5.0, *NUMBERS]}),
    "JohnsonCook": (JohnsonCook, {"C": [0.02, *NUMBERS], "reference": NUMBERS}),
    "Swift": (Swift, {"yield_stress": STRESSES, "prestrain": [0.01, *NUMBERS], "exponent": [0.2, *NUMBERS]}),
    "Voce": (Voce, {"yield_stress": STRESSES, "saturation": STRESSES, "strain": NUMBERS}),
    "swift_from_tensile_test": (
        swift_from_tensile_test,
        {
            "yield_stress": STRESSES,
            "ultimate_stress": [500e6, *STRESSES],
            "uniform_elongation": [0.1, *NUMBERS],
        },
    ),
    "HardeningTable": (
        HardeningTable,
        {
            "plastic_strain": [
                (0.0, 0.1),
                (0.0, 0.1, 0.2),
                (0.1, 0.2),
                (0.0, 0.0),
                (),
                (0.0,),
                (0.0, math.nan),
            ],
            "true_stress": [(3e8, 4e8), (3e8, 4e8, 5e8), (4e8, 3e8), (0.0, 1.0), (), (3e8,), (3e8, math.inf)],
        },
    ),
    "bending_flow_stress": (
        bending_flow_stress,
        {"curve": [Voce(300e6, 100e6, 0.2), Swift(300e6, 0.01, 0.2)], "final_strain": [0.1, *NUMBERS]},
    ),
    "grade_material": (
        grade_material,
        {"name": ["S355", "DP600", "no", ""], "flow": ["mean", "no"], "rate": [False, True]},
    ),
    "law": (
        _law,
        {
            "name": sorted(BENDING),
            "section": sections(),
            "axis": ["y", "z", "x", 0.5],
            "moment": [None, *NUMBERS],
            "start": [None, "cap", "parabola", "no"],
            "scatter": [None, *NUMBERS],
            "no": [None, 1],
        },
    ),
    "axial law": (
        lambda name, section, mode, crush: build_axial_law(
            name, section, steel(), **{k: v for k, v in {"mode": mode, "crush_distance": crush}.items() if v}
        ),
        {
            "name": sorted(AXIAL),
            "section": sections(),
            "mode": [None, "symmetric", "no"],
            "crush": [None, "full", "effective"],
        },
    ),
    "torsion law": (
        lambda name, section, length: build_torsion_law(name, section, steel(), length),
        {"name": sorted(TORSION), "section": sections(), "length": NUMBERS},
    ),
    "specimens": (
        _specimens,
        {
            "text": TEXTS,
            "more": ["", *TEXTS],
            "window": [None, *NUMBERS],
            "stiffness": [None, *NUMBERS],
            "coverage": [0.9, *NUMBERS],
            "factor": NUMBERS,
        },
    ),
    "smoothed": (smoothed, {"abscissa": TIMES, "ordinate": HISTORIES, "window": [0.01, *NUMBERS]}),
    "walls": (
        _walls,
        {
            "points": POINTS,
            "thickness": THIN,
            "radius": RADII,
            "closed": [True, False],
            "more": MORE,
            "welds": WELDS,
            "angle": [0.3, *NUMBERS],
        },
    ),
    "function": (
        lambda given, end, tolerance: _sampled(parse_time_function(given, "m"), end, tolerance),
        {"given": FUNCTIONS, "end": NUMBERS, "tolerance": [1e-3, *NUMBERS]},
    ),
    "transition": (_made, {"kind": ["step", "havsin", "no"], "x1": NUMBERS, "h1": NUMBERS}),
    "table": (
        Table,
        {
            "time": [(0.0, 1.0), (0.0, 1.0, 2.0), (1.0, 0.0), (0.0,), (0.0, math.nan)],
            "value": [(0.0, 1.0), (0.0, 1.0, 2.0), (), (0.0, math.inf)],
        },
    ),
    "sum": (Sum, {"terms": [(_made("step", 1.0, 1.0),), ()]}),
    "stop": (
        _stop,
        {"k": [1e3, *NUMBERS], "e": [1.5, *NUMBERS], "cmax": NUMBERS, "d": NUMBERS, "end": NUMBERS},
    ),
    "quantity": (
        parse_quantity,
        {
            "text": [
                "50 mm",
                "50",
                "x mm",
                "5 mm*s*" * 99,
                "1 " + "m*" * 40 + "m",
                "1 m^99",
                "1e308 km",
                "1 q",
            ],
            "unit": ["m", "rad", "1"],
        },
    ),
    **{
        make.__name__: (make, SHAPE | more)
        for make, more in (
            (RectangularTube, {"corner_radius": RADII}),
            (Channel, {"corner_radius": RADII, "lip": RADII}),
            (Angle, {"corner_radius": RADII}),
            (Hat, {"flange": LENGTHS, "corner_radius": RADII}),
            (ClosedHat, {"flange": LENGTHS, "corner_radius": RADII, "plate_thickness": RADII}),
            (MultiCellTube, {"columns": [2, 1, 0, 99], "rows": [1, 2, 99], "inner_thickness": RADII}),
        )
    },
    "CircularTube": (CircularTube, {"diameter": LENGTHS, "thickness": THIN}),
    "square_tube": (square_tube, {"side": LENGTHS, "thickness": THIN, "corner_radius": RADII}),
}
"""By name: the function, and the values of every argument."""


def call(name: str, chosen: Sequence[int]) -> None:
    """Call a function of the table with the values of these numbers; arguments without one have the first."""
    function, given = CALLS[name]
    numbers = [*chosen, *[0] * len(given)]
    function(
        **{key: values[n % len(values)] for (key, values), n in zip(given.items(), numbers, strict=False)}
    )
