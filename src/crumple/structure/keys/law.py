"""Hinge laws as the description gives them: which law, in which form, with which stops.

Each law type is one class here beside its formula in `crumple.hinge.bending`; its own keys are the options
that the formula takes.
"""

from __future__ import annotations

import math
from numbers import Integral
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Discriminator, Field, Tag, ValidationInfo, model_validator

from crumple.structure.keys.curve import MOST_POINTS, with_curve_read, with_law_read, with_units
from crumple.structure.schema.quantity import (
    Angle,
    DampingOrCritical,
    Moment,
    NonNegativeAngle,
    NonNegativeRotationalDamping,
    PositiveAngle,
    PositiveAngularVelocity,
    PositiveLength,
    PositiveMoment,
    PositiveRotationalStiffness,
    RollingWeight,
    StiffnessOrAuto,
    StopExponent,
)
from crumple.structure.schema.spec import Name, Spec, refuse, type_tag
from crumple.text.plain_yaml import LARGEST_TEXT


class Regularisation(Spec):
    """Ramp of the regularised form."""

    rate: PositiveAngularVelocity = 0.05
    """Half-width of the HAVSIN ramp."""


class Stops(Spec):
    """Stops of both senses: a one-sided spring and damper each, of IMPACT form."""

    rotation: PositiveAngle
    """Rotation at which a stop is touched."""
    stiffness: PositiveRotationalStiffness
    """Spring; with another exponent than 1 the moment at 1 rad of penetration."""
    exponent: StopExponent = 1.0
    """Exponent of the penetration."""
    damping: DampingOrCritical = "critical"
    """Damper at full penetration; critical: computed when the stop is first touched."""
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


def _folder(info: ValidationInfo) -> Path | None:
    """Folder of the input file; None where the law is built in Python."""
    directory = (info.context or {}).get("directory")
    return None if directory is None else Path(directory)


class LawKeys(Spec):
    """Keys that every law has."""

    form: Literal["set-valued", "elastic-plastic", "regularised"] = "set-valued"
    """How the capacity becomes a moment: rigid until reached, a spring in series, or a ramp over the rate."""
    elastic_stiffness: StiffnessOrAuto = "auto"
    """Spring of the elastic-plastic form; auto: the law's own, else EI over the tributary length."""
    regularisation: Regularisation = Regularisation()
    """Ramp of the regularised form."""
    softening: Literal["peak", "rotation", "accumulated"] = "peak"
    """What the curve runs on: largest plastic rotation of both senses, the current one, or the sum of all."""
    stops: Annotated[StopsOrWord, BeforeValidator(_no_stops)] = "law"
    """Stops of both senses; law: those that the law itself asks for."""
    rate: Annotated[Literal["on", "off"], BeforeValidator(_on_or_off)] = "on"
    """Whether the material's strain-rate law raises the capacity."""
    viscous_damping: NonNegativeRotationalDamping = 0.0
    """Rotational damper beside the hinge."""
    bound: Literal["nominal", "lower", "upper"] = "nominal"
    """Which law of the band that the law states: the middle or an edge."""

    @model_validator(mode="after")
    def _ramp_is_used(self) -> LawKeys:
        if self.form != "regularised" and self.regularisation != Regularisation():
            what = f"'regularisation' would do nothing: the form is {self.form}"
            refuse(what, key="regularisation", todo="write 'form: regularised', or leave it out")
        return self


class ConstantLaw(LawKeys):
    """Constant moment: a perfectly plastic hinge."""

    type: Literal["constant"] = "constant"
    """Kind of law."""
    moment: PositiveMoment | None = None
    """Moment; without it the plastic moment of the section."""


Angles = Annotated[tuple[Angle, ...], Field(max_length=MOST_POINTS)]
Moments = Annotated[tuple[Moment, ...], Field(max_length=MOST_POINTS)]
FileName = Annotated[str, Field(max_length=400)]


class ColumnUnits(Spec):
    """Units of plain numbers in a table's lists."""

    rotation: str = "rad"
    """Unit of the rotations, for example deg."""
    moment: str = "N*m"
    """Unit of the moments, for example kN*m."""


class TableLaw(LawKeys):
    """Measured or computed curve of moment against rotation, straight between its points."""

    type: Literal["table"] = "table"
    """Kind of law."""
    file: FileName | None = None
    """CSV file with one head such as `rotation [deg], moment [kN*m]`, in the folder of the input file or
    below."""
    rotation: Angles = ()
    """Rotations, increasing from 0, in place of a file."""
    moment: Moments = ()
    """Moment at each rotation."""
    negative_file: FileName | None = None
    """CSV file of the negative sense, as positive numbers; without it as in the positive sense."""
    negative_rotation: Angles | None = None
    """Rotations of the negative sense."""
    negative_moment: Moments | None = None
    """Moments of the negative sense."""
    units: ColumnUnits | None = None
    """Units of plain numbers in the lists."""
    remove_elastic: bool = False
    """Whether to take out the elastic rise with which a test starts."""
    static: bool = True
    """Whether the test was slow; a dynamic one already holds its rate effect."""

    @model_validator(mode="before")
    @classmethod
    def _embedded(cls, given: Any, info: ValidationInfo) -> Any:
        """Read the curve files, so that the law carries points and not paths."""
        if not isinstance(given, dict):
            return given
        directory = _folder(info)
        given = with_curve_read(given, directory)
        return with_units(with_curve_read(given, directory, "negative_"))

    @model_validator(mode="after")
    def _two_points(self) -> TableLaw:
        for key in ("rotation", "negative_rotation"):
            if len(getattr(self, key) or ()) == 1:
                todo = "add points, or write a constant law with this moment"
                refuse("the table has one point", key=key, allowed="at least two points", todo=todo)
        return self


class KecmanLaw(LawKeys):
    """Kecman-type mechanism of a rectangular tube."""

    type: Literal["kecman"] = "kecman"
    """Kind of law."""
    rolling_weight: RollingWeight = 1.0
    """Weight of the second rolling line of each web."""
    start: Literal["cap", "parabola"] = "cap"
    """Start: the largest moment until the mechanism falls below it, or a parabola tangent to it."""
    after_jamming: Literal["second_fold", "stop", "hold"] = "second_fold"
    """What follows when the walls touch: a further fold in series, an elastic stop, or the moment held."""


class WierzbickiLaw(LawKeys):
    """Closed form of a square tube after Wierzbicki and others (1994)."""

    type: Literal["wierzbicki"] = "wierzbicki"
    """Kind of law."""
    equivalent_side: PositiveLength | None = None
    """Mid-line side of the square tube that stands for a rectangular one."""
    after_jamming: Literal["second_fold", "stop", "hold"] = "second_fold"
    """What follows when the walls touch: a further fold in series, an elastic stop, or the moment held."""


AfterJamming = Literal["second_fold", "stop", "hold"]


class ObliqueLaw(LawKeys):
    """Rectangular tube bent about an axis between its sides: two Kecman-type folds at once."""

    type: Literal["oblique"] = "oblique"
    """Kind of law."""
    angle: Angle = math.pi / 4.0
    """Of the bending axis from the hinge's own axis, 0 deg to 90 deg."""
    rolling_weight: RollingWeight = 1.0
    """Weight of the second rolling line of each web."""
    after_jamming: AfterJamming = "second_fold"
    """What follows when the walls touch: a further fold in series, an elastic stop, or the moment held."""


class CircularLaw(LawKeys):
    """Circular tube: plastic or ovalisation moment, then a kink scaled from a square tube."""

    type: Literal["circular"] = "circular"
    """Kind of law."""
    rolling_weight: RollingWeight = 1.0
    """Weight of the second rolling line of each web of the square tube."""
    after_jamming: AfterJamming = "hold"
    """What follows when the walls touch: a further fold in series, an elastic stop, or the moment held."""


class FoldedProfileLaw(LawKeys):
    """Channel about z, hat or closed hat about y: folding mechanisms of each side, scaled from the tube's."""

    type: Literal["folded_profile"] = "folded_profile"
    """Kind of law."""
    rolling_weight: RollingWeight = 1.0
    """Weight of the second rolling line of each web."""
    after_jamming: AfterJamming = "hold"
    """What follows when the walls touch: a further fold in series, an elastic stop, or the moment held."""


class FileLaw(LawKeys):
    """Law of a law file, as `crumple hinge --save` writes it."""

    type: Literal["file"] = "file"
    """Kind of law."""
    file: FileName | None = None
    """Law file (YAML), in the folder of the input file or below."""
    text: Annotated[str, Field(max_length=LARGEST_TEXT)] = ""
    """Content of a law file, in place of its name."""

    @model_validator(mode="before")
    @classmethod
    def _embedded(cls, given: Any, info: ValidationInfo) -> Any:
        """Read and check the file, so that the law carries its curve and not a path."""
        if not isinstance(given, dict):
            return given
        return with_law_read(given, _folder(info))


LawSpec = Annotated[
    Annotated[ConstantLaw, Tag("(type=constant)")]
    | Annotated[TableLaw, Tag("(type=table)")]
    | Annotated[KecmanLaw, Tag("(type=kecman)")]
    | Annotated[WierzbickiLaw, Tag("(type=wierzbicki)")]
    | Annotated[ObliqueLaw, Tag("(type=oblique)")]
    | Annotated[CircularLaw, Tag("(type=circular)")]
    | Annotated[FoldedProfileLaw, Tag("(type=folded_profile)")]
    | Annotated[FileLaw, Tag("(type=file)")],
    Discriminator(type_tag),
]
"""Any law; ``type`` says which."""

LAW_SPECS: dict[str, type[LawKeys]] = {
    "constant": ConstantLaw,
    "table": TableLaw,
    "kecman": KecmanLaw,
    "wierzbicki": WierzbickiLaw,
    "oblique": ObliqueLaw,
    "circular": CircularLaw,
    "folded_profile": FoldedProfileLaw,
    "file": FileLaw,
}
"""Laws by type; a reference to one of these names means the law with its defaults."""


def _reference_tag(given: Any) -> str:
    return "(name)" if isinstance(given, str | Integral) else type_tag(given)


LawReference = Annotated[
    Annotated[Name, Tag("(name)")]
    | Annotated[ConstantLaw, Tag("(type=constant)")]
    | Annotated[TableLaw, Tag("(type=table)")]
    | Annotated[KecmanLaw, Tag("(type=kecman)")]
    | Annotated[WierzbickiLaw, Tag("(type=wierzbicki)")]
    | Annotated[ObliqueLaw, Tag("(type=oblique)")]
    | Annotated[CircularLaw, Tag("(type=circular)")]
    | Annotated[FoldedProfileLaw, Tag("(type=folded_profile)")]
    | Annotated[FileLaw, Tag("(type=file)")],
    Discriminator(_reference_tag),
]
"""A law, or the name of one in ``hinge_laws``, or the name of a law type."""
