"""Hinge laws as the description gives them: which law, in which form, with which stops.

The keys of a law's own are the options of its class: see `crumple.hinge.registry`.
"""

from __future__ import annotations

from collections.abc import Iterable
from numbers import Integral
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Discriminator, Tag, model_validator

from crumple.hinge.registry import BENDING, FromFiles, options_of
from crumple.registry.keys import Key, sentence_on
from crumple.registry.quantity import (
    DampingOrCritical,
    NonNegativeAngle,
    NonNegativeRotationalDamping,
    PositiveAngle,
    PositiveAngularVelocity,
    PositiveRotationalStiffness,
    StiffnessOrAuto,
    StopExponent,
)
from crumple.registry.refusal import refuse
from crumple.structure.schema.registered import Registered
from crumple.structure.schema.spec import Name, Spec


class Regularisation(Spec):
    """Ramp of the regularised form."""

    rate: PositiveAngularVelocity = 0.05
    """Half-width of the HAVSIN ramp."""


class Stops(Spec):
    """Stops of both senses: a one-sided spring and damper each, of IMPACT form."""

    rotation: PositiveAngle
    """Rotation at which a stop comes into contact."""
    stiffness: PositiveRotationalStiffness
    """Spring; with another exponent than 1 the moment at 1 rad of penetration."""
    exponent: StopExponent = 1.0
    """Exponent of the penetration."""
    damping: DampingOrCritical = "critical"
    """Damper at full penetration; critical: computed at first contact with the stop."""
    penetration: NonNegativeAngle = 0.0
    """Penetration at which the damper acts fully; 0: at once."""


StopsOrWord = Annotated[
    Annotated[Literal["law", "none"], Tag("(word)")] | Annotated[Stops, Tag("(stops)")],
    Discriminator(lambda given: "(word)" if isinstance(given, str) else "(stops)"),
]


def _no_stops(given: Any) -> Any:
    return "none" if given is None or given is False else given


def _on_or_off(given: Any) -> Any:
    return {True: "on", False: "off"}[given] if isinstance(given, bool) else given


class LawKeys(Registered):
    """Keys that every law has."""

    type: str
    """Kind of law."""
    form: Literal["set-valued", "elastic-plastic", "regularised"] = "set-valued"
    """Form of the hinge: rigid up to the capacity, a spring in series, or a ramp over the rate."""
    elastic_stiffness: StiffnessOrAuto = "auto"
    """Spring of the elastic-plastic form; auto: the law's own, else the hinge's share of the member's."""
    regularisation: Regularisation = Regularisation()
    """Ramp of the regularised form."""
    softening: Literal["peak", "rotation", "accumulated"] = "peak"
    """Abscissa of the curve: largest plastic rotation of both senses, the current one, or the sum of all."""
    stops: Annotated[StopsOrWord, BeforeValidator(_no_stops)] = "law"
    """Stops of both senses; law: those of the law itself."""
    rate: Annotated[Literal["on", "off"], BeforeValidator(_on_or_off)] = "on"
    """Whether the material's strain-rate law raises the capacity."""
    viscous_damping: NonNegativeRotationalDamping = 0.0
    """Rotational damper in parallel with the hinge."""
    bound: Literal["nominal", "lower", "upper"] = "nominal"
    """Nominal law, or the lower or upper bound of its band."""

    @model_validator(mode="after")
    def _ramp_is_used(self) -> LawKeys:
        if self.form != "regularised" and self.regularisation != Regularisation():
            what = f"'regularisation' would have no effect: the form is {self.form}"
            refuse(what, key="regularisation", todo="write 'form: regularised', or leave it out")
        return self

    @classmethod
    def types(cls) -> Iterable[str]:
        """Laws of bending."""
        return BENDING

    @classmethod
    def keys_of_type(cls, kind: str) -> tuple[Key, ...]:
        """Options of a law."""
        return tuple(key for key in options_of(BENDING[kind]) if key.name not in cls.model_fields)

    @classmethod
    def sentence_of(cls, kind: str) -> str:
        """What a law is."""
        return sentence_on(BENDING[kind])

    @classmethod
    def file_keys(cls, kind: str) -> tuple[Key, ...]:
        """Keys of a law that name files."""
        law = BENDING[kind]
        return law.file_keys if isinstance(law, FromFiles) else ()

    @classmethod
    def embedded(cls, kind: str, given: dict[str, Any], folder: Path | None) -> dict[str, Any]:
        """Read the files that a law names, so that it carries curves and not paths."""
        law = BENDING[kind]
        return law.embedded(given, folder) if isinstance(law, FromFiles) else given


def _reference_tag(given: Any) -> str:
    return "(name)" if isinstance(given, str | Integral) else "(law)"


LawReference = Annotated[
    Annotated[Name, Tag("(name)")] | Annotated[LawKeys, Tag("(law)")], Discriminator(_reference_tag)
]
"""A law, or the name of one in ``hinge_laws``, or the name of a law type."""
