"""Functions of time as the description gives them: numbers and named shapes, never text to evaluate."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any

from pydantic import GetJsonSchemaHandler, SerializationInfo, ValidationInfo
from pydantic_core import CoreSchema, core_schema

from crumple.errors import InputError
from crumple.function import TimeFunction, parse_time_function
from crumple.registry.refusal import refuse

_RAMP = {"type": "object", "required": ["x0", "h0", "x1", "h1"], "additionalProperties": False}
_STOP = {"type": "object", "required": ["x", "x1", "k", "e", "cmax", "d"]}


@dataclass(frozen=True)
class FunctionOf:
    """What the values of a function of time measure.

    Attributes
    ----------
    noun
        With its article: "a force".
    unit
        SI unit of the values.
    example
        A value as an engineer would write it.
    """

    noun: str
    unit: str
    example: str

    def function_of(self, given: object, info: ValidationInfo) -> TimeFunction:
        """The function; refuses with every problem inside it."""
        in_file = bool(info.context and info.context.get("file"))
        try:
            return parse_time_function(given, self.unit, plain_numbers=not in_file)
        except InputError as error:
            refuse("this is not a function of time", problems=error.problems)

    def __get_pydantic_core_schema__(self, source: Any, handler: Any) -> CoreSchema:
        written = core_schema.plain_serializer_function_ser_schema(_as_mapping, info_arg=True)
        return core_schema.with_info_plain_validator_function(self.function_of, serialization=written)

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        value = {"type": ["string", "number"], "description": f"{self.noun}, for example '{self.example}'"}
        time = {"type": ["string", "number"], "description": "a time, for example '10 ms'"}
        ramp = {**_RAMP, "properties": {"x0": time, "h0": value, "x1": time, "h1": value}}
        table = {
            "type": "object",
            "required": ["time", "value"],
            "properties": {
                "time": {"type": "array", "items": time},
                "value": {"type": "array", "items": value},
                "units": {"type": "object", "description": "units of plain numbers: {time: ms, value: kN}"},
            },
            "additionalProperties": False,
        }
        shapes = {"constant": value, "step": ramp, "step5": ramp, "havsin": ramp, "table": table}
        shapes |= {"sum": {"type": "array", "description": "functions of time, added"}}
        if self.unit in {"N", "N*m"}:
            shapes |= {"impact": _STOP, "bistop": {**_STOP, "required": [*_STOP["required"], "x2"]}}
        return {
            "anyOf": [
                {"type": "string", "examples": [self.example]},
                {"const": 0},
                {
                    "type": "object",
                    "minProperties": 1,
                    "maxProperties": 1,
                    "properties": shapes,
                    "additionalProperties": False,
                },
            ],
            "description": f"{self.noun} as a function of time",
            "x-unit": self.unit,
        }


def _as_mapping(function: TimeFunction, info: SerializationInfo) -> dict[str, Any]:
    return function.as_mapping()


LengthFunction = Annotated[TimeFunction, FunctionOf("a length", "m", "50 mm")]
AngleFunction = Annotated[TimeFunction, FunctionOf("an angle", "rad", "10 deg")]
ForceFunction = Annotated[TimeFunction, FunctionOf("a force", "N", "5 kN")]
MomentFunction = Annotated[TimeFunction, FunctionOf("a moment", "N*m", "1.2 kN*m")]
