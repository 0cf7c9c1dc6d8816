"""Hardening and strain-rate laws in the input."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, ClassVar

from pydantic import model_validator

from crumple import material
from crumple.errors import InputError
from crumple.material.registry import DEFAULT_RATE, HARDENING, RATE
from crumple.registry.keys import Key, keys_of, sentence_on
from crumple.registry.refusal import refuse
from crumple.structure.schema.registered import Registered

YIELD = "yield_stress"
"""Parameter of a hardening curve that the material gives."""


class RateSpec(Registered):
    """Strain-rate law."""

    default_type: ClassVar[str | None] = DEFAULT_RATE

    type: str = DEFAULT_RATE
    """Kind of law."""

    @classmethod
    def types(cls) -> Iterable[str]:
        """Strain-rate laws."""
        return RATE

    @classmethod
    def keys_of_type(cls, kind: str) -> tuple[Key, ...]:
        """Parameters of a law."""
        return keys_of(RATE[kind])

    @classmethod
    def sentence_of(cls, kind: str) -> str:
        """What a law is."""
        return sentence_on(RATE[kind])

    def law(self) -> material.RateLaw:
        """Law of the physics room."""
        return RATE[self.type](**self.own)


class HardeningSpec(Registered):
    """Hardening curve."""

    type: str
    """Kind of curve."""

    @classmethod
    def types(cls) -> Iterable[str]:
        """Hardening curves."""
        return HARDENING

    @classmethod
    def keys_of_type(cls, kind: str) -> tuple[Key, ...]:
        """Parameters of a curve."""
        return tuple(key for key in keys_of(HARDENING[kind]) if key.name != YIELD)

    @classmethod
    def sentence_of(cls, kind: str) -> str:
        """What a curve is."""
        return sentence_on(HARDENING[kind])

    @model_validator(mode="after")
    def _consistent(self) -> HardeningSpec:
        try:
            # whatever the yield stress is, which the material knows
            self.curve(1.0)
        except InputError as error:
            refuse("this is not a hardening curve", problems=error.problems)
        return self

    def curve(self, yield_stress: float) -> material.HardeningCurve:
        """Curve of the physics room."""
        make = HARDENING[self.type]
        given = {YIELD: yield_stress} if YIELD in {key.name for key in keys_of(make)} else {}
        return make(**given, **self.own)


def rate_keys(law: material.RateLaw) -> dict[str, Any]:
    """Keys that describe a rate law of the physics room."""
    kind = next(name for name, make in RATE.items() if type(law) is make)
    return {"type": kind, **_values(law, RateSpec.keys_of_type(kind))}


def hardening_keys(curve: material.HardeningCurve) -> dict[str, Any]:
    """Keys that describe a hardening curve of the physics room."""
    if isinstance(curve, material.PerfectlyPlastic):
        curve = curve.as_table()
    kind = next((name for name, make in HARDENING.items() if type(curve) is make), None)
    if kind is None:
        allowed = f"a curve of one of the types {', '.join(HARDENING)}"
        refuse("this hardening curve cannot be described", allowed=allowed, key="hardening")
    return {"type": kind, **_values(curve, HardeningSpec.keys_of_type(kind))}


def _values(given: object, keys: tuple[Key, ...]) -> dict[str, Any]:
    return {key.name: getattr(given, key.name) for key in keys}
