"""Quantities of an input: texts with units in the input, plain SI floats inside.

``Length``, ``Stress`` and the others are annotated floats.  In Python a plain float is taken as SI and a
text is converted; in an input file a bare number is refused unless it is 0, because 50 may mean 50 mm.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from numbers import Real
from typing import TYPE_CHECKING, Annotated, Any, Literal

from crumple.errors import InputError
from crumple.registry.refusal import refuse
from crumple.units import QuantityError, parse_quantity

if TYPE_CHECKING:
    from pydantic import GetJsonSchemaHandler, ValidationInfo
    from pydantic_core import CoreSchema

LARGEST = 1e18
"""Largest magnitude in SI; beyond it products overflow and no structure is that stiff, large or heavy."""
SMALLEST = 1e-18
"""Smallest magnitude in SI that is not zero; below it products underflow to a singular model."""


class Converted(float):
    """A number that a curve reader has already converted to SI: it needs no unit even in a file."""


@dataclass(frozen=True)
class Dimension:
    """Quantity and permitted range of a number.

    Attributes
    ----------
    noun
        With its article, for messages: "a length".
    unit
        SI unit, ``"1"`` for a plain number.
    example
        As an engineer would write it.
    above, at_least, below, at_most
        Bounds in SI; None where there is none.
    words
        Texts accepted in place of a number, such as "critical".
    """

    noun: str
    unit: str
    example: str
    above: float | None = None
    at_least: float | None = None
    below: float | None = None
    at_most: float | None = None
    words: tuple[str, ...] = ()

    def bounds(self) -> str:
        """Bounds in words, such as ``more than 0``; empty without any."""
        limits = (
            ("more than", self.above),
            ("at least", self.at_least),
            ("less than", self.below),
            ("at most", self.at_most),
        )
        unit = "" if self.unit == "1" else f" {self.unit}"
        texts = [f"{word} {limit:g}{unit if limit else ''}" for word, limit in limits if limit is not None]
        return " and ".join(texts)

    def allowed(self) -> str:
        """What is accepted, in words."""
        written = "a plain number" if self.unit == "1" else f"{self.noun} with its unit"
        words = "".join(f", or {word}" for word in self.words)
        return (
            ", ".join(text for text in (f"{written}, for example {self.example}", self.bounds()) if text)
            + words
        )

    def value_of(self, given: object, info: ValidationInfo) -> float | str:
        """SI value, or one of the permitted words; refuses anything else."""
        if isinstance(given, str) and given in self.words:
            return given
        in_file = bool(info.context and info.context.get("file"))
        value = self._number(given, in_file)
        if not math.isfinite(value):
            refuse("the number is not finite", allowed=self.allowed(), todo="write a finite number")
        if value != 0.0 and not SMALLEST <= abs(value) <= LARGEST:
            refuse(
                "the number is too large or too small for any structure",
                allowed=self.allowed(),
                todo="check its unit",
            )
        if not self._in_bounds(value):
            what, todo = f"the number is out of range: it must be {self.bounds()}", "correct the number"
            refuse(what, allowed=self.allowed(), todo=todo)
        return value

    def _number(self, given: object, in_file: bool) -> float:
        if isinstance(given, str):
            if self.unit == "1":
                refuse("a plain number is needed here, not a text", allowed=self.allowed())
            try:
                return parse_quantity(given, self.unit)
            except QuantityError as error:
                problem = error.problems[0]
                todo = f"write {self.noun} with its unit, for example {self.example}"
                refuse(problem.what, allowed=problem.allowed, todo=todo)
        # Real: the scalars of NumPy are numbers too
        if isinstance(given, bool) or not isinstance(given, Real):
            refuse(f"{self.noun} is needed here", allowed=self.allowed())
        try:
            value = float(given)
        except OverflowError:
            value = math.inf
        converted = not in_file or isinstance(given, Converted)
        if not converted and self.unit != "1" and value != 0.0 and math.isfinite(value):
            refuse(
                "the unit is missing",
                allowed=self.allowed(),
                todo=f"write the unit, for example {self.example}",
            )
        return value

    def _in_bounds(self, value: float) -> bool:
        return (
            (self.above is None or value > self.above)
            and (self.at_least is None or value >= self.at_least)
            and (self.below is None or value < self.below)
            and (self.at_most is None or value <= self.at_most)
        )

    def __get_pydantic_core_schema__(self, source: Any, handler: Any) -> CoreSchema:
        from pydantic_core import core_schema  # noqa: PLC0415  (sections and laws alone need none)

        return core_schema.with_info_plain_validator_function(self.value_of)

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        if self.unit == "1":
            bounds = {"exclusiveMinimum": self.above, "minimum": self.at_least}
            bounds |= {"exclusiveMaximum": self.below, "maximum": self.at_most}
            number = {"type": "number", **{key: limit for key, limit in bounds.items() if limit is not None}}
            return {"anyOf": [number, {"enum": list(self.words)}]} if self.words else number
        alternatives: list[dict[str, Any]] = [
            {"type": "string", "pattern": r"^\s*[+-]?[0-9.]", "maxLength": 80}
        ]
        if self.words:
            alternatives.append({"enum": list(self.words)})
        if self._in_bounds(0.0):
            alternatives.append({"const": 0})
        bounds_text = f" ({self.bounds()})" if self.bounds() else ""
        return {
            "anyOf": alternatives,
            "description": f"{self.noun} with its unit, for example '{self.example}'{bounds_text}",
            "examples": [self.example],
            "x-unit": self.unit,
        }


def texts_to_si(given: object, units: Mapping[str, str]) -> None:
    """Replace texts with units among attributes of a frozen object by SI numbers.

    Parameters
    ----------
    given
        An object whose attributes are being checked.
    units
        SI unit by attribute.

    Raises
    ------
    InputError
        With every text that is no quantity of its unit.
    """
    problems = []
    for name, unit in units.items():
        value = getattr(given, name)
        if not isinstance(value, str):
            continue
        try:
            object.__setattr__(given, name, parse_quantity(value, unit))
        except QuantityError as error:
            problems += [replace(problem, where=name) for problem in error.problems]
    if problems:
        raise InputError(problems)


@dataclass(frozen=True)
class Whole:
    """Whole number between two bounds."""

    at_least: int
    at_most: int

    def __get_pydantic_core_schema__(self, source: Any, handler: Any) -> CoreSchema:
        from pydantic_core import core_schema  # noqa: PLC0415  (sections and laws alone need none)

        return core_schema.int_schema(ge=self.at_least, le=self.at_most, strict=True)


@dataclass(frozen=True)
class Longest:
    """Largest, and least, number of characters of a text or of entries of a list."""

    number: int
    least: int = 0

    def __get_pydantic_core_schema__(self, source: Any, handler: Any) -> CoreSchema:
        schema: CoreSchema = handler(source)
        return {**schema, "max_length": self.number, "min_length": self.least}


def _positive(dimension: Dimension) -> Dimension:
    return replace(dimension, above=0.0)


def _not_negative(dimension: Dimension) -> Dimension:
    return replace(dimension, at_least=0.0)


LENGTH = Dimension("a length", "m", "50 mm")
MASS = Dimension("a mass", "kg", "6 kg")
TIME = Dimension("a time", "s", "100 ms")
ANGLE = Dimension("an angle", "rad", "90 deg")
STRESS = Dimension("a stress", "Pa", "488 MPa")
DENSITY = Dimension("a density", "kg/m^3", "7850 kg/m^3")
# above any crash speed: elastic waves in steel travel at 5 km/s, and neither solver is valid near that
VELOCITY = Dimension("a velocity", "m/s", "10 m/s", at_least=-1000.0, at_most=1000.0)
ACCELERATION = Dimension("an acceleration", "m/s^2", "-9.81 m/s^2")
ANGULAR_VELOCITY = Dimension("an angular velocity", "rad/s", "15 rad/s")
SPIN = replace(ANGULAR_VELOCITY, at_least=-1e4, at_most=1e4)
FORCE = Dimension("a force", "N", "5 kN")
MOMENT = Dimension("a moment", "N*m", "1.2 kN*m")
IMPULSE = Dimension("an impulse", "N*s", "5 N*s")
ANGULAR_IMPULSE = Dimension("an angular impulse", "N*m*s", "5 N*m*s")
ROTARY_INERTIA = Dimension("a rotary inertia", "kg*m^2", "0.1 kg*m^2")
ROTATIONAL_STIFFNESS = Dimension("a rotational stiffness", "N*m/rad", "20 kN*m/rad")
ROTATIONAL_DAMPING = Dimension("a rotational damping", "N*m*s/rad", "2 kN*m*s/rad")
ENERGY = Dimension("an energy", "J", "5 kJ")
RATE = Dimension("a strain rate", "1/s", "40.4 1/s")
FREQUENCY = Dimension("a frequency", "1/s", "500 Hz")
NUMBER = Dimension("a number", "1", "0.5")
COUNT = Whole(1, 20)

Length = Annotated[float, LENGTH]
PositiveLength = Annotated[float, _positive(LENGTH)]
NonNegativeLength = Annotated[float, _not_negative(LENGTH)]
PositiveMass = Annotated[float, _positive(MASS)]
NonNegativeMass = Annotated[float, _not_negative(MASS)]
Time = Annotated[float, TIME]
PositiveTime = Annotated[float, _positive(TIME)]
# of a run or stage: the smallest step of the multibody solver; elastic waves go 5 micrometres meanwhile
Duration = Annotated[float, replace(TIME, at_least=1e-9)]
NonNegativeTime = Annotated[float, _not_negative(TIME)]
Angle = Annotated[float, ANGLE]
PositiveAngle = Annotated[float, _positive(ANGLE)]
NonNegativeAngle = Annotated[float, _not_negative(ANGLE)]
Stress = Annotated[float, STRESS]
PositiveStress = Annotated[float, _positive(STRESS)]
PositiveDensity = Annotated[float, _positive(DENSITY)]
Velocity = Annotated[float, VELOCITY]
Acceleration = Annotated[float, ACCELERATION]
AngularVelocity = Annotated[float, SPIN]
PositiveAngularVelocity = Annotated[float, _positive(ANGULAR_VELOCITY)]
Force = Annotated[float, FORCE]
PositiveForce = Annotated[float, _positive(FORCE)]
PositiveEnergy = Annotated[float, _positive(ENERGY)]
Moment = Annotated[float, MOMENT]
PositiveMoment = Annotated[float, _positive(MOMENT)]
Impulse = Annotated[float, IMPULSE]
AngularImpulse = Annotated[float, ANGULAR_IMPULSE]
NonNegativeRotaryInertia = Annotated[float, _not_negative(ROTARY_INERTIA)]
PositiveRotationalStiffness = Annotated[float, _positive(ROTATIONAL_STIFFNESS)]
NonNegativeRotationalDamping = Annotated[float, _not_negative(ROTATIONAL_DAMPING)]
StiffnessOrAuto = Annotated[
    float | Literal["auto"], replace(_positive(ROTATIONAL_STIFFNESS), words=("auto",))
]
DampingOrCritical = Annotated[
    float | Literal["critical"], replace(_not_negative(ROTATIONAL_DAMPING), words=("critical",))
]
PositiveRate = Annotated[float, _positive(RATE)]
PositiveFrequency = Annotated[float, _positive(FREQUENCY)]
Number = Annotated[float, NUMBER]
PositiveNumber = Annotated[float, _positive(NUMBER)]
NonNegativeNumber = Annotated[float, _not_negative(NUMBER)]
FrictionCoefficient = Annotated[float, replace(NUMBER, example="0.2", at_least=0.0, at_most=10.0)]
Restitution = Annotated[float, replace(NUMBER, example="0.1", at_least=0.0, at_most=1.0)]
RateExponent = Annotated[float, replace(NUMBER, example="5", at_least=1.0)]
StopExponent = RateExponent
HardeningExponent = Annotated[float, replace(NUMBER, example="0.12", at_least=0.0, at_most=1.0)]
RollingWeight = Annotated[float, replace(NUMBER, example="0.5", at_least=0.0, at_most=1.0)]
PoissonsRatio = Annotated[float, replace(NUMBER, example="0.3", at_least=0.0, below=0.5)]
Accuracy = Annotated[float, replace(NUMBER, example="1e-3", at_least=1e-12, at_most=0.1)]
Fraction = Annotated[float, replace(NUMBER, example="0.01", above=0.0, at_most=1.0)]

Count = Annotated[int, COUNT]
"""Number of repeated parts, such as the cells of a section."""

Position = tuple[Length, Length, Length]
Direction = tuple[Number, Number, Number]
