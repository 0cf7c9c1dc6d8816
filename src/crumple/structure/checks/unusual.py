"""Values far outside of what structural metals, thin-walled sections and crashes have: mostly a wrong unit.

Nothing is refused for them.  The ranges are wide, so that whoever is outside of one is very likely mistaken:

- Young's modulus 1 to 1000 GPa: magnesium has 45, tungsten 400; lead, the softest in use, 16.
- Yield, ultimate and flow stress 1 MPa to 5 GPa: pure lead yields at some 5 MPa, steel wires at 4 GPa.
- Flow stress 0.9 to 10 times the yield stress: metals harden in a fold; soft copper up to 10 times.
- Plastic strain of a hardening curve up to 3, 300 %: drawn wire; more is a strain in per cent.
- Stress at 100/s 1 to 10 times the static one: of the laws in use, mild steel has the most, 2.2 times.
- Density 500 to 25 000 kg/m3: lithium, the lightest metal, has 534, osmium, the heaviest, 22 590.
- Wall thickness 0.02 to 100 mm: foil of honeycomb has 0.03 mm; thicker plates are not thin-walled frames.
- Largest side of a section 1 mm to 10 m: from a capillary to a box girder.
- Length of a member 1 mm to 1 km: bars between hinges are longer than their folds; no frame has a longer one.
- Length of a member over the largest side of its section up to 200: the slenderest of frames have 50.
- Largest rotation in the table of a law up to 180 degrees: no member bends further.
- Mass of a lump or obstacle up to 100 000 t: a loaded ship.  Small ones do no harm.
- Offset of a lump from its node up to 100 m: half of a ship.
- Speed up to 500 m/s: above it shock waves in the metal matter, which neither solver has.  Of an initial
  rotation the speed of the fastest node counts: the blades of a gas turbine have 400 m/s at their tips.  Of
  a drive the steepest part of its curve counts.
- Gravity up to 5000 m/s2: 500 g stand for a hard pulse; 9810 is the number in mm/s2.
- Duration 10 microseconds to 1 h: waves cross a section in the former; creep, which no law has, begins to
  matter in the latter.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from crumple.material import HardeningTable
from crumple.structure.keys.hinge_axes import HingeAxes
from crumple.structure.keys.law import LawReference
from crumple.structure.keys.motion import InitialVelocity
from crumple.structure.parts import StructureParts
from crumple.text.names import listed
from crumple.units import format_quantity

LOOKS = 101
"""Times of a run between which the speed of a drive is taken, besides the corners of its curve."""
LONGEST, SMALLEST_SIDE = 1e3, 1e-3
"""Largest usual length of a member, and smallest of the largest side of a section [m]."""
RATE = 100.0
"""Strain rate [1/s] at which rate laws are judged, that of folds in a crash."""

Found = Iterator[tuple[str, float]]
"""Paths and values."""


@dataclass(frozen=True)
class Usual:
    """A range of usual values: what has them, unit, ends in SI, and the values of an input."""

    what: str
    unit: str
    low: float
    high: float
    values: Callable[[StructureParts, float], Found]
    whose: str = ""
    """Behind the value, where it is not that of the key itself."""


@dataclass(frozen=True)
class Unusual:
    """What is unusual in an input: the value found, the limit that it is beyond, a sentence, and its code."""

    place: str
    value: float
    limit: float
    unit: str
    text: str
    code: str = "unusual_value"


def _material(key: str) -> Callable[[StructureParts, float], Found]:
    def values(structure: StructureParts, duration: float) -> Found:
        for name, material in structure.materials.items():
            value = getattr(material, key)
            if value is not None:
                yield f"materials.{name}.{key}", value

    return values


def _flow_ratios(structure: StructureParts, duration: float) -> Found:
    for name, material in structure.materials.items():
        given = (material.flow_stress, material.yield_stress)
        # a stress in a wrong unit has its own sentence
        if material.flow_stress is not None and all(one and 1e6 <= one <= 5e9 for one in given):
            yield f"materials.{name}.flow_stress", material.flow_stress / material.yield_stress


def _plastic_strains(structure: StructureParts, duration: float) -> Found:
    for name, material in structure.materials.items():
        curve = None if material.hardening is None else material.hardening.curve(material.yield_stress)
        if isinstance(curve, HardeningTable):
            yield f"materials.{name}.hardening.plastic_strain", max(curve.plastic_strain)


def _rate_factors(structure: StructureParts, duration: float) -> Found:
    for name, material in structure.materials.items():
        for key in ("yield_rate", "flow_rate"):
            given = getattr(material, key)
            if given is not None:
                yield f"materials.{name}.{key}", float(given.law().factor(RATE))


def _offsets(structure: StructureParts, duration: float) -> Found:
    for name, mass in structure.masses.items():
        yield f"masses.{name}.offset", math.hypot(*mass.offset)


def _thicknesses(structure: StructureParts, duration: float) -> Found:
    for section, member in _used(structure):
        yield f"sections.{section}", structure.section_of(member).thickness


def _sides(structure: StructureParts, duration: float) -> Found:
    for section, member in _used(structure):
        yield f"sections.{section}", float(np.ptp(structure.section_of(member).outer_outline(), axis=0).max())


def _used(structure: StructureParts) -> Iterator[tuple[str, str]]:
    """Sections in use, with a member of each."""
    yield from {spec.section: name for name, spec in structure.members.items()}.items()


def _lengths(structure: StructureParts, duration: float) -> Found:
    for name in structure.members:
        yield f"members.{name}", structure.frame_of(name).length


def _slenderness(structure: StructureParts, duration: float) -> Found:
    side = {place.partition(".")[2]: value for place, value in _sides(structure, duration)}
    lengths = _lengths(structure, duration)
    for (place, length), spec in zip(lengths, structure.members.values(), strict=True):
        # lengths and sides out of their own ranges have their own sentences
        if length <= LONGEST and side[spec.section] >= SMALLEST_SIDE:
            yield place, length / side[spec.section]


def given_laws(structure: StructureParts) -> tuple[tuple[str, LawReference], ...]:
    """Laws that hinges name or describe, with their paths."""
    return structure.kept.once("given laws", "", lambda: tuple(_given_laws(structure)))


def _given_laws(structure: StructureParts) -> Iterator[tuple[str, LawReference]]:
    asked: list[tuple[str, HingeAxes | None]] = [("hinges", structure.hinges)]
    for name, member in structure.members.items():
        if member.bars.number > 1:
            asked += [(f"members.{name}.bars", member.bars)]
        if isinstance(member.hinges, tuple):
            asked += [(f"members.{name}.hinges[{i}]", hinge) for i, hinge in enumerate(member.hinges)]
        elif member.hinges is not None:
            asked += [(f"members.{name}.hinges", member.hinges)]
    for where, keys in asked:
        if keys is not None and keys.law is not None:
            yield f"{where}.law", keys.law
        if keys is not None and keys.laws is not None:
            named = (("y", keys.laws.y), ("z", keys.laws.z))
            yield from ((f"{where}.laws.{axis}", law) for axis, law in named if law is not None)


def _table_ends(structure: StructureParts, duration: float) -> Found:
    described = [(where, law) for where, law in given_laws(structure) if not isinstance(law, str)]
    for where, law in (
        *((f"hinge_laws.{name}", law) for name, law in structure.hinge_laws.items()),
        *described,
    ):
        for key in ("rotation", "negative_rotation"):
            curve = law.own.get(key)
            if isinstance(curve, tuple) and curve:
                yield f"{where}.{key}", max(map(abs, curve))


def _masses(structure: StructureParts, duration: float) -> Found:
    yield from ((f"masses.{name}.mass", mass.mass) for name, mass in structure.masses.items())
    for name, obstacle in structure.obstacles.items():
        if obstacle.mass is not None:
            yield f"obstacles.{name}.mass", obstacle.mass


def _speeds(structure: StructureParts, duration: float) -> Found:
    for i, field in enumerate(structure.initial_velocity):
        if not field.rotation:
            yield f"initial_velocity[{i}].translation", math.hypot(*field.translation)
    for name, obstacle in structure.obstacles.items():
        yield f"obstacles.{name}.velocity", math.hypot(*obstacle.velocity)


def _tip_speeds(structure: StructureParts, duration: float) -> Found:
    for i, field in enumerate(structure.initial_velocity):
        if field.rotation:
            places = (np.asarray(structure.nodes[node], float) for node in _moved(structure, field))
            fastest = max((float(np.linalg.norm(field.at(place))) for place in places), default=0.0)
            yield f"initial_velocity[{i}].rotation", fastest


def _driven_speeds(structure: StructureParts, duration: float) -> Found:
    """Largest slopes of driven displacements between some times of a run and the corners of their curves."""
    driven = [
        *((f"supports.{name}.motion", one.motion) for name, one in structure.supports.items()),
        *((f"obstacles.{name}.motion", one.motion) for name, one in structure.obstacles.items()),
    ]
    for place, motion in driven:
        for axis in ("x", "y", "z"):
            function = getattr(motion, axis)
            if function is None:
                continue
            times = np.linspace(0.0, duration, LOOKS)
            times = np.unique(np.concatenate([times, function.kinks(0.0, duration)]))
            slopes = np.diff(function(times)) / np.diff(times)
            yield f"{place}.{axis}", float(np.abs(slopes).max(initial=0.0))


def _moved(structure: StructureParts, field: InitialVelocity) -> set[str]:
    """Nodes that a field moves, and the far ends of members, which turn with a node that it names."""
    if field.everywhere:
        return set(structure.nodes)
    named = set(field.nodes or ())
    members = set(field.members or ())
    ends = [
        spec.nodes for name, spec in structure.members.items() if name in members or named & set(spec.nodes)
    ]
    return named.union(*ends)


USUAL = (
    Usual("the Young's modulus of a metal", "Pa", 1e9, 1e12, _material("youngs_modulus")),
    Usual("the yield stress of a metal", "Pa", 1e6, 5e9, _material("yield_stress")),
    Usual("the ultimate strength of a metal", "Pa", 1e6, 5e9, _material("ultimate_stress")),
    Usual("the flow stress of a metal", "Pa", 1e6, 5e9, _material("flow_stress")),
    Usual("the flow stress over the yield stress", "1", 0.9, 10.0, _flow_ratios, " of the yield stress"),
    Usual("the largest plastic strain of a hardening curve", "1", 0.0, 3.0, _plastic_strains),
    Usual("the plastic strain at which a metal tears", "1", 0.0, 3.0, _material("failure_strain")),
    Usual("the stress at a strain rate of 100/s", "1", 1.0, 10.0, _rate_factors, " times as strong at 100/s"),
    Usual("the density of a metal", "kg/m^3", 500.0, 25e3, _material("density")),
    Usual("the wall thickness of a thin-walled section", "m", 2e-5, 0.1, _thicknesses),
    Usual("the largest side of a thin-walled section", "m", SMALLEST_SIDE, 10.0, _sides),
    Usual("the length of a member", "m", 1e-3, LONGEST, _lengths),
    Usual(
        "a member's length",
        "1",
        0.0,
        200.0,
        _slenderness,
        " times the largest side of its section",
    ),
    Usual("the largest rotation of a law", "rad", 0.0, math.pi, _table_ends),
    Usual("a mass", "kg", 0.0, 1e8, _masses),
    Usual("the offset of a mass from its node", "m", 0.0, 100.0, _offsets),
    Usual("the speed of a crash", "m/s", 0.0, 500.0, _speeds),
    Usual("the speed of a crash", "m/s", 0.0, 500.0, _tip_speeds, " at the fastest node"),
    Usual("the speed of a crash", "m/s", 0.0, 500.0, _driven_speeds, " where its curve is steepest"),
    Usual("gravity", "m/s^2", 0.0, 5e3, lambda s, _: iter([("gravity", math.hypot(*s.gravity))])),
    Usual("the duration of a crash", "s", 1e-5, 3600.0, lambda _, t: iter([("analysis.duration", t)])),
)


def unusual_values(structure: StructureParts, duration: float) -> tuple[Unusual, ...]:
    """What is outside of the ranges of `USUAL`, alike things together.

    Parameters
    ----------
    structure
        Checked.
    duration
        Of the run [s].
    """
    found = []
    for usual in USUAL:
        outside = {
            place: value
            for place, value in usual.values(structure, duration)
            if not usual.low <= value <= usual.high
        }
        for place, value in list(outside.items())[:1]:
            came = format_quantity(value, usual.unit)
            low, high = (format_quantity(end, usual.unit) for end in (usual.low, usual.high))
            allowed = f"{low} to {high}" if usual.low > 0.0 else f"at most {high}"
            others = list(outside)[1:]
            more = f" (so are {listed(others)})" if others else ""
            text = (
                f"{place}: {came}{usual.whose} is far from usual{more}; {usual.what} is {allowed}. "
                "Check its unit."
            )
            limit = usual.low if value < usual.low else usual.high
            found.append(Unusual(place, value, limit, usual.unit, text))
    return tuple(found)
