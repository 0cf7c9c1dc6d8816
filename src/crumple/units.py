"""The only place of unit conversion: "50 mm" in, SI inside, readable units out.

The grammar is our own and strict: a decimal number, then a product of unit names with small integer
powers ("mm^2", "mm2").  There are no expressions, so a text such as ``9**9**9 mm`` is refused at no cost.
The units of mechanics are a table of exact ratios; any other single unit name is looked up in pint,
which takes a quarter of a second to import and is loaded only then.

An angle is a dimension of its own here: `5 Hz` for an angular velocity is refused, since it may mean
5 rad/s or 31.4 rad/s.
"""

from __future__ import annotations

import difflib
import math
import re
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from typing import Any

from crumple.errors import InputError, Problem

MAX_TEXT = 80
"""Largest number of characters of a quantity; a longer text is a mistake."""
MAX_POWER = 6
"""Largest power of one unit: mm^4 is common, mm^6 is a warping constant."""
MAX_FACTORS = 8
"""Unit names in one product."""

Dimension = tuple[int, int, int, int, int]
"""Powers of length, mass, time, angle, temperature."""

_NUMBER = r"[+-]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][+-]?[0-9]{1,3})?"
_QUANTITY = re.compile(rf"(?P<number>{_NUMBER})\s*(?P<unit>.*)", re.DOTALL)
_FACTOR = re.compile(
    r"\s*(?P<name>[A-Za-zµ°%]{1,24}|1)(?:\s*(?:\^|\*\*)\s*(?P<power>[+-]?[0-9])|(?<=[A-Za-z])(?P<plain>[2-6]))?\s*"
)
_OPERATOR = re.compile(r"[*/·]")
_SAME_CHARACTER = str.maketrans({"μ": "µ", "²": "^2", "³": "^3", "⁴": "^4"})


class QuantityError(InputError, ValueError):
    """A quantity that cannot be accepted; the message gives the value, what is allowed and what to do."""


@dataclass(frozen=True)
class Unit:
    """A unit as a factor to SI: ``ratio * irrational`` with powers of the base dimensions."""

    ratio: Fraction
    irrational: float
    dimension: Dimension

    def times(self, other: Unit, power: int) -> Unit:
        """Product of this unit and another one raised to a small integer power."""
        dimension = tuple(a + power * b for a, b in zip(self.dimension, other.dimension, strict=True))
        return Unit(
            self.ratio * other.ratio**power,
            self.irrational * other.irrational**power,
            dimension,  # type: ignore[arg-type]
        )


_ONE: Dimension = (0, 0, 0, 0, 0)
_LENGTH: Dimension = (1, 0, 0, 0, 0)
_MASS: Dimension = (0, 1, 0, 0, 0)
_TIME: Dimension = (0, 0, 1, 0, 0)
_ANGLE: Dimension = (0, 0, 0, 1, 0)
_TEMPERATURE: Dimension = (0, 0, 0, 0, 1)
_FORCE: Dimension = (1, 1, -2, 0, 0)
_STRESS: Dimension = (-1, 1, -2, 0, 0)
_ENERGY: Dimension = (2, 1, -2, 0, 0)

_POUND = Fraction("0.45359237")
_POUND_FORCE = _POUND * Fraction("9.80665")
_INCH = Fraction("0.0254")
_PREFIXES = {"n": -9, "µ": -6, "u": -6, "m": -3, "": 0, "k": 3, "M": 6, "G": 9}
_PREFIXED: dict[str, tuple[Fraction, Dimension]] = {
    "m": (Fraction(1), _LENGTH),
    "g": (Fraction(1, 1000), _MASS),
    "s": (Fraction(1), _TIME),
    "N": (Fraction(1), _FORCE),
    "Pa": (Fraction(1), _STRESS),
    "J": (Fraction(1), _ENERGY),
    "W": (Fraction(1), (2, 1, -3, 0, 0)),
    "Hz": (Fraction(1), (0, 0, -1, 0, 0)),
    # written without a sign between them, as engineers do
    "Nm": (Fraction(1), _ENERGY),
    "Nmm": (Fraction(1, 1000), _ENERGY),
    "Ns": (Fraction(1), (1, 1, -1, 0, 0)),
}
_OTHERS: dict[str, tuple[Fraction, Dimension]] = {
    "1": (Fraction(1), _ONE),
    "%": (Fraction(1, 100), _ONE),
    "cm": (Fraction(1, 100), _LENGTH),
    "dm": (Fraction(1, 10), _LENGTH),
    "in": (_INCH, _LENGTH),
    "inch": (_INCH, _LENGTH),
    "ft": (12 * _INCH, _LENGTH),
    "t": (Fraction(1000), _MASS),
    "lb": (_POUND, _MASS),
    "lbf": (_POUND_FORCE, _FORCE),
    "psi": (_POUND_FORCE / _INCH**2, _STRESS),
    "ksi": (1000 * _POUND_FORCE / _INCH**2, _STRESS),
    "bar": (Fraction(100_000), _STRESS),
    "min": (Fraction(60), _TIME),
    "h": (Fraction(3600), _TIME),
    "mph": (Fraction("0.44704"), (1, 0, -1, 0, 0)),
    "kmh": (Fraction(5, 18), (1, 0, -1, 0, 0)),
    "K": (Fraction(1), _TEMPERATURE),
    "rad": (Fraction(1), _ANGLE),
    "mrad": (Fraction(1, 1000), _ANGLE),
}
_TURNS: dict[str, tuple[Fraction, Dimension]] = {  # ratio of pi
    "deg": (Fraction(1, 180), _ANGLE),
    "°": (Fraction(1, 180), _ANGLE),
    "rev": (Fraction(2), _ANGLE),
    "rpm": (Fraction(1, 30), (0, 0, -1, 1, 0)),
}


def _table() -> dict[str, Unit]:
    """Units of mechanics by name, each an exact ratio to SI (angles: a ratio of pi)."""
    units = {
        prefix + name: Unit(ratio * Fraction(10) ** exponent, 1.0, dimension)
        for name, (ratio, dimension) in _PREFIXED.items()
        for prefix, exponent in _PREFIXES.items()
    }
    units |= {name: Unit(ratio, 1.0, dimension) for name, (ratio, dimension) in _OTHERS.items()}
    units |= {name: Unit(ratio, math.pi, dimension) for name, (ratio, dimension) in _TURNS.items()}
    return units


COLLOQUIAL: dict[str, str] = {"kilo": "kg", "kilos": "kg"}
"""Units by what people say, which pint takes for others: a kilosecond."""
TABLE = _table()
"""Units known without pint."""

# SI unit: what it measures, accepted units; the first entry of a dimension names the given quantity
_KINDS: dict[str, tuple[str, str]] = {
    "m": ("a length", "m, mm, cm, in, ft"),
    "kg": ("a mass", "kg, g, t, lb"),
    "s": ("a time", "s, ms, µs"),
    "rad": ("an angle", "deg, rad, mrad"),
    "Pa": ("a stress", "Pa, MPa, GPa, N/mm^2, psi, ksi"),
    "N": ("a force", "N, kN, MN, lbf"),
    "N*m": ("a moment", "N*m, kN*m, N*mm"),
    "J": ("an energy", "J, kJ, N*m"),
    "W": ("a power", "W, kW"),
    "m/s": ("a velocity", "m/s, mm/ms, km/h, mph"),
    "m/s^2": ("an acceleration", "m/s^2, mm/ms^2"),
    "rad/s": ("an angular velocity", "rad/s, deg/s, rpm"),
    "rad/s^2": ("an angular acceleration", "rad/s^2, deg/s^2"),
    "1/s": ("a rate or frequency", "1/s, 1/ms, Hz"),
    "kg/m^3": ("a density", "kg/m^3, g/cm^3, t/mm^3"),
    "kg/m": ("a mass per length", "kg/m, g/mm"),
    "kg*m^2": ("a rotary inertia", "kg*m^2, kg*mm^2, t*mm^2"),
    "m^2": ("an area", "mm^2, cm^2, m^2"),
    "m^3": ("a volume or section modulus", "mm^3, cm^3, m^3"),
    "m^4": ("a second moment of area", "mm^4, cm^4, m^4"),
    "N*s": ("an impulse", "N*s, kN*s, kg*m/s"),
    "N*m*s": ("an angular impulse", "N*m*s, kN*m*s"),
    "N/m": ("a stiffness", "N/m, N/mm, kN/mm"),
    "N*s/m": ("a damping", "N*s/m, N*s/mm"),
    "N*m/rad": ("a rotational stiffness", "N*m/rad, kN*m/rad, N*m/deg"),
    "N*m*s/rad": ("a rotational damping", "N*m*s/rad, kN*m*s/rad"),
    "1/rad": ("a number per angle", "1/rad, 1/deg"),
    "K": ("a temperature difference", "K"),
    "1": ("a plain number", "a number without a unit, %"),
}

# SI unit: readable units, largest first; the first in which the number is at least 1 is used
_READABLE: dict[str, tuple[str, ...]] = {
    "m": ("m", "mm", "µm"),
    "m^2": ("m^2", "mm^2"),
    "m^3": ("m^3", "cm^3", "mm^3"),
    "m^4": ("m^4", "cm^4", "mm^4"),
    "m^6": ("m^6", "cm^6", "mm^6"),
    "kg": ("t", "kg", "g"),
    "s": ("s", "ms", "µs", "ns"),
    "rad": ("deg",),
    "Pa": ("GPa", "MPa", "kPa", "Pa"),
    "N": ("MN", "kN", "N"),
    "N*m": ("MN m", "kN m", "N m"),
    "N*m/rad": ("MN m/rad", "kN m/rad", "N m/rad"),
    "N/m": ("MN/m", "kN/m", "N/m"),
    "J": ("MJ", "kJ", "J"),
    "W": ("MW", "kW", "W"),
    "Hz": ("MHz", "kHz", "Hz"),
}
_LARGEST_ALONE = {"t": 1e4, "MN": 1e7, "MN m": 1e7, "MJ": 1e7}
"""Value [SI] below which a large unit is not used: 6000 kg instead of 6 t."""


_EXPONENT_FROM = 1e7
"""Numbers below it are written without an exponent: 369400 instead of 3.694e+05."""


def parse_quantity(text: str, unit: str) -> float:
    """SI value of a text such as ``50 mm`` or ``7850 kg/m^3``.

    Parameters
    ----------
    text
        A decimal number and a unit: names joined by ``*``, ``/`` or a space, powers ``^2``, ``**2`` or ``2``.
        A bare ``0`` needs no unit.
    unit
        SI unit of what is wanted, for example ``"Pa"``; sets the dimension. ``"1"``: a plain number.

    Returns
    -------
    float
        Value in SI, finite and correctly rounded: ``parse_quantity("2.65 mm", "m") == 0.00265``.

    Raises
    ------
    QuantityError
        If the text is not a number with a unit, is not finite or has another dimension.
    """
    if not isinstance(text, str):
        raise _refusal("this is not a text with a number and a unit", text, unit)
    if len(text) > MAX_TEXT:
        raise _refusal(f"a quantity has at most {MAX_TEXT} characters", text, unit)
    return _parsed(text, unit)


# a large frame writes the same few lengths again and again
@lru_cache(8192)
def _parsed(text: str, unit: str) -> float:
    match = _QUANTITY.fullmatch(text.strip())
    if match is None and "\N{MINUS SIGN}" in text:
        raise _refusal("this minus is a typographic sign: write '-'", text, unit)
    if match is not None and match["unit"].startswith(","):
        raise _refusal("this number has a comma: write a decimal point, and no separators", text, unit)
    if match is None:
        raise _refusal("this is not a number with a unit", text, unit)
    number, unit_text = match["number"], match["unit"].strip()
    if not unit_text:
        if float(number) == 0.0 or unit == "1":
            return _finite(Fraction(number), TABLE["1"], text, unit)
        raise _refusal("the unit is missing", text, unit)
    return _finite(Fraction(number), _unit_of(unit_text, unit, text), text, unit)


def unit_factor(unit_text: str, unit: str) -> float:
    """SI value of one of a unit, for column heads: ``unit_factor("deg", "rad")``.

    Parameters
    ----------
    unit_text
        Unit as written, for example ``kN*m``.
    unit
        SI unit that sets the dimension.

    Returns
    -------
    float
        Factor from the written unit to SI.

    Raises
    ------
    QuantityError
        If the unit is unknown or has another dimension.
    """
    if len(unit_text) > MAX_TEXT:
        raise _refusal(f"a unit has at most {MAX_TEXT} characters", unit_text, unit)
    return _finite(Fraction(1), _unit_of(unit_text.strip() or "1", unit, unit_text), unit_text, unit)


def format_quantity(value: float, unit: str, digits: int = 4) -> str:
    """A value in a readable unit: ``format_quantity(488e6, "Pa")`` is ``488 MPa``.

    Parameters
    ----------
    value
        In SI; need not be finite.
    unit
        SI unit, for example ``"N*m"``; a unit without a list of readable units is written unchanged.
    digits
        Significant digits.

    Returns
    -------
    str
        Number, space, unit; `parse_quantity` reads it back.  Angles come in degrees.
    """
    ladder = _READABLE.get(unit, (unit.replace("*", " "),))
    chosen = ladder[-1]
    if value == 0.0:
        # zero is written in the unit in which the quantity is stated in SI
        chosen = next((name for name in ladder if _scale(name) == 1.0), ladder[0])
    elif math.isfinite(value):
        fitting = (
            name
            for name in ladder
            if _digits(value / _scale(name), digits) >= 1.0 and abs(value) >= _LARGEST_ALONE.get(name, 0.0)
        )
        chosen = next(fitting, ladder[-1])
    number = plain_number(value / _scale(chosen), digits)
    return number if chosen == "1" else f"{number} {chosen}"


def plain_number(value: float, digits: int = 4) -> str:
    """A number with significant digits, without an exponent below 10 million: 7630, not 7.63e+03.

    Parameters
    ----------
    value
        In the unit that is written behind it; need not be finite.
    digits
        Significant digits.
    """
    number = format(value, f".{digits}g")
    if "e+0" in number and abs(value) < _EXPONENT_FROM:
        number = format(float(number), ".0f")
    return number


def _digits(value: float, digits: int) -> float:
    """Size of a number after rounding to significant digits, so that 999.99 MPa becomes 1 GPa."""
    return abs(float(format(value, f".{digits}g")))


def _scale(unit_text: str) -> float:
    unit = _parse_unit(unit_text)
    return float(unit.ratio) * unit.irrational


def _finite(number: Fraction, unit: Unit, text: str, wanted: str) -> float:
    try:
        value = float(number * unit.ratio) * unit.irrational
    except OverflowError:
        value = math.inf
    if not math.isfinite(value):
        raise _refusal("the number is too large", text, wanted)
    return value


def _unit_of(unit_text: str, wanted: str, text: str) -> Unit:
    """Parsed unit, refused when its dimension is not that of the wanted unit."""
    try:
        unit = _parse_unit(unit_text)
    except QuantityError as error:
        raise _refusal(error.problems[0].what, text, wanted) from None
    if unit.dimension != _parse_unit(wanted).dimension:
        kind = _kind_of(unit.dimension)
        what = (
            f"{unit_text} is the unit of {kind}" if kind else f"{unit_text} is the unit of another quantity"
        )
        raise _refusal(f"{what}, but {_wanted(wanted)[0]} is needed", text, wanted)
    return unit


@lru_cache(maxsize=1024)
def _parse_unit(unit_text: str) -> Unit:
    """Product of unit names; raises QuantityError with the reason alone."""
    text = unit_text.translate(_SAME_CHARACTER)
    unit, position, sign = TABLE["1"], 0, 1
    for _ in range(MAX_FACTORS):
        match = _FACTOR.match(text, position)
        if match is None:
            raise QuantityError(f"{_quoted(unit_text)} is not a product of unit names")
        power = int(match["power"] or match["plain"] or 1)
        if abs(power) > MAX_POWER:
            raise QuantityError(f"the power {power} is larger than {MAX_POWER}")
        unit = unit.times(_named_unit(match["name"]), sign * power)
        position = match.end()
        if position == len(text):
            return unit
        # a space alone multiplies, as in "kN m"
        operator = _OPERATOR.match(text, position)
        if operator is None and not text[position - 1].isspace():
            raise QuantityError(f"{_quoted(unit_text)} is not a product of unit names")
        sign = -1 if operator is not None and operator[0] == "/" else 1
        position += 1 if operator is not None else 0
    raise QuantityError(f"more than {MAX_FACTORS} unit names in one product")


def _named_unit(name: str) -> Unit:
    known = TABLE.get(name) or (None if name in COLLOQUIAL else _pint_unit(name))
    if known is None:
        hint = f" (did you mean {' or '.join(_meant(name))}?)" if _meant(name) else ""
        raise QuantityError(f"unknown unit {_quoted(name)}{hint}")
    return known


def _meant(name: str) -> list[str]:
    """Units that an unknown name may stand for: kg for "kgs", J*s for "Js", else those spelt nearly so."""
    if name in COLLOQUIAL:
        return [COLLOQUIAL[name]]
    one = TABLE.get(name[:-1]) if name.endswith("s") else None
    if one is not None:
        # a plural is that of a base unit
        return [name[:-1] if sum(map(abs, one.dimension)) == 1 else f"{name[:-1]}*s"]
    close = difflib.get_close_matches(name.lower(), [key.lower() for key in TABLE], n=1, cutoff=0.75)
    return sorted(key for key in TABLE if close and key.lower() == close[0])


@lru_cache(maxsize=1)
def _registry() -> Any:
    import pint  # noqa: PLC0415  (slow, and only for units outside the table)

    return pint.UnitRegistry(cache_folder=None)


@lru_cache(maxsize=256)
def _pint_unit(name: str) -> Unit | None:
    """A single unit name that only pint knows; None if unknown, offset (degC) or not of mechanics."""
    registry = _registry()
    if not name.isalpha() or not registry.parse_unit_name(name):
        return None
    one, two = (registry.Quantity(value, registry.Unit(name)).to_root_units() for value in (1.0, 2.0))
    factor, powers = one.magnitude, dict(one.unit_items())
    # pint's root units: metre, gram, second, radian, kelvin; constants such as pi are no units here
    mass = powers.get("gram", 0)
    ordered = [powers.pop(key, 0) for key in ("meter", "gram", "second", "radian", "kelvin")]
    proportional = abs(two.magnitude - 2 * factor) <= 1e-12 * abs(factor)
    if not proportional or powers or not any(ordered) or any(power != int(power) for power in ordered):
        return None
    ratio = Fraction(factor) * Fraction(1, 1000) ** int(mass)
    return Unit(ratio, 1.0, tuple(int(power) for power in ordered))  # type: ignore[arg-type]


def _kind_of(dimension: Dimension) -> str:
    """Names of what has this dimension: "a moment or an energy"; empty where there is no word."""
    return " or ".join(name for unit, (name, _) in _KINDS.items() if _parse_unit(unit).dimension == dimension)


def _wanted(unit: str) -> tuple[str, str]:
    return _KINDS.get(unit, (f"a quantity in {unit}", unit))


def _quoted(text: object, longest: int = 40) -> str:
    shown = text if isinstance(text, str) else repr(text)
    shown = "".join(character if character.isprintable() else "?" for character in shown[: longest + 1])
    return "'" + (shown if len(shown) <= longest else shown[:longest] + "...") + "'"


def _refusal(what: str, text: object, wanted: str) -> QuantityError:
    name, units = _wanted(wanted)
    example = units.split(", ")[0] if wanted != "1" else ""
    todo = f"write {name} as a number and a unit, for example '5 {example}'" if example else "write a number"
    return QuantityError(Problem(what=what, came=_quoted(text), allowed=units, todo=todo))
